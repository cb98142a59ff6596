"""What the component predicts for each kind of measurement.

A closed contact of any law moves so little that it is linear about its preload; a spring taken off its contact is open
by the largest gap that the component allows.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from scipy.linalg import hankel

from relay_contact.component import Array, Component, Contact, Values, half_sine
from relay_contact.files import RelayContactError
from relay_contact.identification.measurement import BOUNCE, CHATTER, FORCE, FREQUENCY, RESPONSE, RINGDOWN, Measurement
from relay_contact.qualification.level import Lengths, threshold
from relay_contact.qualification.response import EXACT, FREE, interrupting_force, kept, respond
from relay_contact.qualification.standards import Contacts
from relay_contact.qualification.trials import Specimen, vibrated

ALONE: Values = {**FREE, "effects.excitation": "None", "base.acceleration": 0.0}
AWAY: Values = {"contact.overtravel": -1e-2}
MODES = 16
"""Of the spring, where nothing hits it: responses below its third resonance are right to 1e-5, and come faster."""
STATIC: Values = {
    "beam.massDamping": 0.0, "beam.stiffnessDamping": 0.0, "contact.damping": 0.0, "solver.modes": 1,
}  # fmt: skip
"""What a static force does not depend on is the same, so that it is not computed again."""
OUTPUTS = {"displacement": "tip.displacement", "velocity": "tip.velocity"}
KNOCK_OPEN, KNOCK_CLOSED, WEAK_OPEN, WEAK_CLOSED = 1e-2, 1e-4, 1e-4, 1e-6
"""How far a knock would move the tip if it were free, for poles and for amplitudes, as parts of its distance from the
contact, or of the overtravel: as of the linear one, poles to 1e-5, amplitudes to 5e-4 of the largest, most to 1e-5."""
SAMPLES, DENSITY, MODEL_ORDER = 64, 8, 24
"""Of a motion after a knock: points, points per period, and decaying exponentials at most; pole of the exact beam to
1e-6 of its size (tests/python/test_identification.py)."""
WITHIN = 1e-9
"""Singular values, as a part of the largest, that are rounding."""
LINES = 128
"""Steps per period of the highest frequency of a response."""
TOUCHING: Values = {"contact.overtravel": -1e-6, "solver.tolerance": 1e-8}
"""Just before the contact closes; instants of openings are then located well within the steps of derivatives."""
WATCHED, NOTHING = 5e-6, 1e-9  # s: less than a blow of the contact lasts; a bounce where there is none
KEPT = 256  # predictions


def forces(values: Values) -> list[str]:
    """Return the outputs whose sum a gauge at the fixed contact shows: twin contacts press it together."""
    return ["contact.force", *(["parallel.force"] if values.get("effects.parallelContact") else [])]


def exponentials(motion: Array) -> tuple[Array, Array]:
    """Return the ratios from sample to sample of the exponentials of which a motion is a sum, and their courses.

    They are the eigenvalues of the least system that moves so (J.-N. Juang, R. S. Pappa, J. Guid. Control Dyn. 8 (1985)
    620-627).
    """
    half = SAMPLES // 2
    table = hankel(motion[:half], motion[half - 1 :])
    left, sizes, right = np.linalg.svd(table[:, :-1], full_matrices=False)
    order = min(MODEL_ORDER, int((sizes > WITHIN * sizes[0]).sum()))
    system = left[:, :order].T @ table[:, 1:] @ right[:order].T / sizes[:order]
    ratios = np.linalg.eigvals(system).astype(complex)
    # Nothing grows but rounding.
    ratios /= np.maximum(np.abs(ratios), 1.0)
    return ratios, ratios ** np.arange(SAMPLES)[:, None]


@dataclass
class Laboratory:
    """The component in place of the sample."""

    component: Component
    told: Callable[[], object] = lambda: None
    """Called with each prediction, for those who wait."""
    contact: Contact = field(init=False)
    known: dict[tuple[object, ...], Array] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Instantiate the component, once for all."""
        self.contact = Contact(self.component)

    def conditions(self, measurement: Measurement, values: Values) -> Values:
        """Return the parameters of the component under which something was measured."""
        kind, own = measurement.kind, AWAY if measurement.is_open else {}
        if kind in (FORCE, FREQUENCY):
            own = STATIC
        elif kind != BOUNCE:
            own = {**own, "solver.modes": MODES}
        found = {**values, **ALONE, **own, **measurement.settings}
        overtravel = self.overtravel(found)
        touches = kind == BOUNCE and self.rest("preload.force", {**found, **TOUCHING}) > 0
        if touches or (overtravel <= 0 and kind == FREQUENCY):
            text = f"in the position {measurement.position} a pusher or gravity closes the contact"
            allowed = "allowed is one that the overtravel closes"
            raise RelayContactError(f"{measurement.path}: {kind}: {text}: not allowed, {allowed}")
        closed = kind in (RINGDOWN, RESPONSE, CHATTER) and not measurement.is_open
        if closed and overtravel <= 0 and self.rest("preload.force", found) <= 0:
            what = f"{measurement.kind}: in the position {measurement.position} the contact is open"
            allowed = "allowed is a closed one, or the line `# contact = open` before the columns"
            text = f"{what} (contact.overtravel = {overtravel:g} m): not allowed, {allowed}"
            raise RelayContactError(f"{measurement.path}: {text}")
        return found

    def predict(self, measurement: Measurement, values: Values) -> Array:
        """Return the values that the component has in place of those measured."""
        asked = self.conditions(measurement, values)
        key = (*measurement.conditions, *sorted(asked.items()))
        if key not in self.known:
            if len(self.known) >= KEPT:
                self.known.pop(next(iter(self.known)))
            how: dict[str, Callable[[Measurement, Values], Array]] = {
                FORCE: self.force, FREQUENCY: self.frequency, RINGDOWN: self.ringing, RESPONSE: self.amplitude,
                CHATTER: self.level, BOUNCE: self.bounces,
            }  # fmt: skip
            self.told()
            with self.contact.explained():
                self.known[key] = how[measurement.kind](measurement, asked)
        return self.known[key]

    def overtravel(self, values: Values) -> float:
        """Return the overtravel (m)."""
        return self.component.value(values, "contact.overtravel")

    def force(self, measurement: Measurement, values: Values) -> Array:
        """Return the static force (N) on the fixed contact over travel from the working position."""
        over = self.overtravel(values) + measurement.over
        return np.asarray(np.sum([self.at_rest(name, over, values) for name in forces(values)], axis=0))

    def frequency(self, measurement: Measurement, values: Values) -> Array:
        """Return the lowest natural frequency (Hz) of the closed contact over the overtravel."""
        return self.at_rest("preload.frequency", measurement.over, values)

    def at_rest(self, name: str, overtravel: Array, values: Values) -> Array:
        """Return an output at rest over the overtravel (m)."""
        return np.array([self.rest(name, {**values, "contact.overtravel": each}) for each in overtravel.tolist()])

    def ringing(self, measurement: Measurement, values: Values) -> Array:
        """Return decay (1/s) and angular frequency (rad/s, 0 if nothing rings) of what a knock makes ring most."""
        name, part = ("tip.displacement", KNOCK_OPEN) if measurement.is_open else ("contact.force", KNOCK_CLOSED)
        values = {**values, "solver.tolerance": EXACT}
        self.contact.begin_anew(values)
        (frequency,) = self.contact.real("preload.frequency")
        rest = self.contact.real(name)[0]
        size = part * abs(self.overtravel(values)) * (2 * np.pi * frequency) ** 2
        self.contact.begin_anew({**values, **half_sine(size, 0.5 / frequency)})
        step = 1 / frequency / DENSITY
        instants = 1 / frequency + step * np.arange(SAMPLES)
        motion = self.contact.drive(np.append(0.0, instants), {}, [name])[name] - rest
        ratios, course = exponentials(motion)
        parts = course * np.linalg.lstsq(course, motion, rcond=None)[0]
        energy = np.where(ratios.imag > 0, (np.abs(parts) ** 2).sum(axis=0), 0.0)
        if not energy.any():
            # Overdamped; a search that steps here finds itself far away, and turns back.
            return np.array([2 * np.pi * frequency, 0.0])
        pole = np.log(ratios[energy.argmax()]) / step
        return np.array([-pole.real, pole.imag])

    def rest(self, name: str, values: Values) -> float:
        """Return an output at rest."""
        self.contact.begin_anew(values)
        return self.contact.real(name)[0]

    def gains(self, names: list[str], frequencies: Array, values: Values, part: float) -> Array:
        """Return the amplitudes of the sum of outputs per base acceleration: after a knock, by Fourier transforms.

        The end of the answer goes on as a sum of decaying exponentials, one such sum for each step of a sample.
        """
        values = {**values, "solver.tolerance": EXACT}
        natural = self.rest("preload.frequency", values)
        before = np.sum(self.contact.real(*names))
        fastest = max(natural, float(frequencies.max()))
        each = int(np.ceil(LINES / DENSITY * fastest / natural))
        step = 1 / (natural * DENSITY * each)
        # Half a period of the highest frequency, so that nothing beyond is hit.
        length = int(0.5 / fastest / step)
        knock = np.zeros(each * (SAMPLES + DENSITY) + 1)
        knock[: length + 1] = np.sin(np.pi * np.arange(length + 1) / length) ** 2
        knock *= part * abs(self.overtravel(values)) * 4 * np.pi * natural / (length * step)
        found = self.contact.drive(step * np.arange(len(knock)), {"base.acceleration": knock}, names)
        answer = np.sum([found[name] for name in names], axis=0) - before
        end = answer[-SAMPLES * each :].reshape(SAMPLES, each)
        ratios, course = exponentials(end[:, 0])
        parts = np.linalg.lstsq(course, end, rcond=None)[0] * ratios[:, None] ** SAMPLES
        gains = []
        for frequency in frequencies.tolist():
            turns = np.exp(-2j * np.pi * frequency * step * np.arange(len(knock)))
            after = turns[-1] * turns[1] ** np.arange(each) @ (parts / (1 - ratios * turns[each])[:, None]).sum(axis=0)
            whole = (answer @ turns[1:] + after * turns[1]) / (knock @ turns)
            gains.append(abs(whole) / np.sinc(frequency * step) ** 2)
        return np.array(gains)

    def amplitude(self, measurement: Measurement, values: Values) -> Array:
        """Return the amplitudes of a frequency response."""
        own = measurement.quantity
        names = forces(values) if own == "force" else [OUTPUTS[own]]
        part = WEAK_OPEN if measurement.is_open else WEAK_CLOSED
        return self.gains(names, measurement.over, values, part) * measurement.acceleration

    def level(self, measurement: Measurement, values: Values) -> Array:
        """Return the accelerations (m/s2) from which on the contact is interrupted, as far as it is linear."""
        gains = self.gains(["contact.force"], measurement.over, values, WEAK_CLOSED)
        monitor = self.monitor(values)
        reserve = self.rest("preload.force", values) - interrupting_force(self.contact, values, monitor.threshold)
        return max(reserve, 1e-9) / (gains * kept(measurement.over, monitor.opening))

    def bounces(self, measurement: Measurement, values: Values) -> Array:
        """Return the lengths (s) of the first bounce after the fixed contact has met the spring at rest, at speeds."""
        return np.array([self.bounce(float(speed), {**values, **TOUCHING}) for speed in measurement.over])

    def bounce(self, speed: float, values: Values) -> float:
        """Return the length (s) of the first bounce; nearly nothing if there is none within a period of the spring."""
        self.contact.begin_anew(values)
        now, opened = 0.0, -1.0
        (frequency,) = self.contact.real("preload.frequency")
        while now < 1 / frequency:
            self.contact.change("support.displacement", speed * now, speed * (now + WATCHED), WATCHED)
            self.contact.step(now, WATCHED)
            now += WATCHED
            opening, closing = self.contact.real("contact.lastOpening", "contact.lastClosing")
            opened = opening if opened < 0 else opened
            if 0 < opened < closing:
                return closing - opened
        return NOTHING

    def monitor(self, values: Values) -> Contacts:
        """Return what counts as an interruption."""
        names = ("chatter.minimumDuration", "chatter.resistanceThreshold")
        opening, resistance = (self.component.value(values, name) for name in names)
        return Contacts(opening, 1e-6, resistance, 1.0, "", "measured")

    def correction(self, measurement: Measurement, values: Values) -> Array:
        """Return by which factor the levels of a contact that opens differ from those of the linear one."""
        linear = self.predict(measurement, values)
        asked = self.conditions(measurement, values)
        monitor = self.monitor(asked)
        alone = {**asked, "effects.chatter": True, "effects.extremes": True}
        response = respond(self.component, asked, monitor.threshold)
        specimen = Specimen(self.component, alone, monitor, response)

        def tried(at: float, guess: float, part: float) -> tuple[Lengths, float]:
            lengths, _, ahead = vibrated(specimen, at, part * guess)
            return specimen.own(lengths), ahead

        # Factors: beyond a large one, in place of a level in m/s2, no failure is sought.
        return np.array([
            threshold(partial(tried, at, guess), 1.0)[0]
            for at, guess in zip(measurement.over.tolist(), linear.tolist(), strict=True)
        ])  # fmt: skip
