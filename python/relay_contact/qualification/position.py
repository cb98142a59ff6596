"""A position of the coil by one of the models, shaken along an axis: its parts, and how uncertain their margins are.

The margin of a test follows from the response to a pulse; in draws of the uncertain parameters too
(`relay_contact.qualification.statistics`). Where linear theory is off, and by how much, the component tells: as the
relay is, at both ends of each parameter that matters, and at the limit between failing and passing.
"""

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from relay_contact.component import Array, Component, Values
from relay_contact.files import RelayContactError
from relay_contact.many import side_by_side
from relay_contact.qualification import courses, statistics, trials
from relay_contact.qualification.distributions import LEAST, TWO_SIDED, below, quantile
from relay_contact.qualification.excitation import Random, Sine, Test, Transient
from relay_contact.qualification.level import MOST, ROUGHLY, threshold
from relay_contact.qualification.parts import CONTACT, Rest, at_rest
from relay_contact.qualification.relay import NORMAL, Model, Relay
from relay_contact.qualification.response import CALM, Response, answers, spread
from relay_contact.qualification.results import Chance
from relay_contact.qualification.standards import Contacts
from relay_contact.spring import is_entry

MODEL = "model"
CHANCE = "chance of the largest dip"
WORN = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2)
"""Parts of the overtravel over which margins are shown."""
FEWEST, DRAWS = 8, 256
"""Draws of all uncertain parameters in which the component answers a pulse: fewest, most."""
ENOUGH = 0.03
"""Share of the deviation of a margin that its error may be in what follows the draws; else there are more of them."""
MATTERS = 0.2
"""Share of the largest effect of a parameter from which on the component seeks the level at the ends of one."""
AT_LIMIT = 2
"""Draws next to the limit in which the component seeks the level itself."""
SETTLED = 1e-3
"""Part of its largest answer below which that of a drawn contact is cut off."""
GRID = np.linspace(-5.0, 5.0, 41)
"""Scores of the chance of the largest dip."""
LOWEST = 1e-300
"""Margin in place of that of a draw that fails at rest, whose logarithm would be endless."""
FAR = -9e-3
"""Overtravel (m) of a contact that is out of reach."""
OUTDONE = 4.0
"""Times the least level of all parts, by linear theory, from which on a part does not matter beside others.

That of the least may be twice as high, and another matters up to `judgement.BEYOND` of it.
"""
STILL = 1e-9
"""Part of a margin that rounding changes at most."""
NEAR = 0.05
"""Of 1, within which draws are at the limit: others would tell of another level."""


@dataclass(frozen=True)
class Drawn:
    """A margin in many draws of the uncertain parameters."""

    margins: Array
    error: float
    """Largest part by which the component found it to be another than drawn."""
    confirmed: int
    """Draws in which the component sought the level itself."""

    def scaled(self, factor: float) -> "Drawn":
        """Return the margin of what fails at this factor of it."""
        return replace(self, margins=factor * self.margins, confirmed=0)

    @classmethod
    def least(cls, each: list["Drawn"]) -> "Drawn":
        """Return the least margin of several parts in each draw."""
        margins = np.min([own.margins for own in each], axis=0)
        return cls(margins, max(own.error for own in each), sum(own.confirmed for own in each))


@dataclass
class Shared:
    """What all parts of a position have in common: the component answers for all of them at once."""

    nominal: dict[str, Response] = field(default_factory=dict)
    """Responses of the relay as its file says, by part."""
    surfaces: dict[str, dict[str, statistics.Surface]] = field(default_factory=dict)
    """Logarithm of the margin of each test over the scores, by linear theory, by part."""
    tried: dict[tuple[float, ...], tuple[Values, dict[str, Response]]] = field(default_factory=dict)
    """Parameters and responses of draws in which the component seeks levels, by their scores."""
    worn: dict[float, dict[str, Response]] = field(default_factory=dict)
    """Responses over the overtravel (m), which the wear of the contacts takes away, or over the gap, by part."""


