"""The publication's specimen as the component: its runs, and what tables, figures and text share of them."""

from functools import cached_property

import numpy as np

from relay_contact import Array, Value, side_by_side
from report import published as paper
from report.bench import PRESTRESSED, Bench, bench, specimen
from report.figure import Curve
from report.published import BEST, FREQUENCIES, RATIOS
from report.spring import LINEAR, Materials, Spring, elastic_reading

DRAWN = (5.0, 10.0, 20.0, 30.0)
"""Ratios that are drawn over frequency; with smaller ones the contact opens near the resonance."""
GRID: Array = np.array(FREQUENCIES)


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
        literal = specimen(self.component) | dict.fromkeys(("beam.stiffnessDamping", "contact.damping"), paper.BETA)
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
        return paper.deviations(rest - amplitude, rest)[1]

    def deviations(self, ratio: float) -> tuple[float, float]:
        """Return the deviations (%) of least and greatest resistance from those measured, at 1000 Hz."""
        run = self.runs[ratio, 1000.0]
        return paper.deviations(run.least, run.greatest)

    def displacement(self, ratio: float) -> float:
        """Return the displacement amplitude at 1000 Hz, base included, um."""
        run = self.runs[ratio, 1000.0]
        return float(1e6 * run.base * run.travel)

    def peak(self, ratio: float) -> tuple[float, float]:
        """Return the greatest force amplitude (cN) of a ratio in the grid, and its frequency."""
        return max((self.runs[ratio, frequency].amplitude, frequency) for frequency in FREQUENCIES)

    def linear_peak(self, alpha: float) -> tuple[float, float]:
        """Return the same in the frequency domain, with mass damping (1/s)."""
        return greatest(self.spring(alpha=alpha).force(LINEAR), LINEAR)

    def linear_force(self, ratio: float) -> float:
        """Return the greatest force amplitude (cN) of a ratio in the grid, if the contact never opened."""
        return float(self.spring(ratio).force(GRID).max())

    def elastic(self, ratio: float) -> tuple[Spring, Spring]:
        """Return the springs of a ratio whose elastic part is compared: with the start values, and refitted."""
        return self.spring(ratio), self.refitted.of_ratio(ratio)

    def elastic_peaks(self, ratio: float) -> list[tuple[float, float]]:
        """Return the greatest amplitudes (cN) of the elastic part in the grid, and their frequencies."""
        return [greatest(each.elastic(GRID), GRID) for each in self.elastic(ratio)]

    def between_domains(self, ratio: float, alpha: float) -> list[float]:
        """Return the largest relative deviations between frequency domain (1/s) and time domain over the grid.

        Those of the force, of the force without contact damping, of its elastic part, and of this up to 1500 Hz.
        """
        linear, spring = self.spring(alpha=alpha).force(GRID), self.spring(ratio)
        bench().contact.begin_anew(specimen(self.component, ratio) | {"contact.damping": 0.0})
        bare = Spring.of(bench().contact)
        whole = np.array([self.runs[ratio, frequency].amplitude for frequency in FREQUENCIES])
        apart = [np.abs(linear / each - 1) for each in (whole, bare.force(GRID), spring.elastic(GRID))]
        return [float(each.max()) for each in apart] + [float(apart[-1][GRID <= 1500].max())]

    def misfits(self) -> list[float]:
        """Return the misfits of Table 6: of the total force, of its elastic part, and of that refitted."""
        rest, found = self.rest("preload.force"), np.zeros(3)
        for ratio, *known in paper.RESISTANCE_DEVIATIONS:
            amplitudes = [float(each.elastic(1000.0)[0]) / 100 for each in self.elastic(ratio)]
            elastic = [paper.deviations(rest - each, rest + each) for each in amplitudes]
            found += np.abs(np.abs([self.deviations(ratio), *elastic]) - known).sum(axis=1)
        return [float(each) for each in found]


def greatest(amplitudes: Array, frequencies: Array) -> tuple[float, float]:
    """Return the greatest amplitude, and its frequency."""
    at = int(amplitudes.argmax())
    return float(amplitudes[at]), float(frequencies[at])
