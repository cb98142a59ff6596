//! Interruptions and extremes inside communication steps. The first interruption is that of another solution in
//! `tests/python/test_effects_outputs.py`; `parallel.rs` compares several with a trace.

use relay_contact::error::Remark;
use relay_contact::inputs::Inputs;
use relay_contact::reference::Model;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{AxialForceKind, ContactLawKind, IntegerOutput, RealOutput, ResistanceKind};
use testing::near;
use testing::scenes::{self, LAWS, supported};

fn shaken(amplitude: f64) -> Scene {
    let mut scene = scenes::shaken(amplitude, 1000.0);
    scene.effects.axial_force = AxialForceKind::None;
    scene
}

/// Of the scene's contact under a force (N), Ohm.
fn resistance(scene: &Scene, force: f64) -> f64 {
    let resistance = &scene.resistance;
    let closed = if force > 0.0 {
        1.0 / (resistance.coefficient * force.powf(-resistance.exponent) + resistance.film)
    } else {
        0.0
    };
    1.0 / (closed + 1.0 / resistance.open)
}

/// Count, longest and total of the interruptions so far.
fn counted(simulation: &Simulation) -> (i32, f64, f64) {
    (
        simulation.integer(IntegerOutput::ChatterCount),
        simulation.real(RealOutput::ChatterLongestInterruption),
        simulation.real(RealOutput::ChatterTotalInterruption),
    )
}

/// The same after `stop` seconds in communication steps of `size` seconds.
fn interruptions(scene: &Scene, size: f64, stop: f64) -> (i32, f64, f64) {
    let mut simulation = Simulation::new(scene, &Inputs::default(), 0.0).unwrap();
    while simulation.time() < stop - 1e-12 {
        let time = simulation.time();
        simulation.step(&Inputs::default(), time, size.min(stop - time)).unwrap();
    }
    counted(&simulation)
}

#[test]
fn a_threshold_that_an_open_contact_does_not_reach_is_told() {
    let mut scene = Scene::default();
    for (threshold, reached) in [(0.999e9, true), (1e9, false), (2e9, false)] {
        scene.chatter.resistance_threshold = threshold;
        let open = scene.resistance.open;
        let told = [Remark::NoInterruption { threshold, open }];
        let expected = if reached { &told[..0] } else { &told };
        assert_eq!(Model::new(&scene, 0.0).unwrap().remarks(), expected);
    }
    scene.effects.chatter = false;
    assert_eq!(Model::new(&scene, 0.0).unwrap().remarks(), []);
}

#[test]
fn interruptions_do_not_depend_on_the_communication_step() {
    // Errors grow from blow to blow, most under the strongest excitation.
    for (amplitude, threshold, tolerance) in
        [(400.0, 60.0, 1e-6), (400.0, 0.1, 1e-6), (98.0, 0.05, 1e-6), (800.0, 60.0, 1e-9)]
    {
        let mut scene = shaken(amplitude);
        scene.solver.tolerance = tolerance;
        scene.chatter.resistance_threshold = threshold;
        let (stop, events) = (5e-3, 12.0);
        let expected = interruptions(&scene, 1e-2, stop);
        assert!(expected.0 > 0);
        for size in [1e-3, 1e-4, 1e-5, 3e-6, 1e-6] {
            let found = interruptions(&scene, size, stop);
            assert_eq!(found.0, expected.0, "{size}");
            // Instants to 1 ns.
            assert!((found.1 - expected.1).abs() < 1e-9, "{size}: {found:?} {expected:?}");
            near(size, found.2, expected.2, 1e-9 * events);
        }
    }
}

#[test]
fn an_interruption_that_stands_at_the_start_begins_there_and_counts_while_it_goes_on() {
    let mut scene = Scene::default();
    scene.contact.overtravel = -1e-5;
    let mut simulation = Simulation::new(&scene, &Inputs::default(), 2.0).unwrap();
    assert_eq!(counted(&simulation), (0, 0.0, 0.0));
    simulation.step(&Inputs::default(), 2.0, 9e-6).unwrap();
    let (count, longest, total) = counted(&simulation);
    assert_eq!((count, total), (0, 0.0));
    assert!((longest - 9e-6).abs() < 1e-15);
    simulation.step(&Inputs::default(), simulation.time(), 2e-6).unwrap();
    let (count, longest, total) = counted(&simulation);
    assert_eq!((count, total), (1, longest));
    assert!((longest - 1.1e-5).abs() < 1e-14);
}

#[test]
fn without_a_threshold_that_can_be_crossed_there_is_no_interruption_or_one_without_end() {
    // Even an open contact conducts more than this.
    let mut scene = shaken(400.0);
    scene.chatter.resistance_threshold = 2e9;
    assert_eq!(interruptions(&scene, 1e-3, 5e-3), (0, 0.0, 0.0));
    // A film that is more than the threshold is one interruption without end.
    let mut scene = shaken(98.0);
    scene.resistance.film = 100.0;
    let (count, longest, total) = interruptions(&scene, 1e-3, 5e-3);
    assert_eq!((count, longest), (1, total));
    assert!((longest - 5e-3).abs() < 1e-15);
    // Switched off.
    let mut scene = shaken(400.0);
    scene.effects.chatter = false;
    assert_eq!(interruptions(&scene, 1e-3, 5e-3), (0, 0.0, 0.0));
    scene.effects.resistance = ResistanceKind::None;
    assert_eq!(scenes::at_rest(&scene, RealOutput::ContactConductance), 0.0);
    assert_eq!(interruptions(&scene, 1e-3, 5e-3), (0, 0.0, 0.0));
}

