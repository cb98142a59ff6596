"""Which parameters are sought, what the data tell of them, and what they cannot tell."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.special import fdtrc, stdtr

from relay_contact.component import Array, Component, nearest
from relay_contact.files import RelayContactError, read_toml
from relay_contact.identification.fit import HELD, STEP, Fit, Set, Unknown
from relay_contact.identification.measurement import BOUNCE, CHATTER, FORCE, FREQUENCY, RESPONSE, RINGDOWN, Measurement
from relay_contact.identification.prediction import Laboratory
from relay_contact.qualification.relay import Relay
from relay_contact.schema import leaves
from relay_contact.spring import FIXED, PREFIX, STIFFNESS, known

REACH = float(np.log(300.0))
"""Of the search, either way."""
WIDE = float(np.log(2.0))
"""Half of a 95 % interval of a logarithm from which on a parameter is not determined: it may be twice as large."""
TOGETHER = 0.95  # correlation from which on it is said
FAR = float(np.log(5.0))  # from the relay's file, from which on it is said
DRAWN = 60  # values of a fitted curve
CONTRADICT = 1e-3
"""Chance below which it is said that residuals are alike or one of them far from the others, or that frequency and rate
of decay of a ring-down do not agree with the other data."""
SAMPLED = 3.0
"""Rows per period of a ring-down, at least, by the record and by the relay's file: what seems slower than it is would
have to be twice as fast as the file says."""
PERIODS = 1.5  # of a ring-down in a record, at least
BEYOND = {FORCE: 5.0, RESPONSE: 30.0, CHATTER: 30.0, RINGDOWN: 5.0, FREQUENCY: 5.0}
"""Measured over predicted by the relay's file, or the reverse, from which on a unit is wrong: of the stiffness, of the
median amplitude or level, of the frequency."""
OPENS = 0.98  # part of the preload from which on a force amplitude opens the contact


@dataclass(frozen=True)
class Found:
    """What the data tell of a parameter."""

    unknown: Unknown
    value: float
    half: float
    """Of the 95 % interval, as a part of the value."""
    by_others: dict[str, float]
    """What parameters that are not sought, but uncertain in the relay's file, contribute to it."""

    @property
    def interval(self) -> tuple[float, float]:
        """Return the ends of the 95 % interval; it is symmetrical in the logarithm."""
        low, high = sorted((self.value * float(np.exp(-self.half)), self.value * float(np.exp(self.half))))
        return low, high


@dataclass(frozen=True)
class Identification:
    """A relay's parameters by measurements."""

    relay: Relay
    path: Path
    found: list[Found]
    missing: dict[str, str]
    """Parameters that the data do not determine, and why."""
    correlation: Array
    """Of those found, by the scatter of the measurements."""
    others: list[str]
    """Parameters that are not sought, but uncertain in the relay's file."""
    whole: Array
    """Of those found and these, with what these contribute: with the intervals, the covariance of all."""
    sets: list[Set]
    fitted: list[Array]
    """The model's values for each measurement."""
    curves: list[tuple[Array, Array]]
    """The same closer together, to be drawn."""
    notes: list[str]
    wider: dict[str, list[str]]
    """Those found that the relay's file leaves more uncertain, in positions in which they were not found: these."""

    def __getitem__(self, label: str) -> Found:
        """Return what was found of a parameter, by its name, with its position where it has one for each."""
        for each in self.found:
            if each.unknown.label == label:
                return each
        labels = [each.unknown.label for each in self.found]
        raise KeyError(f"{label}: {self.missing.get(label, 'not sought')}{nearest(label, labels)}")


