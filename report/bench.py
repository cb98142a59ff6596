"""The component in place of the published specimen: at rest, and in steady vibration."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from relay_contact import Array, Component, Contact, Value, Values
from relay_contact.component import sine
from report.published import ACCELERATION, BEST

RISE, SAMPLES = 20, 64
"""Periods of the gentle start, and samples of the period that is read."""
PERIODIC = 1e-7
"""A motion is periodic if the extremes of the force change by less than this part of the preload from one period to the
next: below the digits shown."""
PATIENCE = 2000  # periods
SOON = 10  # periods after a sudden start
FINE: Values = {"solver.tolerance": 1e-9}
"""Far below the digits shown."""
PRESTRESSED: Values = {"effects.axialForce": "FromPreload"}


@dataclass(frozen=True)
class Period:
    """A period of vibration, sampled."""

    frequency: float
    force: Array
    """Of the contact, N."""
    elastic: Array
    """Its elastic part, N."""
    displacement: Array
    """Of the contact with the base, m."""
    resistance: Array
    least: float
    """Extremes of the force, N."""
    greatest: float
    base: float
    """Amplitude of the base, m."""
    repeats: bool
    """Whether the motion is periodic; otherwise the extremes are those of this period."""

    @property
    def amplitude(self) -> float:
        """Half the range of the force, cN."""
        return 50 * (self.greatest - self.least)

    @property
    def elastic_amplitude(self) -> float:
        """Half the range of its elastic part, cN."""
        return 100 * half_range(self.elastic)

    @property
    def travel(self) -> float:
        """Half the range of the displacement over the amplitude of the base."""
        return half_range(self.displacement) / self.base

    @property
    def phase(self) -> float:
        """The phase between force and displacement, from 0 to 180 degrees."""
        force, displacement = (np.fft.rfft(each)[1] for each in (self.force, self.displacement))
        return float(abs(np.degrees(np.angle(force / displacement))))


def half_range(samples: Array) -> float:
    """Return half the difference of maximum and minimum of a period, between its samples too, by its Fourier series."""
    fine = 16 * np.fft.irfft(np.fft.rfft(samples), 16 * len(samples))
    return float(np.ptp(fine) / 2)


class Bench:
    """An instance of the component."""

    def __init__(self, component: Component) -> None:
        """Instantiate it, once for all runs."""
        self.component = component
        self.contact = Contact(component)
        self.known: dict[str, Period] = {}

    def rest(self, values: Values, output: str) -> float:
        """Return an output of the contact at rest."""
        self.contact.begin_anew(values)
        return self.contact.get(output)

    def shaken(self, values: Values, frequency: float, level: float, rise: int = 0) -> float:
        """Begin a vibration from rest that rises over so many periods; return the deflection at rest, m."""
        self.contact.begin_anew({**values, **sine(frequency, level, rise / frequency)})
        return self.contact.get("tip.displacement")

    def period(self, frequency: float, level: float, deflection: float, number: int, repeats: bool = False) -> Period:
        """Return the period with this number, which comes next."""
        names = ("contact.force", "contact.elasticForce", "tip.displacement", "contact.resistance",
                 "step.minimumForce", "step.maximumForce")  # fmt: skip
        time = (number + np.arange(SAMPLES + 1) / SAMPLES) / frequency
        force, elastic, tip, resistance, least, greatest = self.contact.drive(time, {}, names).values()
        base = level / (2 * np.pi * frequency) ** 2
        phase = 2 * np.pi * np.arange(1, SAMPLES + 1) / SAMPLES
        with_base = tip - deflection - base * np.sin(phase)
        extremes = float(least.min()), float(greatest.max())
        return Period(frequency, force, elastic, with_base, resistance, *extremes, base, repeats)

    def vibrate(self, values: Values, frequency: float, level: float = ACCELERATION) -> Period:
        """Return a period of steady vibration, started gently so that it is steady soon."""
        key = repr((sorted(values.items()), frequency, level))
        if key not in self.known:
            deflection = self.shaken(values, frequency, level, RISE)
            self.contact.step(0.0, RISE / frequency)
            number, repeats = self.settle(frequency)
            self.known[key] = self.period(frequency, level, deflection, number, repeats)
        return self.known[key]

    def settle(self, frequency: float) -> tuple[int, bool]:
        """Wait until the motion repeats; return the number of the next period, and whether it does."""
        preload = self.contact.get("preload.force")
        last = np.full(2, np.inf)
        for number in range(RISE, RISE + PATIENCE):
            self.contact.step(number / frequency, 1 / frequency)
            this = np.array(self.contact.real("step.minimumForce", "step.maximumForce"))
            if np.abs(this - last).max() < PERIODIC * preload:
                return number + 1, True
            last = this
        return RISE + PATIENCE, False

    def sudden(self, values: Values, frequency: float) -> float:
        """Return the largest displacement amplitude (m) in a period soon after a sudden start."""
        deflection = self.shaken(values, frequency, ACCELERATION)
        periods = [self.period(frequency, ACCELERATION, deflection, number) for number in range(SOON)]
        return max(float(np.ptp(each.displacement)) / 2 for each in periods)


def damped(values: Values, ratio: float) -> dict[str, Value]:
    """Return the values, which have the damping of the published ratio 10, with that of another one."""
    names = ("beam.stiffnessDamping", "contact.damping")
    return {**values, **{name: float(values[name]) * ratio / BEST for name in names}}


def specimen(component: Component, ratio: float = BEST) -> dict[str, Value]:
    """Return the specimen with the damping of a published ratio."""
    names = ("beam.stiffnessDamping", "contact.damping")
    return damped({**PRESTRESSED, **FINE, **{name: component.start(name) for name in names}}, ratio)


@cache
def bench() -> Bench:
    """Return the instance of this process."""
    return Bench(Component())
