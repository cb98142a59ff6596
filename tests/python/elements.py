"""Hermite's beam element, for finite elements that share no code with the component."""

import numpy as np

from relay_contact import Array


def element(bending: float, per_length: float, length: float) -> tuple[Array, Array]:
    """Return stiffness (N/m) and mass (kg) of an element: bending stiffness (N m2), mass per length (kg/m), length (m).

    Its degrees of freedom are deflection and slope at its start, then at its end.
    """
    h = length
    bent = [[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h]]
    bent += [[-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]]
    moved = [[156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h]]
    moved += [[54, 13 * h, 156, -22 * h], [-13 * h, -3 * h * h, -22 * h, 4 * h * h]]
    return bending / h**3 * np.array(bent), per_length * h / 420 * np.array(moved)