def usual(relay: Relay, measurements: list[Measurement]) -> list[str]:
    """Return the parameters that are sought unless others are named."""
    file = str(next(iter(relay.positions.values())).get("beam.file", ""))
    entries = known(file)
    own = f"{PREFIX}damping" in entries
    names = [STIFFNESS if file else "beam.youngsModulus"]
    names += [f"{PREFIX}damping" if own else "beam.stiffnessDamping", "contact.damping"]
    if f"{PREFIX}frequency" not in entries:
        # Modes have the rivet in them.
        names.append("tip.mass")
    closed = [each for each in measurements if not each.is_open]
    if closed and any(values.get("effects.contactLaw") == "Rough" for values in relay.positions.values()):
        names += ["contact.stiffness", "contact.stiffnessExponent"]
    if any(each.kind != FREQUENCY for each in closed):
        names.insert(0, "contact.overtravel")
    return names


def unknowns(
    component: Component, relay: Relay, path: Path, measurements: list[Measurement], names: list[str]
) -> list[Unknown]:
    """Return the parameters sought by name, one for each position of the coil where it is given there."""
    tables = read_toml(path).get("position", [{}])
    used = [name for name in relay.positions if any(each.position == name for each in measurements)]
    found = []
    for name in names:
        if name.startswith(FIXED):
            text = "not allowed, allowed are entries of the spring of the moving contact"
            raise RelayContactError(f"{name}: of the spring of the fixed contact: {text}")
    # Each once, in whichever spelling.
    for name in dict.fromkeys(name if name.startswith(PREFIX) else component.settable(name) for name in names):
        if not name.startswith(PREFIX) and component.variables[name].type != "Real":
            raise RelayContactError(f"{name}: not a parameter of type Real, which cannot be identified")
        own = {place for place, table in zip(relay.positions, tables, strict=True) if has(table, name)}
        shared = [place for place in used if place not in own]
        groups = ([tuple(shared)] if shared else []) + [(place,) for place in used if place in own]
        for group in groups:
            values = relay.positions[group[0]]
            if name.startswith(PREFIX):
                file = str(values.get("beam.file", ""))
                allowed = known(file) if file else []
                if name not in allowed:
                    near = nearest(name, allowed) if file else ", as there is none: seek beam.youngsModulus"
                    raise RelayContactError(f"{name}: no such entry in the spring file{near}")
                start, least, most = 1.0, 0.0, np.inf
            else:
                variable = component.variables[name]
                start = component.value(values, name)
                least, most = float(variable.min or 0.0), float(variable.max or np.inf)
            if start == 0:
                raise RelayContactError(
                    f"{name} = 0 in the relay's file: not allowed, a search keeps the sign of its start"
                )
            # So far within what is allowed that derivatives are too.
            least, most = sorted((least / start, most / start))
            low = max(-REACH, np.log(least) + STEP if least > 0 else -REACH)
            high = min(REACH, float(np.log(most)) - STEP)
            label = f"{name}, {group[0]}" if len(groups) > 1 else name
            found.append(Unknown(name, group, start, label, low, high))
    return found


def wider(relay: Relay, path: Path, found: list[Found]) -> dict[str, list[str]]:
    """Return names that the relay's file leaves more uncertain, in some positions in which they were not found.

    `[uncertainty]` holds in all positions.
    """
    tables, told = read_toml(path).get("position", [{}]), {}
    for name in sorted({each.unknown.name for each in found} & relay.uncertainty.keys()):
        mine = [each for each in found if each.unknown.name == name]
        known = {place for each in mine for place in each.unknown.positions}
        left = [place for place, table in zip(relay.positions, tables, strict=True)
                if has(table, name) and place not in known]  # fmt: skip
        if left and relay.uncertainty[name].half(mine[0].unknown.start) > max(each.half for each in mine):
            told[name] = left
    return told


def has(position: Mapping[str, Any], name: str) -> bool:
    """Tell whether the table of a position gives a parameter itself."""
    return any(each == name for each, *_ in leaves(position.get("parameters", {})))


