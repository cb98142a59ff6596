"""A relay against a standard: each test in each position of the coil, its margin, and how well the margin is known.

The margin is the level that interrupts the closed contact, or closes the open one, relative to that of the test. Its
interval comes from draws of the uncertain parameters: the component answers a pulse with each, and the margins follow
from the answers; at the ends of the interval the component seeks the level itself.

A relay is judged by each of its models. A finished test is a file in the folder `parts`, named by a hash of all that it
depends on: an interrupted assessment continues, with the same bytes.
"""

import hashlib
import json
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from scipy.stats import norm, qmc

from relay_contact.component import Array, Component, Values
from relay_contact.figures import three
from relay_contact.files import HERE, RelayContactError
from relay_contact.qualification.relay import Model, Relay
from relay_contact.qualification.response import Response, margin, open_at_rest, respond
from relay_contact.qualification.standards import Contacts, Random, Shock, Sine, Standard, Test
from relay_contact.qualification.trials import (
    CLOSED,
    OPEN,
    SAMPLE,
    SHOWN,
    Lengths,
    Specimen,
    middle_dip,
    shock,
    shock_threshold,
    sine_least,
    sine_threshold,
    sweep,
    threshold,
    window,
)  # fmt: skip
from relay_contact.spring import PREFIX

Part = dict[str, Any]
"""What a test showed in a position of the coil, as its file holds it."""
MODEL = "model"
CHANCE = "chance of the largest dip"
WORN = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2)
"""Parts of the overtravel over which margins are shown."""
MANY = 10_000
"""Decay times that a sweep takes to cross a resonance, above which their number does not matter."""
DRAWS = 256
"""Of the uncertain parameters: a chance of failing is known to half a per cent, an end of an interval to 5 % of it."""
LIMITS = (0.025, 0.975)
TWO_SIDED = float(norm.ppf(LIMITS[1]))
"""Standard deviations from the middle of a normal distribution to the limits of 95 %."""
SETTLED = 1e-3
"""Part of its largest answer below which that of a drawn contact is cut off."""
LEAST = 0.01
"""Part of its value that a drawn parameter has at least, so that none changes its sign."""


def scores(count: int) -> Array:
    """Return the draws of some normally distributed quantities, in columns, in standard deviations from their middles.

    They are points of Sobol's sequence, which fill the space evenly: each column alone is as even as it can be.
    """
    points = qmc.Sobol(count, scramble=False).random(DRAWS) + 0.5 / DRAWS
    return np.asarray(norm.ppf(points))


