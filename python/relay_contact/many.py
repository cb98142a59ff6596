"""Many simulations at once, by threads of this process: while the component steps, Python is free for others."""

import contextvars
import os
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import FIRST_EXCEPTION, ThreadPoolExecutor, wait
from contextvars import ContextVar
from functools import cache
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING, TypeVar

from relay_contact.component import KEPT, Component, Value, Values, default_component, units
from relay_contact.files import RelayContactError, shown
from relay_contact.scene import Scene, progress_bar

if TYPE_CHECKING:
    import pandas as pd

Item = TypeVar("Item")
Found = TypeVar("Found")

Case = Scene | str | Path | tuple[Scene | str | Path, Values]
"""A scene, its name or its file; with changes of its parameters and constant inputs."""
SHARE: ContextVar[int | None] = ContextVar("workers", default=None)
"""Of what runs beside others: the workers that are left for each."""


def cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def checked(workers: int | None) -> int:
    """Return the number of workers that is asked for; without one that of the cores, or what others leave of them."""
    if workers is None:
        return SHARE.get() or cores()
    if isinstance(workers, bool) or not isinstance(workers, int) or workers < 1:
        raise RelayContactError(f"workers = {workers!r}: not allowed, allowed is a whole number greater than 0")
    return workers


def side_by_side(
    work: Callable[[Item], Found], items: Sequence[Item], workers: int | None = None,
    tell: Callable[[], object] = lambda: None,
) -> list[Found]:  # fmt: skip
    """Return what work makes of each item, in their order, by so many threads; those of all cores, if not given.

    Work within work shares them. Warnings of the component are kept in the order of the items. `tell` is called by
    this thread for each item, within a twentieth of a second after it is done. An error ends it, once what runs is
    done: that of the first item, in their order, however fast others fail.
    """
    workers = checked(workers)
    used = max(1, min(workers, len(items)))
    kept: list[dict[str, str]] = [{} for _ in items]
    left, found, failed = deque(enumerate(items)), dict[int, Found](), dict[int, Exception]()
    ended = Event()

    def own(index: int, item: Item) -> None:
        SHARE.set(max(1, workers // used))
        if KEPT.get() is not None:
            KEPT.set(kept[index])
        found[index] = work(item)

    def take(context: contextvars.Context) -> None:
        while not ended.is_set():
            try:
                index, item = left.popleft()
            except IndexError:
                return
            try:
                context.copy().run(own, index, item)
            except Exception as error:
                failed[index] = error
                ended.set()

    # This thread rests meanwhile: woken after each item it would take the lock of the interpreter from the others.
    with ThreadPoolExecutor(used) as pool:
        futures = [pool.submit(take, contextvars.copy_context()) for _ in range(used)]
        told, running = 0, set(futures)
        try:
            while running:
                done, running = wait(futures, 0.05, FIRST_EXCEPTION)
                for each in done:
                    each.result()
                finished = len(found)
                for _ in range(finished - told):
                    tell()
                told = finished
        finally:
            ended.set()
    if failed:
        raise failed[min(failed)]
    if (whole := KEPT.get()) is not None:
        for kind, message in (pair for each in kept for pair in each.items()):
            whole.setdefault(kind, message)
    return [found[index] for index in range(len(items))]


def run_many(
    scenes: str | Path | Scene | Iterable[Case],
    *,
    workers: int | None = None,
    outputs: str | list[str] | None = None,
    component: Component | None = None,
    progress: bool | Callable[[int], object] = False,
) -> "pd.DataFrame":
    """Run scenes from their begin to their stop, on all cores; return a table with a row for each, in their order.

    A scene is given by its name, its file or as a `Scene`, alone or with changes of parameters and constant inputs:
    ("chatter-41g", {"excitation.frequency": 500.0}). The row has what is changed and, at the stop, the outputs of the
    scene, or those of `outputs`, in the SI units that `attrs["units"]` says; a choice has its number. The values are
    those of `run`, bit by bit, whatever the number of workers. The column "warning" has what the component warned of.
    A scene that cannot be run has no outputs, and the column "error" says why; the others are run. `progress=True`
    shows a bar; a function is called after each scene with the number of those that are done.
    """
    # It takes half a second to import.
    import pandas as pd

    component = component or default_component()
    # A text alone would be a scene for each of its letters.
    cases = [scenes] if isinstance(scenes, str | Path | Scene) else list(scenes)
    pairs = [case if isinstance(case, tuple) and len(case) == 2 else (case, {}) for case in cases]
    for number, (scene, changes) in enumerate(pairs):
        # Else all that ran before it would be lost.
        if not (isinstance(scene, str | Path | Scene) and isinstance(changes, Mapping)):
            text = "not allowed, allowed is a scene, alone or as (scene, {name: value})"
            raise RelayContactError(f"scenes[{number}] = {shown(cases[number])}: {text}")
    read = cache(Scene.read)
    names = [component.name(name) for name in ([outputs] if isinstance(outputs, str) else outputs or [])]

    def row(pair: tuple[Scene | str | Path, Values]) -> tuple[dict[str, Value], dict[str, float], dict[str, str]]:
        given, changes = pair
        changed: dict[str, Value] = {}
        found: dict[str, float] = {}
        told = {"scene": given.title if isinstance(given, Scene) else str(given), "warning": "", "error": ""}
        try:
            changed |= component.settables(changes)
            scene = (given if isinstance(given, Scene) else read(given)).changed(component, changes)
            points = scene.points()
            with scene.started(component, points) as (contact, inputs):
                contact.drive(points, inputs)
                ends = {name: float(course[-1]) for name, course in inputs.items()}
                found = contact.every(*(names or map(component.name, scene.outputs)))
                found |= {name: ends[name] for name in found.keys() & ends.keys()}
                told["warning"] = " ".join(contact.warnings)
        except (RelayContactError, OSError) as error:
            told["error"] = str(error)
        return changed, found, told

    done = 0

    def tell() -> None:
        nonlocal done
        done += 1
        bar.update()
        if callable(progress):
            progress(done)

    form = "{desc} {percentage:3.0f} %|{bar}| {n} of {total} scenes"
    with progress_bar(len(pairs), form, progress is True, desc="simulated") as bar:
        rows = side_by_side(row, pairs, workers, tell)
    named = [name for part in (0, 1) for each in rows for name in each[part]]
    columns = dict.fromkeys(["scene", *named, "warning", "error"])
    table = pd.DataFrame([{**changed, **found, **told} for changed, found, told in rows], columns=list(columns))
    known = units(component.description)
    table.attrs["units"] = {name: known[name].si for name in columns if name in known}
    return table