def sought(
    laboratory: Laboratory, relay: Relay, measurements: list[Measurement], parameters: list[Unknown], opens: bool = True
) -> tuple[Fit, dict[str, str]]:
    """Fit; take out one after the other what the data do not determine, with the reason.

    `opens`: levels at which the contact opens are those of the component with a contact that does, not a linear one.
    """
    fit = Fit(laboratory, dict(relay.positions), [Set(each) for each in measurements], parameters, held=HELD)
    for each in fit.sets:
        check(each, fit.predicted(each, fit.logarithms))
    fit.look_around()
    fit.run()
    missing: dict[str, str] = {}
    while True:
        halves = fit.halves()
        wide = np.flatnonzero(halves > WIDE)
        if not len(wide):
            if fit.held == np.inf:
                break
            fit.held = np.inf
            fit.run()
            continue
        # What is known from elsewhere is taken out first: the data then tell the others.
        known = relay.parts(laboratory.component)
        order = [(known.get(fit.unknowns[each].name, np.inf), -halves[each], each) for each in wide]
        worst = int(min(order)[2])
        missing[fit.unknowns[worst].label] = reason(fit, worst, relay)
        fit = without(fit, worst)
        if not fit.unknowns:
            return fit, missing
        fit.run()
    levels = [each for each in fit.sets if each.measurement.kind == CHATTER]
    if opens and levels:
        for each in levels:
            values = fit.values(each.measurement.position, fit.logarithms)
            each.factor = laboratory.correction(each.measurement, values)
        fit.run()
    return fit, missing


def check(each: Set, predicted: Array) -> None:
    """Refuse what is far from the prediction by the relay's file, and a ring-down that is sampled too coarsely."""
    own, ratio, words, why = each.measurement, 1.0, "", ""
    if own.kind == FORCE:
        measured, expected = (float(np.polyfit(own.over, values, 1)[0]) for values in (own.values, predicted))
        ratio = measured / max(expected, 1e-300)
        words = f"columns travel, force: stiffness {measured:.3g} N/m, by the relay's file {expected:.3g} N/m"
    elif own.kind in (FREQUENCY, RESPONSE, CHATTER):
        ratio = float(np.median(own.values / np.maximum(predicted, 1e-300)))
        other = "overtravel" if own.kind == FREQUENCY else "frequency"
        words = f"columns {own.quantity}, {other}: {ratio:.3g} times what the relay's file gives (median)"
    elif each.ring:
        frequency, expected = (float(pole[1]) / (2 * np.pi) for pole in (each.ring.pole, predicted))
        if not expected:
            text = "with the parameters of the relay's file nothing rings: not allowed, allowed is less damping"
            raise RelayContactError(f"{own.path}: {own.kind}: {text}")
        length, rate = float(np.ptp(own.over)), 1 / float(np.median(np.diff(own.over)))
        ratio, fewest = frequency / expected, SAMPLED * max(frequency, expected)
        words = f"column time: rings at {frequency:.3g} Hz, by the relay's file at {expected:.3g} Hz"
        coarse = f"{words}, with {rate:.3g} rows per second: too coarse, it may ring faster than the rows show"
        why = f", and is {rate:.3g} rows per second enough"
    limit = BEYOND.get(own.kind, np.inf)
    if not 1 / limit < ratio < limit:
        allowed = f"less than {limit:g} times more or less"
        question = f"are the units of the columns right, and the parameters in the relay's file{why}?"
        raise RelayContactError(f"{own.path}: {words}: not allowed, allowed is {allowed}; {question}")
    if each.ring and rate < fewest:
        raise RelayContactError(f"{own.path}: {coarse}; allowed is {fewest:.3g} or more")
    if each.ring and length * frequency < PERIODS:
        text = f"a record of {length:.3g} s: not allowed, allowed is {PERIODS / frequency:.3g} s or more"
        raise RelayContactError(f"{own.path}: {words}: {text}")


def without(fit: Fit, number: int) -> Fit:
    """Return a fit without a parameter, which has the value of the file."""
    left = [each for index, each in enumerate(fit.unknowns) if index != number]
    smaller = Fit(fit.laboratory, fit.positions, fit.sets, left, held=fit.held)
    smaller.logarithms = np.delete(fit.logarithms, number)
    smaller.ends = [np.delete(end, number) for end in fit.ends]
    return smaller


