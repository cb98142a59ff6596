"""Hermite's beam elements, for finite elements that share no code with the component."""

from collections.abc import Iterable

import numpy as np

from relay_contact import Array

Part = tuple[int, int, float, float, float]
"""Nodes at its start and end, bending stiffness (N m2), mass per length (kg/m), length (m)."""


def assembled(nodes: int, parts: Iterable[Part]) -> tuple[Array, Array]:
    """Return stiffness and mass, N/m and kg; degrees of freedom are deflection and slope of each node."""
    stiffness, mass = np.zeros((2, 2 * nodes, 2 * nodes))
    for start, end, bending, per_length, h in parts:
        bent = [[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h]]
        bent += [[-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]]
        moved = [[156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h]]
        moved += [[54, 13 * h, 156, -22 * h], [-13 * h, -3 * h * h, -22 * h, 4 * h * h]]
        at = [2 * start, 2 * start + 1, 2 * end, 2 * end + 1]
        stiffness[np.ix_(at, at)] += bending / h**3 * np.array(bent)
        mass[np.ix_(at, at)] += per_length * h / 420 * np.array(moved)
    return stiffness, mass