/// Extremes are those of a trace every 10 ns.
#[test]
fn extremes_are_those_of_the_course_inside_the_step() {
    for law in LAWS {
        for amplitude in [98.0, 400.0] {
            let mut scene = shaken(amplitude);
            scene.effects.contact_law = law;
            let tolerance = 1e-6 * scenes::force_scale(&scene);
            for (size, parts) in [(1e-3, 100_000), (1e-4, 10_000), (2.5e-5, 2500), (1e-6, 100)] {
                let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
                let mut fine = simulation.clone();
                for _ in 0..20 {
                    let time = simulation.time();
                    let mut forces = vec![fine.real(RealOutput::ContactForce)];
                    simulation.step(&Inputs::default(), time, size).unwrap();
                    for part in 0..parts {
                        let fine_size = size / f64::from(parts);
                        fine.step(&Inputs::default(), time + f64::from(part) * fine_size, fine_size).unwrap();
                        forces.push(fine.real(RealOutput::ContactForce));
                    }
                    let least = simulation.real(RealOutput::StepMinimumForce);
                    let greatest = simulation.real(RealOutput::StepMaximumForce);
                    let (low, high) = forces
                        .iter()
                        .fold((f64::MAX, f64::MIN), |(low, high), force| (low.min(*force), high.max(*force)));
                    // Between two points of the trace the force turns: by an eighth of its second difference.
                    let turn = forces.windows(3).map(|f| (f[0] - 2.0 * f[1] + f[2]).abs()).fold(0.0, f64::max);
                    let allowed = 2.0 * tolerance;
                    let at = format!("{law:?} {amplitude} m/s2, {size} s from {time}");
                    assert!(least <= low + allowed && least >= low - allowed - turn, "{at}: {least} {low} {turn}");
                    assert!(
                        greatest >= high - allowed && greatest <= high + allowed + turn,
                        "{at}: {greatest} {high} {turn}"
                    );
                    let worst = simulation.real(RealOutput::StepMaximumResistance);
                    assert_eq!(worst, resistance(&scene, least));
                }
            }
        }
    }
}

/// The force of a damped contact of rough surfaces grows as `t^(n/(1-n))` when it closes, nearly a jump for small `n`. A polynomial
/// through the instant of closing overshoots it by a tenth.
#[test]
fn the_greatest_force_of_a_blow_on_a_contact_of_nearly_constant_stiffness_is_within_the_tolerance() {
    let greatest = |exponent: f64, tolerance: f64| {
        let mut scene = shaken(400.0);
        scene.effects.contact_law = ContactLawKind::Rough;
        scene.contact.stiffness_exponent = exponent;
        scene.contact.damping = 1e-4;
        scene.solver.tolerance = tolerance;
        let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
        let mut greatest = 0.0_f64;
        // Up to the first blow.
        while simulation.interruptions().count == 0 || simulation.real(RealOutput::ContactForce) == 0.0 {
            simulation.step(&Inputs::default(), simulation.time(), 1e-5).unwrap();
            greatest = simulation.real(RealOutput::StepMaximumForce);
        }
        greatest
    };
    for exponent in [0.02, 0.05, 0.1, 0.2] {
        let exact = greatest(exponent, 1e-8);
        for tolerance in [1e-2, 1e-3, 1e-4, 1e-6] {
            let error = (greatest(exponent, tolerance) - exact).abs() / exact;
            assert!(error <= tolerance, "n = {exponent}, {tolerance}: {error:.1e} of {exact} N");
        }
    }
}

#[test]
fn a_step_that_ends_with_the_integrators_own_has_the_extremes_of_it() {
    let mut scene = shaken(400.0);
    // Its threshold is passed just before the contact opens, and ends a step.
    scene.effects.chatter = false;
    let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
    let mut openings = 0;
    while openings < 2 {
        let time = simulation.time();
        let ahead = simulation.motion().events_ahead().next();
        let Some(event) = ahead.filter(|event| !event.closes) else {
            simulation.step(&Inputs::default(), time, 1e-6).unwrap();
            continue;
        };
        let before = simulation.real(RealOutput::ContactForce);
        simulation.step(&Inputs::default(), time, event.time - time).unwrap();
        assert_eq!(simulation.time(), event.time);
        assert_eq!(simulation.real(RealOutput::StepMinimumForce), 0.0);
        assert!(simulation.real(RealOutput::StepMaximumForce) >= before);
        openings += 1;
    }
}