def reason(fit: Fit, number: int, relay: Relay) -> str:
    """Tell why a parameter is not determined, and what happens with it."""
    row = np.abs(fit.correlation[number])
    partners = [each.label for index, each in enumerate(fit.unknowns) if index != number and row[index] > TOGETHER]
    why = "the data hardly depend on it"
    if partners:
        why = f"the data tell it only together with {' and '.join(partners)}"
    part = relay.parts(fit.laboratory.component).get(fit.unknowns[number].name)
    kept = f"with its ± {100 * part:g} %" if part else "as if it were exact"
    return f"{why}; taken from the relay's file {kept}"


def conclude(fit: Fit, missing: dict[str, str], relay: Relay, path: Path) -> Identification:
    """Return intervals, correlations and what else has to be said."""
    halves = fit.halves() if fit.unknowns else np.zeros(0)
    names = {unknown.name for unknown in fit.unknowns}
    parts = relay.parts(fit.laboratory.component)
    others = [name for name, part in parts.items() if name not in names and part]
    # By how much each of these at its end moves what was found, and by what is independent of them.
    shifts = np.zeros((len(fit.unknowns), len(others)))
    for number, name in enumerate(others if fit.unknowns else []):
        shifts[:, number] = fit.shifts(name, parts[name])
    root = relay.correlation.root(others)
    moved = shifts @ root
    correlation = fit.correlation if fit.unknowns else np.zeros((0, 0))
    together = correlation * np.outer(halves, halves) + moved @ moved.T
    sizes = np.sqrt(np.diag(together))
    found = []
    for number, unknown in enumerate(fit.unknowns):
        own = dict(zip(others, np.abs(shifts[number]).tolist(), strict=True))
        value = unknown.start * float(np.exp(fit.logarithms[number]))
        found.append(Found(unknown, value, float(sizes[number]), own))
    fitted = [fit.modelled(each, fit.logarithms) for each in fit.sets]
    curves = [curve(fit, each, model) for each, model in zip(fit.sets, fitted, strict=True)]
    notes = [line for each, model in zip(fit.sets, fitted, strict=True) for line in remarks(fit, each, model)]
    notes += [
        f"{one.label} and {other.label} are known better together than alone (correlation {correlation[i, j]:+.3f})"
        for i, one in enumerate(fit.unknowns) for j, other in enumerate(fit.unknowns[:i])
        if abs(correlation[i, j]) > TOGETHER
    ]  # fmt: skip
    notes += [
        f"{each.unknown.label} is known to ± {100 * each.half:.3g} %, by what others leave open: `qualify` takes less "
        "than 100 %"
        for each in found if each.half >= 1
    ]  # fmt: skip
    notes += [
        f"{each.unknown.label} is {each.value / each.unknown.start:.3g} times its value in the relay's file: is the "
        "file that of this relay, and its model complete?"
        for each in found if abs(np.log(each.value / each.unknown.start)) > FAR
    ]  # fmt: skip
    stays = wider(relay, path, found)
    notes += [
        f"{name}: in the position {', '.join(left)} it is that of the relay's file, whose uncertainty stays: it holds "
        "in all positions"
        for name, left in stays.items()
    ]  # fmt: skip
    if any("Coulomb" in values.values() for values in relay.positions.values()):
        notes.append("measurements are compared with a contact without the friction of the relay's file")
    for other in fit.rivals() if fit.unknowns else []:
        told = (f"{each.label} = {each.start * np.exp(x):.4g}" for each, x in zip(fit.unknowns, other, strict=False))
        notes.append(f"other values fit nearly as well: {', '.join(told)}; the intervals are those of the best alone")
    # What was found of a spring is in its file.
    stated = names | {"beam.file" for name in names if name.startswith(PREFIX)}
    for model in relay.models:
        # What `qualify` takes in place of what was found.
        if kept := sorted(model.parameters.keys() & stated):
            text = f"keeps its own {', '.join(kept)}: it was not fitted to the data; identify it by a file of its own"
            notes.append(f"the model {model.name!r} of the relay's file {text}")
    beside = moved @ root / sizes[:, None]
    whole = np.block([[together / np.outer(sizes, sizes), beside], [beside.T, root @ root]])
    return Identification(
        relay, path, found, missing, correlation, others, whole, fit.sets, fitted, curves, notes, stays,
    )  # fmt: skip


