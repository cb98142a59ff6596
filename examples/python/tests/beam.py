"""The specimen once more, independent of the component: finite elements, Hertz contact, an implicit solver of SciPy."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.linalg import eigh

Array = NDArray[np.float64]

LENGTH, WIDTH, THICKNESS, YOUNG, DENSITY = 0.0155, 0.05423, 1.1898e-4, 1.24e11, 8300.0
TIP_MASS, DAMPING, RADIUS = 2.26e-5, 8.063e-5, 0.02177
BENDING = YOUNG * WIDTH * THICKNESS**3 / 12  # N m2
LINE_MASS = DENSITY * WIDTH * THICKNESS  # kg/m
MODULUS = 1 / ((1 - 0.33**2) / 8.6e10 + (1 - 0.34**2) / 8.192e10)
HERTZ = 4 / 3 * MODULUS * RADIUS**0.5
CARRIED = (
    TIP_MASS + 3 / 8 * LINE_MASS * LENGTH
)  # what the contact carries of the spring under a constant acceleration, kg
THRESHOLD_FORCE = (7.4118e-3 / 60) ** (1 / 0.9515)  # N, at which the resistance is 60 Ohm


@dataclass
class Modes:
    """Modes of the cantilever with its rivet, of unit modal mass."""

    squares: Array
    """Squared angular frequencies."""
    tip: Array
    load: Array
    """Modal load of a unit base acceleration."""


def modes(elements: int = 20) -> Modes:
    """Assemble Hermite beam elements."""
    h = LENGTH / elements
    stiffness = BENDING / h**3 * np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]])
    mass = [[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]]
    inertia = LINE_MASS * h / 420 * np.array(mass)
    scale = np.array([1, h, 1, h])
    size = 2 * elements + 2
    k, m, load = np.zeros((size, size)), np.zeros((size, size)), np.zeros(size)
    for element in range(elements):
        at = slice(2 * element, 2 * element + 4)
        k[at, at] += stiffness * np.outer(scale, scale)
        m[at, at] += inertia * np.outer(scale, scale)
        load[at] += LINE_MASS * h * np.array([1 / 2, 1 / 12, 1 / 2, -1 / 12]) * scale
    m[-2, -2] += TIP_MASS
    load[-2] += TIP_MASS
    squares, shapes = eigh(k[2:, 2:], m[2:, 2:])
    return Modes(squares, shapes[-2], shapes.T @ load[2:])


@dataclass
class Course:
    """Force (N) at the asked times, and the instants (s) at which it falls to that of the threshold and leaves it."""

    force: Array
    opened: Array
    closed: Array


def simulate(
    times: Array,
    gap: float,
    contact_damping: float,
    support: Callable[[float], tuple[float, float]] = lambda _: (0.0, 0.0),
    acceleration: Callable[[float], float] = lambda _: 0.0,
    max_step: float = 1e-6,
) -> Course:
    """Simulate from rest; gap (m; negative: overtravel, with its preload), support: displacement and velocity."""
    beam = modes()
    count = len(beam.squares)
    state = np.zeros(2 * count)
    if gap < 0:
        flexibility = float(np.sum(beam.tip**2 / beam.squares))
        low, high = 0.0, -gap  # indentation
        while high - low > 1e-16:
            middle = (low + high) / 2
            low, high = (low, middle) if middle + flexibility * HERTZ * middle**1.5 > -gap else (middle, high)
        state[:count] = beam.tip * HERTZ * low**1.5 / beam.squares

    def force(time: float, state: Array) -> float:
        position, velocity = support(time)
        indentation = position - gap - beam.tip @ state[:count]
        if indentation <= 0:
            return float(indentation)  # not above 0: for the events alone
        rate = velocity - beam.tip @ state[count:]
        return float(HERTZ * indentation**0.5 * (indentation + 1.5 * contact_damping * rate))

    def derivative(time: float, state: Array) -> Array:
        position, velocity = state[:count], state[count:]
        spring = -beam.squares * (position + DAMPING * velocity)
        moved = beam.tip * max(force(time, state), 0.0) - beam.load * acceleration(time)
        return np.concatenate([velocity, spring + moved])

    def falls(time: float, state: Array) -> float:
        return force(time, state) - THRESHOLD_FORCE

    def rises(time: float, state: Array) -> float:
        return force(time, state) - THRESHOLD_FORCE

    falls.direction, rises.direction = -1, 1  # type: ignore[attr-defined]
    result = solve_ivp(
        derivative,
        (times[0], times[-1]),
        state,
        "Radau",
        times,
        events=(falls, rises),
        rtol=1e-6,
        atol=np.repeat([1e-15, 1e-9], count),  # modal: position, velocity
        max_step=max_step,
    )
    forces = [max(force(time, column), 0.0) for time, column in zip(result.t, result.y.T, strict=True)]
    return Course(np.array(forces), *result.t_events)
