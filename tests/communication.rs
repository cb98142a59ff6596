//! Communication points: what is read there does not depend on how many there are, or where the integrator's own steps end.

use relay_contact::error::StepErrorCause;
use relay_contact::inputs::Inputs;
use relay_contact::reference::Model;
use relay_contact::scene::Scene;
use relay_contact::simulation::{Event, Simulation};
use relay_contact::variables::{ContactLawKind, IntegerOutput, RealOutput, VARIABLES};
use testing::near;
use testing::scenes::{self, accelerated, at_rest, force_scale, largest_difference, supported};

fn shaken(amplitude: f64, tolerance: f64) -> Scene {
    let mut scene = scenes::shaken(amplitude, 1000.0);
    scene.solver.tolerance = tolerance;
    scene
}

/// Force, indentation, velocity and displacement of the tip at every 10 us, with communication steps of `size` us.
fn motion(scene: &Scene, size: u32, inputs: impl Fn(f64) -> Inputs) -> Vec<[f64; 4]> {
    let mut simulation = Simulation::new(scene, &inputs(0.0), 0.0).unwrap();
    let mut rows = Vec::new();
    for k in 0..2000 / size {
        let time = |k: u32| 1e-6 * f64::from(k * size);
        simulation.step(&inputs(time(k)), time(k), 1e-6 * f64::from(size)).unwrap();
        if ((k + 1) * size).is_multiple_of(10) {
            let outputs = [
                RealOutput::ContactForce,
                RealOutput::ContactIndentation,
                RealOutput::TipVelocity,
                RealOutput::TipDisplacement,
            ];
            rows.push(outputs.map(|output| simulation.real(output)));
        }
    }
    rows
}

fn check(scene: &Scene, inputs: impl Fn(f64) -> Inputs + Copy) {
    let exact = {
        let mut scene = scene.clone();
        scene.solver.tolerance = 1e-10;
        motion(&scene, 10, inputs)
    };
    // A force wrong by the tolerance belongs to an indentation wrong by that over the stiffness, and where the contact is open to
    // a spring bent wrongly; its velocity changes with the period of the beam's third mode at the fastest.
    let force = scene.solver.tolerance * scenes::force_scale(scene);
    let way = force / scenes::tip_stiffness(scene);
    let allowed = [force, way, way * 2.0 * std::f64::consts::PI * 9100.0, way];
    for size in [1, 2, 5, 10] {
        for (row, (found, exact)) in motion(scene, size, inputs).iter().zip(&exact).enumerate() {
            for ((found, exact), allowed) in found.iter().zip(exact).zip(allowed) {
                near(format_args!("{} us, steps of {size} us", 10 * (row + 1)), *found, *exact, allowed);
            }
        }
    }
}

/// Also with an input that changes: it counts from its communication point on; and with inputs along lines that bend at every 300 us,
/// beyond which the integrator goes.
#[test]
fn what_is_read_inside_the_integrators_steps_is_within_the_tolerance() {
    let pulsed = |time: f64| accelerated(if (time / 3e-4).fract() < 0.5 { 40.0 } else { -60.0 }, 0.0);
    for amplitude in [98.0, 400.0] {
        for tolerance in [1e-3, 1e-5, 1e-7] {
            check(&shaken(amplitude, tolerance), |_| Inputs::default());
        }
    }
    check(&shaken(98.0, 1e-6), pulsed);
    let bent = |time: f64| {
        let (line, since) = ((time / 3e-4 + 1e-9).floor(), (time / 3e-4 + 1e-9).fract() * 3e-4);
        let up = if line % 2.0 == 0.0 { 1.0 } else { -1.0 };
        let lowest = if up > 0.0 { 0.0 } else { 1.0 };
        Inputs {
            base_acceleration: 60.0 * lowest + up * 2e5 * since,
            base_acceleration_rate: up * 2e5,
            ..supported(3e-6 * lowest + up * 1e-2 * since, up * 1e-2)
        }
    };
    for amplitude in [98.0, 400.0] {
        check(&shaken(amplitude, 1e-6), bent);
    }
}

