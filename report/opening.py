"""Does the contact open? The verdict of the standards on the published specimen, by the package's own tests."""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from relay_contact import Component, Values, side_by_side
from relay_contact.component import sine
from relay_contact.figures import GRAVITY as G
from relay_contact.qualification.excitation import Shock, Sine
from relay_contact.qualification.level import RESOLUTION, Lengths, threshold
from relay_contact.qualification.relay import Relay
from relay_contact.qualification.response import Response, respond
from relay_contact.qualification.standards import Standard
from relay_contact.qualification.trials import Piece, Specimen, sine_threshold, steady, sweep
from report.bench import specimen
from report.figure import Curve, Figure
from report.published import FORCE, PEAKS
from report.spring import Spring
from report.text import table

RANGE = (10.0, 3000.0)  # Hz
FINE = 9  # frequencies around the weakest
UNIT = Sine("1 g", "", "measured", 1.0, 10.0, RANGE, 1.0)
"""At every frequency of the map 1 g, not limited by the displacement."""
CONDITIONS = ("204 A", "204 B", "204 D")  # of MIL-STD-202 that the map shows
DIGIT = 0.0005  # N, half a unit of the last digit of the published preload
SHOCK = "test", "shock", "direction", "opens at all", "longest interruption", "smallest force, relative to the preload"


@cache
def standard() -> Standard:
    """Return the standard whose monitor and shocks are taken, and whose vibration is asked for."""
    return Standard.read("MIL-PRF-28776")


@cache
def levels() -> dict[str, Sine]:
    """Return the levels of vibration by name; the last is the one asked for."""
    found = {}
    for each in (Standard.read("MIL-STD-202"), standard()):
        for test in each.tests:
            if isinstance(test, Sine) and (each is standard() or test.name in CONDITIONS):
                name = f"{each.title.partition(',')[0]} {test.clause.partition(';')[0]}: {test.acceleration:g} g"
                found[name] = test
    return found


@cache
def subject() -> Specimen:
    """Return the published specimen, in this process."""
    component = Component()
    values = readings(component)[0]
    return Specimen(component, values, standard().contacts, linear(component, values))


def readings(component: Component) -> list[Values]:
    """Return the parameters by each reading of the publication, the first of which the map shows."""
    relay = Relay.read("paper", component)
    (position,) = relay.positions.values()
    return [{**position, **model.parameters} for model in relay.models]


def linear(component: Component, values: Values) -> Response:
    """Return the linear response of a specimen."""
    return respond(component, values, standard().contacts.threshold)


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


def verdict(margin: float, uncertainty: float) -> str:
    """Return the verdict of a margin that is known to a part of it."""
    return "passed" if margin > 1 + uncertainty else "failed" if margin < 1 - uncertainty else "undecided"


def seen(points: list[Thresholds]) -> tuple[str, list[tuple[Sine, float, float]]]:
    """Run the levels; return their table, and the margin of each with its frequency (Hz)."""
    rows, margins, uncertainty = [], [], total(uncertainties())
    tasks = [(test, [each for each in points if test.band[0] <= each.frequency <= test.band[1]])
             for test in levels().values()]  # fmt: skip
    for name, (test, covered) in zip(levels(), tasks, strict=True):
        frequencies = np.array([each.frequency for each in covered])
        outcomes = sweep(subject(), test, frequencies, [subject().response])
        factors = np.array([each.interrupts for each in covered]) * G / test.amplitude(frequencies)
        lengths = np.array([max(failed.values(), default=0.0) for failed, _ in outcomes])
        forces = np.array([left[0] for _, left in outcomes]) / rest()
        at = int(factors.argmin())
        margins.append((test, float(factors[at]), float(frequencies[at])))
        longest, least = int(lengths.argmax()), int(forces.argmin())
        rows.append([
            name, "{:g} to {:g} Hz".format(*test.band),
            verdict(factors[at], uncertainty), f"{factors[at]:.2f} at {frequencies[at]:.0f} Hz",
            f"{duration(lengths[longest])} at {frequencies[longest]:.0f} Hz" if lengths.any() else "none",
            f"{100 * forces[least]:.1f} % at {frequencies[least]:.0f} Hz",
        ])  # fmt: skip
    columns = ["level", "frequencies", "verdict", "smallest margin", "longest interruption", SHOCK[-1]]
    return table(columns, rows), margins


def duration(seconds: float) -> str:
    """Return the length of an interruption in words."""
    return f"{1e6 * seconds:.1f} µs" if seconds else "none"


@cache
def rest() -> float:
    """Return the preload, N."""
    with subject().start({}) as contact:
        return contact.get("preload.force")