/// Where the force dips for an instant below that of an interruption, and is back within the same integration step.
#[test]
fn interruptions_of_microseconds_begin_and_end() {
    let mut scene = shaken(98.0);
    // The depth of the shortest dip is 2e-9 of the preload force.
    scene.solver.tolerance = 1e-11;
    scene.chatter.minimum_duration = 0.0;
    let course = |scene: &Scene| {
        let mut simulation = Simulation::new(scene, &Inputs::default(), 0.0).unwrap();
        simulation.step(&Inputs::default(), 0.0, 1e-3).unwrap();
        simulation
    };
    let least = course(&scene).real(RealOutput::StepMinimumForce);
    let mut growth = Vec::new();
    for k in 1..=300 {
        let duration = 3e-8 * f64::from(k);
        // About its minimum the force is F_min + c t^2, with about this c of its sine, N/s2.
        let force = least + 9.5e5 * (0.5 * duration).powi(2);
        scene.chatter.resistance_threshold = resistance(&scene, force);
        let simulation = course(&scene);
        assert_eq!(simulation.integer(IntegerOutput::ChatterCount), 1, "{duration}");
        growth.push(simulation.real(RealOutput::ChatterTotalInterruption) / duration);
    }
    // The same c for all: to the error of the force over the depth, and to the curve's third derivative.
    let last = growth.last().unwrap();
    for (k, growth) in growth.iter().enumerate() {
        assert!((growth / last - 1.0).abs() < 0.01, "{k}: {growth} {last}");
    }
}

/// The fixed contact meets the spring just at a communication point, to the rounding of time and way.
#[test]
fn a_touch_at_a_communication_point_is_one_closing() {
    for case in 0..400 {
        let (size, steps) = (1e-6 + 1e-7 * f64::from(case % 20), 1 + case / 20);
        let mut scene = Scene::default();
        scene.contact.overtravel = -1e-6;
        scene.contact.damping = 2e-6;
        let speed = 1e-6 / (f64::from(steps) * size);
        let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
        let mut time = 0.0;
        for _ in 0..=steps {
            let inputs = supported(speed * time, speed);
            simulation.step(&inputs, time, size).unwrap();
            time += size;
        }
        // It does not bounce within 3 us.
        assert!(simulation.real(RealOutput::ContactLastClosing) > 0.0, "{case}");
        assert_eq!(simulation.real(RealOutput::ContactLastOpening), -1.0, "{case}");
    }
}

/// However rounding leaves the force at the instant at which an interruption begins, it goes on.
#[test]
fn an_interruption_that_hardly_is_one_comes_to_an_end() {
    let mut scene = shaken(98.0);
    scene.chatter.minimum_duration = 0.0;
    let mut least = f64::INFINITY;
    for k in 0..400 {
        // From a force that is never reached to one below which it stays for microseconds.
        let force = 0.1037 + 1e-6 * f64::from(k);
        scene.chatter.resistance_threshold = resistance(&scene, force);
        let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
        for period in 0..6 {
            simulation.step(&Inputs::default(), 1e-3 * f64::from(period), 1e-3).unwrap();
            least = least.min(simulation.real(RealOutput::StepMinimumForce));
        }
        let (count, steps) =
            (simulation.integer(IntegerOutput::ChatterCount), simulation.integer(IntegerOutput::SolverSteps));
        assert!(steps < 200 && count <= 6, "{force}: {count} in {steps} steps");
        assert!(count > 0 || force < least + 1e-6, "{force} {least}");
    }
}

/// However tight the tolerance, a contact whose force is linear up to its opening opens and closes as often, and the
/// work grows as the steps get shorter.
#[test]
fn a_linearised_contact_opens_once_at_every_tolerance() {
    for amplitude in [389.0, 800.0, 2000.0] {
        for frequency in [234.0, 792.0, 2500.0] {
            for (beam, contact) in [(5e-6, 5e-6), (1e-6, 1e-6), (2e-7, 2e-6), (2e-5, 2e-7), (1e-6, 0.0)] {
                let mut scene = scenes::shaken(amplitude, frequency);
                scene.effects.contact_law = ContactLawKind::Linearised;
                scene.beam.stiffness_damping = beam;
                scene.contact.damping = contact;
                let mut course = |tolerance| {
                    scene.solver.tolerance = tolerance;
                    let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
                    simulation.step(&Inputs::default(), 0.0, 4e-3).unwrap();
                    let count = |output| simulation.integer(output);
                    let steps = count(IntegerOutput::SolverSteps) + count(IntegerOutput::SolverRejectedSteps);
                    (simulation.events().0.count(), steps)
                };
                let (events, steps) = course(1e-8);
                // Steps of order 9; at the last tolerance of order 5, and up to 16 times as short (`constants::LONGER`).
                for (tolerance, factor) in [(1e-9, 20), (1e-10, 20), (1e-11, 64)] {
                    let found = course(tolerance);
                    assert!(
                        found.0 == events && found.1 <= factor * steps,
                        "{amplitude} m/s2, {frequency} Hz, {beam} s, {contact} s, {tolerance}: {found:?}, not {events}, {steps}"
                    );
                }
            }
        }
    }
}
