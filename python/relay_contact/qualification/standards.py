"""What standards ask of a contact, from files: tests, and the interruptions allowed."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field
from pydantic.dataclasses import dataclass

from relay_contact import records
from relay_contact.files import HERE, RelayContactError, by_name, digest, named
from relay_contact.qualification import excitation
from relay_contact.schema import STRICT, Positive, Table, at, read, refused, within
from relay_contact.tables import ACCELERATIONS

Interruption = Annotated[float, within(0.0, 0.1)]
"""Length (s) of an interruption or a make that is allowed."""
KINDS = ("sine", "random", "shock", "spectrum", "history")
"""Lists of tests in a file."""


class Monitor(Table):
    """Voltage (V) and current (A) of a monitor, where they are not those of the standard."""

    voltage: Annotated[float, within(1e-6, 1e4)] | None = None
    current: Annotated[float, within(1e-9, 1e4)] | None = None


@dataclass(frozen=True, config=STRICT)
class Contacts:
    """Longest opening of a closed contact and closing of an open one (s), and the monitor (V, A)."""

    opening: Interruption
    false_make: Interruption
    voltage: Annotated[float, within(1e-6, 1e4)]
    current: Annotated[float, within(1e-9, 1e4)]
    clause: str
    evidence: excitation.Evidence | dict[str, excitation.Evidence] = excitation.LEVELS[-1]

    def monitored(self, monitor: Monitor) -> "Contacts":
        """Return the limits with another monitor."""
        return replace(self, **monitor.model_dump(exclude_none=True))

    @property
    def threshold(self) -> float:
        """Resistance (Ohm) at which the contact has half of the monitor's voltage."""
        return self.voltage / self.current


class Recorded(Table):
    """A measured record: its file, beside that of the standard; all its channels, or one."""

    file: Annotated[str, Field(min_length=1)]
    name: Annotated[str, Field(min_length=1)] | None = None
    channel: str = ""
    unit: Literal["", *ACCELERATIONS] = ""  # type: ignore[valid-type]
    rate: Positive | None = None
    reversed: Annotated[bool, Field(strict=True)] = False
    axis: str = ""
    clause: str = ""
    evidence: excitation.Evidence = "measured"

    def tests(self, folder: Path) -> list[excitation.History]:
        """Return a test for each channel."""
        path = folder / self.file
        found = records.read(path, self.channel, self.unit, self.rate)
        name = self.name or path.name
        return [
            excitation.History(
                f"{name}, {each.channel}" if len(found) > 1 else name, self.clause or f"{path.name}, {each.channel}",
                self.evidence, axis=self.axis, record=each, both=self.reversed,
                digest=digest(each.time.tobytes() + each.acceleration.tobytes() + repr(each.notes).encode()),
            )
            for each in found
        ]  # fmt: skip


class Content(Table):
    """Contents of the file of a standard."""

    title: str | None = None
    contacts: Contacts
    sine: Annotated[list[excitation.Sine], Field(default_factory=list)]
    random: Annotated[list[excitation.Random], Field(default_factory=list)]
    shock: Annotated[list[excitation.Shock], Field(default_factory=list)]
    spectrum: Annotated[list[excitation.Spectrum], Field(default_factory=list)]
    history: Annotated[list[Recorded], Field(default_factory=list)]


@dataclass(frozen=True)
class Standard:
    """What a file of a standard holds."""

    title: str
    contacts: Contacts
    tests: tuple[excitation.Test, ...]
    digest: str = ""
    """Of the file."""
    left: tuple[excitation.Test, ...] = ()
    """Tests of the file that are not wanted."""

    @classmethod
    def read(cls, standard: str | Path) -> "Standard":
        """Read a standard by its name, such as "MIL-PRF-28776", or a file of one's own by its path."""
        path = named("standard", standard, standards())
        content = read(path, Content)
        tests: list[excitation.Test] = []
        for kind in KINDS:
            for number, entry in enumerate(getattr(content, kind)):
                with at(path, kind, number):
                    own = entry.tests(path.parent) if isinstance(entry, Recorded) else [entry]
                for test in own:
                    if test.name in {each.name for each in tests}:
                        raise refused(path, (kind, number, "name"), test.name, "given twice")
                tests += own
        if not tests:
            raise RelayContactError(f"{path}: no tests; there may be {', '.join(f'[[{kind}]]' for kind in KINDS)}")
        longest = max(content.contacts.opening, content.contacts.false_make)
        for number, shock in enumerate(content.shock):
            if shock.duration <= longest:
                text = f"allowed is more than the longest opening and closing in [contacts], {longest:g} s"
                raise refused(path, ("shock", number, "duration"), shock.duration, text)
        return cls(content.title or path.stem, content.contacts, tuple(tests), digest(path.read_bytes()))


def standards() -> dict[str, Path]:
    """Return the files of the standards by name."""
    return by_name(HERE / "standards")