@dataclass
class Position:
    """A position of the coil by one of the models, along an axis, and a part of it that is judged."""

    component: Component
    relay: Relay
    name: str
    contacts: Contacts
    tests: tuple[Test, ...]
    model: Model
    axis: str = NORMAL
    part: str = CONTACT
    shared: Shared = field(default_factory=Shared, init=False, repr=False)
    decisive: dict[str, tuple[float, courses.Piece]] = field(default_factory=dict, init=False, repr=False)
    """Of long courses, by the test's name: the sign of its direction, and what is around the dip that fails first."""
    specimens: dict[tuple[float, ...], trials.Specimen] = field(default_factory=dict, init=False, repr=False)
    """Relays of draws, by their scores."""

    def named(self, test: Test) -> str:
        """Return what a test is of, in words."""
        several = f", {self.model.name}" if len(self.relay.models) > 1 else ""
        return f"{test.name}, {self.name}{'' if self.axis == NORMAL else f', {self.axis} axis'}{several}"

    @cached_property
    def values(self) -> Values:
        """Parameters of the component."""
        return {**self.relay.positions[self.name], **self.model.parameters, **self.relay.axes.get(self.axis, {})}

    def value(self, name: str) -> float:
        """Return the value of a parameter; that of an entry of a spring file is a factor, 1 but in further axes."""
        return self.component.value(self.values, name)

    @cached_property
    def rest(self) -> Rest:
        """What is judged, by the state at rest."""
        return at_rest(self.component, self.values)

    @cached_property
    def parts(self) -> list["Position"]:
        """The same position for each of its parts, the contact first."""
        every = [self, *(replace(self, part=name) for name in self.rest.held)]
        for each in every[1:]:
            # They know the same parts, and what is known of them.
            each.shared, each.parts = self.shared, every
        return every

    def responses(self, changes: Values, calm: float = SETTLED) -> dict[str, Response]:
        """Return the responses with some other values of parameters, by part."""
        return answers(self.component, {**self.values, **changes}, self.contacts.threshold, self.rest, calm)

    @cached_property
    def specimen(self) -> trials.Specimen:
        """The relay as the file says, to judge the part."""
        if not self.shared.nominal:
            self.shared.nominal |= self.responses({}, CALM)
        return trials.Specimen(self.component, self.values, self.contacts, self.shared.nominal[self.part], self.part)

    @cached_property
    def pieces(self) -> dict[str, dict[str, list[courses.Piece]]]:
        """Of each course, by the test's name and its directions: as a whole, or what is around its largest dips."""
        return {
            test.name: {way: courses.pieces(self.specimen, course, sign) for way, sign in test.directions.items()}
            for test, course in ((each, each.course()) for each in self.tests if isinstance(each, Transient))
        }  # fmt: skip

    @cached_property
    def noises(self) -> dict[Random, tuple[list[courses.Piece], float]]:
        """Of each noise at its unit: what is around its largest dips, and what clipping makes of its level."""
        units = dict.fromkeys(test.unit for test in self.tests if isinstance(test, Random))
        return {test: courses.noise_dips(self.specimen, test) for test in units}

    def is_endless(self, test: Test) -> bool:
        """Return whether a test hardly shakes the part."""
        return self.linear(self.specimen.response, test) >= MOST

    def linear(self, response: Response, test: Test) -> float:
        """Return the margin by linear theory, MOST at most: of noise by a chance of one half, of courses by pieces."""
        if response.reserve <= 0:
            return 0.0
        lasting = self.specimen.lasting
        match test:
            case Sine():
                found = [float(response.sine(test, lasting)[1].min())]
            case Random():
                found = [response.random(test, lasting)]
            case Transient():
                found = [
                    response.course(piece.course, test.directions[way], lasting)
                    for way, own in self.pieces[test.name].items() for piece in own
                ]  # fmt: skip
            case _:
                raise TypeError(test)
        return min(*found, MOST)

    def scores(self, draws: int) -> Array:
        """Return independent scores of the uncertain parameters for which the component answers, in columns.

        All in the middle; one after the other at its upper end, at its lower end; and draws that are even in each.
        """
        count = len(self.relay.uncertainty)
        if not count:
            return np.zeros((1, 0))
        ends = TWO_SIDED * np.eye(count)
        return np.vstack((np.zeros(count), ends, -ends, quantile(spread(draws, count))))

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
            unit = 1.0 if is_entry(name) else value
            found[name] = value * float(distribution.factor(score, unit)) if value else 0.0
        return found

    def answered(self, scores: Array) -> tuple[Values, dict[str, Response]]:
        """Return parameters and responses of a draw, found once."""
        draw = tuple(scores)
        if draw not in self.shared.tried:
            values = self.drawn(scores)
            try:
                self.shared.tried[draw] = {**self.values, **values}, self.responses(values)
            except RelayContactError as error:
                told = ", ".join(f"{name} = {value:.4g}" for name, value in values.items())
                raise RelayContactError(f"a draw of the uncertain parameters, {told}: {error}") from error
        return self.shared.tried[draw]

    @property
    def nominal(self) -> Values:
        """The uncertain parameters as the file says."""
        return {name: self.value(name) for name in self.relay.uncertainty}

    @property
    def surfaces(self) -> dict[str, statistics.Surface]:
        """Logarithm of the margin of each test over the scores, by linear theory; each in as many draws as it needs."""
        if not self.shared.surfaces:
            # Known to all draws, which run beside each other.
            nominal = {each.part: each.specimen.response for each in self.parts}
            own = self.nominal
            known: dict[str, dict[str, statistics.Surface]] = {part: {} for part in nominal}

            def margins(row: Array) -> list[list[float]]:
                responses = nominal if self.drawn(row) == own else self.answered(row)[1]
                if np.count_nonzero(row) > 1:
                    # Those at the end of a parameter alone are asked for again.
                    self.shared.tried.pop(tuple(row), None)
                each = [(one, responses[one.part]) for one in self.parts]
                return [[at.reserve, *(one.linear(at, test) for test in self.tests)] for one, at in each]

            draws = FEWEST
            while any(len(surfaces) < len(self.tests) for surfaces in known.values()):
                scores = self.scores(draws)
                # By part, what is left and test, and draw.
                found = np.moveaxis(np.array(side_by_side(margins, list(scores))), 0, -1)
                rest = found[:, 0]
                fails = (rest <= 0).any(axis=0)
                # Where a part fails at rest nothing is known of the others; if none does, logarithms alone are smooth.
                rest[(rest > 0) & fails] = np.nan
                rest[:] = rest if fails.any() else 1.0
                for surfaces, (left, *rows) in zip(known.values(), found, strict=True):
                    for test, values in zip(self.tests, rows, strict=True):
                        each = statistics.Surface(scores, np.log(np.maximum(values, LOWEST)), left)
                        deviation = float(np.std(each.values[left > 0])) if (left > 0).any() else 0.0
                        if draws == DRAWS or each.error <= max(ROUGHLY, ENOUGH * deviation):
                            surfaces.setdefault(test.name, each)
                draws = min(4 * draws, DRAWS)
            self.shared.surfaces |= known
        return self.shared.surfaces[self.part]

    @cached_property
    def lifted(self) -> float:
        """How far (m) a pusher holds the contact point from where it would be without a contact; 0 without one."""
        if not self.rest.held:
            return 0.0
        with self.component.started({**self.values, "contact.overtravel": FAR}) as contact, contact.explained():
            return -contact.get("tip.displacement")

    @property
    def overtravel(self) -> float:
        """The overtravel (m) that wear takes away, that of the pusher included; negative: the gap."""
        return self.value("contact.overtravel") + self.lifted

    @property
    def worn(self) -> dict[float, Response]:
        """The responses over the overtravel (m), which the wear of the contacts takes away, or over the gap."""
        if not self.shared.worn:
            whole, lifted = self.overtravel, self.lifted
            found = side_by_side(lambda part: self.responses({"contact.overtravel": part * whole - lifted}), WORN)
            self.shared.worn |= {abs(part * whole): own for part, own in zip(WORN, found, strict=True)}
        return {over: responses[self.part] for over, responses in self.shared.worn.items()}

    def wear(self, test: Test, factor: float) -> dict[str, list[float]]:
        """Return the margin over overtravel or gap, for a margin that the component found as it is."""
        margins = [self.linear(response, test) for response in self.worn.values()]
        ratio = factor / margins[WORN.index(1.0)]
        return {"overtravel": list(self.worn), "margin": [ratio * value for value in margins]}

    @cached_property
    def weakest(self) -> dict[str, trials.Weakest]:
        """Where each sine fails at the least level, by the test's name."""
        return {test.name: trials.sine_least(self.specimen, test) for test in self.tests if isinstance(test, Sine)}

    @cached_property
    def middle(self) -> dict[Random, tuple[float, list[str], courses.Piece]]:
        """Of each noise at its unit: at which part of linear theory it fails, what fails, and the dip."""

        def enough(test: Random) -> float:
            own, *others = (each.linear(each.specimen.response, test) for each in (self, *self.parts))
            return OUTDONE * min(others) / max(own, 1e-12)

        return {test: courses.middle_dip(self.specimen, test, dips, enough(test))
                for test, (dips, _) in self.noises.items()}  # fmt: skip

    def turn(self, test: Test, number: int, expected: float) -> float:
        """Return what `sought` does: of noises that differ in level alone once for all."""
        if not isinstance(test, Random):
            return self.sought(test, number, expected)
        key = test.unit, tuple(self.surfaces[test.name].scores[number])
        # The first of them to ask, whatever its level, finds the same to the last bit.
        found: float = self.specimen.once(key, lambda: self.sought(test, number, round(expected, 9)))
        return found

    def sought(self, test: Test, number: int, expected: float) -> float:
        """Return the logarithm of the level that fails in the component in a draw by that of linear theory.

        It is sought where the relay as its file says fails: beside the weakest frequency by as much, in the same dip;
        and where a sweep follows a resonance, as for that relay.
        """
        surface = self.surfaces[test.name]
        linear = float(np.exp(surface.values[number]))
        if not LOWEST * (1 + STILL) < linear < MOST * (1 - STILL):
            return expected
        values, responses = self.answered(surface.scores[number])
        response, lasting = responses[self.part], self.specimen.lasting
        own = replace(self.specimen, values=values, response=response)
        specimen = self.specimens.setdefault(tuple(surface.scores[number]), own)
        if isinstance(test, Sine):
            first, nominal = (each.weakest(test, lasting) for each in (response, self.specimen.response))
            weakest = self.weakest[test.name]
            beside = 1.0 if test.steps or weakest.order else weakest.frequency / nominal
            frequency = float(np.clip(first * beside, *test.band))
            tried = trials.sine_tried(specimen, test, frequency)
        else:
            if isinstance(test, Random):
                piece, sign = self.middle[test.unit][2], 1.0
                # Another dip may stand for it, which linear theory expects to fail later.
                part = piece.guess / self.specimen.response.course(piece.course, sign, lasting)
                linear = part * response.course(piece.course, sign, lasting) / self.noises[test.unit][1]
            else:
                assert isinstance(test, Transient)
                ways = [(sign, each) for way, sign in test.directions.items() for each in self.pieces[test.name][way]]
                worst = min(ways, key=lambda way: response.course(way[1].course, way[0], lasting))
                sign, piece = self.decisive.get(test.name, worst)
            tried = piece.tried(specimen, sign)
        level, failed = threshold(tried, linear * np.exp(expected), roughly=True)
        if isinstance(test, Sine):
            found = trials.Weakest(frequency, level, failed)
            if not test.steps and abs(level / linear - 1) > trials.APART:
                found = trials.followed(specimen, test, first, 1, found, linear, roughly=True)
            level = trials.across(specimen, test, found, linear, roughly=True).factor
        elif isinstance(test, Transient):
            for way, each in courses.further(specimen, test, level, linear):
                tried, least = each.tried(specimen, test.directions[way]), level * (1 - ROUGHLY)
                if failing := tried(least)[0]:
                    level, _ = threshold(tried, least, failing, roughly=True)
        return float(np.log(level / linear))

    def dips(self, test: Test, scores: Array) -> Array:
        """Return the part of the margin for scores of the chance of the largest dip."""
        if not isinstance(test, Random):
            return np.ones(len(scores))
        response, lasting = self.specimen.response, self.specimen.lasting
        moments = response.moments(test)
        found = np.array([response.random(test, lasting, float(each), moments) for each in below(GRID)])
        return np.interp(scores, GRID, found / response.random(test, lasting, moments=moments))

    @cached_property
    def independent(self) -> Array:
        """Many independent scores of the uncertain parameters, of what the model leaves out, and of the largest dip."""
        return statistics.drawn(len(self.relay.uncertainty) + 2)

    def margins(self, test: Test, factor: float, confirmed: bool = True) -> Drawn:
        """Return the margin in many draws, for that which the component found as it is; `confirmed` by it in some.

        What the component finds in place of linear theory is, in logarithms, a sum over the parameters, straight from
        the middle of each to its ends. Draws next to the limit tell how well.
        """
        surface, count, independent = self.surfaces[test.name], len(self.relay.uncertainty), self.independent
        scores = independent[:, :count]
        middle = float(np.log(factor / self.linear(self.specimen.response, test)))
        turns, errors, tried = np.zeros((count, 3)), [surface.error if count else 0.0], 0

        def told(scores: Array) -> Array:
            ends = (-TWO_SIDED, 0.0, TWO_SIDED)
            each = [np.interp(score, ends, turn) for score, turn in zip(scores.T, turns, strict=True)]
            return np.asarray(middle + np.sum(each, axis=0))

        if count and confirmed:
            if self.drawn(surface.scores[0]) != self.nominal:
                middle = self.turn(test, 0, middle)
            drawn = surface.values[1 + 2 * count :]
            # An end that fails at rest would hide all others.
            known = np.where(surface.left > 0, surface.values, surface.values[0])
            upper, lower, _ = np.split(known[1:], (count, 2 * count))
            effects = np.abs(upper - lower)
            matter = (effects > 0) & (effects >= MATTERS * effects.max())
            for number in range(count):
                if matter[number]:
                    turns[number, ::2] = [self.turn(test, 1 + at + number, middle) - middle for at in (count, 0)]
                elif abs(middle) > trials.APART:
                    # It may matter far from linear theory alone.
                    turns[number] = (self.turn(test, 1 + number, middle) - middle) * np.array((-1.0, 0.0, 1.0))
            expected = told(surface.scores[-len(drawn) :])
            away = np.abs(drawn + expected)
            near = [at for at in np.argsort(away)[:AT_LIMIT].tolist() if away[at] < NEAR]
            for at in near:
                found = self.turn(test, len(surface.values) - len(drawn) + at, float(expected[at]))
                errors.append(float(np.abs(np.expm1(expected[at] - found))))
            tried = int(np.count_nonzero(turns)) + len(near)
        left_out = np.maximum(1 + self.model.uncertainty * independent[:, -2] / TWO_SIDED, LEAST)
        others = self.dips(test, independent[:, -1]) * left_out
        return Drawn(np.exp(surface(scores) + told(scores)) * others, max(errors), tried)

    def chance(self, test: Test, drawn: Drawn, factor: float) -> Chance:
        """Return the chance of failing and what contributes to it, from the margins in many draws."""
        count, independent, margins = len(self.relay.uncertainty), self.independent, drawn.margins
        correlated = np.column_stack((independent[:, :count] @ self.root.T, independent[:, count:]))
        names = [*self.relay.uncertainty, MODEL, CHANCE]
        used = [name != MODEL or self.model.uncertainty > 0 for name in names]
        used[-1] = isinstance(test, Random)
        correlated, names = correlated[:, used], [name for name, own in zip(names, used, strict=True) if own]
        plane = np.column_stack((np.ones(len(margins)), correlated))
        slopes = np.linalg.lstsq(plane.T @ plane, plane.T @ margins / factor)[0][1:]
        effects = {name: float(TWO_SIDED * abs(slope)) for name, slope in zip(names, slopes, strict=True)}
        failing, low, high = statistics.chance(margins, drawn.error)
        indices = statistics.first_order(correlated, margins, names)
        return Chance(failing, low, high, effects, indices, drawn.confirmed, drawn.error)
