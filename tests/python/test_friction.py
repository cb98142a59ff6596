"""Friction between the contacts, by motions solved by other means (frictional.py)."""

import re
from dataclasses import dataclass
from functools import cache
from math import pi

import numpy as np
import pytest

from component import COMPONENT, run
from frictional import FrictionalMotion, Phase
from reference import Reference
from relay_contact import Array, Contact, Scene, Values
from relay_contact import run as run_scene
from relay_contact.component import half_sine, sine

TOLERANCE, STEP = 1e-6, 5e-6
# Instants are located to 1 ns.
LOCATED = 1e-9
SLIDING: Values = {"effects.axialForce": "None", "effects.friction": "Coulomb", "solver.tolerance": TOLERANCE}
SHAKEN: Values = {**SLIDING, **sine(1000.0, 98.0)}
MANY: Values = {"solver.modes": 24}


def struck(amplitude: float, duration: float, beam: float, contact: float, friction: float) -> Values:
    """Give a shock (m/s2, s) with the damping (s) of beam and contact and a coefficient of friction, by many modes."""
    damping = {"beam.stiffnessDamping": beam, "contact.damping": contact}
    return {**SLIDING, **half_sine(amplitude, duration), **damping, "friction.coefficient": friction, **MANY}


FORCES, WAYS = ["contact.force", "contact.tangentialForce"], ["contact.slip", "contact.slipDistance"]
ENERGY, INSTANTS = "friction.energy", ["contact.lastOpening", "contact.lastClosing"]
OUTPUTS = [*FORCES, *WAYS, ENERGY, *INSTANTS]
MOTIONS: dict[str, tuple[Values, float]] = {
    "sticks": ({**SHAKEN, "friction.coefficient": 10.0, "friction.initial": 0.0}, 2e-3),
    "slips": (SHAKEN, 2e-3),
    "slips without damping of the contact": ({**SHAKEN, "effects.contactDamping": False}, 2e-3),
    "slips on a high contact": ({**SHAKEN, "tip.contactHeight": 3e-3, "friction.initial": 0.5}, 2e-3),
    "opens": ({**SHAKEN, "beam.stiffnessDamping": 1e-5, "contact.damping": 1e-5, "excitation.frequency": 1350.0}, 3e-3),
    "shock": ({**SLIDING, **half_sine(-490.0, 1e-3)}, 2e-3),
    # Friction is at its limit from the start.
    "slips at once": (struck(-2062.0, 2.059e-4, 5.253e-6, 1.393e-5, 0.288), 1e-3),
    # Its damper lets go of the indented contact, which closes again before the indentation is gone.
    "closes while indented": (struck(-793.0, 2.717e-4, 2.763e-6, 1.084e-4, 0.2873), 1e-3),
    "no friction": ({**SHAKEN, "friction.coefficient": 0.0}, 2e-3),
}
OPENING = {"opens", "shock", "slips at once", "closes while indented"}


@dataclass
class Results:
    """What component and reference give."""

    found: dict[str, Array]
    expected: dict[str, Array]
    changes: dict[tuple[str, str], list[float]]
    motion: FrictionalMotion
    reference: Reference


@cache
def results(name: str) -> Results:
    """Run the component and the reference."""
    values, stop = MOTIONS[name]
    found = run(values, stop, STEP, OUTPUTS)
    motion = FrictionalMotion(Reference(values), 1e-12)
    return Results(found, *motion.outputs(found["time"]), motion, motion.relay)


def allowed(reference: Reference, expected: dict[str, Array]) -> dict[str, float]:
    """Give the errors allowed in outputs: the tolerance relative to the largest force, and to what belongs to it."""
    force = TOLERANCE * max(reference.force_scale, np.max(expected["contact.force"]))
    limit = reference.coefficient * reference.force
    # What the tangential spring yields before it slips counts where the contact sticks.
    yields = limit / reference.tangential
    ways = {each: TOLERANCE * max(yields, np.max(np.abs(expected[each]))) for each in WAYS}
    return dict.fromkeys(FORCES, force) | ways | {ENERGY: TOLERANCE * max(limit * yields, expected[ENERGY][-1])}


@pytest.mark.parametrize("name", MOTIONS)
def test_forces_slip_and_energy(name: str) -> None:
    own = results(name)
    found, expected = own.found, own.expected
    # Where the contact opens or closes forces change as a root of time, and a sample may be on either side.
    changes = np.concatenate([[0.0], *own.changes.values()])
    away = np.min(np.abs(found["time"][:, None] - changes), axis=1) > 2 * LOCATED
    coarser, _ = FrictionalMotion(own.reference, 1e-11).outputs(found["time"])
    for output, error in allowed(own.reference, expected).items():
        # In flight, where slip makes no force, no step is as short as its course would need.
        seen = away & (expected["contact.force"] > 0) if output == "contact.slip" else away
        # The reference's own error is less than this difference.
        assert np.max(np.abs(coarser[output] - expected[output])[seen]) <= 0.3 * error, output
        assert np.max(np.abs(found[output] - expected[output])[seen]) <= error, output


@pytest.mark.parametrize("name", MOTIONS)
def test_the_instants_of_opening_and_closing(name: str) -> None:
    own = results(name)
    expected = [own.changes.get(("contact", what), []) for what in ("leaves", "closes")]
    assert bool(expected[0]) == (name in OPENING)
    for output, instants in zip(INSTANTS, expected, strict=True):
        seen = np.unique(own.found[output])
        assert seen[seen > 0] == pytest.approx(instants, rel=0, abs=LOCATED)


