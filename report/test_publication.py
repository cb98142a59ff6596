"""The closed forms of the report against the component, and against what other solutions of the model agree on."""

import numpy as np
import pandas as pd
import pytest

from relay_contact import Component, Contact, Values, fmu_path
from report import accuracy, effects, fit, opening
from report.bench import Bench, specimen
from report.effects import effects as listed
from report.files import DOCS
from report.published import FORCE_AMPLITUDE, FREQUENCIES, PEAKS, WITH_PRESTRESS, numbers
from report.spring import PARAMETERS, Materials, Specimen, Spring, elastic_reading, identified

COMPONENT = Component(fmu_path())
NO_AXIAL: Values = {"effects.axialForce": "None"}


@pytest.fixture(scope="module")
def bench() -> Bench:
    return Bench(COMPONENT)


@pytest.fixture
def contact(bench: Bench) -> Contact:
    bench.contact.begin_anew({**specimen(COMPONENT), **NO_AXIAL})
    return bench.contact


@pytest.mark.parametrize("frequency", [250.0, 1250.0, 2000.0])
def test_amplitudes_of_the_component_are_those_of_the_closed_form_but_for_the_square_of_the_force(
    bench: Bench, frequency: float
) -> None:
    values = specimen(COMPONENT)
    period = bench.vibrate(values, frequency)
    bench.contact.begin_anew(values)
    spring = Spring.of(bench.contact)
    # The force amplitude is a third of the static force; what its square adds is below a thousandth of it.
    assert period.amplitude == pytest.approx(spring.force(frequency)[0], rel=1e-3)
    assert period.elastic_amplitude == pytest.approx(spring.elastic(frequency)[0], rel=1e-3)
    # At the clamp it moves with the base, to the rounding of the largest term of the sum, a free mass: 1/omega^2.
    assert abs(spring.deflection(frequency, 0.0)[0]) < 1e-14 / (2 * np.pi * frequency) ** 2


def test_a_force_that_opens_the_contact_is_told(bench: Bench) -> None:
    assert bench.vibrate(specimen(COMPONENT, 0.1), 1250.0).least == 0.0


def test_the_identified_specimen_has_the_published_results_and_the_start_values(contact: Contact) -> None:
    found = identified(Materials.of(contact))
    assert found.spring.force(1000.0)[0] == pytest.approx(FORCE_AMPLITUDE, rel=1e-9)
    # Start values are rounded to four or five digits, that of the rivet to three.
    for (name, *_), value, exact in zip(PARAMETERS, Specimen.of(contact).values, found.values, strict=True):
        assert value == pytest.approx(exact, rel=2.5e-3 if "rivet" in name else 3e-4), name
    # And the component has the published first frequency with them.
    values = {"beam.width": 1e-3 * found.values[3], "beam.thickness": 1e-3 * found.values[4],
              "tip.mass": 1e-6 * found.values[5], "contact.curvatureRadius": 1e-3 * found.values[0]}  # fmt: skip
    with COMPONENT.started({**NO_AXIAL, **values}) as exact_contact:
        assert exact_contact.get("preload.frequency") == pytest.approx(WITH_PRESTRESS, rel=1e-9)


def test_the_elastic_part_fits_both_amplitudes_it_is_fitted_to(contact: Contact) -> None:
    (_, frequency, amplitude), *_ = PEAKS
    spring = elastic_reading(Materials.of(contact), frequency, amplitude).spring
    assert spring.elastic([1000.0, frequency]) == pytest.approx([FORCE_AMPLITUDE, amplitude], rel=1e-8)


def test_contact_damping_is_not_what_separates_the_domains(bench: Bench) -> None:
    # The contact is stiff against the spring: what it has of the force is what the spring brings.
    for ratio in (10.0, 20.0, 30.0):
        forces = []
        for damping in (specimen(COMPONENT, ratio)["contact.damping"], 0.0):
            bench.contact.begin_anew(specimen(COMPONENT, ratio) | {"contact.damping": damping})
            forces.append(Spring.of(bench.contact).force(np.array(FREQUENCIES)))
        assert forces[1] == pytest.approx(forces[0], rel=0.01)


def test_the_rough_scene_has_the_numbers_of_the_fit_which_are_a_minimum(bench: Bench) -> None:
    asked = [number for number in numbers() if number.fitted]
    known = np.array([number.published for number in asked])
    law = fit.LAWS[1]
    free = pd.read_csv(fit.PARAMETERS, index_col=["contact", "parameter"]).value[law.name].drop("rms").to_numpy()
    stored = pd.read_csv(fit.TABLE)[law.name].to_numpy()
    assert fit.values_of(bench, law.values(COMPONENT, free), numbers()) == pytest.approx(stored, rel=1e-3)

    def residual(at: np.ndarray) -> float:
        found = fit.values_of(bench, law.values(COMPONENT, at), asked)
        return float(np.sqrt(np.mean(np.log(found / known) ** 2)))

    least = residual(free)
    # Each number takes on a few times the rounding of the parameters, of four digits.
    assert least == pytest.approx(0.0597, abs=2e-4)
    for place in range(len(free)):
        for factor in (0.97, 1.03):
            moved = free.copy()
            moved[place] *= factor
            assert residual(moved) > least, (place, factor)


def test_thresholds_of_the_opening_are_those_between_a_closed_and_an_open_contact() -> None:
    found = opening.thresholds(2000.0)
    # Linear theory is right to a thousandth where the force amplitude is a third of the preload; its error is of second
    # order.
    assert found.opens == pytest.approx(found.linear, rel=9e-3)
    # Found by an importer's user: 52 g after a sudden start, 65 g in steady vibration.
    assert (found.sudden, found.interrupts) == pytest.approx((52.0, 65.0), abs=0.5)


def test_the_advice_on_the_tolerance_answers_its_questions() -> None:
    page = (DOCS / "accuracy.md").read_text(encoding="utf-8")
    asked = {"contact resistance": (1e-3, "paper", 7e-3), "impact force": (1e-3, "closing bounce", 1e-2)}
    delivered = accuracy.delivered(page)
    for words, (tolerance, scene, allowed) in asked.items():
        (line,) = [line for line in page.splitlines() if line.startswith("|") and words in line]
        assert float(line.split("|")[2]) == tolerance
        # Smaller tolerances answer it, too.
        errors = [each[accuracy.SCENES.index(scene)] for known, each in delivered.items() if known <= tolerance]
        assert errors
        assert max(errors) <= allowed


def test_the_page_of_effects_has_every_effect() -> None:
    heads = [line.split("|")[1].partition(" (")[0].strip()
             for line in effects.PAGE.read_text(encoding="utf-8").splitlines() if line.startswith("|")]  # fmt: skip
    for effect in listed():
        assert heads.count(effect.name) == (2 if effect.off else 1), f"{effect.name}: cargo xtask effects"
