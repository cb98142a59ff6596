"""Vibration and shock of MIL-STD-202 on a relay contact under FMPy: one page for a qualification file.

Method 204: a sine whose frequency goes logarithmically up and down again, the lesser of an acceleration and a double
amplitude. Method 213: a half-sine shock, here in both directions along the motion of the contact. A test fails where
the contact resistance stays above 60 Ohm for 10 us or more (MIL-PRF-28776; MIL-STD-202 method 310).

The component generates the sweep and times every interruption to a nanosecond inside its steps, however long they are:
a communication step is a bin of frequency here. The shock that presses is generated inside too; the one that pulls is
the input base.acceleration, linear over steps of 10 us (off the sine by 1e-6 of its peak).

The specimen is that of the component's start values: the equivalent beam identified from Zhang et al., "Machines" 2025,
13(1), 52. SPECIMEN below changes it. The contact is at rest before each sweep, up or down, and before each shock: the
sudden start of a sweep is part of it, and seen in the first bin downwards.

Condition A of both methods is checked; the other conditions and those of MIL-PRF-28776 are from memory and not verified
against the standards' texts. The standards also ask for two directions across the contact's motion and for repetitions:
the model has the one direction, and repeats exactly.

A faster sweep (--sweep-time) is not conservative: the force lags behind the frequency, and a resonance with little
damping has no time to build up. In 1 s the sweep at 30 g shows interruptions of 49 us upwards and 57 us downwards,
instead of 54 us. The summary says in how many of its decay times the resonance is crossed. A bin of a fast sweep may
also be shorter than a period at low frequencies: its least force is then that of a part of a period.
"""

import argparse
from collections.abc import Callable
from dataclasses import replace
from textwrap import wrap

import numpy as np
from tqdm import tqdm

from common import GRAVITY as G
from common import parser, read_arguments, within
from qualification_page import LIMIT, Level, Outcome, Shock, Sweep, page, write
from relay_contact import Component, Contact, Values

SPECIMEN: dict[str, float] = {}
"""Parameters that differ from the component's start values, for example {"contact.overtravel": 0.25e-3}."""
SHOWN = ["beam.length", "beam.width", "beam.thickness", "beam.youngsModulus", "beam.density", "beam.stiffnessDamping"]
SHOWN += ["tip.mass", "contact.overtravel", "contact.curvatureRadius", "contact.damping", "chatter.resistanceThreshold"]
"""Parameters on the page."""
SHOCK_STEP = 1e-5  # s
RESOLUTION = 1e-4  # of margins
ENOUGH = (
    1000  # decay times a sweep should take to cross the resonance: the lag then changes an interruption by per cents
)


VIBRATION = {
    "A": Level("method 204 A", 10, (10, 500), 1.524e-3, 900),
    "B": Level("method 204 B", 15, (10, 2000), 1.524e-3, 1200),
    "C": Level("method 204 C", 10, (10, 2000), 1.524e-3, 1200),
    "D": Level("method 204 D", 20, (10, 2000), 1.524e-3, 1200),
}
RELAYS = Level("MIL-PRF-28776", 30, (10, 3000), 4.95e-3, 1200)
SHOCKS = {"A": (50, 11e-3), "B": (75, 6e-3), "C": (100, 6e-3)}
"""Peak (g) and duration (s) of the half sines of method 213."""


class Specimen:
    """The component with the parameters of the specimen."""

    def __init__(self, component: Component) -> None:
        """Look at it at rest."""
        self.component = component
        with self.at_rest() as contact:
            self.preload, self.natural, alpha, beta = contact.real(
                "preload.force", "preload.frequency", "beam.massDamping", "beam.stiffnessDamping"
            )
            units = {name: component.variables[name].declaredType.unit for name in SHOWN}
            self.shown = [f"{name} {contact.get(name):g} {units[name]}" for name in SHOWN]
        self.decay = 2 / max(alpha + beta * (2 * np.pi * self.natural) ** 2, 1.0)
        """Decay time of the first resonance, s."""

    def at_rest(self, values: Values | None = None) -> Contact:
        """Give the contact at rest, with further parameters."""
        return self.component.started(SPECIMEN | {"chatter.minimumDuration": LIMIT} | dict(values or {}))


def monitor(contact: Contact) -> tuple[int, float, float]:
    """Give interruptions so far that count, the time (s) of them all and of the longest."""
    total, longest = contact.real("chatter.totalInterruption", "chatter.longestInterruption")
    return int(contact.get("chatter.count")), total, longest


