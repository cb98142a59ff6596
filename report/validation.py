"""The numbers of docs/validation.md, and its tables of what was fitted."""

from typing import Any

import numpy as np
import pandas as pd
from scipy.optimize import brentq

from relay_contact import Scene
from relay_contact.figures import significant
from report import fit, fit_figures, plots
from report import published as paper
from report.figure import Figure
from report.publication import Publication
from report.published import FORCE, RATIOS
from report.spring import PARAMETERS, RIVET, SOURCES, Specimen, identified, sensitivities
from report.text import number, percent, rendered, signed, table

CONTACTS = {"Hertz": "smooth spheres", "Rough": "rough contact", "support": "support that yields"}


def row(published: float, value: float, digits: int, unit: str = "") -> str:
    """Return the cells of a published value: it, the component's, and the relative deviation."""
    unit = f" {unit}" if unit else ""
    return f"{published:g}{unit} | {number(value, digits)}{unit} | {percent(value / published)}"


def difference(published: float, value: float, digits: int, unit: str) -> str:
    """Return the same cells with the difference."""
    return f"{published:g} {unit} | {number(value, digits)} {unit} | {signed(value - published, digits)} {unit}"


def points(published: float, value: float) -> str:
    """Return the same cells for percentages, with the difference of their magnitudes."""
    return f"{published:g} % | {signed(value, 2)} % | {signed(abs(value) - abs(published), 2)} points"


def figures(of: Publication) -> list[Figure]:
    """Return the figures of docs/validation.md."""
    return [*plots.figures(of), *fit_figures.figures()]


def page(of: Publication, figures: list[Figure]) -> tuple[str, dict[str, str]]:
    """Return docs/validation.md, and what its sections say in a sentence, by their titles."""
    shared = {"of": of, "paper": paper, "row": row, "difference": difference, "points": points, "eq9": prestress(of)}
    return rendered("validation.md", figures, shared | reproduced(of) | identification(of) | fitted_contacts())


def reproduced(of: Publication) -> dict[str, Any]:
    """Return numbers of the sections on what is reproduced and what is not."""
    inverted = []
    for _, least, greatest in paper.RESISTANCE_DEVIATIONS:
        high = paper.force(paper.LEAST_RESISTANCE * (1 + 0.01 * least))
        low = paper.force(paper.GREATEST_RESISTANCE * (1 - 0.01 * greatest))
        inverted.append(((high + low) / 2, 50 * (high - low)))
    found = np.abs([of.deviations(ratio) for ratio, *_ in paper.RESISTANCE_DEVIATIONS])
    weakly = of.spring(RATIOS[0])
    places = np.linspace(0, 1, 101)
    shape = [abs(weakly.deflection(of.rest("preload.frequency"), place)[0]) for place in places]
    alphas, apart = of.by_alpha
    return {
        "most_excess": np.ceil(np.abs(of.excess()).max()),
        "inverted": inverted,
        "furthest": float(found[:, 1].max()), "nearest": float(found[:, 0].min()),
        "best_alpha": alphas[int(np.argmin(apart))],
        "shape": {"tip": shape[-1] / max(shape), "place": float(places[int(np.argmax(shape))])},
        "scene_rivet": 1e6 * float(Scene.read("paper-elastic").values["tip.mass"]),
        "misfits": of.misfits(),
    }  # fmt: skip


def prestress(of: Publication) -> dict[str, Any]:
    """Return what the axial force of eq. 9 does, and which force the published shift of the frequency asks for."""
    first, axial, buckling = of.rest("preload.frequency"), of.rest("preload.axialForce"), of.spring().buckling
    without = of.rest("preload.frequency", effects_axialForce="None")
    shift, known = without - first, paper.WITHOUT_PRESTRESS - paper.WITH_PRESTRESS
    wanted = without * paper.WITH_PRESTRESS / paper.WITHOUT_PRESTRESS

    def excess(force: float) -> float:
        return of.rest("preload.frequency", effects_axialForce="Prescribed", beam_axialForce=force) - wanted

    needed = brentq(excess, 0.0, 0.99 * buckling)
    return {
        "force": 1e3 * axial, "shift": shift, "times": known / shift, "needed": needed,
        "part": 100 * needed / buckling, "buckling": buckling,
    }  # fmt: skip


