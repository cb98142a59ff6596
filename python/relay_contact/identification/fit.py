"""Least squares with the component as the model: values, 95 % intervals, correlations, and what the data cannot tell.

The unknowns are logarithms of parameters relative to the relay's file, and of the calibrations of the instruments. The
scatter of each measurement is estimated from its residuals. Size, phase and offset of a ring-down are free: they are
eliminated for each trial of the others (G. H. Golub, V. Pereyra, SIAM J. Numer. Anal. 10 (1973) 413-432).
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import least_squares
from scipy.special import stdtrit

from relay_contact.component import Array, Values
from relay_contact.identification.measurement import BOUNCE, RELATIVE, RINGDOWN, Measurement
from relay_contact.identification.prediction import Laboratory, Ringing

ROUGH = 0.05
"""Scatter, as a part of the value (of the largest, in static force and ring-down), until it is known."""
STEP, SMALL = 3e-4, 0.05
"""Of a logarithm, for derivatives, and of the phase (rad) of a ring-down's last period by a logarithm, at most."""
NEAR, FAR = 10.0, 2e-2
"""Change of the logarithms below which derivatives stay: in steps, and before ring-downs have periods."""
ENOUGH, ROUGHLY = 1e-6, 1e-3
"""Relative changes of the sum of squares at which a search ends, and 100 times those of the logarithms."""
STARTS = tuple(np.arange(1.0, -5.5, -0.5))  # logarithms of contact.damping at which bounces are tried
ROUNDS, CHANGE = 5, 0.02  # of the estimate of the scatter, until it changes by less
TINY = 1e-8  # sensitivity, as a part of the largest, below which there is none
ALL = 1.96  # standard deviations within which 95 % of a normal distribution lie
ENDS = {"low": -1.0, "high": 1.0}
"""Of the search; its signs are the ends of the logarithm of a calibration."""
FREE = 3  # of a ring-down: size, phase and offset


Derivatives = tuple[Array, Array]
"""Of the residuals by the logarithms, after these."""


@dataclass(frozen=True)
class Unknown:
    """A parameter to be found, in positions of the coil that have it in common."""

    name: str
    positions: tuple[str, ...]
    start: float
    label: str
    low: float
    """Least logarithm of the value over that of the start, and greatest."""
    high: float


@dataclass
class Set:
    """A measurement, with what of it does not change during the fit."""

    measurement: Measurement
    sigma: float = ROUGH
    """Scatter in units of the residuals."""
    freedom: float = 1.0
    """Degrees of freedom of this estimate."""
    place: int | None = None
    """Among the calibrations that are sought."""
    factor: Array | float = 1.0
    """By which the prediction is multiplied: levels of a contact that opens relative to those of the linear one."""

    @property
    def scale(self) -> float:
        """Give the unit of the residuals, in that of the values."""
        return float(np.abs(self.measurement.values).max())

    def modelled(self, predicted: Array | Ringing, calibration: float) -> Array:
        """Give the values of the model beside those measured."""
        if isinstance(predicted, Ringing):
            shapes = predicted.shapes / np.abs(predicted.shapes).max(axis=0)
            weights, *_ = np.linalg.lstsq(shapes, self.measurement.values, rcond=None)
            return np.asarray(shapes @ weights)
        return np.asarray(predicted * self.factor * np.exp(calibration))

    def residuals(self, modelled: Array) -> Array:
        """Give measured less modelled values: as parts of them, or of the largest."""
        values = self.measurement.values
        if self.measurement.kind in RELATIVE:
            return np.asarray(np.log(values / np.maximum(modelled, 1e-300)))
        return (values - modelled) / self.scale


def oscillation(time: Array, values: Array) -> tuple[float, float]:
    """Give frequency (Hz) and rate of decay (1/s) of a decaying sine."""
    length = time[-1] - time[0]
    even = np.linspace(time[0], time[-1], len(time))
    spectrum = np.abs(np.fft.rfft(np.interp(even, time, values) - values.mean(), 8 * len(time)))
    top = max(1, int(spectrum.argmax()))
    first = top * (len(time) - 1) / (8 * len(time) * length)

    def left(unknown: Array) -> Array:
        phase, size = 2 * np.pi * np.exp(unknown[0]) * time, np.exp(-np.exp(unknown[1]) * (time - time[0]))
        shapes = np.column_stack((size * np.cos(phase), size * np.sin(phase), np.ones(len(time))))
        weights, *_ = np.linalg.lstsq(shapes, values, rcond=None)
        return np.asarray(values - shapes @ weights)

    fits = [least_squares(left, np.log([first, decays / length])) for decays in (0.3, 1.0, 3.0, 10.0)]
    frequency, decay = np.exp(min(fits, key=lambda fit: float(fit.cost)).x)
    return float(frequency), float(decay)


