"""A relay as its file describes it: contacts, coil positions, and how well its parameters are known."""

import sys
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import pydantic.dataclasses
from pydantic import Field

from relay_contact import schema
from relay_contact.component import Component, Value, Values, nearest
from relay_contact.files import RelayContactError, by_name, digest, found, named, read_toml
from relay_contact.qualification import distributions
from relay_contact.qualification.distributions import Correlation, Distribution
from relay_contact.qualification.parts import check_held
from relay_contact.qualification.standards import Contacts, Monitor
from relay_contact.spring import PREFIX, by_modes, is_entry, known_of

OF_THE_TEST = ("excitation.", "effects.excitation", "chatter.", "effects.chatter", "effects.extremes", "second.minimum",
               "solver.tolerance")  # fmt: skip
"""Beginnings of the names of parameters that the tests set: in the file of a relay they would contradict them."""
NEEDED = {
    "pusher": ("position",),
    "armature": ("mass", "stiffness", "returnForce", "unbalance", "holdForce", "gapConstant", "restPosition",
                 "corePosition"),
}  # fmt: skip
"""Parameters that the tables of parts that hold the contact have to have, by table."""
TABLES = tuple(NEEDED)
"""These tables, each named as the group of parameters in it; a table that is there is in the model."""
OF_THE_POSITION = {
    "coil.relativeCurrent": "1 at nominal current, 0 without current",
    "pusher.displacement": "where the pusher stays",
}
"""Inputs that say where the parts are, the same in all tests, in words; needed by what they are not used without."""
HALF, STEP, FURTHER, HARD = 10, 1e-5, 1e-4, 4.0
"""Steps of a blow that closes, half of those that open then, their length (s), how far (m) a mass without a spring
moves beyond the contacts, and how many times as hard the blow is, for one that a stiff spring holds."""


NORMAL = "normal"
"""The axis of base acceleration along the motion of the contact."""


class CoilPosition(schema.Table):
    """A position of the coil."""

    name: Annotated[str, Field(min_length=1)] | None = None
    parameters: schema.Nested


@pydantic.dataclasses.dataclass(frozen=True, config=schema.STRICT)
class Model:
    """One of the models by which a relay is judged."""

    name: Annotated[str, Field(min_length=1)] = ""
    parameters: Mapping[str, Any] = field(default_factory=dict)
    """Of the component, in place of those of the relay, in all positions."""
    uncertainty: schema.Share = 0.0
    """Of margins, as a part of them with 95 % confidence, by what the model leaves out."""


class Surfaces(schema.Table):
    """What is known of the surfaces of the contacts."""

    roughness: schema.Positive | None = None


class Content(schema.Table):
    """Contents of the file of a relay."""

    title: str | None = None
    parameters: schema.Nested
    pusher: dict[str, Any] | None = None
    armature: dict[str, Any] | None = None
    position: Annotated[list[CoilPosition], Field(min_length=1, default_factory=lambda: [CoilPosition(parameters={})])]
    uncertainty: schema.Nested
    correlation: Correlation = Correlation()
    model: Annotated[list[Model], Field(min_length=1, default_factory=lambda: [Model()])]
    monitor: Monitor = Monitor()
    contact: Surfaces = Surfaces()
    axes: dict[str, list[float]] = Field(default_factory=dict)


