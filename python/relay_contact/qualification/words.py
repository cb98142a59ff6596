"""What an assessment found, in words and in the cells of tables, three significant digits each."""

from relay_contact.figures import three
from relay_contact.qualification.excitation import LEVELS
from relay_contact.qualification.judgement import verdict
from relay_contact.qualification.level import MOST
from relay_contact.qualification.parts import CLOSED, CONTACT, CORE, OPEN, PUSHER, STOP
from relay_contact.qualification.position import CHANCE, MODEL, WORN
from relay_contact.qualification.results import Chance, Finding, Margin, PartMargin, Tested

HEAD = (
    "test", "level", "verdict", "margin", "95 % interval of the parameters", "weakest at", "fails first", "in the test",
    "least force or gap",
)  # fmt: skip
REASONS = ("test", "what limits", "what the interval comes from", "to measure or tighten", "chance of failing",
           "passes from")  # fmt: skip
QUANTITIES = dict.fromkeys((CLOSED, CORE, STOP, PUSHER), "force") | {OPEN: "gap"}
FAILURES = {CLOSED: "interrupted", OPEN: "makes"}
LEAVES = {CORE: "armature leaves its core", STOP: "armature leaves its stop", PUSHER: "spring leaves its pusher"}
MARKS: dict[str, str] = dict(zip(LEVELS, ("", "", " †", " *"), strict=True))
"""Of tests with numbers that were not read in the standard."""
UNREAD = "† Read in a quotation of the standard. * From memory: not, or not all, read in the standard's text."
TOLD = {MODEL: "allowance for the model", CHANCE: CHANCE}
UNSTATED = "none stated"
"""In place of an interval and a chance, where the relay's file has nothing that they could come from."""
COARSE = "what the record leaves open, besides the uncertainties"
LEAST_SHARE = 0.1  # of the variance, below which knowing a parameter narrows the interval by less than 5 %


def time_text(seconds: float) -> str:
    """Return a short time in words."""
    return f"{three(1e3 * seconds)} ms" if seconds >= 1e-3 else f"{three(1e6 * seconds)} µs"


def is_open(margin: Margin) -> bool:
    """Return whether the first contact was open, so that its gap was observed."""
    return CLOSED not in margin.rest


def failure(name: str, length: float, where: str = "") -> str:
    """Return how something fails, for how long (s) if it is a contact, in words."""
    told = LEAVES.get(name) or f"{name} {FAILURES[name]} for {time_text(length)}"
    return f"{told} {where}".rstrip()


def failures(margin: Margin) -> str:
    """Return what fails at the level of the test, and the longest failure of contacts, in words."""
    told = [failure(name, length, margin.where[name]) for name, length in margin.failed.items()]
    if not told and margin.margin <= 1:
        return f"none fails at this level itself, but at {three(margin.margin)} of it"
    return ", ".join(told) or "none fails"


def failing(margin: Margin) -> str:
    """Return what fails at the margin of a course, in words."""
    told = [failure(name, length) for name, length in margin.curves["failing"].items()]
    return f"At {three(margin.margin)} of the level: {', '.join(told) or 'none fails'}"


def at_rest(margin: Margin) -> str:
    """Return forces and gap at rest, in words."""
    texts: dict[str, tuple[str, float]] = {name: (f"force of the {name} {{}} cN", 100) for name in QUANTITIES}
    texts[OPEN] = ("gap of the open contact {} mm", 1e3)
    return ", ".join(texts[name][0].format(three(texts[name][1] * value)) for name, value in margin.rest.items())


def left_of(margin: Margin, name: str) -> str:
    """Return what is left of force or gap at the level of the test, as a part of that at rest."""
    return f"{QUANTITIES[name]} {three(100 * max(margin.least[name], 0.0) / margin.rest[name])} %"


def factor_text(margin: float) -> str:
    """Return a margin in words."""
    return f"> {MOST:g}" if margin >= MOST else three(margin)


def numbers(own: Margin | PartMargin, stated: bool) -> tuple[str, str]:
    """Return a margin and its interval if there is one, in words: not of what does not fail."""
    interval = f"{three(own.low)} to {three(own.high)}" if stated else UNSTATED
    return factor_text(own.margin), "" if own.margin >= MOST and own.low > 1 else interval


def own_cells(finding: Finding) -> list[str]:
    """Return what the table has of a test by one model, from the verdict on."""
    if finding.judged is None:
        return [finding.verdict, "", "", finding.limits, "", "", ""]
    own = finding.judged
    # Of parts that are held in their own rows.
    left = [left_of(own, name) for name in own.least if name not in LEAVES]
    first = " and ".join(own.decides) or "none"
    return [finding.verdict, *numbers(own, own.stated), own.weakest, first, failures(own), ", ".join(left)]


