"""A relay against a standard: each test in each position of the coil, its margin, and how well the margin is known.

The margin is the level that interrupts the closed contact, or closes the open one, relative to that of the test. A
finished test is a file in the folder `parts`, named by a hash of all that it depends on: an interrupted assessment
continues, with the same bytes.
"""

import hashlib
import json
import math
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from relay_contact.component import Component, Values
from relay_contact.files import HERE, RelayContactError
from relay_contact.qualification.relay import Relay
from relay_contact.qualification.response import Response, margin, open_at_rest, respond
from relay_contact.qualification.standards import Contacts, Random, Shock, Sine, Standard, Test
from relay_contact.qualification.trials import (
    CLOSED,
    OPEN,
    SAMPLE,
    SHOWN,
    Specimen,
    dips,
    shock,
    shock_threshold,
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


@dataclass
class Position:
    """A position of the coil: its contacts, and the responses with each parameter at the ends of its interval."""

    component: Component
    relay: Relay
    name: str
    contacts: Contacts

    @property
    def values(self) -> Values:
        """Parameters of the component."""
        return self.relay.positions[self.name]

    def value(self, name: str) -> float:
        """Give the value of a parameter; that of an entry of the spring file is a factor."""
        return 1.0 if name.startswith(PREFIX) else float(self.values.get(name, self.component.start(name)))

    @cached_property
    def specimen(self) -> Specimen:
        """The contacts as the file says."""
        response = respond(self.component, self.values, self.contacts.threshold)
        return Specimen(self.component, self.values, self.contacts, response)

    @cached_property
    def ends(self) -> dict[str, tuple[Response, Response]]:
        """The responses at the ends of the interval of each uncertain parameter."""

        def end(name: str, part: float) -> Response:
            changed = {**self.values, name: self.value(name) * (1 + part)}
            return respond(self.component, changed, self.contacts.threshold)

        return {name: (end(name, -part), end(name, part)) for name, part in self.relay.uncertainty.items()}

    @cached_property
    def worn(self) -> dict[float, Response]:
        """The responses over the overtravel (m), which the wear of the contacts takes away, or over the gap."""
        name = "contact.overtravel"
        nominal = self.value(name)
        return {
            abs(part * nominal): respond(self.component, {**self.values, name: part * nominal}, self.contacts.threshold)
            for part in WORN
        }

    def wear(self, test: Test, factor: float) -> dict[str, list[float]]:
        """Give the margin over overtravel or gap, for a margin that the component found as it is."""
        opening = self.specimen.lasting
        ratio = factor / margin(self.specimen.response, test, opening)
        return {
            "overtravel": list(self.worn),
            "margin": [ratio * margin(response, test, opening) for response in self.worn.values()],
        }

    def effects(self, test: Test) -> dict[str, float]:
        """Give what each uncertainty adds to that of the margin, as parts of the margin, with 95 % confidence."""
        opening = self.specimen.lasting
        nominal = margin(self.specimen.response, test, opening)
        found = {
            name: abs(margin(high, test, opening) - margin(low, test, opening)) / (2 * nominal)
            for name, (low, high) in self.ends.items()
        }
        if self.relay.model:
            found[MODEL] = self.relay.model
        if isinstance(test, Random):
            low, high = (self.specimen.response.random(test, opening, chance) for chance in (0.025, 0.975))
            found[CHANCE] = abs(high - low) / (2 * nominal)
        return found


Job = tuple[Path, Position, Test, int]
"""The file that a test is to write, the position, the test, and the number of frequencies."""


def spring_of(values: Values) -> bytes:
    """Give the contents of the spring file of a position, if it has one."""
    file = str(values.get("beam.file", ""))
    return Path(file).read_bytes() if file else b""


def verdict(factor: float, uncertainty: float) -> str:
    """Compare a margin with 1; within its uncertainty nothing is decided."""
    if abs(factor - 1) <= uncertainty:
        return "undecided"
    return "FAIL" if factor < 1 else "pass"


def passes(wear: dict[str, list[float]], uncertainty: float) -> float | None:
    """Give the overtravel or gap (m) from which on a margin with an uncertainty, as a part of it, passes."""
    least = [value * (1 - uncertainty) for value in wear["margin"]]
    if least[-1] < 1:
        return None
    return float(np.interp(1.0, least, wear["overtravel"]))


def chance_below(factor: float, uncertainty: float) -> float:
    """Give the chance that a margin is below 1, normally distributed; `uncertainty` has 95 % confidence."""
    if not uncertainty:
        return float(factor < 1)
    return (1 + math.erf(1.96 * (1 - factor) / uncertainty / math.sqrt(2))) / 2


def vibration(position: Position, test: Sine, points: int) -> Part:
    """Vibrate steadily at frequencies of the sweep, and seek the level that fails where it is least."""
    specimen = position.specimen
    response = specimen.response
    frequency, factors = response.sine(test, specimen.lasting)
    at = int(factors.argmin())
    weakest = float(frequency[at])
    low, high = test.frequencies
    near = weakest * np.linspace(0.9, 1.1, points // 4)
    near = near[(near > low) & (near < high)]
    chosen = np.unique(np.concatenate((np.geomspace(low, high, points), near, [weakest])))
    rows = sweep(specimen, test, chosen)
    factor, decides = sine_threshold(specimen, test, weakest, float(factors[at]))
    lengths = {name: [length.get(name, 0.0) for length, _ in rows] for name in specimen.monitors}
    least = {name: [left[number] for _, left in rows] for number, name in enumerate(specimen.monitors)}
    if 0 < at < len(factors) - 1:
        octaves = 2 * np.log2(high / low) * 60 / test.sweep_time
        width = response.bandwidth(weakest)
        decays = width / weakest * test.sweep_time / (2 * np.log(high / low)) * np.pi * width
        limits = f"resonance, {width:.0f} Hz wide; the sweep of {octaves:.2g} octaves a minute crosses it in "
        limits += f"{decays:.0f} decay times" if decays < MANY else f"over {MANY} decay times"
    elif at == 0:
        limits = "lowest frequency of the range, the whole force of inertia"
    else:
        limits = "highest frequency of the range, below the resonance"
    return {
        "margin": factor, "decides": decides, "linear": float(factors[at]), "weakest": f"{weakest:.0f} Hz",
        "limits": limits, "failed": {name: max(each) for name, each in lengths.items() if any(each)},
        "least": {name: min(each) for name, each in least.items()},
        "curves": {"frequency": chosen.tolist(), "level": test.amplitude(chosen).tolist(),
                   "length": lengths, "least": least},
    }  # fmt: skip


def random(position: Position, test: Random) -> Part:
    """Seek the level at which the largest dips of a record fail; for the time of the test by Rice's rate."""
    specimen = position.specimen
    response = specimen.response
    ratios, decides = [], []
    found = dips(specimen, test)
    for acceleration, guess in found:
        level, failed = threshold(lambda factor, course=acceleration: window(specimen, course, factor)[0], guess)  # type: ignore[misc]
        decides += [name for name in failed if name not in decides]
        ratios.append(level / guess)
    linear = response.random(test, specimen.lasting)
    rms, _ = response.moments(test)
    lengths, rows = window(specimen, found[0][0], 1.0, watched=True)
    density = test.spectrum(response.frequency) * response.gain**2
    share = np.cumsum(density) / density.sum()
    half = response.frequency[np.searchsorted(share, [0.25, 0.75])]
    moving, rest = ("motion", "gap") if specimen.is_open else ("force", "preload")
    shown = rows[-round(10e-3 / SAMPLE) :]
    return {
        "margin": linear * float(np.mean(ratios)), "decides": decides, "linear": linear,
        "weakest": f"{half[0]:.0f} to {half[1]:.0f} Hz",
        "limits": f"half of the power of the {moving} is there; {rms / response.reserve:.2g} of the {rest} rms",
        "failed": lengths, "least": dict(zip(specimen.monitors, rows[:, 1:].min(axis=0).tolist(), strict=True)),
        "curves": {"time": (SAMPLE * np.arange(len(shown))).tolist(), "course": shown[:, 0].tolist()},
    }  # fmt: skip


def shocks(position: Position, test: Shock) -> Part:
    """Run a shock in both directions, and seek the levels that fail."""
    specimen = position.specimen
    response = specimen.response
    guesses = response.shock(test, specimen.lasting)
    signs = {"closing": 1.0, "opening": -1.0}
    runs = {name: shock(specimen, test, sign, SHOWN) for name, sign in signs.items()}
    way, other = sorted(guesses, key=lambda name: guesses[name])
    factor, decides = shock_threshold(specimen, test, signs[way], guesses[way])
    if shock(specimen, test, signs[other] * factor)[0]:
        lower, failed = shock_threshold(specimen, test, signs[other], min(guesses[other], factor))
        if lower < factor:
            way, factor, decides = other, lower, failed
    shown = runs["closing" if specimen.is_open else "opening"][1][:-1]
    slow = response.reserve / (response.gain[0] * 9.80665 * test.acceleration) / guesses[way]
    return {
        "margin": factor, "decides": decides, "linear": guesses[way], "weakest": f"{way} direction",
        "limits": f"inertia of the spring, {slow:.2f} times that of a slow shock",
        "failed": {name: max(each.get(name, 0.0) for each, _ in runs.values()) for name in specimen.monitors
                   if any(name in each for each, _ in runs.values())},
        "least": {name: float(min(rows[:, 2 + number].min() for _, rows in runs.values()))
                  for number, name in enumerate(specimen.monitors)},
        "curves": {"time": shown[:, 0].tolist(), "course": shown[:, 1].tolist()},
    }  # fmt: skip


def tested(position: Position, test: Test, points: int) -> Part:
    """Run a test in a position of the coil."""
    part: Part = {
        "position": position.name, "test": test.name, "kind": type(test).__name__.lower(), "level": str(test),
        "clause": test.clause, "verified": test.verified,
    }  # fmt: skip
    second = bool(position.value("effects.secondContact"))
    if position.value("contact.overtravel") == 0:
        return part | {"verdict": "not judged", "limits": "the contact just touches: neither closed nor open"}
    if second and open_at_rest(position.component, position.values):
        reason = "both contacts open: closings on both sides are not judged; give each side as a position of its own"
        return part | {"verdict": "not judged", "limits": reason}
    match test:
        case Sine():
            part |= vibration(position, test, points)
        case Random():
            part |= random(position, test)
        case Shock():
            part |= shocks(position, test)
    effects = position.effects(test)
    relative = float(np.sqrt(sum(effect**2 for effect in effects.values())))
    shares = {name: (effect / relative) ** 2 for name, effect in effects.items()} if relative else {}
    part |= {"uncertainty": relative * part["margin"], "effects": effects, "shares": shares}
    part |= {"wear": position.wear(test, part["margin"]), "overtravel": abs(position.value("contact.overtravel"))}
    part |= {"passes": passes(part["wear"], relative), "chance": chance_below(part["margin"], part["uncertainty"])}
    specimen = position.specimen
    rest = {OPEN if specimen.is_open else CLOSED: specimen.response.reserve}
    part |= {"rest": rest | ({OPEN: position.value("second.gap")} if second else {})}
    part |= {"natural": specimen.response.natural}
    return part | {"verdict": verdict(part["margin"], part["uncertainty"])}


def key(component: Component, relay: Relay, standard: Standard, position: str, test: Test, points: int) -> str:
    """Give a name for a test that changes with all that its result depends on."""
    text = hashlib.sha256(component.path.read_bytes())
    for name in ("assessment", "response", "standards", "trials"):
        text.update((HERE / "qualification" / f"{name}.py").read_bytes())
    text.update(spring_of(relay.positions[position]))
    values = {name: value for name, value in relay.positions[position].items() if name != "beam.file"}
    settings = [position, values, relay.uncertainty, relay.model, repr(standard.contacts), repr(test)]
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
        return text_of(tested(Position(Component(path), relay, position.name, position.contacts), test, points))


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
            bare = Position(None, position.relay, position.name, position.contacts)  # type: ignore[arg-type]
            paths[client.submit(on_worker, fmu, spring, bare, test, points, pure=False)] = path
        for future, text in as_completed(list(paths), with_results=True):
            yield paths[future], text


def assess(
    component: Component, relay: Relay, standard: Standard, folder: Path, points: int,
    tell: Callable[[str], object] = lambda _: None, cluster: str | None = None,
) -> list[Part]:  # fmt: skip
    """Run every test in every position, or what is left of it, and give the parts.

    `tell` is called with what begins, and with nothing once it is finished; `cluster` is the address of a Dask cluster.
    """
    (folder / "parts").mkdir(parents=True, exist_ok=True)
    jobs: list[Job] = []
    for name in relay.positions:
        position = Position(component, relay, name, standard.contacts)
        for test in standard.tests:
            path = folder / "parts" / f"{key(component, relay, standard, name, test, points)}.json"
            jobs.append((path, position, test, points))
    todo = [job for job in jobs if not job[0].exists()]
    for _ in range(len(jobs) - len(todo)):
        tell("")
    for path, text in on_cluster(cluster, component, todo) if cluster else here(todo, tell):
        part = path.with_name(f"{path.name}.{os.getpid()}.part")
        part.write_text(text, encoding="utf-8")
        part.replace(path)
        tell("")
    return [json.loads(path.read_text(encoding="utf-8")) for path, *_ in jobs]


def here(jobs: list[Job], tell: Callable[[str], object]) -> Iterator[tuple[Path, str]]:
    """Run tests one after another; give the path and text of each part."""
    for path, position, test, points in jobs:
        tell(f"{test.name}, {position.name}")
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
