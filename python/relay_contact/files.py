"""Where component, scenes, relays and standards are: carried by the wheel, or in the project's folders."""

import hashlib
import os
import re
import tomllib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import get_ident
from typing import Any

HERE = Path(__file__).resolve().parent
PROJECT = HERE.parents[1]
"""The project's top folder, where this package is used from there."""


class RelayContactError(ValueError):
    """A wrong name or value, or what the component refuses; the message says what is allowed."""


class RelayContactWarning(UserWarning):
    """What the component warns of, such as a parameter without effect, or a tolerance that may not be kept."""


def found(name: str, in_project: str) -> Path:
    """Give a file or folder that the wheel carries, else that of the project."""
    carried = HERE / "data" / name
    return carried if carried.exists() else PROJECT / in_project


def fmu_path() -> Path:
    """Give the component: the file that RELAY_CONTACT_FMU names, else the one carried, else the one built here."""
    given = os.environ.get("RELAY_CONTACT_FMU")
    return Path(given) if given else found("RelayContact.fmu", "dist/RelayContact.fmu")


def page_path() -> Path:
    """Return the page that runs the simulation in a browser: the one carried, else the one built here."""
    return found("explore.html", "dist/explore.html")


def description_path() -> Path:
    """Give the list of variables: the project's, which is there before the component is built, else the component."""
    own = PROJECT / "modelDescription.xml"
    return own if own.exists() else fmu_path()


def by_name(folder: Path) -> dict[str, Path]:
    """Give the TOML files of a folder by name."""
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def scenes() -> dict[str, Path]:
    """Give the scene files by name."""
    return by_name(found("scenes", "scenes"))


def named(kind: str, name: str | Path, known: dict[str, Path]) -> Path:
    """Give the file that a name or a path stands for."""
    if str(name) in known:
        return known[str(name)]
    if Path(name).is_file():
        return Path(name)
    raise RelayContactError(f"{name}: no such file, and no {kind} of this name; there are {', '.join(known)}")


def digest(data: bytes) -> str:
    """Return the hash by which contents are known: the first 16 digits of SHA-256."""
    return hashlib.sha256(data).hexdigest()[:16]


@contextmanager
def at_once(path: str | Path) -> Iterator[Path]:
    """Give the path to write at for a file that is there as a whole or not at all: others may read or write it now."""
    path = Path(path)
    part = path.with_name(f"{path.name}.{os.getpid()}.{get_ident()}.part")
    try:
        yield part
        part.replace(path)
    except OSError as error:
        raise OSError(error.errno, error.strerror or str(error), str(path)) from error
    finally:
        # What cannot be written, as to a medium for reading alone, is not there.
        with suppress(OSError):
            part.unlink()


def write_at_once(path: Path, text: str) -> None:
    """Write a text as a whole or not at all."""
    with at_once(path) as part:
        part.write_text(text, encoding="utf-8")


def spare(written: Iterable[Path], read: Iterable[Path]) -> None:
    """Refuse to write over a file that was read."""
    own = {path.resolve() for path in read}
    for path in written:
        if path.resolve() in own:
            raise RelayContactError(f"{path}: is read: not allowed, allowed is another folder for what is written")


def shown(value: object) -> str:
    """Return a value that a user gave, for a message."""
    text = "a table" if isinstance(value, dict) else f'"{value}"' if isinstance(value, str) else repr(value)
    return text if len(text) < 60 else f"{text[:56]} ..."


def read_toml(path: Path) -> dict[str, Any]:
    """Return the contents of a TOML file; an error names file and line."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except tomllib.TOMLDecodeError as error:
        text, _, place = str(error).removesuffix(")").rpartition(" (at ")
        line = re.match(r"line (\d+)", place)
        lines = path.read_text(encoding="utf-8-sig").split("\n")
        at = int(line[1]) if line else len(lines)
        text += "; decimals have a point" if re.search(r"=\s*[+-]?\d+,\d", lines[at - 1]) else ""
        raise RelayContactError(f"{path}:{at}: not TOML: {text}") from error
    except UnicodeDecodeError as error:
        at = error.object.count(b"\n", 0, error.start) + 1
        raise RelayContactError(f"{path}:{at}: not TOML: not text in UTF-8") from error
    except RecursionError as error:
        raise RelayContactError(f"{path}: not TOML: nested too deeply") from error