@dataclass(frozen=True)
class Relay:
    """What a file of a relay holds, SI units."""

    title: str
    positions: dict[str, Values]
    """Parameters of the component in each position of the coil, by its name."""
    uncertainty: dict[str, Distribution]
    """Of parameters, or entries of the spring file."""
    models: tuple[Model, ...]
    """The first is that of figures and tables; a relay passes only by all of them."""
    monitor: Monitor
    roughness: float | None = None
    """Root mean square of the heights of both surfaces together, m."""
    correlation: Correlation = field(default_factory=Correlation)
    """Of the uncertain parameters."""
    axes: dict[str, Values] = field(default_factory=dict)
    """Further axes of base acceleration: factors of the participations of the modes."""
    digest: str = ""
    """Of the file."""

    @property
    def is_certain(self) -> bool:
        """Return whether nothing is stated that an interval could come from."""
        return not self.uncertainty and not any(model.uncertainty for model in self.models)

    def value(self, component: Component, name: str) -> float:
        """Return the value of a parameter in the first position; of an entry a factor of 1."""
        return component.value(next(iter(self.positions.values())), name)

    def parts(self, component: Component) -> dict[str, float]:
        """Return half of each interval of 95 %, as a part of the value."""
        return {name: each.half(self.value(component, name)) for name, each in self.uncertainty.items()}

    @classmethod
    def read(cls, relay: str | Path, component: Component) -> "Relay":
        """Read a relay by its name, such as "paper", or a file of one's own by its path."""
        path = named("relay", relay, relays())
        content = schema.read(path, Content)
        shared = {**parameters(path, content.parameters, ("parameters",), component), **moved(path, content, component)}
        positions: dict[str, Values] = {}
        for number, each in enumerate(content.position):
            place: schema.Place = ("position", number)
            name = each.name or f"position {number + 1}"
            if name in positions:
                raise schema.refused(path, (*place, "name"), name, "given twice")
            positions[name] = {**shared, **parameters(path, each.parameters, (*place, "parameters"), component)}
            if component.start("beam.file") and "beam.file" not in positions[name]:
                text = "beam.file: missing; the component carries a spring, and a relay names its own"
                raise RelayContactError(f"{path}:{schema.line(path, ('parameters',))}: parameters.{text}")
            with schema.at(path, *place):
                # Parameters that do not fit together.
                blow(component, positions[name])
                check_held(component, positions[name])
            for needed, allowed in OF_THE_POSITION.items():
                switch, kind = schema.SWITCHES[needed]
                if positions[name].get(switch) == kind and needed not in positions[name]:
                    text = f"parameters.{needed}: missing, allowed is {allowed}"
                    raise RelayContactError(f"{path}:{schema.line(path, place)}: {schema.dotted(place)}.{text}")
        models: dict[str, Model] = {}
        for number, rival in enumerate(content.model):
            place = ("model", number)
            name = rival.name or ("as described" if len(content.model) == 1 else f"model {number + 1}")
            if name in models:
                raise schema.refused(path, (*place, "name"), name, "given twice")
            changed = parameters(path, rival.parameters, (*place, "parameters"), component)
            if twin := next((each.name for each in models.values() if each.parameters == changed), None):
                raise schema.refused(path, place, name, f"has the parameters of {twin}")
            models[name] = replace(rival, name=name, parameters=changed)
            with schema.at(path, *place):
                for values in positions.values():
                    blow(component, {**values, **changed})
                    check_held(component, {**values, **changed})
        check_used(path, content, component, [[{**own, **each.parameters} for each in models.values()]
                                              for own in positions.values()])  # fmt: skip
        cases = by_models(positions, models.values())
        uncertainty = uncertainties(path, content.uncertainty, cases, component)
        for number, name in enumerate(content.correlation.names):
            if name not in uncertainty:
                allowed = f"allowed are the names in [uncertainty]{nearest(name, uncertainty)}"
                raise schema.refused(path, ("correlation", "names", number), name, allowed)
        title, roughness = content.title or path.stem, content.contact.roughness
        axes = {name: participations(path, name, own, cases) for name, own in content.axes.items()}
        return cls(
            title, positions, uncertainty, tuple(models.values()), content.monitor, roughness, content.correlation,
            axes, digest(path.read_bytes()),
        )  # fmt: skip


def by_models(positions: Mapping[str, Values], models: Collection[Model]) -> dict[str, Values]:
    """Return the parameters of each position by each model, by both names; by that of the position for one model."""
    return {
        f"{position} by {model.name}" if len(models) > 1 else position: {**values, **model.parameters}
        for position, values in positions.items() for model in models
    }  # fmt: skip


