"""Derivatives of inputs and outputs through FMPy, and the log of events."""

from math import cos, pi, sin

from component import Instance

AMPLITUDE = 98.0
OMEGA = 2 * pi * 1000
STEP = 1e-5
STEPS = 200


def derivative(instance: Instance, name: str) -> float:
    """Give the first derivative of an output."""
    return float(instance.fmu.getRealOutputDerivatives(instance.references(name), [1])[0])


def test_derivatives_make_a_sampled_sine_right_to_the_second_order() -> None:
    """With a hundred steps a period the error falls from some pi / 100 to some (pi / 100)^2 of the amplitude."""
    with Instance() as instance:
        instance.set("effects.excitation", "Sine")
        instance.set("excitation.amplitude", AMPLITUDE)
        instance.initialise(tolerance=1e-8)
        exact = []
        for step in range(STEPS):
            instance.step(step * STEP, STEP)
            exact.append(instance.get("contact.force"))
    swing = (max(exact) - min(exact)) / 2
    for order in (1, 2):
        with Instance() as instance:
            instance.initialise(tolerance=1e-8)
            worst = 0.0
            for step, force in enumerate(exact):
                phase = OMEGA * step * STEP
                instance.set("base.acceleration", AMPLITUDE * sin(phase))
                if order == 2:
                    rate = AMPLITUDE * OMEGA * cos(phase)
                    instance.fmu.setRealInputDerivatives(instance.references("base.acceleration"), [1], [rate])
                instance.step(step * STEP, STEP)
                worst = max(worst, abs(instance.get("contact.force") - force))
        expected = (pi / 100) ** order
        assert 0.2 < worst / swing / expected < 5, f"{worst / swing} of the swing, some {expected} expected"


def test_the_derivative_of_the_force_is_its_slope() -> None:
    """Central differences over 10 us differ from a derivative by the square of that over the fastest period, 0.2 ms."""
    with Instance() as instance:
        instance.set("effects.excitation", "Sine")
        instance.initialise(tolerance=1e-8)
        forces, rates = [], []
        for step in range(STEPS):
            instance.step(step * STEP, STEP)
            forces.append(instance.get("contact.force"))
            rates.append(derivative(instance, "contact.force"))
    steepest = max(map(abs, rates))
    slopes = [(after - before) / (2 * STEP) for before, after in zip(forces, forces[2:], strict=False)]
    worst = max(abs(slope - rate) for slope, rate in zip(slopes, rates[1:], strict=False))
    assert worst < (2 * pi * STEP / 2e-4) ** 2 / 6 * steepest, f"{worst} N/s of {steepest} N/s"


def test_openings_are_logged_with_their_instants() -> None:
    """With logging on each event is a message, and nothing else is."""
    with Instance() as instance:
        instance.set("effects.excitation", "Sine")
        instance.set("excitation.amplitude", 400.0)
        instance.initialise()
        instance.step(0.0, 1e-3)
        opening = instance.get("contact.lastOpening")
        instance.step(1e-3, 5e-4)
        closing = instance.get("contact.lastClosing")
        assert instance.messages == [
            f"fmi2DoStep: the contact opens at {opening!r} s",
            f"fmi2DoStep: the contact closes at {closing!r} s",
        ]
