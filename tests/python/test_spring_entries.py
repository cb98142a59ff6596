"""Entries of spring files as parameters: varied in the component, and uncertain in the file of a relay."""

from pathlib import Path
from typing import Any

import pytest

from component import COMPONENT, ROOT, resting
from qualified import described, placed
from relay_contact import RelayContactError, Values
from relay_contact.qualification import Relay
from relay_contact.qualification.distributions import Distribution
from relay_contact.qualification.excitation import Shock

SEGMENTS = ROOT / "scenes/springs/tapered-cube.toml"
MODES = ROOT / "scenes/springs/tapered-cube-modes.toml"


def frequency(values: Values) -> float:
    """Give the first frequency of the open spring, Hz."""
    return resting({**values, "contact.overtravel": -1e-3}, "preload.frequency")[0]


@pytest.mark.parametrize("file", ["", str(SEGMENTS), str(MODES)])
def test_stiffness_is_that_of_the_whole_spring(file: str) -> None:
    values: Values = {"beam.file": file, "beam.youngsModulus": 2e11}
    # Also with parameters spelled for Python.
    stiffer = frequency({"beam_file": file, "beam_youngsModulus": 2e11, "spring.stiffness": 1.21})
    # Clamp included: frequencies rise with its root.
    assert stiffer == pytest.approx(1.1 * frequency(values), rel=1e-9)
    if file != str(MODES):
        return
    closed: Any = {"beam.file": file, "contact.overtravel": 1e-3, "contact.curvatureRadius": 1.0}
    pairs = (resting({**closed, "spring.stiffness": k}, "preload.force", "preload.indentation") for k in (1, 1.21))
    own, stiff = (force / (1e-3 - indentation) for force, indentation in pairs)
    assert stiff == pytest.approx(1.21 * own, rel=1e-9)
    with COMPONENT.started({**closed, "spring.stiffness": 1.21}) as contact:
        # Of a modulus that nobody has set, and that modes do not have.
        assert "youngsModulus" not in "".join(contact.warnings)


def test_stiffness_is_that_of_both_twin_contacts(tmp_path: Path) -> None:
    """Also of a parallel contact with a compliance of its own."""
    file = tmp_path / "modes.toml"
    mode = "[[mode]]\nfrequency = 300.0\ncontact = 130.0\nparticipation = 0.01\nparallel = 130.0\n"
    file.write_text(f"compliance = 5e-3\nparallel_compliance = 5.2e-3\n{mode}")
    # The first contact stays open.
    values: Values = {"beam.file": str(file), "effects.parallelContact": True, "contact.overtravel": -1e-3,
                      "parallel.offset": -2e-3, "parallel.curvatureRadius": 1.0}  # fmt: skip
    soft, own, stiff = (resting({**values, "spring.stiffness": k}, "parallel.force")[0] for k in (0.9, 1.0, 1.2))
    assert (soft, stiff) == pytest.approx((0.9 * own, 1.2 * own), rel=1e-4)


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("spring.thickness", "thickness = 2e-4", "thickness = 2.2e-4"),
        ("spring.segment.2.width", "4e-3\nwidth_end = 2.4e-3", "4.4e-3\nwidth_end = 2.64e-3"),
        ("spring.mass.1.mass", "mass = 4e-6", "mass = 4.4e-6"),
        ("spring.clamp_stiffness", "clamp_stiffness = 1.2", "clamp_stiffness = 1.32"),
    ],
)
def test_an_entry_is_that_of_the_file(tmp_path: Path, name: str, old: str, new: str) -> None:
    text = SEGMENTS.read_text()
    assert old in text
    edited, marked = (tmp_path / f"{each}.toml" for each in ("edited", "marked"))
    edited.write_text(text.replace(old, new))
    # As some editors begin a file in UTF-8.
    marked.write_text(text, encoding="utf-8-sig")
    expected = frequency({"beam.file": str(edited)})
    assert frequency({"beam.file": str(marked), name: 1.1}) == pytest.approx(expected, rel=1e-12)


