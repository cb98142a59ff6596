"""What is judged of a relay: its contacts, and where its armature and its pusher hold them.

Each part is judged by what vibration leaves of a force or a gap. A contact fails by an interruption or a make that
lasts; an armature fails where it leaves the core or the stop that it rests on, a spring where it leaves its pusher.
Which of them a position has is told by the component at rest. The forces of the stops are those of docs/relay.md.
"""

from dataclasses import dataclass
from math import atan2, exp, log, sqrt

from relay_contact.component import Array, Component, Contact, Values
from relay_contact.files import RelayContactError

CONTACT = "contact"
"""The first contact, with the second one, if there is one."""
CLOSED, OPEN = "closed contact", "open contact"
"""What may fail of it, by its state at rest: by an interruption and by a false make."""
CORE, STOP, PUSHER = "armature at its core", "armature at its stop", "spring at its pusher"
NONE, MOVED = "None", "Armature"
"""Of effects.pusher."""


@dataclass(frozen=True)
class Rest:
    """What is judged of a position of the coil, by its state at rest."""

    is_open: bool
    """Whether the first contact is open."""
    held: tuple[str, ...] = ()
    """The parts beside the contacts that touch, by name."""


@dataclass(frozen=True)
class Part:
    """A force by which a part is held: outputs of the component and their factors, whose products it is the sum of."""

    name: str
    terms: tuple[tuple[str, float], ...]
    offset: float = 0.0
    """Further force, N."""
    least: str = ""
    """The output that is the least of it in a step; without one its end stands for all of a step."""

    @property
    def outputs(self) -> list[str]:
        """Return the outputs that it is read from."""
        return [name for name, _ in self.terms]

    def force(self, rows: dict[str, Array]) -> Array:
        """Return the force (N) by the outputs; a stop that was left would pull."""
        return self.offset + sum(factor * rows[name] for name, factor in self.terms)  # type: ignore[return-value]

    def now(self, contact: Contact) -> float:
        """Return the force of an instance as it is, N."""
        return self.offset + sum(factor * contact.get(name) for name, factor in self.terms)


def at_rest(component: Component, values: Values) -> Rest:
    """Return what is judged with these parameters.

    Without a pusher the sign of the overtravel says whether the contact is to be open, else the component does.
    """
    if component.choice(values, "effects.pusher") == NONE:
        return Rest(component.value(values, "contact.overtravel") < 0)
    known = all_parts(component, values)
    with component.started(values) as contact, contact.explained():
        touching = tuple(name for name, part in known.items() if part.now(contact) > 0)
        return Rest(contact.get("preload.force") <= 0, touching)


def parts(component: Component, values: Values, rest: Rest) -> tuple[Part, ...]:
    """Return the parts beside the contacts that are judged."""
    return tuple(part for name, part in all_parts(component, values).items() if name in rest.held) if rest.held else ()


def all_parts(component: Component, values: Values) -> dict[str, Part]:
    """Return all parts beside the contacts that a relay with these parameters has, by name."""
    found = [Part(PUSHER, (("pusher.force", 1.0),), least="step.minimumPusherForce")]
    if component.choice(values, "effects.pusher") == MOVED:
        names = ("stopStiffness", "stopRestitution", "mass", "restPosition")
        stiffness, restitution, mass, place = (component.value(values, f"armature.{name}") for name in names)
        damper = 2 * damping_ratio(restitution) * sqrt(stiffness * mass)
        overlap, velocity = ("armature.gap", -stiffness), ("armature.velocity", damper)
        resting = ("armature.displacement", -stiffness), ("armature.velocity", -damper)
        found += [
            Part(CORE, (overlap, velocity), least="step.minimumStopForce"),
            Part(STOP, resting, stiffness * place),
        ]
    return {part.name: part for part in found}


def damping_ratio(restitution: float) -> float:
    """Return the share of critical damping with which a mass leaves a stop with a share of its velocity.

    T. Schwager, T. Poeschel, Granular Matter 9 (2007) 465: the touch ends where the force vanishes, not the overlap.
    """
    if restitution >= 1:
        return 0.0
    # It takes long to import.
    from scipy.optimize import brentq

    def excess(logarithm: float) -> float:
        ratio = exp(logarithm)
        if ratio < 1:
            root = sqrt(1 - ratio**2)
            return -ratio / root * atan2(2 * ratio * root, 2 * ratio**2 - 1) - log(restitution)
        root = sqrt(max(ratio**2 - 1, 1e-18))
        return -ratio / root * log((ratio + root) / (ratio - root)) - log(restitution)

    return exp(brentq(excess, -30.0, 10.0, xtol=1e-13))


def check_held(component: Component, values: Values) -> None:
    """Refuse a position in which the nominal current or more does not hold the armature at its core."""
    current = component.value(values, "coil.relativeCurrent")
    if (
        component.choice(values, "effects.pusher") == MOVED
        and abs(current) >= 1
        and CORE not in at_rest(component, values).held
    ):
        with component.started(values) as contact:
            gap = contact.get("armature.gap")
        text = f"not allowed, the magnet does not hold the armature, which rests {1e3 * gap:.3g} mm from its core"
        raise RelayContactError(f"coil.relativeCurrent = {current:g}: {text}")
