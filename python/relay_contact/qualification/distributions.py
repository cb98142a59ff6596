"""How uncertain parameters are distributed, by name, and correlated; as the files of relays give them."""

from math import erfc, sqrt
from statistics import NormalDist
from typing import Annotated, Literal

import numpy as np
from pydantic import Field, TypeAdapter, ValidationError, model_validator
from pydantic.dataclasses import dataclass

from relay_contact.component import Array
from relay_contact.files import RelayContactError
from relay_contact.schema import STRICT, Table, allowed, dotted, within

# scipy has them too, and takes longer to import than a test.
below = np.vectorize(lambda score: erfc(-score / sqrt(2)) / 2, otypes=[float])
"""Chance that a standard normal distribution is below a score."""
quantile = np.vectorize(NormalDist().inv_cdf, otypes=[float])
"""Score that it is below with a chance."""
LIMITS = (0.025, 0.975)
SCORES = quantile(LIMITS)
TWO_SIDED = float(SCORES[1])
"""Standard deviations from the middle of a normal distribution to the limits of 95 %."""
LEAST = 0.01
"""Part of its value that a drawn parameter has at least, so that none changes its sign."""
FEWEST = 5  # values that tell a distribution
Finite = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Part = Annotated[float, within(-1.0, 1.0)]


@dataclass(frozen=True, config=STRICT)
class Distribution:
    """Of a parameter, by parts of its value.

    Normal: `part` on either side with 95 % confidence. Uniform: up to `part` on either side. Triangular: from `low`
    over `mode` to `high`. Data: `values` of a sample, in the unit of the parameter; of an entry of the spring file,
    factors.
    """

    distribution: Literal["normal", "uniform", "triangular", "data"] = "normal"
    part: Annotated[float, Field(strict=True, ge=0, lt=1)] | None = None
    low: Part | None = None
    mode: Part | None = None
    high: Part | None = None
    values: Annotated[tuple[Finite, ...], Field(min_length=FEWEST)] | None = None

    @model_validator(mode="after")
    def is_whole(self) -> "Distribution":
        """Refuse entries that are not those of the distribution."""
        needed = {"triangular": {"low", "mode", "high"}, "data": {"values"}}.get(self.distribution, {"part"})
        given = {name for name in ("part", "low", "mode", "high", "values") if getattr(self, name) is not None}
        if given != needed:
            raise ValueError(f"a {self.distribution} distribution has {', '.join(sorted(needed))}")
        low, mode, high = self.corners
        if self.distribution == "triangular" and not low <= mode <= high > low:
            raise ValueError("low, mode and high have to rise")
        return self

    @property
    def corners(self) -> tuple[float, float, float]:
        """Low, mode and high of a triangle."""
        return self.low or 0.0, self.mode or 0.0, self.high or 0.0

    def factor(self, score: Array, value: float) -> Array:
        """Return the parameter in parts of its value, for scores of a standard normal distribution."""
        chance = below(score)
        match self.distribution:
            case "normal":
                found = 1 + (self.part or 0.0) * np.asarray(score) / TWO_SIDED
            case "uniform":
                found = 1 + (self.part or 0.0) * (2 * chance - 1)
            case "triangular":
                low, mode, high = self.corners
                rising = low + np.sqrt(chance * (high - low) * (mode - low))
                falling = high - np.sqrt((1 - chance) * (high - low) * (high - mode))
                found = 1 + np.where(chance * (high - low) < mode - low, rising, falling)
            case "data":
                found = np.quantile(np.array(self.values), chance, method="hazen") / value
        return np.maximum(found, LEAST)

    def check(self, name: str, value: float, where: str) -> None:
        """Refuse a sample in whose range the value of the parameter is not, or that has another sign."""
        if not self.values:
            return
        low, high = min(self.values), max(self.values)
        if not low <= value <= high or low * value <= 0 or high * value <= 0:
            text = f"not allowed, {where} has {value:g}, which has to be among them, and all of the same sign"
            raise RelayContactError(f"uncertainty.{name}: values of {low:g} to {high:g}: {text}")

    def half(self, value: float) -> float:
        """Return half of the interval of 95 %, as a part of the value."""
        low, high = self.factor(SCORES, value)
        return float(high - low) / 2

    def told(self, value: float) -> str:
        """Describe it."""
        if self.distribution == "normal":
            return f"± {100 * (self.part or 0.0):.3g} %"
        low, high = (100 * (each - 1) for each in self.factor(SCORES, value))
        return f"{low:+.3g} to {high:+.3g} % ({self.distribution})"


def read(value: object) -> Distribution:
    """Return a distribution as a file has it: a part of the value, of a normal one, or a table."""
    entries = value if isinstance(value, dict) else {"part": value}
    try:
        return TypeAdapter(Distribution).validate_python(entries)
    except ValidationError as errors:
        first = errors.errors()[0]
        if not isinstance(value, dict):
            raise ValueError("allowed is a part of the value, from 0 to less than 1, or a distribution") from errors
        place = f"{dotted(first['loc'])}: " if first["loc"] else ""
        raise ValueError(place + allowed(first)) from errors


class Correlation(Table):
    """Coefficients of correlation of some uncertain parameters, as identification finds them."""

    names: tuple[str, ...] = ()
    matrix: tuple[tuple[Annotated[float, within(-1.0, 1.0)], ...], ...] = ()

    @model_validator(mode="after")
    def is_one(self) -> "Correlation":
        """Refuse what is not a matrix of correlations."""
        matrix, count = self.matrix, len(self.names)
        if len(set(self.names)) < count:
            raise ValueError("names: each once")
        if len(matrix) != count or any(len(row) != count for row in matrix):
            raise ValueError(f"matrix: {count} rows of {count} coefficients, one for each name")
        array = np.array(matrix).reshape(count, count)
        if not np.array_equal(array, array.T) or not np.array_equal(np.diag(array), np.ones(count)):
            raise ValueError("matrix: symmetrical, with 1 on its diagonal")
        if count and np.linalg.eigvalsh(array).min() < -1e-6:
            raise ValueError("matrix: these coefficients cannot be together, it has a negative eigenvalue")
        return self

    def root(self, names: list[str]) -> Array:
        """Return by which independent scores are multiplied for correlated ones, in the order of the names."""
        whole = np.eye(len(names))
        for row, one in enumerate(self.names):
            for column, other in enumerate(self.names):
                if one in names and other in names:
                    whole[names.index(one), names.index(other)] = self.matrix[row][column]
        values, directions = np.linalg.eigh(whole)
        # By its eigenvectors: correlations of 1 leave no root of Cholesky's.
        return np.asarray(directions * np.sqrt(np.maximum(values, 0.0)) @ directions.T)