def test_uncertain_entries_make_margins_uncertain(tmp_path: Path) -> None:
    """A slow shock: the preload goes with the cube of the thickness, what is shaken with its first power."""
    rigid = tmp_path / "rigid.toml"
    rigid.write_text("\n".join(line for line in SEGMENTS.read_text().splitlines() if "clamp" not in line))
    values: Values = {"beam.stiffnessDamping": 5e-6, "contact.overtravel": 8e-4, "tip.mass": 0.0}
    parts = {"spring.thickness": Distribution(part=0.02), "spring.stiffness": Distribution(part=0.05)}
    test = Shock("slow", "", "from memory", 20.0, 0.1)
    position = placed(described({**values, "beam.file": str(rigid)}, parts), test)
    own = position.linear(position.specimen.response, test)
    chance = position.chance(test, position.margins(test, own), own)
    effects = chance.effects
    # The mass that the spring carries beside its own is not as thick.
    assert 2 * 0.02 < effects["spring.thickness"] < 3 * 0.02
    # 10 us, the indentation, and the vibration of the spring itself, 5 Hz over 1600 Hz.
    assert effects["spring.stiffness"] == pytest.approx(0.05, rel=5e-3)


def test_a_draw_that_is_refused_is_told_to_be_one() -> None:
    """Beyond the ends of its interval, at which a file is read."""
    values: Values = {"beam.file": str(MODES), "contact.overtravel": 8e-4}
    test = Shock("slow", "", "from memory", 20.0, 0.1)
    position = placed(described(values, {"spring.compliance": Distribution(part=0.5)}), test)
    with pytest.raises(RelayContactError, match=r"a draw of the uncertain parameters, spring.compliance = 0.5: "):
        position.margins(test, 1.0)


def test_unknown_entries_are_explained(tmp_path: Path) -> None:
    file = tmp_path / "relay.toml"
    entry = "uncertainty.spring.segment.3.thickness"
    file.write_text(f"parameters.beam.file = '{SEGMENTS}'\n{entry} = 0.02\n")
    with pytest.raises(RelayContactError, match=f"relay.toml:2: {entry}: no such entry.*did you mean"):
        Relay.read(file, COMPONENT)
    with pytest.raises(RelayContactError, match=r"spring.thickness: no such entry; there are spring.stiffness"):
        frequency({"spring.thickness": 1.1})


def test_what_is_refused_of_a_changed_spring_names_the_file_of_the_user() -> None:
    with pytest.raises(RelayContactError) as refused:
        COMPONENT.started({"beam.file": str(SEGMENTS), "spring.thickness": 1e3})
    assert f"{SEGMENTS}:" in str(refused.value)
    assert str(COMPONENT.folder) not in str(refused.value)


def test_the_spring_of_the_fixed_contact_has_entries_of_its_own(tmp_path: Path) -> None:
    """Neither spring changes with the other, although both have their modulus from the same parameter."""
    strip = tmp_path / "strip.toml"
    strip.write_text("[[segment]]\nlength = 0.01\nwidth = 4e-3\nthickness = 3e-4\n")

    def compliances(changes: dict[str, float]) -> tuple[float, float]:
        """Return those of the moving and of the fixed contact's spring, m/N."""
        values: Values = {"contact.overtravel": 1e-3, "fixed.file": str(strip), **changes}
        force, moving, fixed = resting(values, "contact.force", "tip.displacement", "fixed.displacement")
        return moving / force, -fixed / force

    moving, fixed = compliances({})
    for name, factor, of_moving, of_fixed in (
        ("fixed.spring.thickness", 1.1, 1.0, 1.1**-3),
        ("fixed.spring.segment.1.width", 1.3, 1.0, 1 / 1.3),
        ("fixed.spring.stiffness", 1.2, 1.0, 1 / 1.2),
        ("spring.stiffness", 1.2, 1 / 1.2, 1.0),
    ):
        assert compliances({name: factor}) == pytest.approx((of_moving * moving, of_fixed * fixed), rel=1e-9), name
    both = compliances({"spring.stiffness": 1.2, "fixed.spring.stiffness": 0.9})
    assert both == pytest.approx((moving / 1.2, fixed / 0.9), rel=1e-9)
    with pytest.raises(RelayContactError, match=r"fixed\.spring\.thickness: no such entry"):
        COMPONENT.started({"fixed.spring.thickness": 1.1})
