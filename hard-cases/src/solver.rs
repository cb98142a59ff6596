//! Extreme settings of the solver, and extreme communication steps.

use anyhow::{Result, ensure};
use relay_contact::inputs::Inputs;
use relay_contact::scene::{Scene, Solver};
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ContactLawKind, IntegerOutput, RealOutput};

use crate::case::{Check, cases, closest};
use crate::ride::{Ride, Segment, changed};
use crate::spring::shaken;
use testing::scenes::shaken as excited;
use testing::worst;

cases! { CASES:
    "Tolerance 0.1", "the coarsest allowed"
        => shaken(|scene| scene.solver.tolerance = 0.1);
    "Tolerance 10⁻¹²", "below the rounding floor: the smallest possible tolerance is used"
        => {
            let scene = changed(|scene| scene.solver.tolerance = 1e-12);
            ensure!(scene.solver.effective_tolerance() == Solver::TOLERANCE_FLOOR);
            Ride::shaken(scene).checks()
        };
    "Light spring launched at 6.5 m/s, tolerance 10⁻¹⁰",
        "the tolerance, relative to the preload, is below the rounding error of the impact force"
        => below_rounding();
    "1 mode", "the coarsest model of the spring"
        => shaken(|scene| scene.solver.modes = 1);
    "40 modes", "the highest is above 1 MHz"
        => shaken(|scene| scene.solver.modes = 40);
    "Bonded contact after jumps of 3 000 g, tolerance 1e-6 to 1e-11",
        "rounding of the force of a stiff contact does not shrink with the step"
        => closest([1e-6, 1e-8, 1e-10, 1e-11].map(bonded_after_jumps));
    "5000 g for 50 µs in two communication steps, and in steps around a nanosecond",
        "steps of 10⁻⁹ s: differences of nearly equal numbers everywhere"
        => nanoseconds();
    "98 m/s² at 1 kHz in communication steps of a second, against 10 µs",
        "a thousand periods per step; errors of steps accumulate to drift"
        => seconds();
}

fn force(contact: &Simulation) -> f64 {
    contact.real(RealOutput::ContactForce)
}

fn bonded_after_jumps(tolerance: f64) -> Result<Vec<Check>> {
    let mut scene = Scene::default();
    scene.effects.contact_law = ContactLawKind::Bonded;
    scene.contact.moving.youngs_modulus = 2.1e11;
    scene.solver.tolerance = tolerance;
    let segments =
        [(1.05e-5, 27_658.0, 0.0), (1.62e-4, -16_475.0, 1.08e-6), (1.1e-7, -32_393.0, 0.0), (2.06e-4, 0.0, 0.0)];
    let segments = segments
        .map(|(duration, acceleration, support)| Segment { support, ..Segment::accelerated(duration, acceleration) });
    Ride::new(scene, segments).checks_of_large_forces()
}

fn below_rounding() -> Result<Vec<Check>> {
    let mut scene = Scene::default();
    scene.beam.width = 1e-4;
    scene.tip.mass = 0.0;
    scene.solver.tolerance = 1e-10;
    let ride = Ride { speed: -6.5, steps: 300_000, ..Ride::new(scene, [Segment::accelerated(1e-3, 0.0)]) };
    let state = ride.run(4)?.rig.state;
    Ok(vec![Check::steps(state.steps + state.rejected_steps, ride.steps)])
}

/// The contact opens and closes again.
fn nanoseconds() -> Result<Vec<Check>> {
    let segments = [Segment::accelerated(10e-6, -50_000.0), Segment::accelerated(40e-6, 50_000.0)];
    let ride = Ride::new(Scene::default(), segments);
    let nanoseconds = ride.run(25_000)?;
    ensure!(nanoseconds.rig.state.contact().last_closing > Some(0.0), "the contact does not close again");
    let compared = [1, 64].map(|parts| Ok(vec![nanoseconds.same_force(&ride.run(parts)?)]));
    closest([ride.checks()].into_iter().chain(compared))
}

fn seconds() -> Result<Vec<Check>> {
    let mut seconds = Simulation::new(&excited(98.0, 1000.0), &Inputs::default(), 0.0)?;
    let mut fine = seconds.clone();
    for step in 0..4000 {
        fine.step(&Inputs::default(), f64::from(step) * 1e-5, 1e-5)?;
    }
    let mut off = 0.0;
    for second in 0..3 {
        seconds.step(&Inputs::default(), f64::from(second), 1.0)?;
        off = worst(off, (force(&seconds) - force(&fine)).abs());
    }
    let tolerance = Solver::DEFAULT_TOLERANCE * fine.model().force_scale;
    let steps = seconds.integer(IntegerOutput::SolverSteps).try_into()?;
    let property = "the same force after whole periods, independent of the run time";
    Ok(vec![Check::two_runs(property, off, tolerance), Check::steps(steps, 999_999)])
}
