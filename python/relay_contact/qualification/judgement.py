"""A test in a position of the coil, by one of the models: its margin, its verdict, and what the figures show."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from relay_contact.component import Array, warnings_kept
from relay_contact.figures import GRAVITY as G
from relay_contact.figures import three
from relay_contact.files import RelayContactError
from relay_contact.qualification import synthesis
from relay_contact.qualification.courses import MOST_DIPS, SHORT, Piece, further
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
from relay_contact.qualification.level import MOST, RESOLUTION, Lengths, Tried, threshold
from relay_contact.qualification.parts import CLOSED, CONTACT, CORE, MOVED, NONE, OPEN, STOP
from relay_contact.qualification.position import WORN, Drawn, Position
from relay_contact.qualification.relay import NORMAL
from relay_contact.qualification.response import FLIES, Response
from relay_contact.qualification.results import Finding, Margin, PartMargin, Verdict
from relay_contact.qualification.trials import SHOWN, Specimen, Weakest, sine_threshold, sine_tried, sweep
from relay_contact.records import ATTENUATED

MANY = 10_000
"""Decay times that a sweep takes to cross a resonance, above which their number does not matter."""
QUALITY = 10.0
"""Of the oscillators whose shock response spectrum is shown."""
SHOWN_TIME = 10e-3  # s around a dip
POINTS = 1500  # of a course that is shown as a whole
FOLLOWS = 0.9
"""Part of its level by linear theory below which another part than the first fails because that has failed."""
FOLLOWED = 0.5
"""Part of the gap of the open contact by which a fixed contact is bent that may follow the spring up to there."""
RISING, FURTHER = 1.15, 10.0
"""Factor from one level to the next, and of the least margin up to which others are tried once a part has failed."""
BEYOND = 2.0
"""Factor of the least margin from which on another part does not matter for that of the relay."""


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


@dataclass(frozen=True)
class Level:
    """The level that fails a part, relative to that of the test."""

    factor: float
    decides: list[str]
    """What of the part fails there."""
    linear: float
    weakest: str
    limits: str
    sure: float = 1.0
    """Part of the factor up to which nothing fails."""


def sparing(level: Level, opens: float) -> Level:
    """Return a level that the largest dips alone have told, and the one from which on they fail for an instant.

    Far above that others last as long: a lower level may fail.
    """
    if level.factor * FLIES < opens:
        return level
    told = f"{level.limits}; by the largest dips alone, which fail for an instant from {three(opens)} of the level on"
    return replace(level, limits=told, sure=opens / level.factor)


@dataclass(frozen=True)
class Seen:
    """What happened at the level of the test itself, by what may fail."""

    failed: Lengths
    where: dict[str, str]
    least: dict[str, float]
    curves: dict[str, Any]
    """Of the contact."""


ENDLESS = Level(MOST, [], MOST, "", "hardly moved by the test")
Found = tuple[dict[str, Level], Seen]
"""The levels that fail, by part, and what happened at that of the test."""


def rested(position: Position) -> dict[str, float]:
    """Return force (N) and gap (m) at rest, by what may fail: all of it, friction included."""
    specimen = position.specimen
    second = {OPEN: position.value("second.gap")} if position.value("effects.secondContact") else {}
    with position.component.started(position.values) as contact, contact.explained():
        force, indentation = contact.real("preload.force", "preload.indentation")
        held = {part.name: part.now(contact) for part in specimen.held}
    return ({OPEN: -indentation} if specimen.is_open else {CLOSED: force}) | second | held


def vibration(position: Position, test: Sine, points: int) -> Found:
    """Vibrate steadily at frequencies of the sweep, and seek the levels that fail each part where they are least."""
    specimen = position.specimen
    parts = {each.part: each for each in position.parts}
    weakest = {name: each.weakest[test.name] for name, each in parts.items()}
    low, high = test.band
    near = weakest[CONTACT].frequency * np.linspace(0.9, 1.1, points // 4)
    around = (np.geomspace(low, high, points), near[(near > low) & (near < high)])
    own = [np.array(test.steps)] if test.steps else [] if test.dwell else around
    chosen = np.unique(np.concatenate((*own, [each.frequency for each in weakest.values()])))
    rows = sweep(specimen, test, chosen, [each.specimen.response for each in parts.values()])
    lengths = {name: [length.get(name, 0.0) for length, _ in rows] for name in specimen.names}
    expected = dict(weakest)
    for name, each in parts.items():
        failures = [each.specimen.own(length) for length, _ in rows]
        worst = int(np.argmax([max(length.values(), default=0.0) for length in failures]))
        if weakest[name].factor > 1 and failures[worst]:
            frequency = float(chosen[worst])
            weakest[name] = Weakest(frequency, *sine_threshold(each.specimen, test, frequency, 1.0, failures[worst]))
    beside(parts, test, weakest)
    least = {name: [left[number] for _, left in rows] for number, name in enumerate(specimen.names)}
    levels = {}
    for name, (frequency, factor, decides, order) in weakest.items():
        response = parts[name].specimen.response
        _, factors = response.sine(test, parts[name].specimen.lasting)
        limits = bound(response, test, frequency)
        if order == 1:
            begin = three(response.weakest(test, 0.0))
            limits = f"resonance that a sweep follows down from {begin} Hz; a vibration raised there does not fail"
        elif order:
            limits = f"{order} times this frequency resonates, as the contact is not linear before it opens, either"
        if weakest[name] != expected[name]:
            limits = "fails at the level of the test where linear theory predicts no failure"
        levels[name] = Level(factor, decides, float(factors.min()), f"{three(frequency)} Hz", limits)
    seen = Seen(
        failed={name: max(each) for name, each in lengths.items() if any(each)},
        where={name: f"at {three(chosen[int(np.argmax(each))])} Hz" for name, each in lengths.items() if any(each)},
        least={name: min(each) for name, each in least.items()},
        curves={"frequency": chosen.tolist(), "level": test.amplitude(chosen).tolist(),
                "length": lengths, "least": least},
    )  # fmt: skip
    return levels, seen


def beside(parts: dict[str, Position], test: Sine, weakest: dict[str, Weakest]) -> None:
    """Replace the levels of parts that fail below what linear theory says, where another part has failed first."""
    first = min(weakest, key=lambda name: weakest[name].factor)
    frequency, level, *_ = weakest[first]
    for name in weakest.keys() - {first}:
        if found := follows(sine_tried(parts[name].specimen, test, frequency), level, weakest[name].factor):
            weakest[name] = Weakest(frequency, *found)


def follows(tried: Tried, first: float, own: float) -> tuple[float, list[str]] | None:
    """Return the level below its own at which a part fails as another has, which fails first, and what of it.

    Nothing is linear from there on, and what fails at a level need not at a higher one: all are tried.
    """
    level = first * (1 + RESOLUTION)
    while level < min(own, FURTHER * first):
        if failing := tried(level)[0]:
            return threshold(tried, level, failing)
        level *= RISING
    return None


def bound(response: Response, test: Sine, weakest: float) -> str:
    """Return what limits the margin of a sine, in words."""
    width = response.bandwidth(weakest)
    if test.dwell:
        return f"resonance, {three(width)} Hz wide, at which it stays"
    if test.steps:
        return "the weakest of the frequencies"
    if weakest in test.band:
        whole, below = "the whole force of inertia", "below the resonance"
        lowest = weakest == test.band[0]
        return f"lowest frequency of the range, {whole}" if lowest else f"highest frequency of the range, {below}"
    if weakest == test.corner:
        return "the frequency from which on the displacement is less, above the resonance or without one"
    # Time at each octave, and that which a vibration of this width takes to decay by a factor e.
    octaves = np.log2(1 + width / weakest)
    decays = octaves / test.rate * 60 * np.pi * width
    limits = f"resonance, {three(width)} Hz wide; the sweep of {three(test.rate)} octaves a minute crosses it in "
    return limits + (f"{three(decays)} decay times" if decays < MANY else f"over {MANY} decay times")


def random(position: Position, test: Random) -> Found:
    """Seek the levels at which the largest dips of a record fail; for the time of the test by Rice's rate.

    What happens in the test is that around a dip of the record, raised to the size of the largest in the test.
    """
    found = {each.part: random_level(each, test) for each in shaken(position, test)}
    levels = {each.part: found[each.part][0] if each.part in found else ENDLESS for each in position.parts}
    failed, least = merged(position, [own[1:] for own in found.values()])
    shown = found[CONTACT][2]
    shown = shown[shown[:, 0] > shown[-1, 0] - SHOWN_TIME]
    curves = {"time": (shown[:, 0] - shown[0, 0]).tolist(), "course": shown[:, 1].tolist()}
    return levels, Seen(failed, dict.fromkeys(failed, f"in {three(test.duration / 60)} min"), least, curves)


def shaken(position: Position, test: Test) -> list[Position]:
    """Return the contact, and those of the other parts that a test shakes."""
    return [each for each in position.parts if each.part == CONTACT or not each.is_endless(test)]


def random_level(position: Position, test: Random) -> tuple[Level, Lengths, Array]:
    """Return the level of noise that fails a part, and failures and rows around a dip at the level of the test."""
    specimen = position.specimen
    response = specimen.response
    linear = response.random(test, specimen.lasting)
    _, eased = position.noises[test.unit]
    part, decides, piece = position.middle[test.unit]
    raised = piece.guess / (linear * eased)
    lengths, rows, _ = piece.follow(specimen, raised)
    own = specimen.own(lengths)
    if own and part * linear * eased > 1:
        level, decides = piece.threshold(specimen, 1.0, own, raised)
        part = level / piece.guess
    rms, *_ = response.moments(test)
    density = test.spectrum(response.frequency) * response.gain**2
    share = np.cumsum(density) / density.sum()
    half = response.frequency[np.searchsorted(share, [0.25, 0.75])]
    moving, rest = ("motion", "gap") if specimen.is_open else ("force", "preload")
    rest = rest if position.part == CONTACT else "force at rest"
    weakest = f"{three(half[0])} to {three(half[1])} Hz"
    part_of_rest = three(rms / response.reserve)
    limits = f"half of the variance of the {moving} lies at {weakest}; its rms is {part_of_rest} of the {rest}"
    if eased > 1:
        limits += f"; clipping raises the level by {three(100 * (eased - 1))} %"
    found = Level(linear * part * eased, decides, linear * eased, weakest, limits)
    return sparing(found, response.random(test, 0.0) * eased), lengths, rows


def merged(position: Position, runs: list[tuple[Lengths, Array]]) -> tuple[Lengths, dict[str, float]]:
    """Return the longest failures in several runs, and what was left at least."""
    names = position.specimen.names
    failed = {name: max(lengths.get(name, 0.0) for lengths, _ in runs) for name in names
              if any(name in lengths for lengths, _ in runs)}  # fmt: skip
    least = {name: float(min(rows[:, 2 + number].min() for _, rows in runs)) for number, name in enumerate(names)}
    return failed, least


Run = tuple[str, Piece, Lengths, Array]
"""A direction, a piece of a course, the failures, and rows of what was observed."""


def transient(position: Position, test: Transient) -> Found:
    """Run a course in its directions, or what is around its largest dips, and seek the levels that fail each part."""
    specimen = position.specimen
    found = {each.part: transient_level(each, test) for each in shaken(position, test)}
    levels = {each.part: found[each.part][0] if each.part in found else ENDLESS for each in position.parts}
    first = min(found, key=lambda name: levels[name].factor)
    _, _, decisive, _, signed = found[first]
    for each in position.parts:
        tried, own = decisive.tried(each.specimen, float(np.sign(signed))), levels[each.part]
        if each.part != first and (known := follows(tried, abs(signed), own.factor)):
            levels[each.part] = replace(own, factor=known[0], decides=known[1], weakest=levels[first].weakest)
    told = {name: own[3] for part, own in found.items() for name in specimen.names if part in (name, CONTACT)}
    failed, least = merged(position, [run[2:] for own in found.values() for run in own[1]])
    _, shown, piece, _, level = found[CONTACT]
    start = test.record.time[0] if isinstance(test, History) else 0.0
    failing: Lengths = {}
    if isinstance(test, Shock):
        # In the direction that opens a closed contact, or closes an open one.
        wanted = "closing" if specimen.is_open else "opening"
        course = next(rows for way, *_, rows in shown if way == wanted)[:-1]
    else:
        failing, course = failing_run(specimen, piece, level, start)
    curves = {"time": course[:, 0].tolist(), "course": course[:, 1].tolist(), "failing": failing, **excited(test)}
    return levels, Seen(failed, {name: told[name] for name in failed}, least, curves)


def transient_level(position: Position, test: Transient) -> tuple[Level, list[Run], Piece, str, float]:
    """Return the level of a course that fails a part, its runs at the level of the test, the worst piece, and where.

    Last is the factor at which that piece fails, with the sign of its direction.
    """
    specimen = position.specimen
    ways = test.directions
    own = sorted(((way, piece) for way, each in position.pieces[test.name].items() for piece in each),
                 key=lambda each: each[1].guess)  # fmt: skip
    runs = [(way, piece, *piece.follow(specimen, ways[way], SHOWN)[:2]) for way, piece in own]
    way, piece = own[0]
    factor, decides = (MOST, []) if position.is_endless(test) else piece.threshold(specimen, ways[way])
    for other, each, lengths, _ in runs:
        known, level = {}, 0.0
        if factor > 1 and specimen.own(lengths):
            known, level = specimen.own(lengths), 1.0
        elif each is not piece and each.guess >= factor:
            known, level = specimen.own(each.follow(specimen, ways[other] * factor)[0]), factor
        # Expected to fail below it, one need not at that level: a contact that flies for long may not higher up.
        if known or (each is not piece and each.guess < factor):
            lower, failed = each.threshold(specimen, ways[other], known, level)
            if lower < factor:
                way, piece, factor, decides = other, each, lower, failed
    others = further(specimen, test, factor, own[0][1].guess)
    for other, each in others:
        level = factor * (1 - RESOLUTION)
        if known := specimen.own(each.follow(specimen, ways[other] * level)[0]):
            way, piece = other, each
            factor, decides = each.threshold(specimen, ways[other], known, level)
    start = test.record.time[0] if isinstance(test, History) else 0.0
    where, limits, weakest = words(position, test, way, piece, start)
    found = Level(factor, decides, own[0][1].guess, weakest, limits)
    if len(own) > len(ways):
        position.decisive[test.name] = ways[way], piece
        found = sparing(found, min(specimen.response.course(each.course, ways[other], 0.0) for other, each in own))
        untried = others[-1][1].guess if len(others) >= MOST_DIPS else factor
        found = replace(found, sure=min(found.sure, untried / factor))
    return found, runs, piece, where, ways[way] * factor


def failing_run(specimen: Specimen, piece: Piece, level: float, start: float) -> tuple[Lengths, Array]:
    """Run what is around the dip that fails first at the level at which it fails; return the failures and the run."""
    # Surely beyond it, by as much as it is known.
    lengths, rows, _ = piece.follow(specimen, level * (1 + RESOLUTION), SHOWN)
    dip = int(rows[:, 2].argmin())
    rows[dip, 1] = min(rows[dip, 1:3])
    near = np.abs(rows[:, 0] - rows[dip, 0]) < SHOWN_TIME
    return lengths, np.column_stack((rows[near, 0] + piece.begin + start, rows[near, 1]))


def words(position: Position, test: Transient, way: str, piece: Piece, start: float) -> tuple[str, str, str]:
    """Return where a course fails, what limits its margin, and where it is weakest."""
    response = position.specimen.response
    if isinstance(test, Shock):
        slow = response.reserve / max(response.gain[0] * G * test.acceleration, 1e-300) / piece.guess
        of = " of the spring" if position.part == CONTACT else ""
        return "", f"inertia{of}; dynamic amplification {three(slow)}", f"{way} direction"
    change = test.directions[way] * response.moved(piece.course)
    dip = STEP * int(change.argmin()) + piece.begin + start
    share = float(np.abs(change).max() / max(response.gain[0] * np.abs(piece.course.acceleration).max(), 1e-300))
    limits = f"dip; dynamic amplification {three(share)} of the peak acceleration there"
    told = f"{way} direction" if way in DIRECTIONS else way
    return f"near {dip:.6g} s", limits, f"{told}, at {dip:.6g} s"


def tolerated(position: Position, test: Test) -> tuple[float, float] | None:
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
    if isinstance(test, Spectrum):
        low, high, quality = test.response[0][0], test.response[-1][0], test.quality
    else:
        low, high, quality = max(1.0, 2 / course.end), min(1e4, 0.25 * (len(course.time) - 1) / course.end), QUALITY
    # Of a very short record, or a slow one, one frequency.
    frequency = synthesis.grid(min(low, high), high, spacing)
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
    with warnings_kept() as warnings:
        try:
            finding = judged(position, test, points)
        except RelayContactError as error:
            raise RelayContactError(f"{position.named(test)}: {error}") from error
    return replace(finding, warnings=list(warnings.values()))


def judged(position: Position, test: Test, points: int) -> Finding:
    """Run a test in a position of the coil, by one of the models."""
    notes = [*(test.record.notes if isinstance(test, History) else []), *followed_by(position)]
    evidence = test.weakest_evidence

    def finding(verdict: Verdict, limits: str, own: Margin | None = None) -> Finding:
        return Finding(
            position.name, test.name, position.axis, test.kind, str(test), test.clause, evidence, position.model.name,
            verdict, limits, own, notes,
        )  # fmt: skip

    if known := decided_at_rest(position):
        return finding(*known)
    if isinstance(test, History):
        notes += test.record.sampled(position.specimen.response.natural)
    match test:
        case Sine():
            levels, seen = vibration(position, test, points)
        case Random():
            levels, seen = random(position, test)
        case Transient():
            levels, seen = transient(position, test)
        case _:
            raise TypeError(test)
    for name, each in levels.items():
        if each.factor >= MOST:
            levels[name] = replace(ENDLESS, limits=ENDLESS.limits if each.sure == 1 else each.limits, sure=each.sure)
    own = whole(position, test, levels, seen)
    return finding(verdict(own.low, own.high), levels[first_of(levels)].limits, own)


def followed_by(position: Position) -> list[str]:
    """Return what has to be said of a fixed contact that may follow the spring as far as to the open one."""
    gap = position.value("second.gap")
    if not (position.value("effects.secondContact") and position.values.get("fixed.file")):
        return []
    with position.component.started(position.values) as contact:
        bent = -contact.get("fixed.displacement")
    if bent < FOLLOWED * gap:
        return []
    told = f"the fixed contact is bent by {three(1e3 * bent)} mm at rest, and follows the spring as it leaves"
    return [f"{told}: this may reach the open contact, {three(1e3 * gap)} mm away, below the level that is found"]


def decided_at_rest(position: Position) -> tuple[Verdict, str] | None:
    """Return the verdict of a position that its state at rest decides, and why."""
    pusher = position.component.choice(position.values, "effects.pusher")
    if pusher == MOVED and not {CORE, STOP} & {*position.rest.held}:
        return "FAIL", "the armature rests at neither of its stops"
    if position.axis not in (NORMAL, *position.relay.axes):
        return "not judged", f"the relay's file has no participations of the modes in the axis {position.axis}"
    if position.value("contact.overtravel") == 0 and pusher == NONE:
        return "not judged", "contact.overtravel = 0: meant neither closed nor open"
    if position.value("effects.secondContact") and position.rest.is_open:
        both = "both contacts open: closings on both sides are not judged"
        return "not judged", f"{both}; give each side as a position of its own"
    if position.specimen.response.reserve <= 0:
        if position.rest.is_open:
            return "FAIL", "makes at rest: gravity closes the gap"
        return "FAIL", f"interrupted at rest: more than {position.contacts.threshold:g} Ω of contact resistance"
    return None


def first_of(levels: dict[str, Level]) -> str:
    """Return the part that fails first.

    Others that fail by its failure do so at the same level: of those that the search cannot tell apart it is the one
    that fails first by linear theory.
    """
    least = min(level.factor for level in levels.values())
    tied = [name for name, level in levels.items() if level.factor <= least * (1 + 3 * RESOLUTION)]
    return min(tied, key=lambda name: levels[name].linear)


def whole(position: Position, test: Test, levels: dict[str, Level], seen: Seen) -> Margin:
    """Return the margin of the relay, which is that of the part that fails first, with what it comes from."""
    first = first_of(levels)
    level = replace(levels[first], factor=min(each.factor for each in levels.values()))
    parts = {each.part: each for each in position.parts}
    drawn = {first: parts[first].margins(test, levels[first].factor)}
    for name, each in [item for item in levels.items() if item[0] != first]:
        if each.factor < FOLLOWS * each.linear:
            # It fails as the first part has failed, and by as much with what is uncertain of that.
            levels[name] = replace(each, limits=f"fails once another part has failed: {first}")
            drawn[name] = drawn[first].scaled(each.factor / levels[first].factor)
        else:
            drawn[name] = parts[name].margins(test, each.factor, each.factor < BEYOND * level.factor)
    least = Drawn.least(list(drawn.values()))
    if falls := np.mean(least.margins == 0):
        told = f"{levels[first].limits}; {three(100 * falls)} % of the draws fail at rest"
        levels[first] = replace(levels[first], limits=told)
    natural = position.specimen.response.natural
    kept = test.record.kept(natural) if isinstance(test, History) else 1.0
    known = kept * min(1.0, *(each.factor * each.sure / level.factor for each in levels.values()))
    low, high = ends(least, level.factor, known)
    wears = [each.wear(test, levels[each.part].factor) for each in position.parts]
    wear = {"overtravel": wears[0]["overtravel"], "margin": np.min([each["margin"] for each in wears], axis=0).tolist()}
    own = {
        name: PartMargin(each.factor, *ends(drawn[name], each.factor, kept * each.sure), each.weakest, each.limits)
        for name, each in levels.items()
    }  # fmt: skip
    return Margin(
        margin=level.factor, linear=level.linear, decides=level.decides, weakest=level.weakest, failed=seen.failed,
        where=seen.where, least=seen.least, rest=rested(position), natural=natural,
        curves=seen.curves, overtravel=abs(position.overtravel), wear=wear, passes=passes(wear, low / level.factor),
        low=low, high=high, chance=position.chance(test, least, level.factor) if known >= 1 - ATTENUATED else None,
        parts=own if len(own) > 1 else {}, tolerance=tolerated(parts[first], test),
    )  # fmt: skip


def ends(drawn: Drawn, factor: float, known: float) -> tuple[float, float]:
    """Return the ends of the interval of a margin, as far out as its draws may be wrong.

    What the component found is within. `known` is the part of the margin up to which surely nothing fails: a record may
    lack some of a vibration, and with all of it less of its level may fail.
    """
    low, high = np.quantile(drawn.margins, LIMITS, method="hazen").tolist()
    return known * min(low * max(1 - drawn.error, 0.0), factor), max(high * (1 + drawn.error), factor)
