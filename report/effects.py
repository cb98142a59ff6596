"""What each effect costs and changes: docs/effects.md, of the list in `effects.toml`."""

import tomllib
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from pydantic import BaseModel, ConfigDict

from relay_contact import Component, Result, Scene, run
from report.callgrind import LENGTH, Minimal
from report.files import DOCS
from report.text import number, rendered, signed, table, two_digits

CLOSED, OPENING = ("paper-1khz", "shock-50g"), "chatter-41g"
"""Scenes in which the contact stays closed, and one in which it opens again and again: forces of blows are not
compared, they depend on everything."""
PAGE = DOCS / "effects.md"
OUTPUTS = ["contact.force", "contact.resistance"]


class Effect(BaseModel):
    """An effect that a scene may ask for."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    name: str
    setting: Mapping[str, str]
    """What asks for it."""
    matters: str
    """When it matters."""
    also: Mapping[str, str] = {}
    """What else the run needs to show its cost."""
    reads: str = "contact.force"
    """Outputs that it is for, read after each communication step, with commas between them."""
    beside: str = ""
    """The effect that it cannot be without, and is compared with."""
    off: Mapping[str, str] = {}
    """What takes it away from a scene; empty where there is nothing to compare."""


def effects() -> list[Effect]:
    """Return the list of effects, those first that others are compared with."""
    content = tomllib.loads((Path(__file__).parent / "effects.toml").read_text(encoding="utf-8"))
    return [Effect(name=name, **own) for name, own in content.items()]


def code(settings: Mapping[str, str]) -> str:
    """Return settings as code."""
    return ", ".join(f"`{name} = {value}`" for name, value in settings.items())


class Runs:
    """The scenes with the settings of effects, each different one run once."""

    def __init__(self) -> None:
        """Unpack the component."""
        self.component = Component()
        self.known: dict[str, Result] = {}

    def run(self, name: str, settings: Mapping[str, str]) -> Result:
        """Run a scene with settings."""
        values = {each: self.component.read(each, value) for each, value in settings.items()}
        scene = Scene.read(name, self.component).changed(self.component, values)
        key = repr((name, sorted(scene.values.items())))
        if key not in self.known:
            self.known[key] = run(scene, outputs=OUTPUTS, component=self.component)
        return self.known[key]

    def influence(self, effect: Effect) -> list[str]:
        """Return the cells of an effect: differences of force and resistance, and times open without it and with it."""
        cells = []
        for name in CLOSED:
            both = [self.run(name, settings) for settings in (effect.off, effect.setting)]
            for output in OUTPUTS:
                cells.append(two_digits(1e3 * float(np.abs(both[0][output] - both[1][output]).max())))
        for settings in (effect.off, effect.setting):
            result = self.run(OPENING, settings)
            step = float(result["time"][1] - result["time"][0])
            cells.append(f"{1e3 * step * np.count_nonzero(result['contact.force'][1:] <= 0):.3f}")
        return cells


def write(page: Path = PAGE) -> Path:
    """Measure and write the page."""
    found, minimal, runs = effects(), Minimal(), Runs()
    with ThreadPoolExecutor() as pool:
        changes = [{}, *({**each.also, **each.setting, "outputs": each.reads} for each in found)]
        least, *counts = pool.map(minimal.per_millisecond, changes)
    costs = dict(zip((each.name for each in found), counts, strict=True))
    rows = [["minimal scene", "", number(least, 0), "", ""]]
    for each in found:
        added = 100 * (costs[each.name] / (costs[each.beside] if each.beside else least) - 1)
        name = f"{each.name} (compared with {each.beside})" if each.beside else each.name
        rows.append([name, code(each.setting), number(costs[each.name], 0), f"{signed(added, 1)} %", each.matters])
    columns = ["effect", "compared with"]
    for name in CLOSED:
        columns += [f"*{name}*: change of force, mN", "change of resistance, mΩ"]
    columns += [f"*{OPENING}*: time open without the effect, ms", "with the effect, ms"]
    influences = [[each.name, code(each.off), *runs.influence(each)] for each in found if each.off]
    text, _ = rendered("effects.md", [], {
        "length": 1e3 * LENGTH, "influences": table(columns, influences),
        "costs": table(["effect", "setting", "instructions per ms", "added", "when it matters"], rows),
    })  # fmt: skip
    page.write_text(text, encoding="utf-8")
    return page