def test_the_motions_are_what_their_names_say() -> None:
    phases = {name: set(results(name).motion.phases) for name in MOTIONS}
    assert phases["sticks"] == {Phase.STICK}
    for name in ("slips", "slips without damping of the contact", "slips on a high contact"):
        assert phases[name] == {Phase.STICK, Phase.FORTH, Phase.BACK}
    assert all(phases[name] == set(Phase) for name in OPENING)
    own = results("closes while indented")
    assert max(own.motion.depths) > 0.1 * own.reference.indentation


@pytest.mark.parametrize(
    "values",
    [
        {},
        {"friction.initial": 1.0, "friction.coefficient": 3.0},
        {"friction.initial": -0.3, "tip.contactHeight": 5e-3, "effects.axialForce": "FromPreload"},
        {"effects.axialForce": "Prescribed", "beam.axialForce": 2.0, "environment.gravity": 9.81},
    ],
)
def test_the_preload_holds_the_friction_that_closing_left(values: Values) -> None:
    values = {"effects.axialForce": "None", "effects.friction": "Coulomb", **values}
    outputs = ["contact.force", "contact.tangentialForce", "contact.slip", "contact.indentation"]
    found = {name: course[0] for name, course in run(values, STEP, STEP, outputs).items()}
    reference = Reference(values)
    friction = reference.share * reference.force
    expected = [reference.force, friction, friction / reference.tangential, reference.indentation]
    assert reference.force != pytest.approx(Reference({**values, "friction.initial": 0.0}).force, rel=1e-3)
    # Static equilibrium by two roots of one equation.
    assert [found[name] for name in outputs] == pytest.approx(expected, rel=1e-11)


def test_friction_decides_whether_the_contact_opens() -> None:
    scene = Scene.read("friction-opening")
    outputs = ["chatter.count", "step.minimumForce"]
    count, least = (run_scene(scene, outputs=outputs)[name] for name in outputs)
    assert count[-1] == 0
    # Far from opening, a quarter of the preload.
    assert least[1:].min() > 0.25 * Reference(scene.values).force
    assert run_scene(scene, outputs=outputs, friction_coefficient=0.0)["chatter.count"][-1] > 10


# Random relays that are above their tolerance, by the numbers of docs/friction.md: what all have, and what some have.
NAMES = (
    "beam.stiffnessDamping", "tip.mass", "tip.contactHeight", "contact.overtravel", "contact.curvatureRadius",
    "contact.damping", "friction.coefficient",
)  # fmt: skip
UNSTABLE: dict[int, tuple[tuple[float, ...], Values]] = {
    40070: (
        (1.92855e-6, 3.0442e-7, 7.1475e-4, 2.3432e-5, 8.2912e-4, 1.16634e-5, 0.80547),
        {"beam.length": 8.383e-3, "beam.width": 1.3575e-3, "beam.thickness": 1.214e-4, "beam.youngsModulus": 1.3904e11,
         "beam.density": 7314.3},
    ),
    40345: (
        (1.801806e-5, 4.024318e-4, 2.67712e-3, 6.57304e-5, 3.380915e-4, 1.605229e-5, 0.607796),
        {"effects.axialForce": "Prescribed", "beam.axialForce": 4.47786, "beam.massDamping": 15.3542},
    ),
    40418: (
        (3.0424e-5, 2.4157e-5, 3.73403e-3, 2.25786e-4, 3.4036e-3, 5.42652e-5, 0.68562),
        {"effects.axialForce": "FromPreload", "environment.gravity": 9.81, "beam.length": 3.0417e-2,
         "beam.width": 2.07767e-3, "beam.thickness": 2.68444e-4, "beam.youngsModulus": 1.54939e11,
         "beam.density": 8601.4},
    ),
}  # fmt: skip


def warnings(values: Values) -> list[str]:
    """Give what the component warns of as it is initialised."""
    with Contact(COMPONENT) as contact:
        contact.begin(values)
        return contact.warnings


@pytest.mark.parametrize("number", UNSTABLE)
def test_unstable_slip_is_told(number: int) -> None:
    numbers, others = UNSTABLE[number]
    own = dict(zip(NAMES, numbers, strict=True))
    values = {"effects.axialForce": "None", **own, **others, "effects.friction": "Coulomb", **MANY}
    relay, calmer = Reference(values), {**values, "friction.coefficient": 0.02}
    shares = 1, 1 / 4, 4, 1 / 16, 16
    forces = [share * relay.force for share in shares]
    force, growing = next((force, value) for force in forces if (value := relay.growth(force, -1.0)).real > 0)
    assert growing.real > 1000
    (told,) = warnings(values)
    assert "slip away from the clamp is unstable" in told
    found = [float(each) for each in re.findall(r"(\S+) (?:N|1/s|Hz)\b", told)]
    # Three digits.
    assert found == pytest.approx([force, growing.real, abs(growing.imag) / (2 * pi)], rel=5e-3)
    # Not towards the clamp, nor with little friction.
    stable = Reference(calmer)
    assert all(relay.growth(force, 1.0).real < 0 for force in forces)
    assert all(stable.growth(share * stable.force, sign).real < 0 for share in shares for sign in (-1.0, 1.0))
    assert warnings(calmer) == []
