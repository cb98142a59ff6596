"""Many scenes at once: what each gives alone, in their order, whatever the others do."""

import pickle
import re
import threading
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from fmpy.fmi1 import FMICallException

from component import COMPONENT
from relay_contact import RelayContactError, RelayContactWarning, Result, Scene, Values, run, run_many, side_by_side
from relay_contact.component import Component, FMU2Functions, warnings_kept
from relay_contact.many import SHARE, Case, cores

CHATTER = "chatter-41g"
FREQUENCIES = [300.0, 500.0, 700.0, 1000.0]


def levels() -> list[tuple[str, Values]]:
    return [(CHATTER, {"excitation.frequency": each, "excitation.amplitude": 900.0}) for each in FREQUENCIES]


@pytest.mark.parametrize("workers", [None, 1, 2, 7])
def test_rows_are_in_order_and_those_of_each_alone(workers: int | None) -> None:
    """Bit by bit; scenes of different length and with inputs over time do not end in their order."""
    cases: list[tuple[str, Values]] = [
        *levels(),
        ("closing-bounce", {}),
        ("paper-1khz", {"excitation_amplitude": 50.0}),
    ]
    told: list[int] = []
    table = run_many(cases, workers=workers, component=COMPONENT, progress=told.append)
    assert told == [1, 2, 3, 4, 5, 6]
    assert not table["error"].any()
    assert table["scene"].tolist() == [name for name, _ in cases]
    for (name, changes), (_, row) in zip(cases, table.iterrows(), strict=True):
        alone = run(name, component=COMPONENT, **dict[str, Any](changes))
        columns = list(alone.columns)[1:]
        assert len(columns) > 1
        for column in columns:
            assert row[column] == alone[column][-1], (name, column)
    assert table["excitation.amplitude"].tolist()[-1] == 50.0
    # Rows that could be confused would prove no order.
    assert len(set(table["chatter.longestInterruption"][:4])) == 4


def test_units_and_chosen_outputs() -> None:
    table = run_many(levels()[:1], outputs=["chatter_totalInterruption", "contact.closed"], component=COMPONENT)
    assert list(table) == ["scene", "excitation.frequency", "excitation.amplitude", "chatter.totalInterruption",
                           "contact.closed", "warning", "error"]  # fmt: skip
    units = {"excitation.frequency": "Hz", "excitation.amplitude": "m/s²", "chatter.totalInterruption": "s"}
    assert table.attrs["units"] == units
    assert table["contact.closed"][0] in (0.0, 1.0)


def test_a_scene_and_an_output_alone_are_one_each() -> None:
    table = run_many("paper-1khz", outputs="preload.force", component=COMPONENT)
    assert list(table) == ["scene", "preload.force", "warning", "error"]
    assert table["scene"].tolist() == ["paper-1khz"]
    assert table["error"].tolist() == [""]


