"""The publication's specimen as the component: its runs, and what tables, figures and text share of them."""

from functools import cached_property

import numpy as np

from relay_contact import Value, side_by_side
from report import published as paper
from report.bench import PRESTRESSED, Bench, bench, damped, specimen
from report.figure import Curve
from report.published import ACCELERATION, BEST, FREQUENCIES, RATIOS
from report.spring import Materials, Spring, elastic_reading

DRAWN = (5.0, 10.0, 20.0, 30.0)
"""Ratios that are drawn over frequency; with smaller ones the contact opens near the resonance."""


def base(frequency: float) -> float:
    """Return the amplitude of the base, m."""
    return float(ACCELERATION / (2 * np.pi * frequency) ** 2)


def resistance(force: float) -> float:
    """Return the resistance at a force (N) by the published law, mOhm, as the component has it."""
    return float(paper.RESISTANCE * force**-paper.EXPONENT)


def force(resistance: float) -> float:
    """Return the force (N) at which the published law has a resistance, mOhm."""
    return float((paper.RESISTANCE / resistance) ** (1 / paper.EXPONENT))


def deviations(least: float, greatest: float) -> tuple[float, float]:
    """Return deviations (%) of least and greatest resistance from those measured, by the extremes of the force (N)."""
    measured = paper.LEAST_RESISTANCE, paper.GREATEST_RESISTANCE
    found = resistance(greatest), resistance(least)
    return 100 * (found[0] / measured[0] - 1), 100 * (found[1] / measured[1] - 1)


class Publication:
    """What the component has of the publication."""

    def __init__(self, coarse: bool) -> None:
        """Run the published grid; coarse curves change no number of the text."""
        self.component = bench().component
        self.frequencies = np.arange(250.0, 2001.0, 125.0 if coarse else 25.0).tolist()
        self.overtravels = np.linspace(0.05, 0.5, 10 if coarse else 46)
        grid = [(ratio, frequency) for ratio in RATIOS for frequency in FREQUENCIES]
        curves = [(ratio, frequency) for ratio in DRAWN for frequency in self.frequencies]
        keys = list(dict.fromkeys(grid + curves))
        literal = damped(specimen(self.component), 1.0) | dict.fromkeys(
            ("beam.stiffnessDamping", "contact.damping"), paper.BETAS[3]
        )
        tasks = [(specimen(self.component, ratio), frequency) for ratio, frequency in keys]
        tasks += [(literal, frequency) for frequency in FREQUENCIES]
        runs = side_by_side(lambda task: Bench(self.component).vibrate(*task), tasks)
        self.runs = dict(zip(keys, runs, strict=False))
        self.literal = runs[len(keys) :]

    def spring(self, ratio: float = BEST, alpha: float = 0.0) -> Spring:
        """Return the specimen in closed form: with the damping of a ratio, or with mass damping (1/s) alone."""
        values = specimen(self.component, 0.0 if alpha else ratio)
        bench().contact.begin_anew(values | {"beam.massDamping": alpha})
        return Spring.of(bench().contact)

    @cached_property
    def materials(self) -> Materials:
        """What is published of the materials."""
        bench().contact.begin_anew({})
        return Materials.of(bench().contact)

    def rest(self, output: str, **values: Value) -> float:
        """Return an output at rest, with prestress unless it is changed."""
        named: dict[str, Value] = {name.replace("_", "."): value for name, value in values.items()}
        return bench().rest({**PRESTRESSED, **named}, output)

    def frequency(self, length: float, overtravel: float) -> float:
        """Return the first frequency of another length and overtravel, mm."""
        return self.rest("preload.frequency", beam_length=1e-3 * length, contact_overtravel=1e-3 * overtravel)

    def curve(self, name: str, ratio: float, colour: int) -> Curve:
        """Return the force amplitude over the frequency."""
        return Curve(name, self.frequencies, [self.runs[ratio, f].amplitude for f in self.frequencies], "line", colour)

    @cached_property
    def by_alpha(self) -> tuple[list[float], list[float]]:
        """Mass coefficients, and the deviation of the greatest resistance with each, %."""
        alphas = np.arange(3000.0, 7001.0, 100.0).tolist()
        return alphas, [abs(self.weakest_resistance(alpha)) for alpha in alphas]

    @cached_property
    def refitted(self) -> Spring:
        """The spring whose elastic force has both published amplitudes of ratio 10."""
        _, frequency, amplitude = paper.PEAKS[0]
        return elastic_reading(self.materials, frequency, amplitude).spring

    def excess(self) -> list[float]:
        """Return the displacement of the contact in excess of the base with the least damping drawn, %."""
        return [100 * (self.runs[DRAWN[0], frequency].travel - 1) for frequency in self.frequencies]

    def weakest_resistance(self, alpha: float) -> float:
        """Return the deviation of the greatest resistance in the frequency domain, with mass damping (1/s), %."""
        amplitude = float(self.spring(alpha=alpha).force(1000.0)[0]) / 100
        rest = self.rest("preload.force")
        return deviations(rest - amplitude, rest)[1]

    def peak(self, ratio: float) -> tuple[float, float]:
        """Return the greatest force amplitude (cN) of a ratio in the grid, and its frequency."""
        return max((self.runs[ratio, frequency].amplitude, frequency) for frequency in FREQUENCIES)