@dataclass
class Position:
    """A position of the coil by one of the models: its contacts, and their responses with drawn parameters."""

    component: Component
    relay: Relay
    name: str
    contacts: Contacts
    tests: tuple[Test, ...]
    model: Model

    @cached_property
    def values(self) -> Values:
        """Parameters of the component."""
        return {**self.relay.positions[self.name], **self.model.parameters}

    def value(self, name: str) -> float:
        """Return the value of a parameter; that of an entry of the spring file is a factor."""
        return 1.0 if name.startswith(PREFIX) else float(self.values.get(name, self.component.start(name)))

    def response(self, changes: Values, calm: float = SETTLED) -> Response:
        """Return the response with some other values of parameters."""
        return respond(self.component, {**self.values, **changes}, self.contacts.threshold, calm)

    @cached_property
    def specimen(self) -> Specimen:
        """The contacts as the file says."""
        response = respond(self.component, self.values, self.contacts.threshold)
        return Specimen(self.component, self.values, self.contacts, response)

    @cached_property
    def scores(self) -> Array:
        """Draws of the uncertain parameters, the model and the chance of the largest dip, in columns."""
        return scores(len(self.relay.uncertainty) + 2)

    def drawn(self, number: int) -> Values:
        """Return the uncertain parameters in a draw."""
        return {
            name: self.value(name) * max(1 + part * score / TWO_SIDED, LEAST)
            for (name, part), score in zip(self.relay.uncertainty.items(), self.scores[number], strict=False)
        }

    @cached_property
    def linear(self) -> dict[Test, Array]:
        """Margin of each test in each draw, by the responses, without the uncertainty of the model."""
        found: dict[Test, list[float]] = {test: [] for test in self.tests}
        response = self.specimen.response
        for number, chance in enumerate(norm.cdf(self.scores[:, -1])):
            if self.relay.uncertainty:
                response = self.response(self.drawn(number))
            for test, margins in found.items():
                margins.append(max(margin(response, test, self.specimen.lasting, float(chance)), 0.0))
        return {test: np.array(margins) for test, margins in found.items()}

    @cached_property
    def worn(self) -> dict[float, Response]:
        """The responses over the overtravel (m), which the wear of the contacts takes away, or over the gap."""
        name = "contact.overtravel"
        nominal = self.value(name)
        return {abs(part * nominal): self.response({name: part * nominal}) for part in WORN}

    def wear(self, test: Test, factor: float) -> dict[str, list[float]]:
        """Return the margin over overtravel or gap, for a margin that the component found as it is."""
        margins = [max(margin(response, test, self.specimen.lasting), 0.0) for response in self.worn.values()]
        ratio = factor / margins[WORN.index(1.0)]
        return {"overtravel": list(self.worn), "margin": [ratio * value for value in margins]}

    def margins(self, test: Test, factor: float, linear: float) -> Array:
        """Return the margin in each draw, for that as it is, which the component and linear theory found.

        What the component found in place of linear theory is known in the middle and at two draws, at the ends of the
        interval, and lies on straight lines between.
        """
        found = self.linear[test]
        known = [(linear, factor / linear)]
        if self.relay.uncertainty:
            order = np.argsort(found)
            for limit in LIMITS:
                number = int(order[int(limit * DRAWS)])
                if found[number] > 0:
                    values: Values = {**self.values, **self.drawn(number)}
                    response = self.response(self.drawn(number))
                    known.append(
                        (float(found[number]), ratio(replace(self.specimen, values=values, response=response), test))
                    )
        known.sort()
        part = np.interp(found, *np.array(known).T)
        return np.asarray(part * found * np.maximum(1 + self.model.uncertainty * self.scores[:, -2] / TWO_SIDED, LEAST))

    def effects(self, test: Test, margins: Array, factor: float) -> dict[str, float]:
        """Return what each uncertainty does to the margin, as parts of it, with 95 % confidence.

        By the plane through the margins in all draws.
        """
        plane = np.column_stack((np.ones(DRAWS), self.scores))
        slopes = np.linalg.lstsq(plane, margins / factor)[0][1:]
        found = dict(zip([*self.relay.uncertainty, MODEL, CHANCE], TWO_SIDED * np.abs(slopes), strict=True))
        if not self.model.uncertainty:
            del found[MODEL]
        if not isinstance(test, Random):
            del found[CHANCE]
        return {name: float(effect) for name, effect in found.items()}


Job = tuple[Path, Position, Test, int]
"""The file that a test is to write, the position, the test, and the number of frequencies."""


def spring_of(values: Values) -> bytes:
    """Return the contents of the spring file of a position, if it has one."""
    file = str(values.get("beam.file", ""))
    return Path(file).read_bytes() if file else b""


def ratio(specimen: Specimen, test: Test) -> float:
    """Return the level that fails in the component by that of linear theory."""
    match test:
        case Sine():
            return sine_least(specimen, test)[1] / float(specimen.response.sine(test, specimen.lasting)[1].min())
        case Random():
            return middle_dip(specimen, test)[0]
        case Shock():
            guesses = specimen.response.shock(test, specimen.lasting)
            way = min(guesses, key=lambda name: guesses[name])
            return shock_threshold(specimen, test, SIGNS[way], guesses[way])[0] / guesses[way]
    raise TypeError(test)


def verdict(low: float, high: float) -> str:
    """Compare an interval of a margin with 1; if that is within it, nothing is decided."""
    return "pass" if low > 1 else "FAIL" if high < 1 else "undecided"


def together(verdicts: list[str]) -> str:
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


SIGNS = {"closing": 1.0, "opening": -1.0}