def test_a_bad_scene_is_an_error_of_its_row_alone(tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.toml"
    wrong.write_text("stop = -1\n")
    untimed: Any = {"base.acceleration": [0.0]}
    bad: dict[Any, tuple[Case, str]] = {
        1: (("chatter-41", {}), r"chatter-41: no such file, and no scene"),
        2: ((CHATTER, {"excitation.frequenzy": 1.0}), r"did you mean excitation.frequency\?"),
        3: ((CHATTER, {"beam.length": -1.0}), r"^beam.length = -1 m: not allowed, allowed is"),
        # Found as it is initialised, and as it steps.
        5: ((CHATTER, {"effects.axialForce": "Prescribed", "beam.axialForce": 500.0}), r"buckles"),
        6: ((wrong, {}), r"wrong.toml:1: communicationStep: missing"),
        7: (Scene("endless", 1e30, 1e30, ["contact.force"], {"effects.excitation": "Sine"}, {}), r"spacing of time"),
        8: (Scene("in Python", 1e-3, 1e-5, ["contact.force"], {}, untimed), r'"time" is missing'),
    }  # fmt: skip
    cases = [bad[n][0] if n in bad else (CHATTER, {}) for n in range(10)]
    alone = run(CHATTER, component=COMPONENT)["contact.resistance"][-1]
    for workers in (1, 3):
        told: list[int] = []
        table = run_many(cases, workers=workers, component=COMPONENT, progress=told.append)
        assert told[-1] == len(told) == len(cases)
        for n, row in table.iterrows():
            if n in bad:
                assert pytest.approx(np.nan, nan_ok=True) == row["contact.resistance"]
                assert re.search(bad[n][1], row["error"]), (n, row["error"])
            else:
                assert (row["contact.resistance"], row["error"]) == (alone, "")


def test_an_instance_that_cannot_be_reset_is_freed_and_has_its_row(monkeypatch: pytest.MonkeyPatch) -> None:
    """As after a fatal error: the others are run, by instances of their own."""
    component = Component(COMPONENT.path)
    freed: list[object] = []
    free = FMU2Functions.freeInstance

    def fails(_self: FMU2Functions) -> None:
        raise FMICallException(function="fmi2Reset", status=4)

    def counted(self: FMU2Functions) -> None:
        freed.append(self)
        free(self)

    monkeypatch.setattr(FMU2Functions, "reset", fails)
    monkeypatch.setattr(FMU2Functions, "freeInstance", counted)
    table = run_many([CHATTER, "no-scene", CHATTER], workers=1, component=component)
    assert [bool(error) for error in table["error"]] == [False, True, False]
    assert len(freed) == len(set(map(id, freed))) == 2
    assert not component.idle


def test_of_several_failures_the_first_in_order_is_told() -> None:
    second = threading.Event()

    def work(item: int) -> None:
        if item == 0:
            assert second.wait(60)
            # Long after the other is known to have failed.
            time.sleep(0.2)
        second.set()
        raise ValueError(item)

    with pytest.raises(ValueError, match="0"):
        side_by_side(work, [0, 1, 2], 2)


def test_a_table_made_in_python_is_that_of_run() -> None:
    table: Any = {"time": [0.0, 1e-3], "base_acceleration": [0.0, 300.0]}
    scene = Scene("pressed", 1e-3, 1e-5, [*2 * ["contact.force"], "base.acceleration"], {}, table)
    pressed = run(scene, component=COMPONENT)["contact.force"]
    assert pressed[-1] > 1.2 * pressed[0]
    frame: Any = pd.DataFrame(table)
    assert np.array_equal(run(scene, inputs=frame, component=COMPONENT)["contact.force"], pressed)
    found = run_many([scene], component=COMPONENT)
    assert (found["contact.force"][0], found["base.acceleration"][0]) == (pressed[-1], 300.0)


def test_values_from_the_columns_of_a_table_are_those_of_python() -> None:
    single, modes = np.float32(2e-4), np.int64(9)
    changes: Any = {"effects.contactDamping": np.False_, "contact.overtravel": single, "solver.modes": modes}
    plain: Values = {"effects.contactDamping": False, "contact.overtravel": float(single), "solver.modes": 9}
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        table = run_many([(CHATTER, changes), (CHATTER, plain)], component=COMPONENT)
    assert table["error"].tolist() == ["", ""]
    assert table["contact.force"][0] == table["contact.force"][1]


def test_an_instance_that_is_given_back_twice_is_not_taken_from_the_next() -> None:
    with COMPONENT.started({"contact.overtravel": 1e-4}) as first:
        first.give_back()
        with COMPONENT.started({"contact.overtravel": 3e-4}) as second:
            force = second.get("contact.force")
            first.give_back()
            second.step(0.0, 1e-5)
            assert second.get("contact.force") == pytest.approx(force, rel=1e-9)
    assert len(set(map(id, COMPONENT.idle))) == len(COMPONENT.idle)


def test_none_are_an_empty_table() -> None:
    table = run_many([], component=COMPONENT)
    assert list(table) == ["scene", "warning", "error"]
    assert len(table) == 0


@pytest.mark.parametrize("workers", [0, -1, 1.5, True, "2"])
def test_other_numbers_of_workers_are_refused(workers: int) -> None:
    with pytest.raises(RelayContactError, match=r"workers = .*: not allowed, allowed is a whole number greater than 0"):
        run_many([CHATTER], workers=workers, component=COMPONENT)


def test_an_unknown_output_is_refused_before_anything_runs() -> None:
    with pytest.raises(RelayContactError, match=r"contact.forze: no such variable; did you mean contact.force\?"):
        run_many([CHATTER], outputs=["contact.forze"], component=COMPONENT)


@pytest.mark.parametrize("wrong", [[CHATTER, {}], (CHATTER, None), (CHATTER, {}, 1), {"tip.mass": 1e-4}, None])
def test_a_row_that_is_no_scene_is_refused_before_anything_runs(wrong: Any) -> None:  # noqa: ANN401
    done: list[int] = []
    with pytest.raises(RelayContactError, match=r"scenes\[1\] = .*: not allowed, allowed is a scene, alone or as \(sc"):
        run_many([CHATTER, wrong], component=COMPONENT, progress=done.append)
    assert not done


def test_a_warning_stands_in_its_row() -> None:
    unused: Values = {"beam.thickness": 1.23e-4}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RelayContactWarning)
        table = run_many(["tapered-spring", ("tapered-spring", unused)], component=COMPONENT)
    assert ["beam.thickness = 0.000123 m: not used" in text for text in table["warning"]] == [False, True]
    assert not table["error"].any()


