"""Least squares with the component as the model: values, 95 % intervals, correlations, and what the data cannot tell.

The unknowns are logarithms of parameters relative to the relay's file, and of the calibrations of the instruments. The
scatter of each measurement is estimated from its residuals. A ring-down has two, of its frequency and rate of decay.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.linalg import lstsq
from scipy.ndimage import minimum_filter
from scipy.optimize import least_squares
from scipy.special import stdtrit

from relay_contact.component import Array, Values
from relay_contact.files import RelayContactError
from relay_contact.identification.measurement import BOUNCE, CHATTER, RELATIVE, RESPONSE, RINGDOWN, Measurement
from relay_contact.identification.prediction import Laboratory
from relay_contact.identification.ringdown import RingDown, ring_down, shapes
from relay_contact.spring import STIFFNESS

ROUGH = 0.05
"""Scatter until it is known, as a part of the value (of the largest static force, of the frequency of a ring-down): the
search comes near before a frequency, which may be known to 1e-5, leaves it a narrow curved valley."""
STEP = 1e-3
"""Of a logarithm, either way, for derivatives: right to STEP^2 / 6 of the third ones, and to the error of a prediction
(1e-8 to 1e-7) over STEP."""
NEAR = 3e-3
"""Change of the logarithms below which derivatives stay."""
ENOUGH = 1e-8
"""Relative change of the sum of squares at which a search ends, and 100 times that of the logarithms."""
TRIALS = 100
NEARBY = tuple(np.linspace(-1.2, 1.2, 25).tolist())
TRIED: tuple[tuple[set[str], dict[str, tuple[float, ...]]], ...] = (
    ({BOUNCE}, {"contact.damping": tuple(np.arange(1.0, -5.5, -0.5).tolist())}),
    ({RESPONSE, CHATTER}, {"beam.youngsModulus": NEARBY, STIFFNESS: NEARBY, "tip.mass": NEARBY[::4]}),
)
"""Logarithms of parameters that are tried together before a search: where the contact does not bounce at all, or a
weakly damped resonance is on the other side of a frequency that was measured, it finds no way."""
BEGUN, ROUGHLY = 4, 1e-5  # what is enough for searches from the best of them that are better than all beside them
RIVAL = 10.0
"""Difference of the sums of squares, of chance 2e-3 for one parameter, below which another answer is told."""
ROUNDS, CHANGE = 8, 0.005  # of the estimate of the scatter, until it changes by less
FEWEST = 2.0
"""Degrees of freedom of a scatter below which its estimate does not fall: a measurement that others hardly check would
be met ever more closely, and end as exact."""
HELD = 1.5
"""Standard deviation of the logarithms, about the relay's file, as long as some of them are not determined: the search
would go far away along them, and might find another minimum there."""
TINY = 1e-8  # sensitivity, as a part of the largest, below which there is none
UNKNOWN = 10.0  # standard deviation of logarithms, at least, where there is none
ALL = 1.96  # standard deviations within which 95 % of a normal distribution lie
ENDS = {"low": -1.0, "high": 1.0}
"""Of the search; its signs are the ends of the logarithm of a calibration."""

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
    ring: RingDown | None = None

    def __post_init__(self) -> None:
        """Fit a ring-down by itself, once for all."""
        if self.measurement.kind == RINGDOWN and self.ring is None:
            self.ring = ring_down(self.measurement.over, self.measurement.values)
            self.sigma = ROUGH * float(np.linalg.norm(self.ring.root[:, 1] * self.ring.pole[1]))

    @property
    def size(self) -> int:
        """Return the number of residuals."""
        return 2 if self.ring else len(self.measurement.values)

    @property
    def scale(self) -> float:
        """Return the unit of the residuals, in that of the values."""
        return float(np.abs(self.measurement.values).max())

    def modelled(self, predicted: Array, calibration: float) -> Array:
        """Return the values of the model beside those measured."""
        if self.ring:
            columns = shapes(self.measurement.over, predicted)
            return np.asarray(columns @ lstsq(columns, self.measurement.values)[0])
        return np.asarray(predicted * self.factor * np.exp(calibration))

    def differences(self, modelled: Array) -> Array:
        """Return measured less modelled values: as parts of them, or of the largest."""
        values = self.measurement.values
        if self.measurement.kind in RELATIVE:
            return np.asarray(np.log(values / np.maximum(modelled, 1e-300)))
        return (values - modelled) / self.scale

    def residuals(self, predicted: Array, calibration: float) -> Array:
        """Return what the search makes small: of a ring-down, what its pole adds to the residuals of its own fit."""
        if self.ring:
            return np.asarray(self.ring.root @ (self.ring.pole - predicted))
        return self.differences(self.modelled(predicted, calibration))


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
    held: float = np.inf
    """Standard deviation of the logarithms of the parameters about zero."""
    ends: list[Array] = field(default_factory=list)
    """Of the first searches, from several starts."""

    def __post_init__(self) -> None:
        """Begin at the values of the file."""
        self.calibrated = [each for each in self.sets if each.measurement.calibration]
        for place, each in enumerate(self.calibrated):
            each.place = place
        self.logarithms = np.zeros(len(self.unknowns) + len(self.calibrated))

    def values(self, position: str, logarithms: Array) -> Values:
        """Return the parameters in a position."""
        changed = {
            unknown.name: unknown.start * float(np.exp(x))
            for unknown, x in zip(self.unknowns, logarithms, strict=False) if position in unknown.positions
        }  # fmt: skip
        return {**self.positions[position], **changed}

    def predicted(self, each: Set, logarithms: Array, extra: Values | None = None) -> Array:
        """Return what the component predicts for a measurement."""
        values = {**self.values(each.measurement.position, logarithms), **(extra or {})}
        return self.laboratory.predict(each.measurement, values)

    def modelled(self, each: Set, logarithms: Array) -> Array:
        """Return the model's values for a measurement."""
        return each.modelled(self.predicted(each, logarithms), self.calibration(each, logarithms))

    def left(self, each: Set, logarithms: Array, extra: Values | None = None) -> Array:
        """Return the residuals of a measurement, relative to its scatter."""
        predicted = self.predicted(each, logarithms, extra)
        return each.residuals(predicted, self.calibration(each, logarithms)) / each.sigma

    def calibration(self, each: Set, logarithms: Array) -> float:
        """Return the logarithm by which an instrument is wrong."""
        if each.place is None:
            return 0.0
        return float(logarithms[len(self.unknowns) + each.place])

    def beliefs(self, logarithms: Array) -> Array:
        """Return the residuals of the calibrations, what their makers say of them, and of parameters that are held."""
        parts = [each.measurement.calibration / ALL for each in self.calibrated]
        return np.asarray(logarithms / np.array([self.held] * len(self.unknowns) + parts))

    def residuals(self, logarithms: Array) -> Array:
        """Return all residuals, relative to the scatter."""
        return np.concatenate([*(self.left(each, logarithms) for each in self.sets), self.beliefs(logarithms)])

    def derivatives(self, at: Array) -> Array:
        """Return those of the residuals by the logarithms."""
        steps = STEP * np.eye(len(at))
        ahead, behind = (np.column_stack([self.residuals(at + sign * step) for step in steps]) for sign in (1, -1))
        return np.asarray((ahead - behind) / (2 * STEP))

    def search(self, last: Derivatives | None, enough: float = ENOUGH) -> Derivatives:
        """Find the least squares from where the search is; return the derivatives there, and where exactly."""

        def jacobian(at: Array) -> Array:
            nonlocal last
            if last is None or np.abs(at - last[0]).max() > NEAR:
                last = at.copy(), self.derivatives(at)
            return last[1]

        free = len(self.logarithms) - len(self.unknowns)
        low, high = ([getattr(each, end) for each in self.unknowns] + [sign] * free for end, sign in ENDS.items())
        start = np.clip(self.logarithms, low, high)
        if not (slopes := jacobian(start)).any():
            # The data tell nothing of any.
            return start, slopes
        found = least_squares(
            self.residuals, start, jacobian, bounds=(low, high), ftol=enough, xtol=100 * enough, gtol=None,
            max_nfev=TRIALS,
        )  # fmt: skip
        # What holds the search does not let it go far along what the data do not determine.
        if found.status == 0 and self.held == np.inf and enough == ENOUGH:
            text = "begin from other values in the relay's file"
            raise RelayContactError(f"no least squares after {TRIALS} trials: {text}")
        self.logarithms = found.x
        jacobian(found.x)
        assert last is not None
        return last

    def run(self) -> None:
        """Find unknowns and scatter together."""
        last = None
        for _ in range(ROUNDS):
            last = self.search(last)
            self.jacobian = last[1]
            # It scales the derivatives too.
            if self.estimate() < CHANGE:
                break

    def squares(self, at: Array) -> float:
        """Return the sum of squares."""
        return float((self.residuals(at) ** 2).sum())

    def look_around(self) -> None:
        """Begin where the contact bounces, or the spring resounds, nearly as measured."""
        measured = {each.measurement.kind for each in self.sets}
        for kinds, tried in TRIED:
            axes = [name for name in tried if kinds & measured and any(each.name == name for each in self.unknowns)]
            if not axes:
                continue
            grids = dict(zip(axes, np.meshgrid(*(tried[name] for name in axes), indexing="ij"), strict=True))
            points = np.tile(self.logarithms, (*grids[axes[0]].shape, 1))
            for number, each in enumerate(self.unknowns):
                if each.name in axes:
                    points[..., number] = np.clip(grids[each.name], each.low, each.high)
            squares = np.apply_along_axis(self.squares, -1, points)
            lowest = squares == minimum_filter(squares, 3)
            for start in points[lowest][np.argsort(squares[lowest], kind="stable")][:BEGUN]:
                self.logarithms = start
                self.search(None, ROUGHLY)
                if all(np.abs(self.logarithms - end).max() > 100 * STEP for end in self.ends):
                    self.ends.append(self.logarithms)
            self.logarithms = min(self.ends, key=self.squares)

    def rivals(self) -> list[Array]:
        """Return where else a search ends that fits nearly as well."""
        own, halves, found = self.logarithms, self.halves(), []
        least = self.squares(own) + RIVAL
        for end in self.ends:
            self.logarithms = end
            self.search(None, ROUGHLY)
            away = np.abs(self.logarithms - own)[: len(halves)]
            if (away > 2 * halves).any() and self.squares(self.logarithms) < least:
                found.append(self.logarithms)
        self.logarithms = own
        return found

    def slices(self) -> list[slice]:
        """Return the rows of each measurement."""
        ends = np.cumsum([each.size for each in self.sets]).tolist()
        return [slice(end - each.size, end) for end, each in zip(ends, self.sets, strict=True)]

    def estimate(self) -> float:
        """Estimate the scatter of each measurement from its residuals; give the largest relative change."""
        covariance = self.covariance
        left = self.residuals(self.logarithms)
        changes = []
        for each, rows in zip(self.sets, self.slices(), strict=True):
            own = self.jacobian[rows]
            spent = float(np.einsum("ij,jk,ik->", own, covariance, own))
            more, squares = (each.ring.freedom, each.ring.left / each.sigma**2) if each.ring else (0, 0.0)
            freedom = len(own) + more - spent
            each.freedom = max(1.0, freedom)
            least = 1e-9 if freedom >= FEWEST else 1.0
            factor = max(float(np.sqrt(((left[rows] ** 2).sum() + squares) / each.freedom)), least)
            changes.append(abs(np.log(factor)))
            each.sigma *= factor
            self.jacobian[rows] /= factor
        return float(max(changes))

    @property
    def covariance(self) -> Array:
        """Covariance of the logarithms; where the data tell nothing it is very large, not infinite."""
        # That parameters are held tells nothing.
        end = self.slices()[-1].stop
        told = np.delete(self.jacobian, slice(end, end + len(self.unknowns)), axis=0)
        sizes = np.maximum(np.linalg.norm(told, axis=0), TINY)
        # As many rows as unknowns at least: with fewer, directions that the data tell nothing of would be left out.
        rows = np.vstack([told / sizes, np.zeros((len(sizes), len(sizes)))])
        _, singular, directions = np.linalg.svd(rows, full_matrices=False)
        # However small the scatter is.
        least = np.minimum(TINY, np.linalg.norm(directions / sizes, axis=1) / UNKNOWN)
        scaled = directions / np.where(singular > TINY, singular, least)[:, None]
        return np.asarray(scaled.T @ scaled / np.outer(sizes, sizes))

    @property
    def correlation(self) -> Array:
        """Correlations of the parameters."""
        covariance = self.covariance[: len(self.unknowns), : len(self.unknowns)]
        size = np.sqrt(np.diag(covariance))
        return np.asarray(covariance / np.outer(size, size))

    def halves(self) -> Array:
        """Return half of the 95 % intervals of the logarithms of the parameters, by the scatter alone.

        That the weights of the measurements are estimates themselves widens them: M. G. Kenward, J. H. Roger,
        Biometrics 53 (1997) 983-997. Of the degrees of freedom of measurements that share in a parameter the mean by
        their shares counts: the sum that F. E. Satterthwaite, Biometrics Bulletin 2 (1946) 110-114, has for shares that
        are given is too large where they go by the same estimates (93 % in place of 95 % for 7, 9 and 6 rows).
        """
        covariance = self.covariance
        told = [self.jacobian[rows].T @ self.jacobian[rows] for rows in self.slices()]
        lost = sum(2 / each.freedom * (own - own @ covariance @ own) for each, own in zip(self.sets, told, strict=True))
        wider = np.maximum(np.diag(covariance + 2 * covariance @ lost @ covariance), np.diag(covariance))
        influence = covariance @ self.jacobian.T
        shares = np.array([(influence[:, rows] ** 2).sum(axis=1) for rows in self.slices()]) / np.diag(covariance)
        freedom = np.array([each.freedom for each in self.sets])
        degrees = 1 / np.maximum(shares.sum(axis=0) * (shares / freedom[:, None]).sum(axis=0), 1e-9)
        return np.asarray(stdtrit(degrees, 0.975) * np.sqrt(wider))[: len(self.unknowns)]

    def shifts(self, name: str, part: float) -> Array:
        """Return by how much the parameters move if another one, known to a part of its value only, is at its end."""
        step = min(part, STEP)

        def moved(factor: float) -> Array:
            left = []
            for each in self.sets:
                values = self.values(each.measurement.position, self.logarithms)
                known = self.laboratory.component.value(values, name)
                left.append(self.left(each, self.logarithms, {name: known * factor}))
            return np.concatenate([*left, self.beliefs(self.logarithms)])

        slope = (moved(1 + step) - moved(1 - step)) / (2 * step)
        return np.asarray(-part * self.covariance @ (self.jacobian.T @ slope))[: len(self.unknowns)]
