"""Whether the contact of a relay is smooth enough for Hertz's law.

By the number of J. A. Greenwood, K. L. Johnson and E. Matsubara, Wear 100 (1984) 47: roughness times radius of
curvature over the square of the radius of Hertz's circle, which is the roughness over the indentation.
"""

from relay_contact.component import Component
from relay_contact.qualification.relay import Relay
from relay_contact.qualification.response import compliance

SMOOTH = 0.05
"""The number below which Hertz's law is wrong by 7 % at most, 1."""
PAGE = "docs/contact-law.md"


def told(component: Component, relay: Relay) -> list[str]:
    """Return lines about the contact in each position."""
    lines = []
    for name, values in relay.positions.items():
        with component.started(values) as contact, contact.explained():
            force = contact.get("preload.force")
        if force <= 0:
            lines.append(f"{name}: open at rest")
            continue
        curvature = component.value(values, "contact.curvatureRadius")
        # The circle in which smooth spheres touch.
        radius = (0.75 * force * curvature * compliance(component, values)) ** (1 / 3)
        indentation = radius**2 / curvature
        lines.append(
            f"{name}: {100 * force:.3g} cN; a smooth contact touches in a circle of radius "
            f"{1e6 * radius:.3g} um, indented by {1e9 * indentation:.3g} nm"
        )
        if relay.roughness is None:
            limit = f"{1e9 * SMOOTH * indentation:.2g} nm"
            lines.append(f"  no roughness given: Hertz's law holds up to {limit} rms, both surfaces together ({PAGE})")
            continue
        number = relay.roughness / indentation
        holds = "holds" if number <= SMOOTH else "does not hold"
        lines.append(
            f"  Greenwood-Johnson-Matsubara number {number:.3g} for {1e6 * relay.roughness:g} um rms: "
            f"Hertz's law {holds}, as it does up to {SMOOTH:g} ({PAGE})"
        )
    return lines
