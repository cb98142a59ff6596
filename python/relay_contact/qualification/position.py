"""A position of the coil by one of the models, shaken along an axis: its contacts, and how uncertain their margins are.

The margin of a test follows from the response to a pulse; in draws of the uncertain parameters too
(`relay_contact.qualification.statistics`). Where linear theory is off, and by how much, the component tells: as the
relay is, at both ends of the interval, and at the limit between failing and passing.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.stats import norm, qmc

from relay_contact.component import Array, Component, Values
from relay_contact.qualification import statistics
from relay_contact.qualification.distributions import LEAST, LIMITS, TWO_SIDED
from relay_contact.qualification.excitation import Random, Sine, Test, Transient
from relay_contact.qualification.relay import NORMAL, Model, Relay
from relay_contact.qualification.response import Response, margin, respond
from relay_contact.qualification.results import Chance
from relay_contact.qualification.standards import Contacts
from relay_contact.qualification.trials import Piece, Specimen, middle_dip, noise_dips, pieces, sine_least
from relay_contact.spring import PREFIX

MODEL = "model"
CHANCE = "chance of the largest dip"
WORN = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2)
"""Parts of the overtravel over which margins are shown."""
FEWEST, EACH, DRAWS = 64, 16, 256
"""Draws of the uncertain parameters in which the component answers a pulse: fewest, for each parameter, most."""
AT_LIMIT = 2
"""Draws next to the limit in which the component seeks the level itself."""
SETTLED = 1e-3
"""Part of its largest answer below which that of a drawn contact is cut off."""
GRID = np.linspace(-5.0, 5.0, 41)
"""Scores of the chance of the largest dip."""
NEAR = 0.05
"""Of 1, within which draws are at the limit: others would tell of another level."""


@dataclass
class Position:
    """A position of the coil by one of the models, along an axis."""

    component: Component
    relay: Relay
    name: str
    contacts: Contacts
    tests: tuple[Test, ...]
    model: Model
    axis: str = NORMAL

    @cached_property
    def values(self) -> Values:
        """Parameters of the component."""
        return {**self.relay.positions[self.name], **self.model.parameters, **self.relay.axes.get(self.axis, {})}

    def value(self, name: str) -> float:
        """Return the value of a parameter; that of an entry of the spring file is a factor, 1 but in further axes."""
        if name.startswith(PREFIX):
            return float(self.values.get(name, 1.0))
        return float(self.values.get(name, self.component.start(name)))

    def response(self, changes: Values, calm: float = SETTLED) -> Response:
        """Return the response with some other values of parameters."""
        return respond(self.component, {**self.values, **changes}, self.contacts.threshold, calm)

    @cached_property
    def specimen(self) -> Specimen:
        """The contacts as the file says."""
        response = respond(self.component, self.values, self.contacts.threshold)
        return Specimen(self.component, self.values, self.contacts, response)

    @cached_property
    def pieces(self) -> dict[str, dict[str, list[Piece]]]:
        """Of each course, by the test's name and its directions: as a whole, or what is around its largest dips."""
        return {
            test.name: {way: pieces(self.specimen, test.course(), sign) for way, sign in test.directions.items()}
            for test in self.tests if isinstance(test, Transient)
        }  # fmt: skip

    @cached_property
    def noises(self) -> dict[str, tuple[list[Piece], float]]:
        """Of each noise, by the test's name: what is around its largest dips, and what clipping makes of its level."""
        return {test.name: noise_dips(self.specimen, test) for test in self.tests if isinstance(test, Random)}

    def linear(self, response: Response, test: Test) -> float:
        """Return the margin by linear theory, of a course by its pieces."""
        lasting = self.specimen.lasting
        if isinstance(test, Transient):
            found = [
                response.course(piece.course, test.directions[way], lasting)
                for way, own in self.pieces[test.name].items() for piece in own
            ]  # fmt: skip
            return max(min(found), 0.0)
        return max(margin(response, test, lasting), 0.0)

    @cached_property
    def scores(self) -> Array:
        """Independent scores of the uncertain parameters in the draws that the component answers, in columns.

        They are points of Sobol's sequence, which fill the space evenly: each column alone is as even as it can be.
        """
        count = len(self.relay.uncertainty)
        if not count:
            return np.zeros((1, 0))
        # Powers of 2, of which each column is even.
        draws = min(DRAWS, max(FEWEST, 2 ** int(np.ceil(np.log2(EACH * (count + 1))))))
        return np.asarray(norm.ppf(qmc.Sobol(count, scramble=False).random(draws) + 0.5 / draws))

    @cached_property
    def root(self) -> Array:
        """By which independent scores are multiplied for correlated ones."""
        return self.relay.correlation.root(list(self.relay.uncertainty))

    def drawn(self, scores: Array) -> Values:
        """Return the uncertain parameters for independent scores."""
        found = {}
        for (name, distribution), score in zip(self.relay.uncertainty.items(), self.root @ scores, strict=True):
            value = self.value(name)
            # A sample of an entry of the spring file has factors of it.
            unit = 1.0 if name.startswith(PREFIX) else value
            found[name] = value * float(distribution.factor(score, unit)) if value else 0.0
        return found

    @cached_property
    def surfaces(self) -> dict[str, statistics.Surface]:
        """Logarithm of the margin of each test over the scores, by linear theory."""
        found: dict[str, list[float]] = {test.name: [] for test in self.tests}
        for row in self.scores:
            response = self.response(self.drawn(row)) if len(row) else self.specimen.response
            for test in self.tests:
                found[test.name].append(np.log(max(self.linear(response, test), 1e-9)))
        return {name: statistics.Surface(self.scores, np.array(values)) for name, values in found.items()}

    @cached_property
    def worn(self) -> dict[float, Response]:
        """The responses over the overtravel (m), which the wear of the contacts takes away, or over the gap."""
        name = "contact.overtravel"
        nominal = self.value(name)
        return {abs(part * nominal): self.response({name: part * nominal}) for part in WORN}

    def wear(self, test: Test, factor: float) -> dict[str, list[float]]:
        """Return the margin over overtravel or gap, for a margin that the component found as it is."""
        margins = [self.linear(response, test) for response in self.worn.values()]
        ratio = factor / margins[WORN.index(1.0)]
        return {"overtravel": list(self.worn), "margin": [ratio * value for value in margins]}

    def ratio(self, values: Values, response: Response, test: Test) -> float:
        """Return the level that fails in the component, with other parameters, by that of linear theory."""
        specimen = replace(self.specimen, values={**self.values, **values}, response=response)
        match test:
            case Sine():
                return sine_least(specimen, test)[1] / self.linear(response, test)
            case Random():
                dips, eased = self.noises[test.name]
                lasting = self.specimen.lasting
                own = [replace(each, guess=response.course(each.course, 1.0, lasting)) for each in dips]
                return middle_dip(specimen, own)[0] * eased
        ways = self.pieces[test.name].items()
        assert isinstance(test, Transient)
        guesses = [
            (response.course(piece.course, test.directions[way], specimen.lasting), way, piece)
            for way, own in ways for piece in own
        ]  # fmt: skip
        guess, way, piece = min(guesses, key=lambda each: each[0])
        return piece.threshold(specimen, test.directions[way], guess=guess)[0] / guess

    def dips(self, test: Test, scores: Array) -> Array:
        """Return the part of the margin for scores of the chance of the largest dip."""
        if not isinstance(test, Random):
            return np.ones(len(scores))
        response, lasting = self.specimen.response, self.specimen.lasting
        found = np.array([response.random(test, lasting, float(each)) for each in norm.cdf(GRID)])
        return np.interp(scores, GRID, found / response.random(test, lasting))

    def margins(self, test: Test, factor: float) -> tuple[Array, Chance]:
        """Return the margin in many draws, for that which the component found as it is, and what comes of them.

        What the component found in place of linear theory lies on straight lines between the draws where it is known.
        """
        surface = self.surfaces[test.name]
        count = len(self.relay.uncertainty)
        independent = statistics.drawn(count + 2)
        linear = np.exp(surface(independent[:, :count]))
        nominal = self.linear(self.specimen.response, test)
        known = {nominal: factor / nominal}
        others = self.dips(test, independent[:, -1]) * np.maximum(
            1 + self.model.uncertainty * independent[:, -2] / TWO_SIDED, LEAST
        )

        def whole() -> Array:
            levels = np.array(sorted(known.items()))
            return np.asarray(np.interp(linear, *levels.T) * linear * others)

        errors = [surface.error if count else 0.0]
        chosen = [int(np.argsort(linear)[int(limit * len(linear))]) for limit in LIMITS] if count else []
        for round_ in range(2 if count else 0):
            for number in chosen:
                values = self.drawn(independent[number, :count])
                response = self.response(values)
                own = self.linear(response, test)
                if own <= 0:
                    continue
                found = self.ratio(values, response, test)
                if round_:
                    levels = np.array(sorted(known.items()))
                    errors.append(abs(np.interp(linear[number], *levels.T) * linear[number] / (own * found) - 1))
                known[own] = found
            if not round_:
                away = np.abs(np.log(whole()))
                chosen = [int(each) for each in np.argsort(away)[:AT_LIMIT] if away[each] < NEAR]
        margins = whole()
        return margins, self.chance(test, margins, factor, independent, float(max(errors)), len(known) - 1)

    def chance(
        self, test: Test, margins: Array, factor: float, independent: Array, error: float, confirmed: int
    ) -> Chance:
        """Return the chance of failing and what contributes to it, from the margins in many draws."""
        count = len(self.relay.uncertainty)
        correlated = np.column_stack((independent[:, :count] @ self.root.T, independent[:, count:]))
        names = [*self.relay.uncertainty, MODEL, CHANCE]
        used = [name != MODEL or self.model.uncertainty > 0 for name in names]
        used[-1] = isinstance(test, Random)
        correlated, names = correlated[:, used], [name for name, own in zip(names, used, strict=True) if own]
        plane = np.column_stack((np.ones(len(margins)), correlated))
        slopes = np.linalg.lstsq(plane, margins / factor)[0][1:]
        effects = {name: float(TWO_SIDED * abs(slope)) for name, slope in zip(names, slopes, strict=True)}
        failing, low, high = statistics.chance(margins, error)
        indices = statistics.first_order(correlated, margins, names)
        return Chance(failing, low, high, effects, indices, confirmed, error)
