"""Vibration and shock that standards require of relays, and what counts as an interruption of a closed contact.

From the standards' texts: condition A of methods 204 and 213 of MIL-STD-202, and MIL-PRF-28776F: vibration (4.8.10.1),
limit of an interruption (4.8.9, as method 310). Conditions B to D of method 204, B and C of method 213 are from memory.
"""

from dataclasses import dataclass

import numpy as np

from relay_contact import Array
from relay_contact.figures import GRAVITY as G

LIMIT = 10e-6  # s, longest interruption allowed
# Half of the 6 V of a monitor with 10 mA. The component's default of 60 Ohm is that of 100 mA.
THRESHOLD = 600.0  # Ohm


@dataclass(frozen=True)
class Level:
    """Sine sweep up and down: acceleration [g], range [Hz], double amplitude [m], time [s]."""

    name: str
    acceleration: float
    frequencies: tuple[float, float]
    double_amplitude: float
    sweep_time: float

    def amplitude(self, frequency: Array) -> Array:
        """Give the amplitude at frequencies (Hz), m/s2: limited by the displacement at low frequencies."""
        return np.minimum(G * self.acceleration, self.double_amplitude / 2 * (2 * np.pi * frequency) ** 2)

    def __str__(self) -> str:
        """Describe the level."""
        low, high = self.frequencies
        return f"{self.acceleration:g} g or {1e3 * self.double_amplitude:g} mm, {low:g}-{high:g}-{low:g} Hz"


VIBRATION = {
    "A": Level("method 204 A", 10, (10, 500), 1.524e-3, 900),
    "B": Level("method 204 B", 15, (10, 2000), 1.524e-3, 1200),
    "C": Level("method 204 C", 10, (10, 2000), 1.524e-3, 1200),
    "D": Level("method 204 D", 20, (10, 2000), 1.524e-3, 1200),
}
RELAYS = Level("MIL-PRF-28776", 30, (10, 3000), 4.95e-3, 1200)
SHOCKS = {"A": (50, 11e-3), "B": (75, 6e-3), "C": (100, 6e-3)}
"""Peak [g] and duration [s] of the half sines of method 213."""
