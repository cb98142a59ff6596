"""The partner of the contact in actuator.py: an electromagnet with its coil and its armature, an FMU by PythonFMU.

    voltage U(t) --- coil R, L(g) --- 0 V          L(g) = L_0 / (1 + g / g_0)

    psi' = U - R i,   psi = L(g) i
    m v' = F - F_r - k (p - p_0) - c v - F_p - F_core + F_rest,   p' = v,   g = p_1 - p
    F = i^2 L_0 / (2 g_0) / (1 + g / g_0)^2

with the coil's flux linkage psi and the position p of the armature's face, as pusher.displacement: the iron of the
magnetic circuit takes as many ampere turns as an air gap of g_0, and F is the derivative of the coil's energy by the
gap. It is the law of the component's own armature (docs/relay.md), with i^2 L_0 / (2 g_0) for its hold force times
relative current squared. One-sided springs with dampers stop the armature at its core (p_1) and at rest (p_0). F_p is
what the contact spring bears on the pusher.

The tool that loads the FMU runs this file, which needs only Python itself; a file that also imported FMPy, libcosim and
matplotlib would make every user of the FMU install them.
"""

import math
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Any
from xml.etree.ElementTree import Element, SubElement

from pythonfmu import Fmi2Causality, Fmi2Initial, Fmi2Slave, Fmi2Variability, Real

SUBSTEP = 1e-6  # s; the stops swing with a period of 280 us
State = tuple[float, float, float]
"""Flux linkage [V s], position [m] and velocity [m/s]."""


@dataclass(frozen=True)
class Magnet:
    """Its parameters, in SI units: of a relay for 12 V; spring and positions are those of the component's armature."""

    resistance: float = 240.0
    inductance: float = 1.92
    constant: float = 3e-4
    mass: float = 2e-3
    stiffness: float = 300.0
    return_force: float = 0.5
    damping: float = 0.05
    rest: float = -3e-4
    core: float = 1e-4
    stop_stiffness: float = 1e6
    stop_damping: float = 31.708  # a restitution of 0.4

    def open_share(self, place: float) -> float:
        """Give the inductance at a position over that at the core; a core that gives way changes nothing."""
        gap = self.core - place
        return 1 / (1 + gap / self.constant) if gap > 0 else 1.0

    def current(self, state: State) -> float:
        """Give the current of the coil."""
        return state[0] / (self.inductance * self.open_share(state[1]))

    def pull(self, state: State) -> float:
        """Give the force of the magnet: psi = L i makes it the same at any gap."""
        return state[0] ** 2 / (2 * self.inductance * self.constant)

    def at_rest(self) -> State:
        """Give the state without voltage, pressed on the rest stop."""
        # Return spring and stop share the force.
        return 0.0, self.rest - self.return_force / (self.stiffness + self.stop_stiffness), 0.0

    def rates(self, state: State, voltage: float, pushed: float) -> State:
        """Give the derivatives by time under a voltage and the force of the spring on the pusher."""
        _, place, velocity = state
        force = self.pull(state) - self.return_force - self.stiffness * (place - self.rest)
        force -= self.damping * velocity + pushed
        for depth, rate, way in ((place - self.core, velocity, -1), (self.rest - place, -velocity, 1)):
            if depth > 0:
                force += way * max(0.0, self.stop_stiffness * depth + self.stop_damping * rate)
        return voltage - self.resistance * self.current(state), velocity, force / self.mass

    def after(self, state: State, voltage: float, pushed: float, time: float) -> State:
        """Give the state after a time, in substeps that end where the armature meets a stop."""
        count = max(1, round(time / SUBSTEP))
        h = time / count
        for _ in range(count):
            after = self.step(state, voltage, pushed, h)
            for depth, deeper in (
                (state[1] - self.core, after[1] - self.core),
                (self.rest - state[1], self.rest - after[1]),
            ):
                if depth < 0 < deeper:
                    before = h * depth / (depth - deeper)
                    after = self.step(self.step(state, voltage, pushed, before), voltage, pushed, h - before)
            state = after
        return state

    def step(self, state: State, voltage: float, pushed: float, h: float) -> State:
        """Give the state after a substep of the classical method of Runge and Kutta."""
        first = self.rates(state, voltage, pushed)
        second = self.rates(moved(state, first, h / 2), voltage, pushed)
        third = self.rates(moved(state, second, h / 2), voltage, pushed)
        fourth = self.rates(moved(state, third, h), voltage, pushed)
        flux, place, velocity = (
            (a + 2 * b + 2 * c + d) / 6 for a, b, c, d in zip(first, second, third, fourth, strict=True)
        )
        return moved(state, (flux, place, velocity), h)


def moved(state: State, rates: State, time: float) -> State:
    """Give the state after a time at constant rates."""
    return state[0] + time * rates[0], state[1] + time * rates[1], state[2] + time * rates[2]