def test_a_run_keeps_its_warnings_whatever_runs_meanwhile() -> None:
    """Copies in other processes have them, too."""
    unused: Any = {"beam.thickness": 1.23e-4}
    meanwhile: list[Result] = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RelayContactWarning)
        result = run("tapered-spring", component=COMPONENT, stop=1e-3, **unused,
                     progress=lambda _: meanwhile.append(run(CHATTER, component=COMPONENT, stop=1e-5)))  # fmt: skip
    assert meanwhile[0].warnings == []
    (told,) = result.warnings
    assert "beam.thickness = 0.000123 m: not used" in told
    copied = pickle.loads(pickle.dumps(result))
    assert (copied.warnings, copied.units) == (result.warnings, result.units)
    assert np.array_equal(copied, result)


def test_the_lock_of_the_interpreter_is_released_while_the_component_steps() -> None:
    """Python counts on while a run is within its one call."""
    contact = COMPONENT.started({"effects.excitation": "Sine", "excitation.amplitude": 900.0})
    with contact:
        stop, counted = threading.Event(), 0

        def follow() -> None:
            contact.drive(np.linspace(0, 0.5, 50_001), {})
            stop.set()

        thread = threading.Thread(target=follow)
        thread.start()
        while not stop.is_set():
            counted += 1
            time.sleep(1e-3)
        thread.join()
    # Of a call that holds it there would be one, or two.
    assert counted > 10


def test_instances_serve_one_run_after_another() -> None:
    run_many([CHATTER] * 6, workers=2, component=COMPONENT)
    idle = len(COMPONENT.idle)
    run_many([CHATTER, (CHATTER, {"beam.length": -1.0})] * 6, workers=2, component=COMPONENT)
    assert len(COMPONENT.idle) == max(idle, 2)
    contact = COMPONENT.started()
    with contact:
        assert contact.get("contact.force") == contact.get("contact_force") > 0
        contact.set("base_acceleration", 50.0)
        assert contact.drive([0.0, 1e-4], {"base_acceleration": [50.0, 0.0]}, ["contact_force"])["contact_force"] > 0
        with pytest.raises(RelayContactError, match=r"contact.farce: no such variable; did you mean contact.force"):
            contact.real("contact.farce")
        with pytest.raises(RelayContactError, match="time of 2 dimensions: not allowed"):
            contact.drive([[0.0, 1e-5]], {})
        with pytest.raises(TypeError, match="Cannot cast array data"):
            contact.drive(np.array([0, 10_000], dtype="timedelta64[ns]"), {})
        with pytest.raises(RelayContactError, match="allowed is each input once"):
            contact.drive([0.0, 1e-5], {"base_acceleration": [0.0, 0.0], "base.acceleration": [0.0, 50.0]})
    with pytest.raises(AttributeError):
        contact.get("contact.force")


def test_work_within_work_shares_the_cores_and_leaves_them_free() -> None:
    threads = threading.active_count()

    def shares(_: int) -> list[int | None]:
        return [SHARE.get(), *side_by_side(lambda _: SHARE.get(), range(2))]

    assert side_by_side(shares, range(2), 8) == [[4, 2, 2]] * 2
    assert side_by_side(shares, range(3), 2) == [[1, 1, 1]] * 3
    assert SHARE.get() is None
    assert cores() >= 1
    assert threading.active_count() == threads


@pytest.mark.parametrize("kind", [RelayContactError, IndexError, StopIteration])
@pytest.mark.parametrize("workers", [1, 2])
@pytest.mark.parametrize("of_work", [True, False])
def test_an_error_of_own_work_or_of_what_is_told_ends_it(kind: type[Exception], workers: int, of_work: bool) -> None:
    begun: list[int] = []
    threads = threading.active_count()

    def fail() -> None:
        raise kind("the third")

    def work(item: int) -> None:
        begun.append(item)
        time.sleep(1e-3)
        if of_work and item == 3:
            fail()

    with pytest.raises(kind, match="the third"):
        side_by_side(work, range(1000), workers, (lambda: None) if of_work else fail)
    assert 0 < len(begun) < 900
    assert threading.active_count() == threads


def test_warnings_are_kept_in_the_order_of_the_items() -> None:
    """Of a kind the first item's, though the second is done before."""

    def work(item: float) -> None:
        time.sleep(item)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RelayContactWarning)
            COMPONENT.warn(f"slept {item} s")

    with warnings_kept() as kept:
        side_by_side(work, [0.05, 0.0], 2)
    assert list(kept.values()) == ["slept 0.05 s"]