/// The steps of a fixed contact that approaches steadily, and makes the spring bounce, are the integrator's own: as many as in one
/// communication step, though the importer rounds where it is at each point. Then it is held there.
#[test]
fn an_input_along_a_line_does_not_break_the_steps() {
    let mut scene = Scene::default();
    scene.contact.overtravel = -2e-5;
    scene.contact.damping = 1e-6;
    let runs = [1, 250].map(|count| {
        let size = 5e-3 / f64::from(count);
        let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
        let mut events = 0;
        for k in 0..count {
            let time = f64::from(k) * size;
            simulation.step(&supported(0.06 * time, 0.06), time, size).unwrap();
            events += simulation.events().0.count();
        }
        let moved = simulation.integer(IntegerOutput::SolverSteps);
        for k in 0..count {
            simulation.step(&supported(3e-4, 0.0), 5e-3 + f64::from(k) * size, size).unwrap();
        }
        let held = simulation.integer(IntegerOutput::SolverSteps) - moved;
        (events, moved, held, simulation.real(RealOutput::TipDisplacement))
    });
    let [(events, moved, held, place), (of_many, moved_in_many, held_in_many, place_of_many)] = runs;
    assert_eq!((events, of_many), (3, 3));
    let more = moved_in_many - moved + held_in_many - held;
    assert!(more <= 20, "{moved} {moved_in_many}, {held} {held_in_many}");
    near("displacement", place_of_many, place, 1e-15);
}

/// An input that changes by so little that its steps are rounding moves the contact all the same.
#[test]
fn an_input_that_creeps_by_roundings_is_followed() {
    let scene = Scene::default();
    let start = 1e-4_f64;
    let mut simulation = Simulation::new(&scene, &supported(start, 0.0), 0.0).unwrap();
    let before = simulation.real(RealOutput::TipDisplacement);
    let mut at = start;
    for k in 0..2000 {
        simulation.step(&supported(at, 0.0), 1e-6 * f64::from(k), 1e-6).unwrap();
        at = at.next_up();
    }
    let moved = simulation.real(RealOutput::TipDisplacement) - before;
    near("displacement", moved, at - start, 0.05 * (at - start));
}

#[test]
fn a_step_of_a_rounding_from_a_point_early_by_more_does_not_turn_time_back() {
    let mut simulation = Simulation::new(&shaken(98.0, 1e-6), &Inputs::default(), 0.0).unwrap();
    // Communication points inside steps of the integrator and, each 300 us, at the end of one.
    for k in 0..2000 {
        let size = if k % 30 == 0 { 3e-4 } else { 1e-6 };
        let time = simulation.time();
        simulation.step(&Inputs::default(), time, size).unwrap();
        let (time, force) = (simulation.time(), simulation.real(RealOutput::ContactForce));
        let spacing = time.next_up() - time;
        simulation.step(&Inputs::default(), time - 4.0 * spacing, spacing).unwrap();
        assert!(simulation.time() >= time, "{} {time}", simulation.time());
        // It changes by some hundreds of newtons a second.
        let found = simulation.real(RealOutput::ContactForce);
        assert!((found - force).abs() < 1e-13, "{time}: {found} {force}");
    }
}

/// The spacing of floating-point numbers of time may be a tenth of a fiftieth of the lowest period: the motion still has the
/// steps that it needs; and a communication step cannot be shorter than it.
#[test]
fn a_time_too_coarse_for_the_motion_is_refused() {
    let scene = Scene::default();
    let frequency = at_rest(&scene, RealOutput::PreloadFrequency);
    for start in [0.0, 1e9, 1e11, 1e13, 1e15, 1e18] {
        let mut simulation = Simulation::new(&scene, &Inputs::default(), start).unwrap();
        let inputs = accelerated(98.0, 0.0);
        let stepped = simulation.step(&inputs, start, 1e-3).map_err(|error| error.cause);
        let coarse = f64::EPSILON * (start + 1e-3);
        if coarse > 2e-3 / frequency {
            let Err(StepErrorCause::Resolution { spacing, allowed }) = stepped else {
                panic!("{start} s: {stepped:?}");
            };
            assert_eq!(spacing, coarse);
            let expected = if start + 1e-3 == start { 1e-3 } else { 2e-3 / frequency };
            assert!((allowed / expected - 1.0).abs() < 1e-12, "{allowed} s");
        } else {
            assert_eq!(stepped, Ok(()), "{start} s");
        }
    }
}