UNITS = {
    "V": {"kg": 1, "m": 2, "s": -3, "A": -1},
    "A": {"A": 1},
    "Ohm": {"kg": 1, "m": 2, "s": -3, "A": -2},
    "H": {"kg": 1, "m": 2, "s": -2, "A": -2},
    "s": {"s": 1},
    "m": {"m": 1},
    "kg": {"kg": 1},
    "m/s": {"m": 1, "s": -1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N/m": {"kg": 1, "s": -2},
    "N.s/m": {"kg": 1, "s": -1},
}
# Name, unit, start value, meaning; the first eleven in the order of `Magnet`.
PARAMETERS = [
    ("coil.resistance", "Ohm", Magnet.resistance, "Resistance of the coil"),
    ("coil.inductance", "H", Magnet.inductance, "Inductance of the coil with the armature at the core"),
    ("magnet.gapConstant", "m", Magnet.constant, "Gap at which half of the inductance is left"),
    ("armature.mass", "kg", Magnet.mass, "Mass of the armature, reduced to the pusher"),
    ("armature.stiffness", "N/m", Magnet.stiffness, "Stiffness of the return spring"),
    ("armature.returnForce", "N", Magnet.return_force, "Force of the return spring at the rest position"),
    ("armature.damping", "N.s/m", Magnet.damping, "Damping coefficient of the armature"),
    ("armature.restPosition", "m", Magnet.rest, "Position of the pusher where the armature meets its rest stop"),
    ("armature.corePosition", "m", Magnet.core, "Position of the pusher where the armature meets its core"),
    ("armature.stopStiffness", "N/m", Magnet.stop_stiffness, "Stiffness of both stops"),
    ("armature.stopDamping", "N.s/m", Magnet.stop_damping, "Damping coefficient of both stops"),
    ("supply.voltage", "V", 12.0, "Voltage of the source while it is on; off, it is a short circuit"),
    ("supply.onTime", "s", 1e-3, "Instant at which the source is switched on"),
    ("supply.offTime", "s", 21e-3, "Instant at which it is switched off"),
]
INPUTS = [("pusher.force", "N", 0.0, "Force of the contact spring on the pusher, constant during a communication step")]
OUTPUTS = [
    ("pusher.displacement", "m", 0.0, "Position of the pusher"),
    ("pusher.velocity", "m/s", 0.0, "Its derivative"),
    ("coil.current", "A", 0.0, "Current of the coil"),
    ("magnet.force", "N", 0.0, "Force of the magnet"),
]


class Actuator(Fmi2Slave):  # type: ignore[misc]
    """A magnet with its armature and a switched source; its variables are known by name."""

    author = "The relay-contact developers"
    description = "Electromagnet with coil, armature between two stops, and a source that is switched on and off"

    def __init__(self, **kwargs: Any) -> None:  # noqa: ANN401
        """Declare the variables."""
        super().__init__(**kwargs)
        self.values: dict[str, float] = {}
        fixed, continuous = ({"variability": each} for each in (Fmi2Variability.fixed, Fmi2Variability.continuous))
        for variables, options in (
            (PARAMETERS, {"causality": Fmi2Causality.parameter, **fixed}),
            (INPUTS, {"causality": Fmi2Causality.input, **continuous}),
            (OUTPUTS, {"causality": Fmi2Causality.output, "initial": Fmi2Initial.calculated, **continuous}),
        ):
            for name, _, start, description in variables:
                self.values[name] = start
                get, put = partial(self.values.__getitem__, name), partial(self.values.__setitem__, name)
                self.register_variable(Real(name, description=description, getter=get, setter=put, **options))

    def exit_initialization_mode(self) -> None:
        """Start at rest without current."""
        parameters = {name: self.values[name] for name, *_ in PARAMETERS}
        for name, value in parameters.items():
            if not (math.isfinite(value) if "Position" in name else 0 < value < math.inf):
                raise ValueError(f"{name} is {value}: it must be above 0")
        *constants, self.voltage, self.on, self.off = parameters.values()
        self.magnet = Magnet(*constants)
        if self.magnet.core <= self.magnet.rest:
            raise ValueError(f"armature.corePosition is {self.magnet.core}: it must be above armature.restPosition")
        self.state = self.magnet.at_rest()
        self._update()

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Advance the magnet, through the instants at which the source is switched."""
        end = current_time + step_size
        points = [current_time, *(each for each in (self.on, self.off) if current_time < each < end), end]
        for begin, until in pairwise(points):
            middle = (begin + until) / 2
            voltage = self.voltage if self.on < middle < self.off else 0.0
            self.state = self.magnet.after(self.state, voltage, self.values["pusher.force"], until - begin)
        self._update()
        return True

    def _update(self) -> None:
        """Set the outputs."""
        _, place, velocity = self.state
        self.values["pusher.displacement"], self.values["pusher.velocity"] = place, velocity
        self.values["coil.current"] = self.magnet.current(self.state)
        self.values["magnet.force"] = self.magnet.pull(self.state)

    def to_xml(self, *options: Any) -> Element:  # noqa: ANN401
        """Add what PythonFMU omits from the model description: the units and the initial unknowns."""
        root: Element = super().to_xml(*options)
        definitions = Element("UnitDefinitions")
        units = {name: unit for name, unit, *_ in PARAMETERS + INPUTS + OUTPUTS}
        for name in sorted(set(units.values())):
            base = {each: str(exponent) for each, exponent in UNITS[name].items()}
            SubElement(SubElement(definitions, "Unit", name=name), "BaseUnit", base)
        root.insert(1, definitions)
        for variable in root.iter("ScalarVariable"):
            variable[0].set("unit", units[variable.attrib["name"]])
        structure = next(root.iter("ModelStructure"))
        unknowns = SubElement(structure, "InitialUnknowns")
        unknowns.extend(list(structure[0]))
        return root