def curve(fit: Fit, each: Set, model: Array) -> tuple[Array, Array]:
    """Return the model's values closer together; those of a ring-down are close."""
    own = each.measurement
    if own.kind == RINGDOWN:
        return own.over, model
    order = np.argsort(own.over)

    def between(values: Array, over: Array) -> Array:
        return np.interp(over, own.over[order], values[order])

    over = np.linspace(own.over.min(), own.over.max(), DRAWN)
    acceleration = between(own.acceleration, over) if len(own.acceleration) else own.acceleration
    factor = between(each.factor, over) if isinstance(each.factor, np.ndarray) else each.factor
    denser = replace(own, over=over, acceleration=acceleration)
    return over, fit.modelled(replace(each, measurement=denser, factor=factor), fit.logarithms)


def remarks(fit: Fit, each: Set, model: Array) -> list[str]:
    """Tell where a measurement does not agree with the model."""
    own = each.measurement
    order = np.argsort(own.over, kind="stable")
    left = each.differences(model)[order] / each.sigma
    # Chances of more if it were random: of a trend up to the square; of the correlation of neighbours (R. B. Leipnik,
    # Biometrika 34 (1947) 80-87); of the largest of all (W. R. Thompson, Ann. Math. Stat. 6 (1935) 214-219).
    number, worst, squares = len(left), int(np.abs(left).argmax()), max(float((left**2).sum()), 1e-300)
    seen = float(((left @ np.linalg.qr(np.vander(np.arange(number), 3))[0]) ** 2).sum()) / squares
    trend = fdtrc(3, number - 3, seen / max(1 - seen, 1e-12) * (number - 3) / 3)
    together = float((left[1:] * left[:-1]).sum()) / squares
    alike = min(trend, stdtr(number + 1, -together * np.sqrt((number + 1) / (1 - together**2))))
    free = max(each.freedom, 1.001)
    part = min(float(left[worst] ** 2 / free), 0.999999)
    alone = 2 * number * stdtr(free - 1, -np.sqrt((free - 1) * part / (1 - part)))
    # Of the two residuals of a ring-down, in units of their scatter: chi squared.
    misfit = float((fit.left(each, fit.logarithms) ** 2).sum()) if each.ring else 0.0
    off = float(np.exp(fit.calibration(each, fit.logarithms))) - 1
    preload = np.inf
    if own.kind == RESPONSE and not own.is_open and own.quantity == "force":
        conditions = fit.laboratory.conditions(own, fit.values(own.position, fit.logarithms))
        preload = fit.laboratory.rest("preload.force", conditions)
    opens = model > OPENS * preload
    told = {
        f"neighbouring residuals are alike (correlation {together:.2f}, trend {100 * seen:.0f} %): model or "
        "measurement is off by more than scatter, and the intervals are too narrow": alike < CONTRADICT,
        f"its row {order[worst] + 1} is {abs(left[worst]):.1f} times the scatter from the model: is it right?":
            alone < CONTRADICT,
        "frequency or rate of decay do not agree with the other data, or with parameters that are not sought: the "
        "intervals are too narrow": np.exp(-misfit / 2) < CONTRADICT,
        "without a line `# calibration = …` its instrument is taken as exact; the intervals tell the scatter alone":
            not (each.ring or own.calibration or own.kind == BOUNCE),
        f"the instrument would have to show {100 * off:+.1f} %, more than its {100 * own.calibration:g} %":
            0 < own.calibration < abs(off),
        f"the contact opens, at {own.over[int(np.argmax(opens))]:.4g} Hz for one: a frequency response is that of a "
        "contact that stays closed; leave such rows out, or measure at a lower level": opens.any(),
        "rows in which the contact is open tell nothing": own.kind == FORCE and (model <= 0).any(),
    }  # fmt: skip
    return [f"{own.name}: {text}" for text, true in told.items() if true]
