"""What a laboratory would measure on the published relay, by the second solution of the model, with scatter."""

from functools import cache
from pathlib import Path

import numpy as np

from reference import Reference
from relay_contact import Array, Value, Values, write_table
from relay_contact.identification.measurement import FORCE, RESPONSE, RINGDOWN, Measurement
from relay_contact.identification.measurement import FREQUENCY as FREQUENCIES

TRUTH: dict[str, float] = {
    "contact.overtravel": 2.06e-4, "beam.youngsModulus": 1.2e11, "tip.mass": 2.4e-5, "beam.stiffnessDamping": 7.5e-5,
}  # fmt: skip
AWAY: Values = {"contact.overtravel": -1e-2}
SCATTER = {"force": 0.005, "ring": 0.01, "response": 0.03, "chatter": 0.03}
"""Standard deviations: of the largest force, of the first deflection, and of each amplitude and level."""
TRAVEL = np.linspace(-1e-4, 2e-4, 7)
TIME = np.linspace(2e-3, 22e-3, 120)
FREQUENCY = np.linspace(400.0, 2200.0, 9)
LEVELS = np.linspace(600.0, 1600.0, 6)
OPENING, RESISTANCE = 10e-6, 60.0
RINGING: dict[str, float] = {**TRUTH, "tip.mass": 1.761e-4, "beam.stiffnessDamping": 1e-5}
"""A relay whose open spring rings at 223 Hz and decays by a factor e in 0.10 s."""
GUESSED = {name: value * part for (name, value), part in zip(RINGING.items(), (0.97, 1.05, 0.9, 1.3), strict=True)}
"""What its drawing says."""
PRESSED = np.linspace(-1e-4, 2e-4, 13)
CALIBRATION = 0.005
CLOSED = "contact closed"
SINCE = 0.02
"""Time (s) after a pluck at which its record begins: of the second vibration, 1 % of the first, exp(-7.6) is left."""


ROUGH: dict[str, float] = {
    "contact.stiffness": 5.2e4, "contact.stiffnessExponent": 0.62, "beam.youngsModulus": 1.2e11,
}  # fmt: skip
"""A relay with a rough contact."""
ROUGH_GUESSED: Values = {
    "effects.contactLaw": "Rough", "effects.axialForce": "None", "contact.stiffness": 4e4,
    "contact.stiffnessExponent": 0.5, "beam.youngsModulus": 1.24e11,
}  # fmt: skip
OVERTRAVELS = np.linspace(0.04e-3, 0.5e-3, 12)
CURVES = (0.08e-3, 0.2e-3, 0.5e-3)
"""Overtravels (m) of its response curves."""


def deflection(values: Values, time: Array) -> Array:
    """Return that of the open spring (m) after it was bent by 0.1 mm and let go at time 0, all its modes."""
    spring = Reference({**values, **AWAY})
    modes = spring.modes()
    bent = modes.tip * 1e-4 * spring.tip_stiffness / modes.omega_squared
    decay = modes.damping / 2
    own = np.sqrt(modes.omega_squared - decay**2 + 0j)
    since = time[:, None]
    # Roots of each mode; modes above a frequency do not oscillate.
    slow, fast = -decay + 1j * own, -decay - 1j * own
    shape = (fast * np.exp(slow * since) - slow * np.exp(fast * since)) / (fast - slow)
    return np.asarray((shape * modes.tip * bent).sum(axis=1).real)


def exact(values: Values) -> dict[str, Array]:
    """Return what would be measured without scatter: N, m, N at 20 m/s2, m/s2."""
    relay = Reference(values)
    responses = np.array([abs(relay.force_response(f)) for f in FREQUENCY])
    levels = np.array([abs(relay.force_response(f)) for f in LEVELS])
    overtravel = relay.overtravel
    return {
        "force": np.array([Reference({**values, "contact.overtravel": overtravel + x}).force for x in TRAVEL]),
        "ring": deflection(values, TIME),
        "response": 20.0 * responses,
        # A sine that is below zero for the time; the spring feels 1/4655 of what Hertz's stiffness changes.
        "chatter": (relay.force - relay.force_of_resistance(RESISTANCE)) / levels / np.cos(np.pi * LEVELS * OPENING),
    }


def scattered(clean: dict[str, Array], seed: int) -> dict[str, Array]:
    """Return what is measured."""
    chance = np.random.default_rng(seed)
    found = {name: values.copy() for name, values in clean.items()}
    for name, values in found.items():
        normal = chance.standard_normal(len(values))
        if name in ("response", "chatter"):
            found[name] = values * np.exp(SCATTER[name] * normal)
        else:
            found[name] = values + SCATTER[name] * np.abs(values).max() * normal
    return found