def check_used(path: Path, content: Content, component: Component, known: list[list[Values]]) -> None:
    """Refuse a parameter of a part that the relay does not have where it is given: without a word it would be without.

    `known` are the parameters of each position, by each model.
    """
    every = [values for own in known for values in own]
    tables: list[tuple[schema.Place, Mapping[str, Any], list[Values]]] = [
        ((), {name: own for name in TABLES if (own := getattr(content, name))}, every),
        (("parameters",), content.parameters, every),
        *((("position", at, "parameters"), each.parameters, known[at]) for at, each in enumerate(content.position)),
        *((("model", at, "parameters"), each.parameters, [own[at] for own in known])
          for at, each in enumerate(content.model)),
    ]  # fmt: skip
    for place, table, where in tables:
        for name, keys, value in schema.leaves(table):
            if needed := schema.lacking(component, name, where):
                raise schema.refused(path, (*place, *keys), value, f"not used without {needed}")


def check_monitor(component: Component, relay: Relay, contacts: Contacts) -> None:
    """Refuse a monitor for which a closed contact is interrupted at rest, or an open one is closed.

    Refuse twin contacts, too, of which the first, whose force is judged, is open beside the other.
    """
    monitor = f"a monitor of {contacts.voltage:g} V and {contacts.current:g} A"
    text = f"{monitor} sees an interruption from {contacts.threshold:g} Ohm on: not allowed, the contact has"
    for name, values in by_models(relay.positions, relay.models).items():
        with component.started(values) as contact:
            force, resistance, apart = contact.real("contact.force", "contact.resistance", "resistance.open")
            parallel, offset = contact.real("parallel.force", "parallel.offset")
        if parallel > 0 and force <= 0:
            why = "at rest the parallel contact is closed and the first, whose force is judged, is open: exchange both"
            raise RelayContactError(f"{name}: parallel.offset = {offset:g} m: not allowed, {why}")
        if force > 0 and resistance >= contacts.threshold:
            raise RelayContactError(f"{name}: {text} {resistance:.3g} Ohm at rest")
        if contacts.threshold >= apart:
            raise RelayContactError(f"{name}: {text} {apart:g} Ohm while it is open")


def parameters(path: Path, table: Mapping[str, Any], place: schema.Place, component: Component) -> Values:
    """Return the parameters in a table of a relay's file, and the inputs that belong to it."""
    for name, keys, value in schema.leaves(table):
        if name.startswith(OF_THE_TEST):
            raise schema.refused(path, (*place, *keys), value, "the tests of a standard set it, not the relay")
        group = name.partition(".")[0]
        if (place == ("parameters",) and group in TABLES) or name == "effects.pusher":
            where = f"its place is the table [{group}]" if group in TABLES else "the tables [pusher], [armature] say it"
            raise schema.refused(path, (*place, *keys), value, where)
    return schema.variables(path, table, place, component, inputs=OF_THE_POSITION)


def moved(path: Path, content: Content, component: Component) -> dict[str, Value]:
    """Return the parameters of pusher and armature, and what their tables say of the model."""
    tables = {name: own for name in TABLES if (own := getattr(content, name)) is not None}
    if not tables:
        return {}
    found = schema.variables(path, tables, (), component, inputs=OF_THE_POSITION)
    if "armature" in tables and "pusher" not in tables:
        raise RelayContactError(
            f"{path}:{schema.line(path, ('armature',))}: pusher: missing, by which the armature moves it"
        )
    file = {name: value for name, _, value in schema.leaves(content.parameters)}.get("beam.file", "")
    has_place = bool(file) and by_modes(path.parent / str(file))
    for name, own in tables.items():
        # With start values that nobody chose a verdict would be that of another relay.
        for entry in NEEDED[name]:
            if entry not in own and not (has_place and name == "pusher"):
                raise RelayContactError(f"{path}:{schema.line(path, (name,))}: {name}.{entry}: missing")
    kind = "Armature" if "armature" in tables else "Prescribed"
    return {"effects.pusher": kind} | found


