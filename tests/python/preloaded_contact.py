"""A mass pressed on a contact by a constant force, shaken by a sine or by white noise: reference digits.

The problem of the literature on vibrating Hertzian contacts (P. R. Nayak, J. Sound Vib. 22 (1972) 297;
J. Perret-Liaudet and E. Rigaud, J. Sound Vib. 265 (2003) 289 and 309; Q. Ma, A. Kahraman, J. Perret-Liaudet and
E. Rigaud, doi:10.1115/1.2190230), for a force that follows any power p, in units of preload, stiffness
at preload and mass:

    y'' + 2 z y' + g(y, y') - 1 = s cos(w t),   g = max(0, u^p + 2 z_c u^(p - 1) y') where u = 1 + y/p > 0, else 0

Nothing is integrated in time here: the steady motion balances `HARMONICS` harmonics, the period of the free motion is a
quadrature of its energy, and under white noise the Fokker-Planck equation has a closed stationary solution. What
`tests/preloaded_contact.rs` quotes is printed by

    .venv/bin/python tests/python/preloaded_contact.py
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import cos, exp, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.optimize import brentq

Array = NDArray[np.float64]

HARMONICS = 240
SAMPLES = 8192
"""Of a period, in which the force is evaluated."""
STEP = 0.02
"""Of the level, from one motion to the next."""
HERTZ, ROUGH = 1.5, 1 / (1 - 0.54)
"""Exponents: of spheres, and of a stiffness that grows with the force to the power 0.54."""


@dataclass(frozen=True)
class Problem:
    """Exponent p, dampings z and z_c, frequency w and level s; the motion repeats after some periods of the sine."""

    p: float
    z: float
    z_c: float
    w: float
    s: float
    periods: int = 1

    @property
    def numbers(self) -> str:
        """What a row begins with."""
        return f"{self.z}, {self.z_c}, {self.w}, {self.s}, {self.periods}"

    def contact(self, y: Array, rate: Array) -> tuple[Array, Array, Array]:
        """Return the force, and its derivatives by deviation and rate."""
        u = 1 + y / self.p
        inside = np.where(u > 0, u, 1.0)
        stiffness = inside ** (self.p - 1)
        force = inside**self.p + 2 * self.z_c * stiffness * rate
        slope = stiffness + 2 * self.z_c * (self.p - 1) / self.p * inside ** (self.p - 2) * rate
        closed = (u > 0) & (force > 0)
        return force * closed, slope * closed, 2 * self.z_c * stiffness * closed


class Basis:
    """Mean, cosines and sines of a period, sampled."""

    def __init__(self, harmonics: int, samples: int) -> None:
        """Tabulate them."""
        self.order = np.arange(1, harmonics + 1)
        angle = 2 * pi * np.outer(np.arange(samples), self.order) / samples
        self.values = np.hstack([np.ones((samples, 1)), np.cos(angle), np.sin(angle)])
        self.analysis = self.values.T * 2 / samples
        self.analysis[0] /= 2

    def rate(self, size: float) -> Array:
        """Return the matrix that differentiates coefficients, at the base frequency."""
        count = len(self.order)
        matrix = np.zeros((2 * count + 1, 2 * count + 1))
        index = np.arange(count)
        matrix[1 + index, 1 + count + index] = size * self.order
        matrix[1 + count + index, 1 + index] = -size * self.order
        return matrix

    def steady(self, problem: Problem, start: Array) -> Array:
        """Return the coefficients of the steady motion by Newton's method from others."""
        rate = self.rate(problem.w / problem.periods)
        linear = rate @ rate + 2 * problem.z * rate
        moved = self.values @ rate
        load = np.zeros(len(start))
        load[0], load[problem.periods] = 1.0, problem.s
        a = start
        for _ in range(80):
            force, slope, loss = problem.contact(self.values @ a, moved @ a)
            residual = linear @ a + self.analysis @ force - load
            jacobian = linear + self.analysis @ (slope[:, None] * self.values + loss[:, None] * moved)
            step: Array = np.linalg.solve(jacobian, residual)
            a = a - step * min(1.0, 1.0 / np.abs(step).max())
            if np.abs(step).max() < 1e-11:
                return np.asarray(a)
        raise ArithmeticError(f"{problem}: no balance")