def files(folder: Path, measured: dict[str, Array]) -> dict[str, Path]:
    """Write files as a laboratory has them; give their paths."""
    columns = {
        "force": ("travel [mm],force [cN]", (1e3 * TRAVEL, 1e2 * measured["force"])),
        "ring": ("time [ms],displacement [um]", (1e3 * TIME, 1e6 * measured["ring"])),
        "response": ("frequency [Hz],acceleration [m/s2],force [mN]",
                     (FREQUENCY, np.full(len(FREQUENCY), 20.0), 1e3 * measured["response"])),
        "chatter": ("frequency [kHz],level [g]", (1e-3 * LEVELS, measured["chatter"] / 9.80665)),
    }  # fmt: skip
    paths = {name: folder / f"{name}.csv" for name in columns}
    for name, (head, values) in columns.items():
        write_table(paths[name], f"# made by the second solution\n{head}", np.column_stack(values), digits=9)
    return paths


@cache
def pressed() -> Array:
    """Return the static force (N) of RINGING over PRESSED without scatter."""
    overtravel = RINGING["contact.overtravel"]
    return np.array([Reference({**RINGING, "contact.overtravel": overtravel + x}).force for x in PRESSED])


@cache
def plucked(length: float, rate: float) -> tuple[Array, Array]:
    """Return times (s) and deflections (m) of RINGING in a record of a length (s) and rate (1/s), without scatter."""
    time = SINCE + np.arange(round(length * rate)) / rate
    return time, deflection(RINGING, time)


def record(length: float, rate: float, noise: float, seed: int) -> list[Measurement]:
    """Return a static force, its gauge wrong by chance, and a ring-down with noise, as a part of the largest value."""
    # Other chances for each length, rate and scatter.
    chance = np.random.default_rng([seed, round(1e3 * length), round(rate), round(1e4 * noise)])
    gauge = np.exp(CALIBRATION / 1.96 * chance.standard_normal())
    force = pressed() * gauge + SCATTER["force"] * pressed().max() * chance.standard_normal(len(PRESSED))
    time, motion = plucked(length, rate)
    motion = motion + noise * np.abs(motion).max() * chance.standard_normal(len(time))
    return [
        Measurement(Path("force.csv"), FORCE, PRESSED, "force", "N", force, position=CLOSED, calibration=CALIBRATION),
        # A recorder has been running for a while.
        Measurement(Path("ring.csv"), RINGDOWN, 7 + time, "displacement", "m", motion, position=CLOSED, is_open=True),
    ]


def rough(overtravel: float, values: dict[str, float] = ROUGH) -> Reference:
    """Return a relay with a rough contact as the second solution, linear about its preload at an overtravel (m)."""
    return Reference({**values, "effects.contactLaw": "Rough", "contact.overtravel": overtravel})


@cache
def rough_frequencies() -> Array:
    """Return the frequencies (Hz) of ROUGH over OVERTRAVELS without scatter."""
    return np.array([rough(each).frequency() for each in OVERTRAVELS])


@cache
def rough_curves() -> Array:
    """Return the amplitudes (N) of ROUGH at 1 m/s2 over FREQUENCY without scatter, in rows for CURVES."""
    return np.array([[abs(rough(each).force_response(f)) for f in FREQUENCY] for each in CURVES])


def rough_frequency_record(seed: int) -> list[Measurement]:
    """Return frequencies over the overtravel with noise, a thousandth of the value."""
    values = rough_frequencies() * np.exp(0.001 * np.random.default_rng(seed).standard_normal(len(OVERTRAVELS)))
    return [Measurement(Path("frequency.csv"), FREQUENCIES, OVERTRAVELS, "frequency", "Hz", values, position=CLOSED)]


def rough_curve_records(seed: int) -> list[Measurement]:
    """Return response curves at several overtravels with SCATTER."""
    chance, one = np.random.default_rng(seed), np.ones(len(FREQUENCY))
    found = []
    for overtravel, curve in zip(CURVES, rough_curves(), strict=True):
        values = curve * np.exp(SCATTER["response"] * chance.standard_normal(len(one)))
        settings: dict[str, Value] = {"contact.overtravel": overtravel}
        found.append(Measurement(Path("response.csv"), RESPONSE, FREQUENCY, "force", "N", values, one, CLOSED,
                                 settings=settings))  # fmt: skip
    return found
