"""An electromagnet with its coil and its armature, as the example actuator.py couples it to the contact.

    voltage U(t) --- coil R, L(g) --- 0 V          L(g) = L_0 / (1 + g / g_0)

    psi' = U - R i,   psi = L(g) i
    m v' = F - F_r - k (p - p_0) - c v - F_p - F_core + F_rest,   p' = v,   g = p_1 - p
    F = i^2 L_0 / (2 g_0) / (1 + g / g_0)^2

with the coil's flux linkage psi and the position p of the armature's face, as pusher.displacement: the iron of the
magnetic circuit takes as many ampere turns as an air gap of g_0, and F is the derivative of the coil's energy by the
gap. It is the law of the component's own armature (docs/relay.md), with i^2 L_0 / (2 g_0) for its hold force times
relative current squared. One-sided springs with dampers stop the armature at its core (p_1) and at rest (p_0). F_p is
what the contact spring bears on the pusher.

Python alone is enough for this file: it is part of the FMU that actuator.py makes.
"""

from dataclasses import dataclass

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
