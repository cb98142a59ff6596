"""A test in a position of the coil, by one of the models: its margin, its verdict, and what the figures show."""

from dataclasses import replace
from typing import Any

import numpy as np

from relay_contact.component import Array
from relay_contact.figures import GRAVITY as G
from relay_contact.figures import three
from relay_contact.qualification import synthesis
from relay_contact.qualification.distributions import LIMITS
from relay_contact.qualification.excitation import (  # fmt: skip
    DIRECTIONS,
    STEP,
    Course,
    History,
    Random,
    Shock,
    Sine,
    Spectrum,
    Test,
    Transient,
    straight,
)
from relay_contact.qualification.position import WORN, Position
from relay_contact.qualification.relay import NORMAL
from relay_contact.qualification.response import Response, open_at_rest
from relay_contact.qualification.results import CLOSED, OPEN, Finding, Margin, Verdict
from relay_contact.qualification.trials import (
    SAMPLE,
    SHORT,
    SHOWN,
    Lengths,
    Piece,
    Specimen,
    middle_dip,
    sine_least,
    sine_threshold,
    sweep,
)

MANY = 10_000
"""Decay times that a sweep takes to cross a resonance, above which their number does not matter."""
QUALITY = 10.0
"""Of the oscillators whose shock response spectrum is shown."""
SHOWN_TIME = 10e-3  # s around a dip
POINTS = 1500  # of a course that is shown as a whole


def verdict(low: float, high: float) -> Verdict:
    """Compare an interval of a margin with 1; if that is within it, nothing is decided."""
    return "pass" if low > 1 else "FAIL" if high < 1 else "undecided"


def together(verdicts: list[Verdict]) -> Verdict:
    """Return the verdict of several models: what all say, else nothing is decided."""
    return verdicts[0] if len(set(verdicts)) == 1 else "undecided"


def passes(wear: dict[str, list[float]], least: float) -> float | None:
    """Return the overtravel or gap (m) from which on a test is passed, the interval included.

    `least` is the low end of the interval of the margin, as a part of it. The least value shown if the test is passed
    from there on, none if it is not up to the largest.
    """
    ends, over = least * np.array(wear["margin"]), wear["overtravel"]
    at = WORN.index(1.0)
    step = -1 if ends[at] > 1 else 1
    while 0 <= at + step < len(over) and (ends[at] > 1) == (ends[at + step] > 1):
        at += step
    if not 0 <= at + step < len(over):
        return over[0] if step < 0 else None
    low, high = sorted((at, at + step))
    return float(np.interp(1.0, ends[[low, high]], [over[low], over[high]]))


def rested(position: Position) -> dict[str, float]:
    """Return force (N) and gap (m) at rest."""
    specimen = position.specimen
    second = {OPEN: position.value("second.gap")} if position.value("effects.secondContact") else {}
    return {OPEN if specimen.is_open else CLOSED: specimen.response.reserve} | second


def found(position: Position, limits: str, **more: Any) -> tuple[Margin, str]:  # noqa: ANN401
    """Return a margin with what all kinds of tests have in common, and what limits it."""
    rest, natural = rested(position), position.specimen.response.natural
    return Margin(rest=rest, natural=natural, overtravel=abs(position.value("contact.overtravel")), **more), limits