def participations(path: Path, axis: str, own: list[float], cases: dict[str, Values]) -> Values:
    """Return the participations of the modes in an axis as factors of those in the spring file, that of all cases."""
    found: dict[str, float] = {}
    for values in cases.values():
        if values.get("fixed.file") or values.get("effects.pusher", "None") != "None":
            text = "further axes are those of the moving contact's spring alone, without other parts"
            raise schema.refused(path, ("axes", axis), own, text)
        if values.get("environment.gravity"):
            text = "environment.gravity would act along this axis, not along the normal"
            raise schema.refused(path, ("axes", axis), own, text)
        file = str(values.get("beam.file", ""))
        modes = read_toml(Path(file)).get("mode", []) if file else []
        if axis == NORMAL or len(modes) != len(own):
            text = f"allowed is one participation for each of the {len(modes)} modes in the spring file"
            raise schema.refused(path, ("axes", axis), own, "the spring file has it" if axis == NORMAL else text)
        for number, (mode, part) in enumerate(zip(modes, own, strict=True), 1):
            if not mode["participation"]:
                text = f"mode {number} has none in the spring file, of which this is a factor"
                raise schema.refused(path, ("axes", axis, number - 1), part, text)
            factor = part / mode["participation"]
            if found.setdefault(f"{PREFIX}mode.{number}.participation", factor) != factor:
                text = f"mode {number} has another participation in another spring file of this relay"
                raise schema.refused(path, ("axes", axis, number - 1), part, text)
    return found


def uncertainties(
    path: Path, table: dict[str, Any], cases: dict[str, Values], component: Component
) -> dict[str, Distribution]:
    """Return the uncertainties of a relay's file by name; each changes something in one position by one model."""
    found: dict[str, tuple[schema.Place, Distribution]] = {}
    for name, keys, part in schema.leaves(table):
        place = ("uncertainty", *keys)
        with schema.at(path, *place):
            if is_entry(name):
                for values in cases.values():
                    allowed = known_of(values)
                    if name not in allowed:
                        text = f"no such entry in the spring file{nearest(name, allowed)}"
                        raise RelayContactError(f"{schema.dotted(place)}: {text}")
            elif name not in OF_THE_POSITION and (
                component.variables[schema.exact(component, name, "parameter")].type != "Real"
            ):
                raise RelayContactError(f"{schema.dotted(place)}: not a parameter of type Real")
        if name in found:
            raise schema.refused(path, place, part, "given twice")
        try:
            found[name] = place, distributions.read(part)
        except ValueError as error:
            raise schema.refused(path, place, part, str(error)) from error
    rest = {case: blow(component, values) for case, values in cases.items()} if found else {}
    for name, (place, distribution) in found.items():
        with schema.at(path, *place):
            used = [distribution.part == 0]
            for case, values in cases.items():
                start = component.value(values, name)
                ends = [start, start] if not start else start * distribution.factor(distributions.SCORES, start)
                mine = [blow(component, values, {name: float(end)}) != rest[case] for end in ends]
                if any(mine):
                    distribution.check(name, start, case)
                used += mine
            if not any(used):
                raise RelayContactError(
                    f"{schema.dotted(place)}: not used, {name} changes nothing in this relay, or it is 0"
                )
    return {name: distribution for name, (_, distribution) in found.items()}


def blow(component: Component, values: Values, changed: Values | None = None) -> list[float]:
    """Return what the contacts do after a blow that closes the first and one that opens it, with other parameters."""
    watched = ("contact.force", "contact.resistance", "tip.displacement", "second.force", "second.resistance",
               "fixed.displacement", "pusher.force", "armature.displacement")  # fmt: skip
    travel = FURTHER + sum(abs(component.value(values, name)) for name in ("contact.overtravel", "second.gap"))
    size = HARD * 2 * travel / (HALF * STEP) ** 2
    # Twice where it turns around.
    time = STEP * np.insert(np.arange(3.0 * HALF + 1), HALF, HALF)
    course = np.repeat([size, -size], [HALF + 1, 2 * HALF + 1])
    with component.started({**values, **(changed or {})}) as contact, contact.explained():
        # These forces are only compared: a warning of their error would be taken as one of the relay's tests.
        contact.told = sys.maxsize
        rows = contact.drive(time, {"base.acceleration": course}, watched)
        return [float(value) for row in zip(*rows.values(), strict=True) for value in row]


def relays() -> dict[str, Path]:
    """Return the files of the relays by name."""
    return by_name(found("relays", "relays"))
