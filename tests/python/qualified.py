"""Relays and tests that no file has, judged by `qualify`."""

from collections.abc import Mapping
from pathlib import Path

from component import COMPONENT
from relay_contact import Values
from relay_contact.qualification import FEW, Relay, Standard, Tested
from relay_contact.qualification.assessment import assess
from relay_contact.qualification.distributions import Correlation, Distribution
from relay_contact.qualification.excitation import Test as Asked
from relay_contact.qualification.position import Position
from relay_contact.qualification.relay import Model
from relay_contact.qualification.standards import Contacts, Monitor

CONTACTS = Standard.read("MIL-PRF-28776").contacts


def described(
    values: Values, uncertainty: Mapping[str, Distribution] | None = None, correlation: Correlation | None = None
) -> Relay:
    """Return a relay in one position of the coil, by one model."""
    return Relay("own", {"own": values}, dict(uncertainty or {}), (Model("one", {}, 0.0),), Monitor(),
                 correlation=correlation or Correlation())  # fmt: skip


def placed(relay: Relay, *tests: Asked) -> Position:
    """Return the first position of the coil by the first model, for some tests."""
    return Position(COMPONENT, relay, next(iter(relay.positions)), CONTACTS, tests, relay.models[0])


def judged(relay: Relay, folder: Path, *tests: Asked, contacts: Contacts = CONTACTS) -> list[Tested]:
    """Return what some tests show."""
    return assess(COMPONENT, relay, Standard("own", contacts, tests), folder, FEW)