def vibration(position: Position, test: Sine, points: int) -> Part:
    """Vibrate steadily at frequencies of the sweep, and seek the level that fails where it is least."""
    specimen = position.specimen
    response = specimen.response
    _, factors = response.sine(test, specimen.lasting)
    at = int(factors.argmin())
    weakest, factor, decides = sine_least(specimen, test)
    low, high = test.frequencies
    near = weakest * np.linspace(0.9, 1.1, points // 4)
    near = near[(near > low) & (near < high)]
    chosen = np.unique(np.concatenate((np.geomspace(low, high, points), near, [weakest])))
    rows = sweep(specimen, test, chosen)
    lengths = {name: [length.get(name, 0.0) for length, _ in rows] for name in specimen.monitors}
    worst = int(np.argmax([max(length.values(), default=0.0) for length, _ in rows]))
    elsewhere = factor > 1 and bool(rows[worst][0])
    if elsewhere:
        weakest = float(chosen[worst])
        factor, decides = sine_threshold(specimen, test, weakest, 1.0, rows[worst][0])
    least = {name: [left[number] for _, left in rows] for number, name in enumerate(specimen.monitors)}
    if elsewhere:
        limits = "fails at the level of the test where linear theory does not expect it"
    elif 0 < at < len(factors) - 1:
        octaves = 2 * np.log2(high / low) * 60 / test.sweep_time
        width = response.bandwidth(weakest)
        decays = width / weakest * test.sweep_time / (2 * np.log(high / low)) * np.pi * width
        limits = f"resonance, {three(width)} Hz wide; the sweep of {three(octaves)} octaves a minute crosses it in "
        limits += f"{three(decays)} decay times" if decays < MANY else f"over {MANY} decay times"
    elif at == 0:
        limits = "lowest frequency of the range, the whole force of inertia"
    else:
        limits = "highest frequency of the range, below the resonance"
    return {
        "margin": factor, "decides": decides, "linear": float(factors[at]), "weakest": f"{three(weakest)} Hz",
        "limits": limits, "failed": {name: max(each) for name, each in lengths.items() if any(each)},
        "where": {name: f"at {three(chosen[int(np.argmax(each))])} Hz" for name, each in lengths.items() if any(each)},
        "least": {name: min(each) for name, each in least.items()},
        "curves": {"frequency": chosen.tolist(), "level": test.amplitude(chosen).tolist(),
                   "length": lengths, "least": least},
    }  # fmt: skip


def random(position: Position, test: Random) -> Part:
    """Seek the level at which the largest dips of a record fail; for the time of the test by Rice's rate.

    What happens in the test is that around a dip of the record, raised to the size of the largest in the test.
    """
    specimen = position.specimen
    response = specimen.response
    linear = response.random(test, specimen.lasting)
    part, decides, course, guess = middle_dip(specimen, test)
    lengths, rows = window(specimen, course, guess / linear, watched=True)
    if lengths and part * linear > 1:
        level, decides = threshold(lambda factor: window(specimen, course, factor)[0], guess / linear, lengths)
        part = level / guess
    rms, _ = response.moments(test)
    density = test.spectrum(response.frequency) * response.gain**2
    share = np.cumsum(density) / density.sum()
    half = response.frequency[np.searchsorted(share, [0.25, 0.75])]
    moving, rest = ("motion", "gap") if specimen.is_open else ("force", "preload")
    shown = rows[-round(10e-3 / SAMPLE) :]
    return {
        "margin": linear * part, "decides": decides, "linear": linear,
        "weakest": f"{three(half[0])} to {three(half[1])} Hz",
        "limits": f"half of the power of the {moving} is there; {three(rms / response.reserve)} of the {rest} rms",
        "failed": lengths, "where": dict.fromkeys(lengths, f"in {test.duration / 60:g} min"),
        "least": dict(zip(specimen.monitors, rows[:, 1:].min(axis=0).tolist(), strict=True)),
        "curves": {"time": (SAMPLE * np.arange(len(shown))).tolist(), "course": shown[:, 0].tolist()},
    }  # fmt: skip


def shocks(position: Position, test: Shock) -> Part:
    """Run a shock in both directions, and seek the levels that fail."""
    specimen = position.specimen
    response = specimen.response
    guesses = response.shock(test, specimen.lasting)
    runs = {name: shock(specimen, test, sign, SHOWN) for name, sign in SIGNS.items()}
    way, other = sorted(guesses, key=lambda name: guesses[name])
    factor, decides = shock_threshold(specimen, test, SIGNS[way], guesses[way])
    for each, level in ((other, factor), (way, 1.0), (other, 1.0)):
        known: Lengths = shock(specimen, test, SIGNS[each] * level)[0] if level == factor else runs[each][0]
        if known and level <= factor:
            lower, failed = shock_threshold(specimen, test, SIGNS[each], level, known)
            if lower < factor:
                way, factor, decides = each, lower, failed
    shown = runs["closing" if specimen.is_open else "opening"][1][:-1]
    lengths = {name: max(each.get(name, 0.0) for each, _ in runs.values()) for name in specimen.monitors
               if any(name in each for each, _ in runs.values())}  # fmt: skip
    slow = response.reserve / (response.gain[0] * 9.80665 * test.acceleration) / guesses[way]
    return {
        "margin": factor, "decides": decides, "linear": guesses[way], "weakest": f"{way} direction",
        "limits": f"inertia of the spring, {three(slow)} times that of a slow shock",
        "failed": lengths, "where": dict.fromkeys(lengths, ""),
        "least": {name: float(min(rows[:, 2 + number].min() for _, rows in runs.values()))
                  for number, name in enumerate(specimen.monitors)},
        "curves": {"time": shown[:, 0].tolist(), "course": shown[:, 1].tolist()},
    }  # fmt: skip


def tested(position: Position, test: Test, points: int) -> Part:
    """Run a test in a position of the coil, by one of the models; with what the component warned of."""
    position.component.warnings.clear()
    part = judged(position, test, points)
    return part | {"warnings": list(position.component.warnings.values())}


def judged(position: Position, test: Test, points: int) -> Part:
    """Run a test in a position of the coil, by one of the models."""
    part: Part = {
        "position": position.name, "test": test.name, "kind": type(test).__name__.lower(), "level": str(test),
        "clause": test.clause, "verified": test.verified, "model": position.model.name,
    }  # fmt: skip
    second = bool(position.value("effects.secondContact"))
    if position.value("contact.overtravel") == 0:
        return part | {"verdict": "not judged", "limits": "the contact just touches: neither closed nor open"}
    if second and open_at_rest(position.component, position.values):
        reason = "both contacts open: closings on both sides are not judged; give each side as a position of its own"
        return part | {"verdict": "not judged", "limits": reason}
    specimen = position.specimen
    if specimen.response.reserve <= 0:
        reason = f"interrupted at rest: more than {position.contacts.threshold:g} Ω of contact resistance"
        return part | {"verdict": "FAIL", "limits": reason}
    match test:
        case Sine():
            part |= vibration(position, test, points)
        case Random():
            part |= random(position, test)
        case Shock():
            part |= shocks(position, test)
    factor = part["margin"]
    margins = position.margins(test, factor, part["linear"])
    low, high = np.quantile(margins, LIMITS, method="hazen").tolist()
    low, high = min(low, factor), max(high, factor)
    rest = {OPEN if specimen.is_open else CLOSED: specimen.response.reserve}
    wear = position.wear(test, factor)
    return part | {
        "verdict": verdict(low, high), "low": low, "high": high, "chance": float(np.mean(margins < 1)),
        "effects": position.effects(test, margins, factor), "wear": wear, "passes": passes(wear, low / factor),
        "overtravel": abs(position.value("contact.overtravel")), "natural": specimen.response.natural,
        "rest": rest | ({OPEN: position.value("second.gap")} if second else {}),
    }  # fmt: skip


def key(position: Position, test: Test, points: int) -> str:
    """Return a name for a test that changes with all that its result depends on."""
    text = hashlib.sha256(position.component.path.read_bytes())
    for name in ("assessment", "response", "standards", "trials"):
        text.update((HERE / "qualification" / f"{name}.py").read_bytes())
    text.update(spring_of(position.values))
    values = {name: value for name, value in position.values.items() if name != "beam.file"}
    model = position.model
    uncertainty = list(position.relay.uncertainty.items())
    monitored = repr(position.contacts), repr(test)
    settings = [position.name, values, uncertainty, model.name, model.uncertainty, *monitored]
    text.update(json.dumps([*settings, points], sort_keys=True).encode())
    return text.hexdigest()[:16]


def on_worker(fmu: bytes, spring: bytes, position: Position, test: Test, points: int) -> str:
    """Run a test on another machine, which has this package; give the text of its part."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "component.fmu"
        path.write_bytes(fmu)
        values = dict(position.values)
        if spring:
            values["beam.file"] = str(Path(folder) / "spring.toml")
            Path(str(values["beam.file"])).write_bytes(spring)
        relay = replace(position.relay, positions={position.name: values})
        model = replace(position.model, parameters={})
        here = Position(Component(path), relay, position.name, position.contacts, (test,), model)
        return text_of(tested(here, test, points))


def text_of(part: Part) -> str:
    """Give the contents of the file of a part."""
    return json.dumps(part, indent=1)


def on_cluster(address: str, component: Component, jobs: list[Job]) -> Iterator[tuple[Path, str]]:
    """Run tests on a Dask cluster; give the path and text of each part as it is finished."""
    try:
        from distributed import Client, as_completed
    except ImportError as error:
        raise RelayContactError("a cluster needs Dask: pip install 'relay-contact[cluster]'") from error
    fmu = component.path.read_bytes()
    with Client(address) as client:
        paths = {}
        for path, position, test, points in jobs:
            spring = spring_of(position.values)
            # A component cannot be sent; the worker unpacks its own.
            bare = replace(position, component=None)  # type: ignore[arg-type]
            paths[client.submit(on_worker, fmu, spring, bare, test, points, pure=False)] = path
        for future, text in as_completed(list(paths), with_results=True):
            yield paths[future], text


def assess(
    component: Component, relay: Relay, standard: Standard, folder: Path, points: int,
    tell: Callable[[str], object] = lambda _: None, cluster: str | None = None,
) -> list[Part]:  # fmt: skip
    """Run every test in every position by every model, or what is left of it, and return a part for each test.

    It is that of the first model, with the verdict by all, and `models` has the parts of all.

    `tell` is called with what begins, and with nothing once it is finished; `cluster` is the address of a Dask cluster.
    """
    (folder / "parts").mkdir(parents=True, exist_ok=True)
    jobs: list[Job] = []
    for name in relay.positions:
        for model in relay.models:
            position = Position(component, relay, name, standard.contacts, standard.tests, model)
            for test in standard.tests:
                jobs.append((folder / "parts" / f"{key(position, test, points)}.json", position, test, points))
    todo = [job for job in jobs if not job[0].exists()]
    for _ in range(len(jobs) - len(todo)):
        tell("")
    for path, text in on_cluster(cluster, component, todo) if cluster else here(todo, tell):
        part = path.with_name(f"{path.name}.{os.getpid()}.part")
        part.write_text(text, encoding="utf-8")
        part.replace(path)
        tell("")
    found = [json.loads(path.read_text(encoding="utf-8")) for path, *_ in jobs]
    for warning in (warning for part in found for warning in part["warnings"]):
        component.warn(warning)
    grouped: dict[tuple[str, str], list[Part]] = {}
    for part in found:
        grouped.setdefault((part["position"], part["test"]), []).append(part)
    return [
        {**parts[0], "verdict": together([part["verdict"] for part in parts]), "models": parts}
        for parts in grouped.values()
    ]


def here(jobs: list[Job], tell: Callable[[str], object]) -> Iterator[tuple[Path, str]]:
    """Run tests one after another; give the path and text of each part."""
    for path, position, test, points in jobs:
        several = f", {position.model.name}" if len(position.relay.models) > 1 else ""
        tell(f"{test.name}, {position.name}{several}")
        yield path, text_of(tested(position, test, points))


def chosen(standard: Standard, texts: list[str]) -> Standard:
    """Give a standard with those of its tests whose names contain one of some texts."""
    if not texts:
        return standard
    found = {text: [test for test in standard.tests if text.lower() in test.name.lower()] for text in texts}
    for text, tests in found.items():
        if not tests:
            names = ", ".join(test.name for test in standard.tests)
            raise RelayContactError(f"{text}: no test named so; there are {names}")
    return replace(
        standard, tests=tuple(test for test in standard.tests if any(test in each for each in found.values()))
    )