/// Exact steps too, which need no steps in between.
#[test]
fn a_linear_motion_whose_time_is_too_coarse_is_refused_and_stays_as_it_was() {
    let mut scene = scenes::shaken(9.8, 1000.0);
    scene.effects.contact_law = ContactLawKind::Linearised;
    scene.effects.extremes = false;
    scene.effects.chatter = false;
    for (start, size) in [(1e12, 1e-3), (1e13, 1e-3), (1e13, 1e-2), (1e15, 1e-3), (1e15, 1.0)] {
        let mut simulation = Simulation::new(&scene, &Inputs::default(), start).unwrap();
        let before = *simulation.motion();
        let stepped = simulation.step(&Inputs::default(), start, size).map_err(|error| error.cause);
        assert!(matches!(stepped, Err(StepErrorCause::Resolution { .. })), "{start} s: {stepped:?}");
        assert_eq!(*simulation.motion(), before);
    }
}

/// Steps that are sums of powers of two, so that times are exact.
#[test]
fn a_simulation_may_start_before_one_second_before_zero() {
    let size = (-14.0_f64).exp2();
    let run = |start: f64| {
        let scene = Scene::default();
        let mut simulation = Simulation::new(&scene, &Inputs::default(), start).unwrap();
        let mut forces = Vec::new();
        for k in 0..64 {
            let inputs = accelerated(if k % 16 < 8 { -600.0 } else { 200.0 }, 0.0);
            simulation.step(&inputs, start + f64::from(k) * size, size).unwrap();
            forces.push(simulation.real(RealOutput::ContactForce));
        }
        assert!(simulation.motion().is_sound());
        let events = [RealOutput::ContactLastOpening, RealOutput::ContactLastClosing];
        (forces, events.map(|event| simulation.real(event) - start))
    };
    let (expected, expected_events) = run(0.0);
    assert!(expected_events.iter().all(|event| *event > 0.0), "it does not open and close");
    // Both are within the tolerance, which is relative to the largest force too.
    let largest = expected.iter().copied().fold(force_scale(&Scene::default()), f64::max);
    let allowed = 2.0 * Scene::default().solver.effective_tolerance() * largest;
    for start in [-1.0, -2.0, -4.0] {
        let (forces, events) = run(start);
        assert!(largest_difference(&forces, &expected) < allowed, "{start} s");
        assert!(largest_difference(&events, &expected_events) < 1e-9, "{start} s");
    }
}

#[test]
fn a_contact_at_rest_is_not_integrated() {
    for parts in [1, 3600] {
        let scene = Scene::default();
        let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
        let force = simulation.real(RealOutput::ContactForce);
        let size = 3600.0 / f64::from(parts);
        for k in 0..parts {
            simulation.step(&Inputs::default(), f64::from(k) * size, size).unwrap();
        }
        assert_eq!(simulation.real(RealOutput::ContactForce), force);
        assert_eq!(simulation.integer(IntegerOutput::SolverSteps), 0);
        // An input wakes it, and the motion after it comes to rest where the force is what statics say.
        let pressed = accelerated(10.0, 0.0);
        simulation.step(&pressed, 3600.0, 1.0).unwrap();
        let steps = simulation.integer(IntegerOutput::SolverSteps);
        assert!(steps > 5, "{steps}");
        simulation.step(&pressed, 3601.0, 1e6).unwrap();
        assert_eq!(simulation.integer(IntegerOutput::SolverSteps), steps);
        let statics = 10.0 * scenes::propped_mass(&scene);
        let added = simulation.real(RealOutput::ContactForce) - force;
        assert!((added / statics - 1.0).abs() < 1e-3, "{added} {statics}");
    }
}

#[test]
fn a_generator_that_starts_late_wakes_the_contact_in_time() {
    let mut scene = shaken(98.0, 1e-6);
    let start = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
    scene.excitation.start_time = 1234.5;
    for size in [1235.0_f64, 1234.5] {
        let mut late = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
        let mut prompt = start.clone();
        let end = 1234.5 + 2.3e-4;
        late.step(&Inputs::default(), 0.0, size.min(end)).unwrap();
        if late.time() < end {
            late.step(&Inputs::default(), late.time(), end - late.time()).unwrap();
        }
        prompt.step(&Inputs::default(), 0.0, 2.3e-4).unwrap();
        let [late, prompt] = [&late, &prompt].map(|simulation| simulation.real(RealOutput::ContactForce));
        // At 1234 s time has a spacing of 2e-13 s, and the force changes by some 1e3 N/s.
        assert!((late - prompt).abs() < 1e-6 * prompt, "{late} {prompt}");
    }
}