def uncertainties() -> tuple[float, float]:
    """Return how far the preload over the greatest force amplitude is uncertain, as parts.

    By the difference of the published maximum from this model's, and by the last digit of the published preload.
    """
    ratio, frequency, known = PEAKS[0]
    with subject().component.started(specimen(subject().component, ratio)) as contact:
        found = float(Spring.of(contact).force(frequency)[0])
    return abs(found / known - 1), DIGIT / FORCE


def total(parts: tuple[float, float]) -> float:
    """Return the uncertainty by both."""
    return float(np.hypot(*parts))


def shocks(quick: bool) -> str:
    """Return the table of shocks."""
    rows = []
    tests = [test for test in standard().tests if isinstance(test, Shock)]
    for test in tests[:1] if quick else tests:
        for direction, sign in (("presses the contact", 1.0), ("pulls it open", -1.0)):
            lengths, course, _ = Piece(test.course(), 1.0, 0.0).follow(subject(), sign, 1)
            least = float(course[:, 2].min()) / rest()
            rows.append([
                f"{test.clause.rpartition(' of ')[2].rpartition(', ')[2]}, condition {test.name[-1]}",
                f"{test.acceleration:g} g, {1e3 * test.duration:g} ms", direction, "yes" if least <= 0 else "no",
                duration(max(lengths.values(), default=0.0)), f"{100 * least:.1f} %",
            ])  # fmt: skip
    return table(SHOCK, rows)


def found(quick: bool) -> list[Thresholds]:
    """Return thresholds at equal ratios of frequency and at the ends of the levels, and more where they are lowest."""
    ends = [frequency for test in levels().values() for frequency in test.band]
    frequencies = sorted({round(each, 6) for each in [*np.geomspace(*RANGE, 12 if quick else 80), *ends]})
    points = side_by_side(thresholds, frequencies)
    at = min(range(len(points)), key=lambda place: points[place].opens)
    around = frequencies[max(at - 1, 0)], frequencies[min(at + 1, len(points) - 1)]
    between = [each for each in np.geomspace(*around, FINE + 2)[1:-1].round(6) if each not in frequencies]
    return sorted(points + side_by_side(thresholds, between), key=lambda each: each.frequency)


def figure(points: list[Thresholds]) -> Figure:
    """Draw the map."""
    frequencies = np.array([each.frequency for each in points])
    curves = [
        Curve("opens for 10 µs, steady vibration", frequencies, [each.interrupts for each in points]),
        Curve("the same after a sudden start", frequencies, [each.sudden for each in points], "dashed"),
    ]
    for colour, (name, test) in enumerate(levels().items(), 1):
        own = np.sort([*frequencies, test.corner])
        own = own[(own >= test.band[0]) & (own <= test.band[1])]
        curves.append(Curve(name, own, test.amplitude(own) / G, "dashed", colour))
    x, y = "frequency / Hz", "amplitude of the base acceleration / g"
    return Figure("opening-map", "Base acceleration that opens the contact", x, y, curves, "xy")


def values(quick: bool) -> tuple[list[Figure], dict[str, Any]]:
    """Return the figures and the numbers of the section."""
    points, parts = found(quick), uncertainties()
    seen_levels, margins = seen(points)
    asked, margin, frequency = margins[-1]
    weakest = min(points, key=lambda each: each.opens)
    elastic = linear(subject().component, readings(subject().component)[1])
    needed = [float(each.sine(UNIT, 0.0)[1].min()) for each in (elastic, subject().response)]
    at_2000 = min(points, key=lambda each: abs(each.frequency - 2000))
    words = {"passed": "The contact passes", "failed": "The contact fails at"}
    passed = [f"{test.acceleration:g} g" for test, each, _ in margins if verdict(each, total(parts)) == "passed"]

    def furthest(name: str) -> float:
        return 100.0 * max(abs(float(getattr(each, name)) / each.interrupts - 1) for each in points)

    return [figure(points)], {
        "answer": words.get(verdict(margin, total(parts)), "It is undecided whether the contact passes"),
        "asked": asked.acceleration, "passed": ", ".join(passed) or "none of the levels",
        "from_": margin * float(asked.amplitude(np.array(frequency))) / G,
        "at": frequency, "uncertainty": 100 * total(parts), "weakest": weakest, "parts": [100 * part for part in parts],
        "elastic": needed[0] / needed[1], "levels": seen_levels, "shocks": shocks(quick), "count": len(points),
        "furthest": {"opens": furthest("opens"), "linear": furthest("linear")}, "at_2000": at_2000, "gravity": G,
        "resolution": 100 * RESOLUTION,
    }  # fmt: skip