def sweep(specimen: Specimen, level: Level, bins: int) -> Sweep:
    """Sweep up and down. A logarithmic sweep takes equally long for equal ratios: a bin is one communication step."""
    edges = np.geomspace(*level.frequencies, bins + 1)
    run = Sweep(level, np.sqrt(edges[1:] * edges[:-1]))
    for way, order in (("up", slice(None)), ("down", slice(None, None, -1))):
        begin, end = np.array(level.frequencies)[order]
        found = np.zeros((bins, 3))
        bar = tqdm(run.frequency[order], bar_format="{desc} |{bar}|")
        length = level.sweep_time / 2 / bins
        values: Values = {
            "effects.excitation": "LogSweep",
            "excitation.amplitude": G * level.acceleration,
            "excitation.displacementLimit": level.double_amplitude / 2,
            "excitation.frequency": float(begin),
            "excitation.endFrequency": float(end),
            "excitation.duration": level.sweep_time / 2,
        }
        with specimen.at_rest(values) as contact:
            before, time = monitor(contact), 0.0
            for row, frequency in zip(found, bar, strict=True):
                bar.set_description_str(f"{level.acceleration:g} g, {way:4} {frequency:5.0f} Hz", refresh=False)
                contact.step(time, length)
                time += length
                now = monitor(contact)
                new = now[0] - before[0]
                row[:] = contact.get("step.minimumForce"), new, (now[1] - before[1]) / new if new else 0
                if now[0] and now[2] > max(before[2], run.longest[0]):
                    run.longest = now[2], float(frequency)
                before = now
        run.bins[way] = found[order]
    return run


def threshold(interrupts: Callable[[float], bool]) -> float:
    """Give the least factor of a level that interrupts: by steps of a tenth, then by bisection."""
    failed = interrupts(1.0)
    low = high = 1.0
    while interrupts(low if failed else high) == failed:
        low, high = (low / 1.1, low) if failed else (high, high * 1.1)
        if not 1e-3 < high < 1e3:
            return high
    while high > (1 + RESOLUTION) * low:
        middle = (low * high) ** 0.5
        low, high = (low, middle) if interrupts(middle) else (middle, high)
    return high


def weakest(specimen: Specimen, run: Sweep) -> float:
    """Give the frequency (Hz) at which a growing level first opens the contact, from one that leaves it closed."""
    if run.least_force().min() > 0.1 * specimen.preload:
        return float(run.frequency[run.least_force().argmin()])
    level = run.level
    half = replace(level, acceleration=level.acceleration / 2, double_amplitude=level.double_amplitude / 2)
    return weakest(specimen, sweep(specimen, half, len(run.frequency)))


def vibration(specimen: Specimen, level: Level, bins: int) -> tuple[Sweep, Outcome]:
    """Sweep; where the contact is weakest, seek the level that interrupts in steady vibration."""
    run = sweep(specimen, level, bins)
    count = int(sum(found[:, 1].sum() for found in run.bins.values()))
    frequency = weakest(specimen, run)
    amplitude = float(level.amplitude(np.array(frequency)))

    def interrupts(factor: float) -> bool:
        sine = {"excitation.frequency": frequency, "excitation.amplitude": factor * amplitude}
        settling = max(10 * specimen.decay, 2 / frequency)  # of the sudden start, 5e-5 are left
        with specimen.at_rest({"effects.excitation": "Sine", **sine}) as contact:
            contact.step(0.0, settling)
            settled = monitor(contact)[0]
            contact.step(settling, 5 / frequency)
            return monitor(contact)[0] > settled

    least = float(run.least_force().min()) / specimen.preload
    margin = threshold(interrupts)
    return run, Outcome(level.name, str(level), count, run.longest[0], least, f"{frequency:.0f} Hz", margin)


def half_sine(specimen: Specimen, peak: float, duration: float, pulls: bool) -> Shock:
    """Run a shock (m/s2, s) and as long again."""
    inside: Values = {
        "effects.excitation": "HalfSine",
        "excitation.amplitude": peak,
        "excitation.duration": duration,
    }
    time = SHOCK_STEP * np.arange(round(2 * duration / SHOCK_STEP) + 1, dtype=np.float64)
    pulse = -peak * np.sin(np.pi * np.minimum(time / duration, 1)) * pulls
    force, least = np.zeros(len(time)), np.inf
    with specimen.at_rest({} if pulls else inside) as contact:
        force[0], now = contact.get("contact.force"), 0.0
        for index in range(1, len(time)):
            contact.change("base.acceleration", pulse[index - 1], pulse[index], SHOCK_STEP)
            contact.step(now, SHOCK_STEP)
            now += SHOCK_STEP
            force[index], in_step = contact.real("contact.force", "step.minimumForce")
            least = min(least, in_step)
        count, _, longest = monitor(contact)
    return Shock(time, force, least, count, longest)