/// Bad input loses nothing: after a step that fails the motion is where it was, and goes on as if it had not been asked for.
#[test]
fn a_step_that_fails_leaves_the_motion_as_it_was() {
    let mut simulation = Simulation::new(&shaken(400.0, 1e-6), &Inputs::default(), 0.0).unwrap();
    let outputs = |simulation: &Simulation| -> Vec<_> {
        let values = VARIABLES.iter().filter_map(|variable| simulation.output(variable));
        values.map(f64::to_bits).collect()
    };
    let size = 1.3e-5;
    for k in 0..100 {
        let time = f64::from(k) * size;
        simulation.step(&Inputs::default(), time, size).unwrap();
        if k % 9 != 8 {
            continue;
        }
        let unasked = simulation.clone();
        let (pressed, thrown) = (accelerated(1e3, 0.0), accelerated(0.0, 1e305));
        simulation.step(&thrown, simulation.time(), size).unwrap_err();
        assert_eq!(outputs(&simulation), outputs(&unasked), "{k}");
        let mut others = [simulation.clone(), unasked];
        for (next, inputs) in [Inputs::default(), pressed, Inputs::default()].iter().enumerate() {
            let [found, expected] = others.each_mut().map(|simulation| {
                simulation.step(inputs, simulation.time(), size).unwrap();
                (outputs(simulation), simulation.events().0.copied().collect::<Vec<_>>())
            });
            assert_eq!(found, expected, "{k} {next}");
        }
    }
}

/// Openings and closings over 3 ms, with communication steps of `size` quarters of a microsecond; at every eleventh of them the motion is restored
/// from a copy.
fn events(size: u32, inputs: impl Fn(f64) -> Inputs) -> Vec<Event> {
    let mut simulation = Simulation::new(&shaken(400.0, 1e-6), &Inputs::default(), 0.0).unwrap();
    let mut events = Vec::new();
    for k in 0..12_000 / size {
        let time = 2.5e-7 * f64::from(k * size);
        simulation.step(&inputs(time), time, 2.5e-7 * f64::from(size)).unwrap();
        let (list, left_out) = simulation.events();
        assert_eq!(left_out, None);
        events.extend(list);
        if k % 11 == 0 {
            let course = *simulation.motion();
            simulation.go_on_from(&course);
            assert_eq!(simulation.events().0.count(), 0);
        }
    }
    events
}

/// A push that comes and goes takes back what the integrator has done ahead. Without it: hard case "Chatter at 41 g".
#[test]
fn every_event_is_reported_once() {
    let pulsed = |time: f64| accelerated(if (time / 5e-4 + 1e-6) % 2.0 < 1.0 { 1.0 } else { 0.0 }, 0.0);
    let expected = events(2000, pulsed);
    assert!(expected.len() >= 5, "{expected:?}");
    for pair in expected.windows(2) {
        assert!(pair[0].time < pair[1].time && pair[0].closes != pair[1].closes, "{pair:?}");
    }
    for size in [400, 40, 4, 1] {
        let found = events(size, pulsed);
        assert_eq!(found.len(), expected.len(), "{size}: {found:?} {expected:?}");
        for (found, expected) in found.iter().zip(&expected) {
            assert_eq!(found.closes, expected.closes);
            // A force wrong by the tolerance reaches zero at another time.
            near(size, found.time, expected.time, 1e-8);
        }
    }
}

/// Length of a communication step (s), base acceleration at its start (m/s2), and the rate of that (m/s3).
type Driven = (f64, f64, f64);

