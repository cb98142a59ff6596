"""A relay as its file describes it: contacts, coil positions, and how well its parameters are known."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from relay_contact.component import Component, Values, nearest
from relay_contact.files import RelayContactError, by_name, found, named, read_toml
from relay_contact.scene import flat, parameters
from relay_contact.spring import PREFIX
from relay_contact.spring import known as known_entries

KEYS = ("title", "parameters", "position", "uncertainty", "model", "monitor")


@dataclass(frozen=True)
class Relay:
    """What a file of a relay holds, SI units."""

    title: str
    positions: dict[str, Values]
    """Parameters of the component in each position of the coil, by its name."""
    uncertainty: dict[str, float]
    """Of parameters, or entries of the spring file, as parts of their values, with 95 % confidence."""
    model: float
    """Of margins, as a part of them, by what the model leaves out."""
    monitor: dict[str, float]
    """Voltage (V) and current (A) of the monitor, where they are not those of the standard."""

    @classmethod
    def read(cls, relay: str | Path, component: Component) -> "Relay":
        """Read a relay by its name, such as "paper", or a file of one's own by its path."""
        path = named("relay", relay, relays())
        content = read_toml(path)
        for name in content:
            if name not in KEYS:
                raise RelayContactError(f"{path}: {name}: unknown{nearest(name, KEYS)}")

        def known(table: dict[str, Any]) -> dict[str, Any]:
            try:
                return {component.settable(name): value for name, value in parameters(table, path).items()}
            except RelayContactError as error:
                raise RelayContactError(f"{path}: {error}") from error

        shared = known(content.get("parameters", {}))
        positions: dict[str, Values] = {
            each.get("name", f"position {number}"): shared | known(each.get("parameters", {}))
            for number, each in enumerate(content.get("position", [{}]), 1)
        }
        uncertainty = {name: float(value) for name, value in flat(content.get("uncertainty", {})).items()}
        for name in uncertainty:
            if name.startswith(PREFIX):
                for values in positions.values():
                    allowed = known_entries(str(values.get("beam.file", "")))
                    if name not in allowed:
                        text = f"no such entry in the spring file{nearest(name, allowed)}"
                        raise RelayContactError(f"{path}: uncertainty of {name}: {text}")
            elif component.variables[component.settable(name)].type != "Real":
                raise RelayContactError(f"{path}: uncertainty of {name}: not a real parameter")
        model = float(content.get("model", {}).get("uncertainty", 0.0))
        return cls(content.get("title", path.stem), positions, uncertainty, model, content.get("monitor", {}))


def relays() -> dict[str, Path]:
    """Give the files of the relays by name."""
    return by_name(found("relays", "relays"))