def part_rows(finding: Finding) -> list[list[str]]:
    """Return a row for each part of a relay that has others than its contacts."""
    margin = finding.judged
    found: list[list[str]] = []
    if margin is None:
        return found
    for name, part in margin.parts.items():
        names = [each for each in (CLOSED, OPEN) if each in margin.least] if name == CONTACT else [name]
        label = "contacts" if len(names) > 1 else names[0]
        told = [failure(each, margin.failed[each], margin.where[each]) for each in names if each in margin.failed]
        left = [left_of(margin, each) for each in names]
        interval = numbers(part, margin.stated)
        cells = [verdict(part.low, part.high), *interval, part.weakest, "", ", ".join(told) or "holds", ", ".join(left)]
        found.append([f"· {label}", "", *cells])
    return found


def rows(tested: Tested) -> list[list[str]]:
    """Return the rows of a test in the table: one, or the verdict of all models and a row for each of them."""
    first = tested.first
    if len(tested.models) == 1:
        return [[first.named, first.level, *own_cells(first)], *part_rows(first)]
    known = [each.judged.margin for each in tested.models if each.judged]
    ends = [factor_text(each) for each in (min(known), max(known))] if known else []
    spread = ends[0] if known and min(known) >= MOST else " to ".join(ends)
    whole = [first.named, first.level, tested.verdict, spread, "by model", *[""] * 4]
    found = [whole]
    for each in tested.models:
        found += [[f"- {each.model}", "", *own_cells(each)], *part_rows(each)]
    return found


def contributions(chance: Chance) -> str:
    """Return what contributes most to an interval, in words."""
    found = sorted(chance.effects.items(), key=lambda item: -item[1])[:3]
    told = [f"{TOLD.get(name, name)} ± {three(100 * effect)} %" for name, effect in found if effect > 1e-4]
    nothing = "what the relay's file names hardly moves it" if found else "the relay's file names no uncertainty"
    return ", ".join(told) or f"nothing: {nothing}"


def tighten(chance: Chance) -> str:
    """Return of which parameters the knowledge would narrow the interval most, in words."""
    found = sorted(((share, name) for name, share in chance.indices.items() if name not in TOLD), reverse=True)[:2]
    told = [f"{name}, {three(100 * share)} % of the variance" for share, name in found if share > LEAST_SHARE]
    return "; ".join(told) or f"no parameter has {100 * LEAST_SHARE:g} % of the variance"


def ppm(share: float) -> str:
    """Return a chance in parts per million, of many in per cent."""
    return f"{three(100 * share)} %" if share >= 0.1 else f"{three(1e6 * share)} ppm"


def chance_text(chance: Chance) -> str:
    """Return the chance of failing with its own interval, in words."""
    if not chance.effects:
        return UNSTATED
    if chance.low == 0:
        return f"< {ppm(chance.high)}"
    if chance.high == 1:
        return f"all but < {ppm(1 - chance.low)}"
    return f"{ppm(chance.failing)} ({ppm(chance.low)} to {ppm(chance.high)})"


def passes_text(margin: Margin) -> str:
    """Return from which overtravel or gap on a test is passed, in words."""
    what, over = "gap" if is_open(margin) else "overtravel", margin.wear["overtravel"]
    if margin.passes is None:
        return f"nothing up to {WORN[-1]:g} times the {what}"
    below = "< " if margin.passes <= over[0] else ""
    return f"{below}{three(1e3 * margin.passes)} mm {what}"


def limits(finding: Finding) -> str:
    """Return what limits a margin, and what the tolerance of a pulse makes of it."""
    own = finding.judged
    if own is None or own.tolerance is None:
        return finding.limits
    low, high = own.tolerance
    return f"{finding.limits}; {three(low)} to {three(high)} by the pulses within the tolerance"


def reasons(tested: Tested) -> list[list[str]]:
    """Return the rows of a test in the table of reasons."""
    found = []
    for each in tested.models:
        test = each.named + (f": {each.model}" if len(tested.models) > 1 else "")
        told = [""] * 4
        if each.judged:
            chance = each.judged.chance
            known = [contributions(chance), tighten(chance), chance_text(chance)] if chance else [COARSE, "", UNSTATED]
            told = [*known, passes_text(each.judged)]
        found.append([test, limits(each), *told])
        if each.judged:
            others = {name: own.limits for name, own in each.judged.parts.items() if own.limits != each.limits}
            found += [[f"· {name}", limit, *[""] * 4] for name, limit in others.items()]
    return found