def shock(specimen: Specimen, condition: str) -> tuple[dict[str, Shock], Outcome]:
    """Run a shock in both directions."""
    peak, duration = SHOCKS[condition]

    def run(way: str, factor: float = 1.0) -> Shock:
        return half_sine(specimen, factor * G * peak, duration, way == "pulling")

    runs = {way: run(way) for way in ("pressing", "pulling")}
    margins = {
        "pressing": threshold(lambda factor: run("pressing", factor).count > 0),
        "pulling": threshold(lambda factor: run("pulling", factor).count > 0),
    }
    way = min(margins, key=lambda way: margins[way])
    count, longest = sum(hit.count for hit in runs.values()), max(hit.longest for hit in runs.values())
    least = min(hit.least_force for hit in runs.values()) / specimen.preload
    level = f"half sine of {peak:g} g, {1e3 * duration:g} ms"
    return runs, Outcome(f"method 213 {condition}", level, count, longest, least, way, margins[way])


def arguments() -> argparse.Namespace:
    """Read the command line."""
    line = parser(str(__doc__).splitlines()[0], epilog="Takes under a minute.")
    add = line.add_argument
    add("--quick", action="store_true", help="sweeps of 60 s, 400 bins")
    add("--vibration", choices=VIBRATION, default="A", help="condition of method 204; B to D are from memory")
    more, far = within(0, 1e4, "g"), within(1e-3, 1000, "mm")
    add("--acceleration", type=more, default=30, help="of a second sweep [g] (%(default)s); 0: no second sweep")
    add("--frequencies", type=float, nargs=2, default=(10, 3000), help="of the second [Hz]", metavar=("LOW", "HIGH"))
    add("--double-amplitude", type=far, default=4.95, help="of the second, from end to end [mm] (%(default)s)")
    slow = within(0.1, 1e5, "s")
    add("--sweep-time", type=slow, help="up and down [s] (900 for condition A, else 1200)")
    add("--shock", choices=SHOCKS, default="A", help="condition of method 213; B and C are from memory")
    given = read_arguments(line)
    low, high = given.frequencies
    if not 1e-3 <= low < high <= 1e6:
        line.error(f"--frequencies {low:g} {high:g}: from 1e-3 to 1e6 Hz, the first below the second")
    return given


def asked(given: argparse.Namespace) -> list[Level]:
    """Give the levels that the command line asks for."""
    levels = [VIBRATION[given.vibration]]
    if given.acceleration > 0:
        changes = (given.acceleration, tuple(given.frequencies), 1e-3 * given.double_amplitude)
        same = changes == (RELAYS.acceleration, RELAYS.frequencies, RELAYS.double_amplitude)
        levels.append(RELAYS if same else Level("as given", *changes, RELAYS.sweep_time))
    if given.sweep_time is None and not given.quick:
        return levels
    return [replace(level, sweep_time=given.sweep_time or 60) for level in levels]


def pace(level: Level, specimen: Specimen) -> str:
    """Tell whether a sweep is slow enough for the first resonance."""
    natural, decay = specimen.natural, specimen.decay
    low, high = level.frequencies
    octaves = 2 * 60 * np.log2(high / low) / level.sweep_time
    line = f"{level.name}: swept up and down in {level.sweep_time:g} s, {octaves:.3g} octaves/min"
    if not low < natural < high:
        return f"{line}; the first resonance is not in its range."
    band = 2 / (decay * 2 * np.pi * natural)  # half-power band, relative to the resonance
    times = band * level.sweep_time / (2 * np.log(high / low)) / decay
    slow = "slow enough" if times >= ENOUGH else "TOO FAST to rely on"
    return f"{line}; crosses the first resonance in {times:.0f} decay times: {slow}."


def main() -> None:
    """Run the tests."""
    given = arguments()
    levels = asked(given)
    specimen = Specimen(Component(given.fmu))
    runs = [vibration(specimen, level, 400 if given.quick else 3000) for level in levels]
    shocks, shocked = shock(specimen, given.shock)
    guid = specimen.component.description.guid
    sweeps, outcomes = [run for run, _ in runs], [outcome for _, outcome in runs] + [shocked]
    notes = [
        *wrap(f"Equivalent beam, identified: {', '.join(specimen.shown)}.", 125),
        f"Preload {100 * specimen.preload:.2f} cN, first resonance {specimen.natural:.0f} Hz. Component {guid}.",
        *(pace(level, specimen) for level in levels),
        "Margin: level that interrupts, where the contact is weakest and in steady vibration, over that of the test.",
        "Model: along the motion of the contact alone; no resonances of the case, no bounce after switching.",
        "Method 204 B, C, D, 213 B, C and MIL-PRF-28776 are from memory, not verified against the standards' texts.",
    ]
    write(given.out, sweeps, shocks)
    page(given.out / "qualification.png", sweeps, shocks, outcomes, notes)
    widths = (15, 37, 9, 15, 12, 13, 12, 8)
    for row in [list(Outcome.HEAD), *(outcome.row() for outcome in outcomes)]:
        print("".join(f"{cell:{width}}" for cell, width in zip(row, widths, strict=True)))
    print("\n".join(notes))
    for name in ("qualification.csv", "qualification-shock.csv", "qualification.png"):
        print(given.out / name)


if __name__ == "__main__":
    main()
