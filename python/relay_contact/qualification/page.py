"""The results of an assessment as one page, in HTML and PDF, and tables."""

from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import matplotlib as mpl

from relay_contact import pages
from relay_contact.component import DIFFERENCE, Component, Values, units
from relay_contact.figures import three
from relay_contact.files import digest, write_at_once
from relay_contact.qualification import plots, statistics
from relay_contact.qualification.assessment import springs_of
from relay_contact.qualification.excitation import LEVELS, evidence_told
from relay_contact.qualification.parts import MOVED, NONE, PUSHER
from relay_contact.qualification.position import DRAWS, FEWEST
from relay_contact.qualification.relay import Relay
from relay_contact.qualification.results import Assessment, Tested
from relay_contact.qualification.standards import Standard
from relay_contact.qualification.words import HEAD, REASONS, at_rest, reasons, rows, time_text
from relay_contact.schema import lacking
from relay_contact.spring import SPRING_FILES, by_modes

FILLS = {"pass": "#BFE5D8", "FAIL": "#F5CDB8", "undecided": "#FBE8B0", "not judged": "#E4E4E4"}
FILES = ("qualification.html", "qualification.csv", "sweeps.csv")
PDF = "qualification.pdf"
ALONE = (
    "The interval covers the uncertain parameters and the allowance that the relay's file makes for what the model "
    "leaves out."
)
UNKNOWN = (
    "The relay's file states neither uncertain parameters nor an allowance for what the model leaves out: verdicts are "
    "those of the margins alone."
)
LAWS = {
    "Hertz": "Hertzian contact of smooth bodies",
    "Rough": "contact of rough surfaces, its stiffness the power {:g} of the force,",
    "Linearised": "contact of smooth bodies, linear about the preload,",
    "Bonded": "contact of smooth bodies, linear and unable to open,",
}
"""By effects.contactLaw."""
PUSHERS = {"Prescribed": "pusher that stays where it is", MOVED: "armature that moves a pusher"}
SHAKEN = {
    NONE: ("The contact springs as in a rigid relay", ""),
    "Prescribed": ("The contact springs with their pusher", " and the pusher"),
    MOVED: (
        "The relay with its contacts, its armature and the pusher between them",
        " and pivot and core of the armature",
    ),
}
"""By effects.pusher: what is judged, and what of it the base moves beside the contacts, the least first."""
HIDDEN = ("excitation.", "chatter.", "solver.", "effects.friction", "effects.pusher")
"""Parameters that are not the relay's, and choices of what it does not have at their start values."""
NOT_USED = "not used"
SECTION = ("beam.length", "beam.width", "beam.thickness")
"""What a file of the spring takes the place of."""
CARRIED = ("tip.mass", "tip.rotaryInertia", "pusher.position")
MATERIAL = ("beam.youngsModulus", "beam.density")
"""What modes have in them."""


def form(component: Component, values: Values) -> str:
    """Return the form of the model in words."""

    def has(name: str, group: str = "effects") -> Any:  # noqa: ANN401
        return values.get(f"{group}.{name}", component.start(f"{group}.{name}"))

    law = LAWS[has("contactLaw")].format(has("stiffnessExponent", "contact"))
    axial = {
        "None": "no axial force", "Prescribed": "a given axial force", "FromPreload": "the axial force of the preload",
        "FromDeflection": "the axial force of the present deflection",
    }  # fmt: skip
    parts = [
        "slender spring with Rayleigh damping",
        *(["fixed contact on a spring"] if values.get("fixed.file") else []),
        *([PUSHERS[has("pusher")]] if has("pusher") != NONE else []),
        f"{law} {'with' if has('contactDamping') else 'without'} viscoelastic damping",
        axial[has("axialForce")],
        "no friction" if has("friction") == "None" else f"friction of {has('coefficient', 'friction'):g}",
    ]
    return ", ".join(parts)


def columns_of(relay: Relay) -> dict[str, Values]:
    """Return the parameters of the relay by position and model."""
    return {
        ", ".join([position] * (len(relay.positions) > 1) + [model.name] * (len(relay.models) > 1)) or "value": (
            {**relay.positions[position], **model.parameters}
        )
        for position in relay.positions for model in relay.models
    }  # fmt: skip


def replaced(values: Values) -> tuple[str, ...]:
    """Return the parameters that a file of the spring takes the place of."""
    if not values.get("beam.file"):
        return ()
    if not by_modes(Path(str(values["beam.file"]))):
        return SECTION
    # The spring of the fixed contact may be of that material.
    return SECTION + CARRIED + MATERIAL * (not values.get("fixed.file"))