def vibration(position: Position, test: Sine, points: int) -> tuple[Margin, str]:
    """Vibrate steadily at frequencies of the sweep, and seek the level that fails where it is least."""
    specimen = position.specimen
    response = specimen.response
    known, factors = response.sine(test, specimen.lasting)
    at = int(factors.argmin())
    weakest, factor, decides = sine_least(specimen, test)
    low, high = test.band
    near = weakest * np.linspace(0.9, 1.1, points // 4)
    around = (np.geomspace(low, high, points), near[(near > low) & (near < high)])
    own = [np.array(test.steps)] if test.steps else [] if test.dwell else around
    chosen = np.unique(np.concatenate((*own, [weakest])))
    rows = sweep(specimen, test, chosen)
    lengths = {name: [length.get(name, 0.0) for length, _ in rows] for name in specimen.monitors}
    worst = int(np.argmax([max(length.values(), default=0.0) for length, _ in rows]))
    elsewhere = factor > 1 and bool(rows[worst][0])
    if elsewhere:
        weakest = float(chosen[worst])
        factor, decides = sine_threshold(specimen, test, weakest, 1.0, rows[worst][0])
    least = {name: [left[number] for _, left in rows] for number, name in enumerate(specimen.monitors)}
    reason = "fails at the level of the test where linear theory does not expect it"
    return found(
        position, reason if elsewhere else bound(response, test, at, len(known), weakest),
        margin=factor, decides=decides, linear=float(factors[at]), weakest=f"{three(weakest)} Hz",
        failed={name: max(each) for name, each in lengths.items() if any(each)},
        where={name: f"at {three(chosen[int(np.argmax(each))])} Hz" for name, each in lengths.items() if any(each)},
        least={name: min(each) for name, each in least.items()},
        curves={"frequency": chosen.tolist(), "level": test.amplitude(chosen).tolist(),
                "length": lengths, "least": least},
    )  # fmt: skip


def bound(response: Response, test: Sine, at: int, count: int, weakest: float) -> str:
    """Return what limits the margin of a sine, in words."""
    width = response.bandwidth(weakest)
    if test.dwell:
        return f"resonance, {three(width)} Hz wide, at which it stays"
    if test.steps:
        return "the weakest of the frequencies"
    if not 0 < at < count - 1:
        whole, below = "the whole force of inertia", "below the resonance"
        return f"highest frequency of the range, {below}" if at else f"lowest frequency of the range, {whole}"
    # Time at each octave, and that which a vibration of this width takes to decay by a factor e.
    octaves = np.log2(1 + width / weakest)
    decays = octaves / test.rate * 60 * np.pi * width
    limits = f"resonance, {three(width)} Hz wide; the sweep of {three(test.rate)} octaves a minute crosses it in "
    return limits + (f"{three(decays)} decay times" if decays < MANY else f"over {MANY} decay times")


def random(position: Position, test: Random) -> tuple[Margin, str]:
    """Seek the level at which the largest dips of a record fail; for the time of the test by Rice's rate.

    What happens in the test is that around a dip of the record, raised to the size of the largest in the test.
    """
    specimen = position.specimen
    response = specimen.response
    linear = response.random(test, specimen.lasting)
    dips, eased = position.noises[test.name]
    part, decides, piece = middle_dip(specimen, dips)
    raised = piece.guess / (linear * eased)
    lengths, rows = piece.follow(specimen, raised, points=1)
    if lengths and part * linear * eased > 1:
        level, decides = piece.threshold(specimen, 1.0, lengths, raised)
        part = level / piece.guess
    rms, _ = response.moments(test)
    density = test.spectrum(response.frequency) * response.gain**2
    share = np.cumsum(density) / density.sum()
    half = response.frequency[np.searchsorted(share, [0.25, 0.75])]
    moving, rest = ("motion", "gap") if specimen.is_open else ("force", "preload")
    limits = f"half of the power of the {moving} is there; {three(rms / response.reserve)} of the {rest} rms"
    if eased > 1:
        limits += f"; clipping raises the level by {three(100 * (eased - 1))} %"
    shown = rows[-round(SHOWN_TIME / SAMPLE) :]
    return found(
        position, limits, margin=linear * part * eased, decides=decides, linear=linear * eased,
        weakest=f"{three(half[0])} to {three(half[1])} Hz",
        failed=lengths, where=dict.fromkeys(lengths, f"in {three(test.duration / 60)} min"),
        least=dict(zip(specimen.monitors, rows[:, 2:].min(axis=0).tolist(), strict=True)),
        curves={"time": (shown[:, 0] - shown[0, 0]).tolist(), "course": shown[:, 1].tolist()},
    )  # fmt: skip


def transient(position: Position, test: Transient) -> tuple[Margin, str]:
    """Run a course in its directions, or what is around its largest dips, and seek the levels that fail."""
    specimen = position.specimen
    ways = test.directions
    own = sorted(((way, piece) for way, each in position.pieces[test.name].items() for piece in each),
                 key=lambda each: each[1].guess)  # fmt: skip
    runs = [(way, piece, *piece.follow(specimen, ways[way], SHOWN)) for way, piece in own]
    way, piece = own[0]
    factor, decides = piece.threshold(specimen, ways[way])
    for other, each, lengths, _ in runs:
        known: Lengths = {}
        if factor > 1 and lengths:
            known, level = lengths, 1.0
        elif each is not piece:
            known, level = each.follow(specimen, ways[other] * factor)[0], factor
        if known:
            lower, failed = each.threshold(specimen, ways[other], known, level)
            if lower < factor:
                way, piece, factor, decides = other, each, lower, failed
    failed_ = {name: max(lengths.get(name, 0.0) for *_, lengths, _ in runs) for name in specimen.monitors
               if any(name in lengths for *_, lengths, _ in runs)}  # fmt: skip
    least = {name: float(min(rows[:, 2 + number].min() for *_, rows in runs))
             for number, name in enumerate(specimen.monitors)}  # fmt: skip
    start = test.record.time[0] if isinstance(test, History) else 0.0
    failing: Lengths = {}
    if isinstance(test, Shock):
        shown = opening_run(specimen, runs)
    else:
        failing, shown = failing_run(specimen, piece, ways[way] * factor, start)
    where, limits, weakest = words(position, test, way, piece, start)
    return found(
        position, limits, margin=factor, decides=decides, linear=own[0][1].guess, weakest=weakest, failed=failed_,
        where=dict.fromkeys(failed_, where), least=least, tolerance=tolerated(position, test),
        curves={"time": shown[:, 0].tolist(), "course": shown[:, 1].tolist(), "failing": failing, **excited(test)},
    )  # fmt: skip


def opening_run(specimen: Specimen, runs: list[Any]) -> Array:
    """Return the run of a shock at its level in the direction that opens a closed contact, or closes an open one."""
    wanted = "closing" if specimen.is_open else "opening"
    return np.asarray(next(rows for way, *_, rows in runs if way == wanted)[:-1])


def failing_run(specimen: Specimen, piece: Piece, level: float, start: float) -> tuple[Lengths, Array]:
    """Run what is around the dip that fails first at the level at which it fails; return the failures and the run."""
    lengths, rows = piece.follow(specimen, level, SHOWN)
    dip = int(rows[:, 2].argmin())
    near = np.abs(rows[:, 0] - rows[dip, 0]) < SHOWN_TIME
    return lengths, np.column_stack((rows[near, 0] + piece.begin + start, rows[near, 1]))


def words(position: Position, test: Transient, way: str, piece: Piece, start: float) -> tuple[str, str, str]:
    """Return where a course fails, what limits its margin, and where it is weakest."""
    response = position.specimen.response
    if isinstance(test, Shock):
        slow = response.reserve / (response.gain[0] * G * test.acceleration) / piece.guess
        return "", f"inertia of the spring, {three(slow)} times that of a slow shock", f"{way} direction"
    change = test.directions[way] * response.change(piece.course.sampled())
    dip = STEP * int(change.argmin()) + piece.begin + start
    share = float(np.abs(change).max() / max(response.gain[0] * np.abs(piece.course.acceleration).max(), 1e-300))
    limits = f"dip of {three(share)} times what the peak acceleration there would make slowly"
    told = f"{way} direction" if way in DIRECTIONS else way
    return f"near {dip:.6g} s", limits, f"{told}, at {dip:.6g} s"


def tolerated(position: Position, test: Transient) -> tuple[float, float] | None:
    """Return the margins by linear theory at the ends of the tolerance of a pulse."""
    if not isinstance(test, Shock) or not (test.tolerance.peak or test.tolerance.duration):
        return None
    response, lasting = position.specimen.response, position.specimen.lasting
    margins = [response.course(each.course(), sign, lasting) for each in test.corners for sign in DIRECTIONS.values()]
    return min(margins), max(min(margins[at : at + 2]) for at in range(0, len(margins), 2))


def excited(test: Transient) -> dict[str, Any]:
    """Return what the figures show of a course itself: the whole, its spectrum, its shock response spectrum."""
    if isinstance(test, Shock):
        return {}
    course = test.course()
    sampled = course.sampled()
    # Of a long record fewer frequencies: each takes a filter over all of it.
    spacing = synthesis.SPACING if course.end <= SHORT else 2 ** (1 / 3)
    low, high = (test.response[0][0], test.response[-1][0]) if isinstance(test, Spectrum) else (
        max(1.0, 2 / course.end), min(1e4, 0.25 * (len(course.time) - 1) / course.end)
    )  # fmt: skip
    frequency = synthesis.grid(low, high, spacing)
    quality = test.quality if isinstance(test, Spectrum) else QUALITY
    shown: dict[str, Any] = {
        "srs": [frequency.tolist(), synthesis.response(sampled, STEP, frequency, quality).tolist()]
    }
    if isinstance(test, Spectrum):
        shown["required"] = (G * straight(test.response, frequency)).tolist()
    shown["whole"] = envelope(course, test.record.time[0] if isinstance(test, History) else 0.0)
    shown["spectrum"] = density(sampled, frequency, spacing)
    return shown


def envelope(course: Course, start: float) -> list[list[float]]:
    """Return times (s), and least and greatest accelerations in so many pieces of a course: what a plot would show."""
    cuts = np.unique(np.linspace(0, len(course.time) - 1, POINTS).astype(int))[:-1]
    least, greatest = (way.reduceat(course.acceleration, cuts) for way in (np.minimum, np.maximum))
    return [(course.time[cuts] + start).tolist(), least.tolist(), greatest.tolist()]


def density(sampled: Array, frequency: Array, spacing: float) -> list[float]:
    """Return the power spectral density (m2/s3) of a course, the mean in bands around frequencies (Hz)."""
    power = np.abs(np.fft.rfft(sampled)) ** 2 * 2 * STEP / len(sampled)
    own = np.fft.rfftfreq(len(sampled), STEP)
    ends = np.searchsorted(own, np.outer(frequency, [spacing**-0.5, spacing**0.5]))
    return [float(power[low : max(high, low + 1)].mean()) for low, high in ends]


def tested(position: Position, test: Test, points: int) -> Finding:
    """Run a test in a position of the coil, by one of the models; with what the component warned of."""
    position.component.warnings.clear()
    finding = judged(position, test, points)
    return replace(finding, warnings=list(position.component.warnings.values()))


def judged(position: Position, test: Test, points: int) -> Finding:
    """Run a test in a position of the coil, by one of the models."""
    notes = list(test.record.notes) if isinstance(test, History) else []
    evidence, second = test.weakest_evidence, bool(position.value("effects.secondContact"))

    def finding(verdict: Verdict, limits: str, own: Margin | None = None) -> Finding:
        return Finding(
            position.name, test.name, position.axis, test.kind, str(test), test.clause, evidence, position.model.name,
            verdict, limits, own, notes,
        )  # fmt: skip

    if position.axis not in (NORMAL, *position.relay.axes):
        reason = f"the relay's file has no participations of the modes in the axis {position.axis}"
        return finding("not judged", reason)
    if position.value("contact.overtravel") == 0:
        return finding("not judged", "the contact just touches: neither closed nor open")
    if second and open_at_rest(position.component, position.values):
        reason = "both contacts open: closings on both sides are not judged; give each side as a position of its own"
        return finding("not judged", reason)
    if position.specimen.response.reserve <= 0:
        reason = f"interrupted at rest: more than {position.contacts.threshold:g} Ω of contact resistance"
        return finding("FAIL", reason)
    match test:
        case Sine():
            own, limits = vibration(position, test, points)
        case Random():
            own, limits = random(position, test)
        case Transient():
            own, limits = transient(position, test)
        case _:
            raise TypeError(test)
    margins, chance = position.margins(test, own.margin)
    low, high = np.quantile(margins, LIMITS, method="hazen").tolist()
    low, high = min(low, own.margin), max(high, own.margin)
    wear = position.wear(test, own.margin)
    own = replace(own, low=low, high=high, chance=chance, wear=wear, passes=passes(wear, low / own.margin))
    return finding(verdict(low, high), limits, own)