/// What comes from outside anew in each communication step.
fn plans() -> [(&'static str, Vec<Driven>); 6] {
    // The golden ratio's fractional parts fill an interval evenly; other multiples serve as random numbers.
    let part = |k: u32| (f64::from(k) * 0.618_033_988_749_894_9).fract();
    let random = |k: u32| (f64::from(k) * 0.754_877_666_246_692_8 * 1e3).fract() - 0.5;
    let wave = |time: f64| 50.0 * (1e3 * time).sin();
    // From 1 ns to 20 us.
    let wide = |k: u32| 1e-9 * 2e4_f64.powf(part(k));
    let mut time = 0.0;
    let mut walk = 0.0;
    let smooth = (0..1000).map(|k| {
        let (start, size) = (wave(time), wide(k));
        time += size;
        (size, start, (wave(time) - start) / size)
    });
    let smooth = smooth.collect();
    let walking = (0..1000).map(|k| {
        walk += 0.5 * random(k);
        (1e-6, walk, 0.0)
    });
    [
        ("sampled", (0..1000).map(|k| (1e-6, wave(1e-6 * f64::from(k)), 0.0)).collect()),
        ("random lengths", (0..1000).map(|k| (wide(k), 20.0 * random(k), 0.0)).collect()),
        ("random lengths, linear", smooth),
        ("random walk", walking.collect()),
        ("random", (0..500).map(|k| (1e-6, 200.0 * random(k), 0.0)).collect()),
        ("jumps", (0..150).map(|k| (1e-5, f64::from(k % 5), 0.0)).collect()),
    ]
}

/// Force, least and greatest force of each communication step; steps taken and rejected.
fn driven(scene: &Scene, plan: &[Driven]) -> (Vec<[f64; 3]>, [i32; 2]) {
    let mut inputs = Inputs::default();
    let mut simulation = Simulation::new(scene, &inputs, 0.0).unwrap();
    let rows = plan.iter().map(|(size, acceleration, rate)| {
        (inputs.base_acceleration, inputs.base_acceleration_rate) = (*acceleration, *rate);
        simulation.step(&inputs, simulation.time(), *size).unwrap();
        [RealOutput::ContactForce, RealOutput::StepMinimumForce, RealOutput::StepMaximumForce]
            .map(|output| simulation.real(output))
    });
    let rows = rows.collect();
    let steps = [IntegerOutput::SolverSteps, IntegerOutput::SolverRejectedSteps];
    (rows, steps.map(|output| simulation.integer(output)))
}

/// For closed and opening contacts with 34 and 0.3 % damping of the first mode.
#[test]
fn inputs_and_lengths_that_are_new_in_each_step_keep_the_tolerance() {
    let closed = [(98.0, 1.0, false), (98.0, 1.0, true), (98.0, 0.01, true)];
    for (amplitude, damping, watched) in closed.into_iter().chain([(330.0, 1.0, true), (330.0, 0.01, true)]) {
        for (name, plan) in plans() {
            let with = |tolerance: f64, modes: i32| {
                let mut scene = shaken(amplitude, tolerance);
                scene.beam.stiffness_damping *= damping;
                scene.solver.modes = modes;
                scene.effects.extremes = watched;
                scene.effects.chatter = watched;
                scene
            };
            for tolerance in [1e-3, 1e-6, 1e-8] {
                let scene = with(tolerance, 0);
                let modes = Model::new(&scene, 0.0).unwrap().modes.len();
                // What the number of modes makes is no matter of the steps.
                let (exact, _) = driven(&with(1e-11, i32::try_from(modes).unwrap()), &plan);
                let (found, _) = driven(&scene, &plan);
                let mut scale = scenes::force_scale(&scene);
                let mut most = 0.0_f64;
                for (found, exact) in found.iter().zip(&exact) {
                    scale = scale.max(exact[2]);
                    most = (0..if watched { 3 } else { 1 })
                        .fold(most, |most, i| most.max((found[i] - exact[i]).abs() / scale));
                }
                assert!(most <= tolerance, "{amplitude} m/s2, {damping}, {name}, {tolerance:e}: {most:e}");
            }
        }
    }
}

/// After each change of an input the force bends, which needs steps about as short as after the last one.
#[test]
fn steps_after_an_input_has_changed_begin_with_the_length_that_the_last_change_needed() {
    let [.., (_, plan)] = plans();
    let (_, [steps, rejected]) = driven(&shaken(98.0, 1e-6), &plan);
    let most = 10 * i32::try_from(plan.len()).unwrap();
    assert!(5 * rejected < steps && steps < most, "{steps} steps, {rejected} rejected");
}