def inputs(component: Component, relay: Relay) -> pages.Table:
    """Return a table of all parameters of the relay by position and model, with their uncertainties."""
    columns = columns_of(relay)
    described = units(component.description)
    own = {name for values in columns.values() for name in values}
    without = [replaced(values) for values in columns.values()]
    found = []
    for name, variable in component.variables.items():
        if name in SPRING_FILES or (variable.causality != "parameter" and name not in own):
            continue
        idle = lacking(component, name, [*columns.values()]) or all(name in names for names in without)
        if name not in own and (idle or name.startswith(HIDDEN)):
            continue

        def text(value: Any, name: str = name) -> str:  # noqa: ANN401
            if isinstance(value, str):
                return value
            if component.variables[name].type == "Boolean":
                return str(bool(value)).lower()
            return described[name].text(float(value)).strip() if name in described else f"{float(value):g}"

        distribution = relay.uncertainty.get(name)
        cells = [NOT_USED if name in names else text(values.get(name, component.start(name)))
                 for names, values in zip(without, columns.values(), strict=True)]  # fmt: skip
        told = distribution.told(relay.value(component, name)) if distribution else ""
        found.append([name, *cells, told, "file" if name in own else "start value"])
    for name, distribution in relay.uncertainty.items():
        if name not in component.variables:
            found.append([name, *["as in the spring file"] * len(columns), distribution.told(1.0), "file"])
    for model in relay.models:
        named = f"margin, by {model.name}" if len(relay.models) > 1 else "margin, by what the model leaves out"
        found.append([named, *[""] * len(columns), f"± {100 * model.uncertainty:.3g} %", "file"])
    for one, row in zip(relay.correlation.names, relay.correlation.matrix, strict=True):
        told = ", ".join(f"{other} {each:+.3g}" for other, each in zip(relay.correlation.names, row, strict=True)
                         if other < one)  # fmt: skip
        if told:
            found.append([f"{one}, correlation", *[""] * len(columns), told, "file"])
    return ("parameter", *columns, "uncertainty, 95 %", "from"), found


def springs(relay: Relay) -> list[tuple[str, str]]:
    """Return names and contents of the spring files."""
    files = dict.fromkeys(
        (Path(str(values[name])).name, content)
        for values in columns_of(relay).values() for name, content in springs_of(values).items()
    )  # fmt: skip
    return [(name, content.decode("utf-8-sig")) for name, content in files]


def position_context(assessment: Assessment, component: Component, name: str, values: Values) -> dict[str, Any]:
    """Return what the page says of a position of the coil."""
    relay = assessment.relay
    mine = [tested for tested in assessment if tested.first.position == name]
    known = next((tested.first for tested in mine if tested.judged), None)
    count, forms = len(relay.models), dict[str, list[str]]()
    for model in relay.models:
        forms.setdefault(form(component, {**values, **model.parameters}), []).append(model.name)
    described = "; ".join(f"{', '.join(names)}: {text}" if count > 1 else text for text, names in forms.items())
    several = f"The margins of {count} models show how far another form of the model moves a margin."
    single = "One model is judged: how far another form of the model would move the margin is not known."
    told = several if count > 1 else single
    covered = UNKNOWN if relay.is_certain else ALONE
    cells = []
    for tested in mine:
        # What was not read in the standard is told.
        unread = [tested.first.evidence] if tested.first.evidence not in LEVELS[:2] else []
        first, *others = rows(tested)
        source = ", ".join(filter(None, [tested.first.clause, *unread]))
        cells += [{"cells": first, "source": source}, *({"cells": row, "source": ""} for row in others)]
    notes = [note for tested in mine for note in tested.notes]
    context = {
        "name": name, "rest": "", "sketch": "", "form": f"{covered} {told} Form of the model: {described}.",
        "rows": cells, "reasons": [row for tested in mine for row in reasons(tested)], "notes": notes,
        "figures": [pages.svg(figure) for figure in plots.position_figures(mine, assessment.standard.contacts)],
    }  # fmt: skip
    if known:
        own = known.margin
        moved = values.get("effects.pusher", NONE) != NONE
        clear = "; the pusher does not touch the spring" if moved and PUSHER not in own.rest else ""
        context["rest"] = f"{at_rest(own)}; first resonance {three(own.natural)} Hz{clear}"
        lengths = {} if values.get("beam.file") else {"length": "beam.length"}
        shown = {**lengths, "tip": "tip.mass"}
        given = {key: component.value(values, name) for key, name in shown.items()}
        given["overtravel"] = own.overtravel
        context["sketch"] = pages.svg(plots.sketch(known, given))
    return context


