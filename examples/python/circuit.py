"""The circuit that circuit_rl.py and rollback.py couple to the contact, in closed form where the resistance is held.

    6 V --- R 60 Ohm --- L 1 mH ---+--- contact ------------------- 0 V
                                   +--- Rq 47 Ohm --- Cq 220 nF --- 0 V

Rq and Cq are the usual quench: without them an ideal inductor drives any voltage over an opening contact, and the
component knows no arcs (it holds below about 12 V and 0.4 A). With the load current i and the capacitor's voltage q:

    v = (i + q / Rq) / (1 / Rc + 1 / Rq)    contact voltage
    L di/dt = V - R i - v
    Rq Cq dq/dt = v - q
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from relay_contact import Array, Component, Contact

SOURCE, LOAD, COIL = 6.0, 60.0, 1e-3  # V, Ohm, H
QUENCH, CAPACITOR = 47.0, 220e-9  # Ohm, F
PERIOD = 1e-3  # s, of the vibration
NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)


def shaken(component: Component) -> Contact:
    """Give the contact under the vibration that opens it in every period: 400 m/s2 (41 g) at 1 kHz."""
    return component.started(
        {
            "effects.excitation": "Sine",
            "effects.axialForce": "None",
            "excitation.amplitude": 400.0,
            "excitation.frequency": 1 / PERIOD,
        }
    )


def contact_voltage(current: Any, capacitor: Any, conductance: Any) -> Any:  # noqa: ANN401
    """Give the voltage over the contact from the load current and the capacitor's voltage, numbers or arrays."""
    return (current + capacitor / QUENCH) / (conductance + 1 / QUENCH)


def stored(current: float, capacitor: float) -> float:
    """Give the energy in coil and capacitor."""
    return (COIL * current**2 + CAPACITOR * capacitor**2) / 2


def at_rest(resistance: float) -> tuple[float, float]:
    """Give load current and capacitor's voltage in the steady state."""
    current = SOURCE / (LOAD + resistance)
    return current, current * resistance


def closed_form(conductance: Array, time: Array) -> tuple[Array, Array]:
    """Give exp(A time) and the state at rest of the circuit, d(i, q)/dt = A ((i, q) - rest), at held conductances."""
    a = 1 / (conductance + 1 / QUENCH)
    load = np.stack([-(LOAD + a) / COIL, -a / QUENCH / COIL], axis=-1)
    quench = np.stack([a / (QUENCH * CAPACITOR), (a / QUENCH - 1) / (QUENCH * CAPACITOR)], axis=-1)
    matrix = np.stack([load, quench], axis=-2)
    voltage = SOURCE / (LOAD * conductance + 1)
    # The exponential of a matrix of two rows, by Cayley and Hamilton. Half the trace, half the eigenvalues' distance
    # (the tiny number only keeps it from 0).
    middle = np.trace(matrix, axis1=-2, axis2=-1) / 2
    half = np.sqrt(middle**2 - np.linalg.det(matrix) + 0j) + 1e-30
    even, odd = np.cosh(half * time) * np.exp(middle * time), np.sinh(half * time) / half * np.exp(middle * time)
    shifted = matrix - middle[..., None, None] * np.eye(2)
    exponential = (even[..., None, None] * np.eye(2) + odd[..., None, None] * shifted).real
    return exponential, np.stack([voltage * conductance, voltage], axis=-1)


@dataclass
class Course:
    """What the circuit does within a communication step: at instants since its start, from the start to the end."""

    time: Array
    current: Array
    capacitor: Array
    weights: Array
    """A power times these is the energy over the step."""
    error: float
    """How far the energies of this step may miss their balance."""


class BuiltIn:
    """Closed form. Energies by Gauss quadrature of 16th order: exact but for rounding."""

    def advance(self, start: tuple[float, float], resistance: float, step: float) -> Course:
        """Step once."""
        times, weights = np.pad((NODES + 1) / 2 * step, 1), np.pad(WEIGHTS * step / 2, 1)
        times[-1] = step
        exponentials, _ = closed_form(np.array(1 / resistance), times)
        rest = np.array(at_rest(resistance))
        current, capacitor = (rest + exponentials @ (np.array(start) - rest)).T
        # Some ten roundings of what flows and of what is stored.
        error = 10 * np.finfo(float).eps * (SOURCE**2 / LOAD * step + stored(current[-1], capacitor[-1]))
        return Course(times, current, capacitor, weights, error)