COARSE, FINE = Basis(40, 2048), Basis(HARMONICS, SAMPLES)


def followed(path: list[Problem], start: Array | None = None) -> Array:
    """Return the steady motion at the end of a path of neighbouring problems."""
    a = np.zeros(81) if start is None else start
    for problem in path:
        a = COARSE.steady(problem, a)
    fine = np.zeros(2 * HARMONICS + 1)
    for first in (1, 1 + HARMONICS):
        other = 1 + (first > 1) * 40
        fine[first : first + 40] = a[other : other + 40]
    fine[0] = a[0]
    return FINE.steady(path[-1], fine)


def series(a: Array) -> Callable[[float], float]:
    """Return the function of the angle with these coefficients."""
    order = np.arange(1, len(a) // 2 + 1)
    return lambda x: float(a[0] + np.cos(x * order) @ a[1 : len(order) + 1] + np.sin(x * order) @ a[len(order) + 1 :])


def down(problem: Problem) -> list[Problem]:
    """Return problems from far above the resonance down to this one: they stay on the upper branch."""
    return [replace(problem, w=w) for w in np.linspace(1.6, problem.w, 41)]


def row(problem: Problem, a: Array) -> str:
    """Return a motion: phase of the sine and rate where y = 0 upwards, mean, amplitude, share of time it is open."""
    size = problem.w / problem.periods
    y, v = series(a), series(FINE.rate(size) @ a)
    grid = 2 * pi * np.arange(SAMPLES + 1) / SAMPLES
    values = np.array([y(x) for x in grid])
    first = next(k for k in range(SAMPLES) if values[k] < 0 <= values[k + 1])
    zero = brentq(y, grid[first], grid[first + 1], xtol=1e-15)

    def engaged(x: float) -> float:
        u = 1 + y(x) / problem.p
        return u + 2 * problem.z_c * v(x) if problem.z_c and v(x) < 0 else u

    signs = [engaged(x) > 0 for x in grid]
    shut = [
        brentq(engaged, grid[k], grid[k + 1], xtol=1e-15) * (-1) ** signs[k]
        for k in range(SAMPLES)
        if signs[k] != signs[k + 1]
    ]
    share = (sum(shut) + (0 if signs[0] else 2 * pi)) / (2 * pi)
    phase = (problem.periods * zero + pi / 2) % (2 * pi)
    count = problem.periods
    amplitude = float(np.hypot(a[count], a[count + HARMONICS]))
    return f"{phase:.9f}, {v(zero):.9f}, {a[0]:.7f}, {amplitude:.7f}, {share:.7f}"


def potential(p: float, u: float) -> float:
    """Return the potential energy over that at preload."""
    return float(p / (p + 1) * (max(u, 0.0) ** (p + 1) - 1) - p * (u - 1))


def period(p: float, energy: float) -> float:
    """Return the period of the free motion without damping: in contact by quadrature, in flight by that of a throw."""
    grazing = p * p / (p + 1)
    top = brentq(lambda u: potential(p, u) - energy, 1, 100, xtol=1e-15)
    bottom = brentq(lambda u: potential(p, u) - energy, 0, 1, xtol=1e-15) if energy < grazing else 0.0
    middle, half = (top + bottom) / 2, (top - bottom) / 2

    def lasts(x: float) -> float:
        # u = middle - half cos x: the integrand stays finite where the motion turns.
        squared = 2 * (energy - potential(p, middle - half * cos(x)))
        return p * half * sin(x) / sqrt(squared) if squared > 0 else 0.0

    contact = 2 * quad(lasts, 0, pi, epsabs=1e-11, epsrel=1e-11, limit=500)[0]
    return float(contact + 2 * sqrt(2 * max(energy - grazing, 0.0)))


def noise(p: float, heat: float) -> tuple[float, float, float]:
    """Return deviation of the force, share of the time it is zero, and losses of contact per unit of time.

    Under white noise the density is proportional to exp(-(v^2/2 + V(y)) / heat).
    """

    def moment(n: int) -> float:
        total: float = quad(lambda u: p * u ** (n * p) * exp(-potential(p, u) / heat), 0, 30, epsabs=1e-14, limit=500)[
            0
        ]
        return total

    grazing = exp(-p * p / (p + 1) / heat)
    whole = moment(0) + heat * grazing
    return sqrt(moment(2) / whole - 1), heat * grazing / whole, sqrt(heat / (2 * pi)) * grazing / whole


def up(problem: Problem) -> list[Problem]:
    """Return problems from a weak excitation up to this one: they stay on the lower branch."""
    return [replace(problem, s=s) for s in np.linspace(0.0, problem.s, 21)]


def threshold(problem: Problem) -> tuple[float, Array]:
    """Return the level up to which the motion from a weak excitation on keeps contact, and the motion there."""

    def least(s: float, start: Array) -> tuple[float, Array]:
        a = COARSE.steady(replace(problem, s=s), start)
        return float((1 + COARSE.values @ a / problem.p).min()), a

    s, a = 0.0, np.zeros(81)
    while (found := least(s + STEP, a))[0] > 0:
        s, a = s + STEP, found[1]
    level = float(brentq(lambda level: least(level, a)[0], s, s + STEP, xtol=1e-12))
    return level, followed([replace(problem, s=level)], a)


def main() -> None:
    """Print the tables."""
    for p in (HERTZ, ROUGH):
        print(f"p = {p:.10f}\n  steady: z, z_c, w, s, periods, phase, rate, mean, amplitude, open")
        for problem in (
            Problem(p, 0.05, 0.0, 0.9, 0.05),
            Problem(p, 0.05, 0.0, 0.9, 0.3),
            Problem(p, 0.0, 0.05, 0.9, 0.3),
            Problem(p, 0.05, 0.0, 0.7, 0.4),
            Problem(p, 0.0, 0.05, 0.7, 0.4),
            Problem(p, 0.05, 0.0, 1.02, 0.45),
        ):
            print(f"    {problem.numbers}, {row(problem, followed(down(problem)))}")
        problem = Problem(p, 0.05, 0.0, 0.5, 0.7)
        print(f"    {problem.numbers}, {row(problem, followed(up(problem)))}")
        problem = Problem(p, 0.02, 0.0, 1.8, 0.6, 2)
        # Of two subharmonic motions the stable one.
        begin = np.zeros(81)
        begin[[0, 1, 41]] = -0.3, 0.5, 0.87
        print(f"    {problem.numbers}, {row(problem, followed([problem], begin))}")
        print("  levels: w, s, phase, rate, linear")
        for w in (0.5, 0.95, 1.0, 1.1, 1.5):
            problem = Problem(p, 0.05, 0.0, w, 0.0)
            level, a = threshold(problem)
            phase, rate, *_ = row(problem, a).split(", ")
            print(f"    {w}, {level:.8f}, {phase}, {rate}, {abs(1 - w * w + 0.1j * w):.4f}")
        grazing = p * p / (p + 1)
        print("  free: rate, frequency over that of small vibrations, period")
        for part in (0.01, 0.25, 1 - 1e-9, 2.0, 10.0):
            lasts = period(p, part * grazing)
            print(f"    {sqrt(2 * part * grazing):.10f}, {2 * pi / lasts:.4f}, {lasts:.9f}")
        print("  noise: heat, deviation of the force, share open, losses of contact")
        for heat in (0.5, 1.0):
            print(f"    {heat}, " + ", ".join(f"{value:.6f}" for value in noise(p, heat)))


if __name__ == "__main__":
    main()