def scope(relay: Relay, standard: Standard) -> tuple[list[str], list[str]]:
    """Return what was judged and what was not."""
    axes = ", ".join(["normal to the contact", *relay.axes])
    every = [{**values, **model.parameters} for values in relay.positions.values() for model in relay.models]
    sprung = any(values.get("fixed.file") for values in every)
    # A part that one of the models has is judged.
    pusher = max((str(values.get("effects.pusher", NONE)) for values in every), key=[*SHAKEN].index)
    what, others = SHAKEN[pusher]
    clamps = "the clamps of both springs" if sprung else "the clamp of the spring and the fixed contacts"
    first = f"{what}: base vibration moves {clamps}{others} alike."
    if pusher != NONE:
        first += " A verdict is that of the part that fails first."
    if any(values.get("effects.parallelContact") for values in every):
        first += " Twin contacts fail where both are open at once; forces at rest are those of the first."
    judged = [
        first,
        f"Base acceleration along: {axes}.",
        f"{len(standard.tests)} tests, in the positions of the coil: {', '.join(relay.positions)}.",
    ]
    absent = "Circuit of the coil, and case," if pusher == MOVED else "Armature, actuator, coil and case"
    left = [f"{absent} are not in the model: what they do to the contact is not in any verdict here.",
            "Bounce after switching, and wear beyond the loss of overtravel."]  # fmt: skip
    if standard.left:
        left.insert(0, f"Tests of the standard that were not run: {'; '.join(test.name for test in standard.left)}.")
    if not relay.axes:
        left.append("The other two axes of the relay: only the normal one is judged, as the relay's file has no "
                    "participations of the modes in others.")  # fmt: skip
    return judged, left


def versions(assessment: Assessment, component: Component) -> list[tuple[str, str, str]]:
    """Return version and hash of all that the results come from."""
    described, own = component.description, digest(component.path.read_bytes())
    try:
        package = version("relay-contact")
    except PackageNotFoundError:
        package = "from its folder"
    return [
        ("component", f"{described.modelName} {described.version}, {described.guid}", own),
        ("package", f"relay-contact {package}", ""),
        ("relay", assessment.relay.title, assessment.relay.digest),
        ("standard", assessment.standard.title, assessment.standard.digest),
    ]


def warned(tests: list[Tested]) -> list[str]:
    """Return the first warning of each kind, and which tests it is of, unless of all."""
    found = [each for tested in tests for each in tested.models]
    kinds: dict[str, list[str]] = {}
    for each in found:
        several = f", {each.model}" if len(tests[0].models) > 1 else ""
        for text in each.warnings:
            kinds.setdefault(DIFFERENCE.sub("", text), [text]).append(f"{each.named}, {each.position}{several}")
    return [text if len(of) == len(found) else f"{'; '.join(of)}: {text}" for text, *of in kinds.values()]


def html(assessment: Assessment, component: Component, date: str) -> str:
    """Return the page."""
    relay, standard, tests = assessment.relay, assessment.standard, assessment.tests
    judged, not_judged = scope(relay, standard)
    sources = [(test.name, str(test), test.clause, evidence_told(test.evidence)) for test in standard.tests]
    return pages.render(
        "qualification.html", title=f"{relay.title}: {standard.title}", relay=relay.title, standard=standard.title,
        counts=assessment.counts, date=date,
        warnings=warned(tests), judged=judged, not_judged=not_judged,
        margins=pages.svg(plots.margins(tests)),
        positions=[position_context(assessment, component, name, values) for name, values in relay.positions.items()],
        head=HEAD, reasons=REASONS, fills=FILLS, several=len(relay.models) > 1, first_model=relay.models[0].name,
        inputs=inputs(component, relay), springs=springs(relay), limit=limit(standard), sources=sources,
        fewest=FEWEST, draws=DRAWS, many=statistics.MANY, versions=versions(assessment, component),
    )  # fmt: skip


def limit(standard: Standard) -> str:
    """Return what fails a contact, in words."""
    known = standard.contacts
    return (
        f"A closed contact fails if it is interrupted for {time_text(known.opening)} or more, that is, if its "
        f"resistance exceeds {three(known.threshold)} Ω, at which it takes half of a monitor's {known.voltage:g} V; an "
        f"open one if it conducts better than that for {time_text(known.false_make)} or more ({known.clause}; "
        f"{evidence_told(known.evidence)})."
    )


def write(assessment: Assessment, component: Component, date: str = "", pdf: bool = False) -> None:
    """Write page and tables."""
    folder = assessment.folder
    with mpl.rc_context(pages.STYLE):
        page = html(assessment, component, date)
    write_at_once(folder / FILES[0], page)
    assessment.write()
    if pdf:
        pages.write_pdf(page, folder / PDF)
