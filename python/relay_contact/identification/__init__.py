"""A relay's parameters from measurements of a sample: values, intervals, and what the data cannot tell."""

from pathlib import Path

from relay_contact.component import Component, default_component
from relay_contact.files import RelayContactError, named, spare
from relay_contact.identification.measurement import read
from relay_contact.identification.prediction import Laboratory
from relay_contact.identification.report import FILES, write
from relay_contact.identification.result import Found, Identification, conclude, sought, unknowns, usual
from relay_contact.qualification.relay import Relay, relays
from relay_contact.scene import progress_bar

__all__ = ["Found", "Identification", "identify"]


def identify(
    relay: str | Path,
    data: list[str | Path],
    *,
    out: str | Path | None = None,
    parameters: list[str] | None = None,
    component: Component | None = None,
    progress: bool = False,
) -> Identification:
    """Find parameters of a relay, given by its name or its file, by measurements in CSV files.

    `parameters` are names of parameters of the component, or of entries of the spring file, such as "spring.thickness";
    without them stiffness, damping, rivet, overtravel and contact damping. With `out` a folder is written: the relay's
    file with the values found and their uncertainties, a table, a page and a figure.
    """
    component = component or default_component()
    path = named("relay", relay, relays())
    described = Relay.read(path, component)
    if len({values.get("beam.file") for values in described.positions.values()}) > 1:
        raise RelayContactError(f"{path}: beam.file: not the same in all positions; identify each by itself")
    paths = [Path(each) for each in data]
    known: dict[bytes, Path] = {}
    for each in paths:
        if not each.is_file():
            raise RelayContactError(f"{each}: no such file; it has to be a measurement as a CSV file")
        if (content := each.read_bytes()) in known:
            told = f"the same data as {known[content]}: not allowed, allowed is each measurement once"
            raise RelayContactError(f"{each}: {told}")
        known[content] = each
    if out:
        springs = [Path(str(values["beam.file"])) for values in described.positions.values() if "beam.file" in values]
        made = (f"{path.stem}.toml", *(each.name for each in springs), *FILES)
        spare((Path(out) / name for name in made), (path, *springs, *paths))
    pushed = any(values.get("effects.pusher", "None") != "None" for values in described.positions.values())
    measurements = [read(each, component, list(described.positions), pushed) for each in paths]
    if not measurements:
        raise RelayContactError("no data: one file or more is needed")
    names = parameters or usual(described, measurements)
    asked = unknowns(component, described, path, measurements, names)
    # How many it takes shows as they converge.
    with progress_bar(None, "{n_fmt} predictions of measurements, {elapsed}", progress) as bar:
        fit, missing = sought(Laboratory(component, bar.update), described, measurements, asked)
        result = conclude(fit, missing, described, path)
    if out:
        write(Path(out), result, component)
    return result