def identification(of: Publication) -> dict[str, Any]:
    """Return what was identified, and how it depends on what is published."""
    found, elastic = (identified(of.materials, elastic=each).values for each in (False, True))
    slopes = sensitivities(of.materials, [1e-3] * len(SOURCES))
    rounding = sensitivities(of.materials, [source.rounding for source in SOURCES])
    with of.component.started() as contact:
        starts = Specimen.of(contact).values
    return {
        "identified": zip(PARAMETERS, found, starts, strict=True),
        "sensitivities": zip(SOURCES, slopes, strict=True),
        "found_width": float(found[3]), "slope": float(0.01 * slopes[2][RIVET]),
        "precision": 100 * abs(float(rounding[0][RIVET])) * SOURCES[0].rounding, "elastic_rivet": float(elastic[RIVET]),
    }  # fmt: skip


def fitted_contacts() -> dict[str, Any]:
    """Return the tables and numbers of the three contacts that were fitted."""
    numbers = pd.read_csv(fit.TABLE, keep_default_na=False)
    parameters: Any = pd.read_csv(fit.PARAMETERS, index_col=["contact", "parameter"]).fillna({"unit": ""})

    def find(text: str) -> Any:  # noqa: ANN401
        return numbers[numbers.quantity.str.contains(text, regex=False)].iloc[0]

    def deviation(own: Any, contact: str) -> str:  # noqa: ANN401
        value, known = own[contact], own.published
        apart = f"{signed(value - known, 0)} °" if own.unit == "°" else percent(value / known, 1)
        return f"{significant(value)} {own.unit}".strip() + f", {apart}"

    def compared(own: pd.DataFrame, *last: list[str]) -> str:
        rows = [
            [each.quantity, f"{each.published:.5g} {each.unit}".strip(),
             *(deviation(each, contact) for contact in CONTACTS), each.location]
            for _, each in own.iterrows()
        ]  # fmt: skip
        columns = ["quantity", "published", *CONTACTS.values(), "location in the publication"]
        return table(columns, [*rows, *last])

    def cell(contact: str, name: str) -> str:
        if (contact, name) not in parameters.index:
            return ""
        unit, value, low, high = parameters.loc[(contact, name)]
        interval = f" ({significant(low, 3)} to {significant(high, 3)})"
        return f"{significant(value, 3)} {unit}".strip() + (", undetermined" if high > 100 * low else interval)

    fitted, others = (numbers[numbers.fitted == each] for each in (1, 0))
    rms = {contact: float(parameters.value[contact, "rms"]) for contact in CONTACTS}
    lines = [[name, *(cell(contact, name) for contact in CONTACTS)] for name in parameters.loc["Rough"].index[1:]]
    # Those fitted, and the displacement with the weakest damping, which stands first among the others.
    with_weakest = pd.concat([fitted, others[:1]])
    stiffness = parameters.value.xs("contact stiffness at 0.152 N", level="parameter")
    exponent = parameters.value["Rough", "exponent of the stiffness"]
    rest = find("resistance at rest")
    law = stiffness.Rough * rest.Rough / rest.published
    short = [find(text) for text in ("s = 0.45 mm", "L = 7.5 mm")]
    return {
        "rms": rms,
        "fitted": compared(fitted, ["**rms**", "", *(f"**{number(each, 1)} %**" for each in rms.values()), ""]),
        "others": compared(others),
        "fits": table(["parameter", *CONTACTS.values()], lines),
        "find": find, "stiffness": stiffness,
        "with_weakest": {contact: 100 * np.mean(np.log(with_weakest[contact] / with_weakest.published) ** 2) ** 0.5
                         for contact in CONTACTS},
        "worst_rough": np.ceil(100 * (fitted.Rough / fitted.published - 1).abs().max()),
        "short": {contact: [percent(each[contact] / each.published, 1) for each in short] for contact in CONTACTS},
        "law_stiffness": law, "exponent": exponent,
        "crossing": FORCE * (stiffness.Rough / law) ** (1 / (paper.EXPONENT - exponent)),
    }  # fmt: skip
