"""Published values: Zhang, Zhang, Meng, Ren, Machines 2025, 13(1), 52."""

from dataclasses import dataclass

import pandas as pd

from relay_contact import Values
from report.files import DOCS

ACCELERATION = 98.0
"""Of the excitation grid, m/s2 (Table 3)."""
FREQUENCIES = (250.0, 500.0, 750.0, 1000.0, 1250.0, 1500.0, 1750.0, 2000.0)
"""Of the grid, Hz (Table 3)."""
RATIOS = (0.1, 1.0, 5.0, 10.0, 20.0, 30.0)
"""Damping ratios at 1000 Hz (Table 3)."""
BEST = 10.0
"""The ratio whose results come closest to the measurements."""
BETA = 3.1831e-3
"""Its stiffness coefficient as printed (Table 3)."""

LENGTH, OVERTRAVEL = 15.5e-3, 0.2e-3
"""Of the specimen, m (Table 2)."""
FORCE, STIFFNESS = 0.152, 3.54e6
"""Static force, N, and contact stiffness, N/m (section 3.1)."""
WITHOUT_PRESTRESS, WITH_PRESTRESS = 1397.6, 1354.5
"""First frequency, Hz (section 3.1)."""
SHORT = ((11.5, 0.45, 2777.2), (11.5, 0.5, 2652.3), (7.5, 0.25, 4426.0))
"""Other springs: length and overtravel, mm, and first frequency with prestress, Hz (section 3.1)."""
LENGTHS = (7.5, 11.5, 15.5)
"""Of the modal analyses, mm (Table 2)."""

FORCE_AMPLITUDE, DISPLACEMENT, DISPLACEMENT_RATIO, PHASE = 4.812, 3.115, 1.256, 90.0
"""At 1000 Hz with ratio 10: amplitudes of force, cN, and displacement, um, this over the excitation's, and the phase
between both, degrees (section 3.2, Fig. 6)."""
PEAKS = ((10.0, 1250.0, 5.2), (20.0, 750.0, 3.3), (30.0, 250.0, 3.1))
"""Of the force amplitude in the time domain: ratio, Hz, cN (section 3.2, Fig. 7)."""
DISPLACEMENT_DEVIATIONS = ((10.0, 65.5), (30.0, 11.4))
"""Displacement amplitude over the excitation's, less 1, at 1250 Hz: ratio, % (section 3.2, Fig. 8)."""
DISPLACEMENTS = {0.1: 6.485, 1.0: 4.547, 5.0: 3.773, 10.0: 3.115, 20.0: 2.632, 30.0: 2.524}
"""Amplitudes at 1000 Hz by ratio, um (Table 4)."""
MEASURED_DISPLACEMENT = 2.9
"""At 1000 Hz, um (section 4.2, Fig. 14)."""

ALPHAS = (3000.0, 4000.0, 5000.0, 6000.0, 7000.0)
"""Mass coefficients of the frequency domain, 1/s (section 3.2, Fig. 9)."""
FREQUENCY_DOMAIN_PEAKS = ((3000.0, 1300.0, 8.7), (7000.0, 1100.0, 4.2))
"""Mass coefficient, Hz, cN (section 3.2, Fig. 9)."""
EQUIVALENT = ((10.0, 5125.0, "not stated"), (20.0, 10250.0, "within 8 %"), (30.0, 15375.0, "within 8 %"))
"""Ratio, the mass coefficient that goes with it, 1/s, and the deviation between both domains (section 4.2, Fig. 19)."""

RESISTANCE, EXPONENT = 7.4118, 0.9515
"""At 1 N, mOhm, and the exponent of the force (eq. 29)."""
ROUGHNESS = 12.84e-6
"""Height, m (section 3.3)."""
LEAST_RESISTANCE, GREATEST_RESISTANCE = 25.0, 63.0
"""Measured at 1000 Hz, mOhm (section 4.2, Fig. 16)."""
RESISTANCE_DEVIATIONS = ((10.0, 30.23, 1.89), (20.0, 41.63, 16.18), (30.0, 53.69, 24.85))
"""Of least and greatest resistance from the measured ones: ratio, %, % (Table 6)."""
FREQUENCY_DOMAIN_DEVIATION = 1.21
"""Of the greatest resistance at 1000 Hz with a mass coefficient of 5125 1/s, % (section 4.2)."""


def resistance(force: float) -> float:
    """Return the resistance at a force (N) by eq. 29, mOhm, as the component has it."""
    return float(RESISTANCE * force**-EXPONENT)


def force(resistance: float) -> float:
    """Return the force (N) at which eq. 29 has a resistance, mOhm."""
    return float((RESISTANCE / resistance) ** (1 / EXPONENT))


def deviations(least: float, greatest: float) -> tuple[float, float]:
    """Return deviations (%) of least and greatest resistance from those measured, by the extremes of the force (N)."""
    found = resistance(greatest), resistance(least)
    return 100 * (found[0] / LEAST_RESISTANCE - 1), 100 * (found[1] / GREATEST_RESISTANCE - 1)


@dataclass(frozen=True)
class Number:
    """A published number: what it is of (lengths in mm, mass coefficient in 1/s, frequency in Hz), and its value."""

    quantity: str
    kind: str
    length: float
    overtravel: float
    ratio: float
    alpha: float
    frequency: float
    published: float
    unit: str
    location: str
    fitted: int

    @property
    def spring(self) -> Values:
        """The parameters of its length and overtravel."""
        return {"beam.length": self.length * 1e-3, "contact.overtravel": self.overtravel * 1e-3}


def numbers() -> list[Number]:
    """Return the numbers of docs/published-numbers.csv."""
    table = pd.read_csv(DOCS / "published-numbers.csv").fillna({"unit": ""})
    return [Number(**{str(name): value for name, value in row.items()}) for row in table.to_dict("records")]
