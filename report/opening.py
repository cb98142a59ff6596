"""Does the contact open? The published specimen over frequency, and the verdicts of standards on it."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from relay_contact import Component, qualify, side_by_side
from relay_contact.component import sine
from relay_contact.figures import GRAVITY as G
from relay_contact.qualification import Standard, Tested
from relay_contact.qualification.excitation import Sine
from relay_contact.qualification.level import RESOLUTION, Lengths, threshold
from relay_contact.qualification.relay import Relay
from relay_contact.qualification.response import respond
from relay_contact.qualification.trials import Specimen, sine_threshold, steady
from report.figure import Curve, Figure
from report.files import OUT

RANGE = (10.0, 3000.0)  # Hz
FINE = 9  # frequencies around the weakest
UNIT = Sine("1 g", "", "measured", 1.0, None, RANGE, 1.0)
"""At every frequency of the map 1 g, not limited by the displacement."""
CONDITIONS = ["204 A", "204 B", "204 D"]  # of MIL-STD-202


@cache
def subject() -> Specimen:
    """Return the published specimen, in this process: its first reading, under the monitor of the standard."""
    component, contacts = Component(), Standard.read("MIL-PRF-28776").contacts
    relay = Relay.read("paper", component)
    (position,) = relay.positions.values()
    values = {**position, **relay.models[0].parameters}
    return Specimen(component, values, contacts, respond(component, values, contacts.threshold))


@dataclass(frozen=True)
class Thresholds:
    """Accelerations (g) at a frequency (Hz) from which on the contact opens."""

    frequency: float
    linear: float
    """By linear theory, in steady vibration."""
    opens: float
    """Its force reaches zero, in steady vibration."""
    interrupts: float
    """For as long as counts as an interruption, in steady vibration."""
    sudden: float
    """The same after a sudden start."""


def suddenly(frequency: float, factor: float) -> Lengths:
    """Return the longest interruptions of a vibration (g) that starts at full level, until the start is forgotten."""
    own = subject()
    with own.start(sine(frequency, factor * G)) as contact, contact.explained():
        contact.step(0.0, np.ceil(max(10.0, 0.03 * frequency)) / frequency)
        return own.longest(contact)


def thresholds(frequency: float) -> Thresholds:
    """Find all thresholds at a frequency (Hz)."""
    own = subject()
    known, factors = own.response.sine(UNIT, 0.0)
    guess = float(np.interp(frequency, known, factors))

    def opens(factor: float) -> tuple[Lengths, float]:
        left = steady(own, frequency, factor * G, True)[1][0]
        return {"": 1.0} if left <= 0 else {}, left / own.response.reserve

    first, _ = threshold(opens, guess)
    interrupts, _ = sine_threshold(own, UNIT, frequency, first)
    # From far below: what opens it briefly must not be missed where a stronger start would close it earlier.
    sudden, _ = threshold(lambda factor: (suddenly(frequency, factor), 0.0), 0.5 * guess)
    return Thresholds(frequency, guess, first, interrupts, sudden)


def thresholds_over(quick: bool, levels: Iterable[Sine]) -> list[Thresholds]:
    """Return thresholds at equal ratios of frequency and at the ends of the levels, and more where they are lowest."""
    ends = [frequency for test in levels for frequency in test.band]
    frequencies = sorted({round(each, 6) for each in [*np.geomspace(*RANGE, 12 if quick else 80), *ends]})
    points = side_by_side(thresholds, frequencies)
    at = min(range(len(points)), key=lambda place: points[place].opens)
    around = frequencies[max(at - 1, 0)], frequencies[min(at + 1, len(points) - 1)]
    between = [each for each in np.geomspace(*around, FINE + 2)[1:-1].round(6) if each not in frequencies]
    return sorted(points + side_by_side(thresholds, between), key=lambda each: each.frequency)


def figure(points: list[Thresholds], levels: dict[str, Sine]) -> Figure:
    """Draw the map."""
    frequencies = np.array([each.frequency for each in points])
    curves = [
        Curve("opens for 10 µs, steady vibration", frequencies, [each.interrupts for each in points]),
        Curve("the same after a sudden start", frequencies, [each.sudden for each in points], "dashed"),
    ]
    for colour, (name, test) in enumerate(levels.items(), 1):
        own = np.sort([*frequencies, test.corner])
        own = own[(own >= test.band[0]) & (own <= test.band[1])]
        curves.append(Curve(name, own, test.amplitude(own) / G, "dashed", colour))
    x, y = "frequency / Hz", "base acceleration, amplitude / g"
    return Figure("opening-map", "Base acceleration that opens the contact", x, y, curves, "xy")


def values(quick: bool) -> tuple[list[Figure], dict[str, Any]]:
    """Return the figures and the numbers of the section."""
    judged: dict[str, Tested] = {}
    levels: dict[str, Sine] = {}
    for standard, tests in (("MIL-STD-202", CONDITIONS), ("MIL-PRF-28776", [])):
        found = qualify("paper", standard, tests=tests, out=OUT / "opening" / standard, quick=quick)
        title = found.standard.title.partition(",")[0]
        judged |= {f"{title} {tested.first.test}": tested for tested in found}
        levels |= {f"{title} {test.clause.partition(';')[0]}: {test.acceleration:g} g": test
                   for test in found.standard.tests if isinstance(test, Sine)}  # fmt: skip
    points = thresholds_over(quick, levels.values())
    asked = found["vibration (sine)"]
    answers = {"pass": "The contact passes", "FAIL": "The contact fails at"}
    sines = [tested.verdict for tested in judged.values() if tested.first.kind == "sine"]
    accelerations = [test.acceleration for test in levels.values()]
    passed = [f"{level:g} g" for level, verdict in zip(accelerations, sines, strict=True) if verdict == "pass"]

    def furthest(name: str) -> float:
        return 100.0 * max(abs(float(getattr(each, name)) / each.interrupts - 1) for each in points)

    return [figure(points, levels)], {
        "answer": answers.get(asked.verdict, "It is undecided whether the contact passes"),
        "asked": asked.margin, "margins": [each.margin.margin for each in asked.models], "level": accelerations[-1],
        "passed": passed, "judged": judged,
        "weakest": min(points, key=lambda each: each.interrupts), "count": len(points),
        "at_2000": min(points, key=lambda each: abs(each.frequency - 2000)), "gravity": G,
        "furthest": {"opens": furthest("opens"), "linear": furthest("linear")}, "resolution": 100 * RESOLUTION,
    }  # fmt: skip
