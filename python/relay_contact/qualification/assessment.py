"""A relay against a standard: each test in each position of the coil, along each axis, by each of the relay's models.

A finished test is a file in the folder `parts`, named by a hash of all that it depends on: an interrupted assessment
continues, with the same bytes.
"""

import hashlib
import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Lock

from threadpoolctl import threadpool_limits

from relay_contact.component import Component, Values
from relay_contact.files import HERE, RelayContactError, write_at_once
from relay_contact.many import side_by_side
from relay_contact.qualification.excitation import Test
from relay_contact.qualification.judgement import tested, together
from relay_contact.qualification.position import Position
from relay_contact.qualification.relay import NORMAL, Relay
from relay_contact.qualification.results import FINDING, Finding, Tested
from relay_contact.qualification.standards import Standard
from relay_contact.spring import SPRING_FILES

FEW = 24
"""Frequencies of a sweep in the short form, and by a model that figures do not show."""
Job = tuple[Path, Position, Test, int]
"""The file that a test is to write, the position, the test, and the number of frequencies."""


def springs_of(values: Values) -> dict[str, bytes]:
    """Return the contents of the spring files of a position, by the parameters that name them."""
    files = {name: Path(str(values.get(name, ""))) for name in SPRING_FILES if values.get(name)}
    return {name: path.read_bytes() for name, path in files.items()}


def key(programs: bytes, position: Position, test: Test, points: int) -> str:
    """Return a name for a test that changes with all that its result depends on."""
    text = hashlib.sha256(programs)
    for name, spring in springs_of(position.values).items():
        text.update(name.encode() + spring)
    values = {name: value for name, value in position.values.items() if name not in SPRING_FILES}
    model = position.model
    relay = position.relay
    uncertainty = [repr(relay.uncertainty), repr(relay.correlation)]
    monitored = repr(position.contacts), repr(test)
    settings = [position.name, position.axis, values, uncertainty, model.name, model.uncertainty, *monitored]
    text.update(json.dumps([*settings, points], sort_keys=True).encode())
    return text.hexdigest()[:16]


def on_worker(fmu: bytes, springs: dict[str, bytes], position: Position, test: Test, points: int) -> str:
    """Run a test on another machine, which has this package; return the text of its finding."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "component.fmu"
        path.write_bytes(fmu)
        values = dict(position.values)
        for name, spring in springs.items():
            spring_path = Path(folder) / f"{name}.toml"
            spring_path.write_bytes(spring)
            values[name] = str(spring_path)
        relay = replace(position.relay, positions={position.name: values})
        model = replace(position.model, parameters={})
        here = Position(Component(path), relay, position.name, position.contacts, (test,), model, position.axis)
        return text_of(tested(here, test, points))


def text_of(finding: Finding) -> str:
    """Return the contents of the file of a finding."""
    return FINDING.dump_json(finding, indent=1).decode()


def on_cluster(address: str, component: Component, jobs: list[Job], keep: Callable[[Path, str], object]) -> None:
    """Run tests on a Dask cluster; pass on the path and text of each finding as it is finished."""
    try:
        from distributed import Client, as_completed
    except ImportError as error:
        raise RelayContactError("a cluster needs Dask: pip install 'relay-contact[cluster]'") from error
    fmu = component.path.read_bytes()
    with Client(address) as client:
        paths = {}
        for path, position, test, points in jobs:
            springs = springs_of(position.values)
            # A component cannot be sent; the worker unpacks its own.
            bare = replace(position, component=None)  # type: ignore[arg-type]
            paths[client.submit(on_worker, fmu, springs, bare, test, points, pure=False)] = path
        for future, text in as_completed(list(paths), with_results=True):
            keep(paths[future], text)


def assess(
    component: Component, relay: Relay, standard: Standard, folder: Path, points: int,
    tell: Callable[[str], object] = lambda _: None, cluster: str | None = None, workers: int | None = None,
) -> list[Tested]:  # fmt: skip
    """Run every test in every position, along every axis, by every model, or what is left of it.

    `tell` is called with what begins, and with nothing once it is finished; `cluster` is the address of a Dask cluster,
    `workers` the number of threads without one, by default one for each core.
    """
    (folder / "parts").mkdir(parents=True, exist_ok=True)
    jobs: list[Job] = []
    files = component.path, *sorted(HERE.rglob("*.py"))
    programs = hashlib.sha256(b"".join(path.read_bytes() for path in files)).digest()
    for position, tests in positions(component, relay, standard):
        own = points if position.model is relay.models[0] else min(points, FEW)
        for test in tests:
            jobs.append((folder / "parts" / f"{key(programs, position, test, own)}.json", position, test, own))
    todo = [job for job in jobs if not job[0].exists()]
    for _ in range(len(jobs) - len(todo)):
        tell("")
    telling = Lock()

    def told(label: str) -> None:
        with telling:
            tell(label)

    def keep(path: Path, text: str) -> None:
        write_at_once(path, text)
        told("")

    if cluster:
        on_cluster(cluster, component, todo, keep)
    else:
        here(todo, keep, told, workers)
    found = [FINDING.validate_json(path.read_bytes()) for path, *_ in jobs]
    for warning in (warning for finding in found for warning in finding.warnings):
        component.warn(warning)
    grouped: dict[tuple[str, str, str], list[Finding]] = {}
    for finding in found:
        grouped.setdefault((finding.position, finding.test, finding.axis), []).append(finding)
    return [Tested(together([each.verdict for each in models]), models) for models in grouped.values()]


def positions(component: Component, relay: Relay, standard: Standard) -> Iterator[tuple[Position, list[Test]]]:
    """Return each position of the coil by each model, along each axis, with the tests that it is to pass."""
    known = [NORMAL, *relay.axes]
    asked = [test.axis for test in standard.tests if test.axis and test.axis not in known]
    for name in relay.positions:
        for model in relay.models:
            for axis in dict.fromkeys([*known, *asked]):
                tests = [test for test in standard.tests if test.axis == axis or (not test.axis and axis in known)]
                yield Position(component, relay, name, standard.contacts, tuple(tests), model, axis), tests


def here(
    jobs: list[Job], keep: Callable[[Path, str], object], tell: Callable[[str], object], workers: int | None
) -> None:
    """Run tests on all cores; pass on the path and text of each finding as it is finished.

    Those of a position one after another, as they have in common what its draws answer.
    """
    grouped: dict[int, list[Job]] = {}
    for job in jobs:
        grouped.setdefault(id(job[1]), []).append(job)

    def run(group: list[Job]) -> None:
        for path, position, test, points in group:
            tell(position.named(test))
            keep(path, text_of(tested(position, test, points)))

    # The matrices of a test are small: threads of their own would wait for each other.
    with threadpool_limits(1, user_api="blas"):
        side_by_side(run, list(grouped.values()), workers)


def chosen(standard: Standard, texts: list[str]) -> Standard:
    """Return a standard with those of its tests whose names contain one of some texts."""
    if not texts:
        return standard
    found = {text: [test for test in standard.tests if text.lower() in test.name.lower()] for text in texts}
    for text, tests in found.items():
        if not tests:
            names = ", ".join(test.name for test in standard.tests)
            raise RelayContactError(f"{text}: no test named so; there are {names}")
    wanted = tuple(test for test in standard.tests if any(test in each for each in found.values()))
    return replace(standard, tests=wanted, left=tuple(test for test in standard.tests if test not in wanted))
