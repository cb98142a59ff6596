"""The circuit that the examples couple to the contact, in closed form while the conductance of the contact is constant.

    6 V --- R 60 Ohm --- L 1 mH ---+--- contact ------------------- 0 V
                                   +--- Rq 47 Ohm --- Cq 220 nF --- 0 V

Rq and Cq suppress the arc, as usual: without them an ideal inductor drives any voltage across an opening contact, and
the component does not model arcs (it is valid below about 12 V and 0.4 A). With the load current i, the capacitor
voltage q and the conductance G of the contact:

    v = (i + q / Rq) / (G + 1 / Rq)    contact voltage
    L di/dt = V - R i - v
    Rq Cq dq/dt = v - q
"""

import cmath
from dataclasses import dataclass
from typing import Any

import numpy as np

from relay_contact import Array

State = tuple[float, float]
"""Load current [A] and capacitor voltage [V]."""
POINTS = 8  # given of a communication step


@dataclass
class Course:
    """The circuit within a communication step, at times from its start to its end."""

    time: Array
    current: Array
    capacitor: Array


@dataclass(frozen=True)
class Circuit:
    """Its parameters, in SI units."""

    supply: float = 6.0
    load: float = 60.0
    inductance: float = 1e-3
    quench: float = 47.0
    capacitance: float = 220e-9

    def voltage(self, current: Any, capacitor: Any, conductance: Any) -> Any:  # noqa: ANN401
        """Give the contact voltage; numbers or arrays."""
        return (current + capacitor / self.quench) / (conductance + 1 / self.quench)

    def at_rest(self, conductance: float) -> State:
        """Give the steady state."""
        voltage = self.supply / (self.load * conductance + 1)
        return voltage * conductance, voltage

    def after(self, state: State, conductance: float, time: float) -> State:
        """Give the state after a time."""
        total = conductance + 1 / self.quench
        a = -(self.load + 1 / total) / self.inductance
        b = -1 / (self.quench * total * self.inductance)
        c = 1 / (total * self.quench * self.capacitance)
        d = (1 / (self.quench * total) - 1) / (self.quench * self.capacitance)
        # The exponential of a matrix of two rows, by Cayley and Hamilton.
        mean, half = (a + d) / 2, cmath.sqrt((a - d) ** 2 / 4 + b * c)
        first, second = cmath.exp((mean + half) * time), cmath.exp((mean - half) * time)
        even = ((first + second) / 2).real
        odd = ((first - second) / (2 * half)).real if half else time * first.real
        current, capacitor = self.at_rest(conductance)
        i, q = state[0] - current, state[1] - capacitor
        current += even * i + odd * ((a - mean) * i + b * q)
        return current, capacitor + even * q + odd * (c * i + (d - mean) * q)

    def advance(self, start: State, conductance: float, step: float) -> Course:
        """Simulate a communication step."""
        times = np.linspace(0, step, POINTS + 1)
        current, capacitor = np.array([self.after(start, conductance, time) for time in times.tolist()]).T
        return Course(times, current, capacitor)
