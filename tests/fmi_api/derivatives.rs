//! What derivatives of inputs do over a step, and the derivative of the force.

use relay_contact::fmi2::*;
use relay_contact::scene::Scene;
use testing::close;
use testing::instance::Instance;
use testing::scenes::propped_mass;

#[test]
fn a_derivative_counts_for_one_step() {
    let fmu = Instance::initialized();
    assert_eq!(fmu.set_rates(["support.displacement"], [1], [1e-3]), fmi2OK);
    assert_eq!(fmu.step(0.0, 1e-4), fmi2OK);
    let moved = fmu.real("tip.displacement") + fmu.real("contact.indentation");
    // The fixed contact is where the derivative led; without one it goes back to its input.
    assert_eq!(fmu.step(1e-4, 1e-4), fmi2OK);
    let back = fmu.real("tip.displacement") + fmu.real("contact.indentation");
    assert!((moved - back - 1e-7).abs() < 1e-18, "{moved} {back}");
    assert_eq!(fmu.real("support.displacement"), 0.0);
}

#[test]
fn the_force_follows_an_acceleration_that_grows() {
    let fmu = Instance::initialized();
    assert_eq!(fmu.set_rates(["base.acceleration"], [1], [1e3]), fmi2OK);
    let before = fmu.real("contact.force");
    assert_eq!(fmu.step(0.0, 0.1), fmi2OK);
    let after = fmu.real("contact.force");
    // Slow against every mode.
    let mass = propped_mass(&Scene::default());
    let (found, expected) = (after - before, mass * 100.0);
    close("N", found, expected, 1e-3);
    let (status, rate) = fmu.try_rate("contact.force");
    assert_eq!(status, fmi2OK);
    assert!((rate / (mass * 1e3) - 1.0).abs() < 1e-3, "{rate} N/s");
}

#[test]
fn higher_derivatives_of_inputs_have_no_effect_and_are_told_of_once() {
    let fmu = Instance::initialized();
    let names = ["support.displacement", "support.displacement", "base.acceleration"];
    for step in 0..3 {
        assert_eq!(fmu.set_rates(names, [1, 2, 3], [1e-3, 5.0, 1e9]), fmi2OK);
        assert_eq!(fmu.step(f64::from(step) * 1e-4, 1e-4), fmi2OK);
        let place = fmu.real("tip.displacement") + fmu.real("contact.indentation");
        assert!((place - 2e-4 - 1e-7).abs() < 1e-18, "{place}");
    }
    fmu.expect_message(
        fmi2Warning,
        &["fmi2SetRealInputDerivatives: support.displacement", "order 2"],
    );
}