@dataclass
class Fit:
    """A search for the unknowns."""

    laboratory: Laboratory
    positions: dict[str, Values]
    sets: list[Set]
    unknowns: list[Unknown]
    logarithms: Array = field(default_factory=lambda: np.zeros(0))
    """Of the parameters, then of the calibrations of those measurements that have one."""
    jacobian: Array = field(default_factory=lambda: np.zeros((0, 0)))

    def __post_init__(self) -> None:
        """Begin at the values of the file."""
        self.calibrated = [each for each in self.sets if each.measurement.calibration]
        for place, each in enumerate(self.calibrated):
            each.place = place
        self.logarithms = np.zeros(len(self.unknowns) + len(self.calibrated))
        self.ringing = {
            id(each): oscillation(each.measurement.over, each.measurement.values)
            for each in self.sets if each.measurement.kind == RINGDOWN
        }  # fmt: skip

    @property
    def step(self) -> float:
        """Give the steps of logarithms for derivatives: the frequency goes with half of that of stiffness or mass."""
        spans = {id(each): np.ptp(each.measurement.over) for each in self.sets}
        phases = [np.pi * frequency * spans[key] for key, (frequency, _) in self.ringing.items()]
        return float(min([STEP, *(SMALL / phase for phase in phases)]))

    def values(self, position: str, logarithms: Array) -> Values:
        """Give the parameters in a position."""
        changed = {
            unknown.name: unknown.start * float(np.exp(x))
            for unknown, x in zip(self.unknowns, logarithms, strict=False) if position in unknown.positions
        }  # fmt: skip
        return {**self.positions[position], **changed}

    def modelled(self, each: Set, logarithms: Array, extra: Values | None = None) -> Array:
        """Give the model's values for a measurement."""
        values = {**self.values(each.measurement.position, logarithms), **(extra or {})}
        predicted = self.laboratory.predict(each.measurement, values)
        return each.modelled(predicted, self.calibration(each, logarithms))

    def calibration(self, each: Set, logarithms: Array) -> float:
        """Give the logarithm by which an instrument is wrong."""
        if each.place is None:
            return 0.0
        return float(logarithms[len(self.unknowns) + each.place])

    def beliefs(self, logarithms: Array) -> Array:
        """Give the residuals of the calibrations: what their makers say of them."""
        parts = [each.measurement.calibration / ALL for each in self.calibrated]
        return np.asarray(logarithms[len(self.unknowns) :] / np.array(parts))

    def residuals(self, logarithms: Array, extra: Values | None = None) -> Array:
        """Give all residuals, relative to the scatter."""
        found = [each.residuals(self.modelled(each, logarithms, extra)) / each.sigma for each in self.sets]
        return np.concatenate([*found, self.beliefs(logarithms)])

    def features(self, logarithms: Array) -> Array:
        """Give residuals with frequency and decay in place of each ring-down, whose periods would lead astray."""
        found = []
        for each in self.sets:
            if id(each) not in self.ringing:
                found.append(each.residuals(self.modelled(each, logarithms)) / each.sigma)
                continue
            frequency, decay = self.ringing[id(each)]
            measurement = each.measurement
            shape = self.laboratory.predict(measurement, self.values(measurement.position, logarithms))
            assert isinstance(shape, Ringing)
            since = measurement.over - measurement.over[0]
            last = max(1, int(np.searchsorted(since, min(since[-1], 3 / decay))) - 1)
            modelled = max(shape.decay(0, last) / since[last], 1e-3 * decay)
            found.append(np.log([frequency / shape.frequency, decay / modelled]) / [1e-3, 0.05])
        return np.concatenate([*found, self.beliefs(logarithms)])

    def search(
        self, residuals: Callable[[Array], Array], near: float, enough: float, last: Derivatives | None = None
    ) -> Derivatives:
        """Find the least squares from where the search is; give the derivatives there, and where exactly."""

        def jacobian(at: Array) -> Array:
            nonlocal last
            if last is None or np.abs(at - last[0]).max() > near:
                here = residuals(at)
                steps = self.step * np.eye(len(at))
                last = at.copy(), np.column_stack([(residuals(at + step) - here) / self.step for step in steps])
            return last[1]

        free = len(self.logarithms) - len(self.unknowns)
        bounds = [[getattr(each, end) for each in self.unknowns] + [sign] * free for end, sign in ENDS.items()]
        found = least_squares(
            residuals,
            self.logarithms,
            jacobian,
            bounds=tuple(bounds),
            ftol=enough,
            xtol=100 * enough,
            gtol=None,
            max_nfev=40,
        )
        self.logarithms = found.x
        jacobian(found.x)
        assert last is not None
        return last

    def run(self) -> None:
        """Find unknowns and scatter together."""
        self.look_around()
        if self.ringing:
            self.search(self.features, FAR, ROUGHLY)
        last = None
        for _ in range(ROUNDS):
            last = self.search(self.residuals, NEAR * self.step, ENOUGH, last)
            self.jacobian = last[1]
            # It scales the derivatives too.
            if self.estimate() < CHANGE:
                break

    def look_around(self) -> None:
        """Begin where the contact bounces as measured: where it does not at all, a search finds no way to it."""
        bounces = [each for each in self.sets if each.measurement.kind == BOUNCE]
        damping = [number for number, each in enumerate(self.unknowns) if each.name == "contact.damping"]
        if not (bounces and damping):
            return

        def far(start: float) -> float:
            at = self.logarithms.copy()
            at[damping] = start
            return sum(float((each.residuals(self.modelled(each, at)) ** 2).sum()) for each in bounces)

        self.logarithms[damping] = min(STARTS, key=far)

    def slices(self) -> list[slice]:
        """Give the rows of each measurement."""
        ends = np.cumsum([len(each.measurement.values) for each in self.sets]).tolist()
        return [slice(end - len(each.measurement.values), end) for end, each in zip(ends, self.sets, strict=True)]

    def estimate(self) -> float:
        """Estimate the scatter of each measurement from its residuals; give the largest relative change."""
        covariance = self.covariance
        left = self.residuals(self.logarithms)
        changes = []
        for each, rows in zip(self.sets, self.slices(), strict=True):
            own = self.jacobian[rows]
            spent = float(np.einsum("ij,jk,ik->", own, covariance, own))
            each.freedom = max(1.0, len(own) - spent - FREE * (each.measurement.kind == RINGDOWN))
            factor = max(float(np.sqrt((left[rows] ** 2).sum() / each.freedom)), 1e-9)
            changes.append(abs(np.log(factor)))
            each.sigma *= factor
            self.jacobian[rows] /= factor
        return float(max(changes))

    @property
    def covariance(self) -> Array:
        """Covariance of the logarithms; where the data tell nothing it is very large, not infinite."""
        sizes = np.maximum(np.linalg.norm(self.jacobian, axis=0), TINY)
        _, singular, directions = np.linalg.svd(self.jacobian / sizes, full_matrices=False)
        scaled = directions / np.maximum(singular, TINY)[:, None]
        return np.asarray(scaled.T @ scaled / np.outer(sizes, sizes))

    @property
    def correlation(self) -> Array:
        """Correlations of the parameters."""
        covariance = self.covariance[: len(self.unknowns), : len(self.unknowns)]
        size = np.sqrt(np.diag(covariance))
        return np.asarray(covariance / np.outer(size, size))

    def halves(self) -> Array:
        """Give half of the 95 % intervals of the logarithms of the parameters, by the scatter alone.

        That the weights of the measurements are estimates themselves widens them: M. G. Kenward, J. H. Roger,
        Biometrics 53 (1997) 983-997. Degrees of freedom of a sum of variances that are estimated each by itself:
        F. E. Satterthwaite, Biometrics Bulletin 2 (1946) 110-114.
        """
        covariance = self.covariance
        told = [self.jacobian[rows].T @ self.jacobian[rows] for rows in self.slices()]
        lost = sum(2 / each.freedom * (own - own @ covariance @ own) for each, own in zip(self.sets, told, strict=True))
        wider = np.maximum(np.diag(covariance + 2 * covariance @ lost @ covariance), np.diag(covariance))
        found = []
        influence = covariance @ self.jacobian.T
        parts = np.array([(influence[:, rows] ** 2).sum(axis=1) for rows in self.slices()])
        freedom = np.array([each.freedom for each in self.sets])
        for number in range(len(self.unknowns)):
            variance, own = covariance[number, number], parts[:, number]
            degrees = variance**2 / max(float((own**2 / freedom).sum()), 1e-300)
            found.append(float(stdtrit(degrees, 0.975) * np.sqrt(wider[number])))
        return np.array(found)

    def shifts(self, name: str, part: float) -> Array:
        """Give by how much the parameters move if another one, known to a part of its value only, is at its end."""
        extra: dict[str, Values] = {}
        step = min(part, 1e-3)
        for position in {each.measurement.position for each in self.sets}:
            values = self.values(position, self.logarithms)
            known = 1.0 if name.startswith("spring.") else self.laboratory.component.start(name)
            extra[position] = {name: float(values.get(name, known)) * (1 + step)}
        here = self.residuals(self.logarithms)
        moved = [
            each.residuals(self.modelled(each, self.logarithms, extra[each.measurement.position])) / each.sigma
            for each in self.sets
        ]
        slope = (np.concatenate([*moved, self.beliefs(self.logarithms)]) - here) / step
        return np.asarray(-part * self.covariance @ (self.jacobian.T @ slope))[: len(self.unknowns)]
