//! What is read after a communication step agrees with itself: extremes, instants of events, force, resistance and counts,
//! in any scene and with steps of any lengths.

use fastrand::Rng;
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::scene::file::SceneFile;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ContactLawKind, IntegerOutput, RealOutput};
use testing::kinds::KINDS;
use testing::{relays, scenes};

/// Force, extremes of the step, last opening and closing of a contact at an instant, and whether it is closed.
type Read = (f64, [f64; 5], bool);

/// Says what disagrees after a communication step.
fn disagreement((start, before, _): Read, (time, after, closed): Read, bonded: bool) -> Option<&'static str> {
    let [was, _, _, last_opening, last_closing] = before;
    let [force, least, greatest, opening, closing] = after;
    let (opened, touched) = (opening != last_opening, closing != last_closing);
    let changed = opened || touched;
    let (range, step) = (least..=greatest, start..=time);
    let strange = opened && !step.contains(&opening) || touched && !step.contains(&closing);
    let wrong = [
        (!range.contains(&force), "the force at the end is not between the extremes"),
        (!range.contains(&was), "that at the start is not"),
        (!bonded && least < 0.0, "a tensile force"),
        ((changed || was == 0.0) != (least == 0.0), "open with a force, or no force without an opening"),
        (greatest > 0.0 && !changed && was == 0.0, "a force, and no closing"),
        (closed != (force > 0.0 || !bonded && closing == time), "closed is not a force"),
        (strange, "an event of another step"),
    ];
    wrong.into_iter().find_map(|(wrong, what)| wrong.then_some(what))
}

/// Steps through a scene, with lengths of all kinds, for `duration` seconds.
fn ride(case: &str, scene: &Scene, rng: &mut Rng, duration: f64, inputs: impl Fn(f64, f64) -> Inputs) {
    let mut simulation =
        Simulation::new(scene, &inputs(0.0, 1e-6), 0.0).unwrap_or_else(|error| panic!("{case}: {error}"));
    let bonded = scene.effects.contact_law == ContactLawKind::Bonded;
    let contacts = relays::contacts(scene);
    let read = |simulation: &Simulation| -> Vec<Read> {
        let each = contacts.iter().map(|(names, closed)| {
            let values = names.map(|name| simulation.real(name));
            (simulation.time(), values, simulation.boolean(*closed))
        });
        each.collect()
    };
    // Two in parallel are interrupted while each has more than the threshold.
    let threshold = scene.chatter.resistance_threshold / if scene.effects.parallel_contact { 2.0 } else { 1.0 };
    let mut before = read(&simulation);
    let count = |simulation: &Simulation| {
        [
            f64::from(simulation.integer(IntegerOutput::ChatterCount)),
            simulation.real(RealOutput::ChatterLongestInterruption),
            simulation.real(RealOutput::ChatterTotalInterruption),
        ]
    };
    let mut counted = count(&simulation);
    let mut size = 0.0;
    while simulation.time() < duration {
        let time = simulation.time();
        let own_step = simulation.state().lengths.short.max(simulation.state().lengths.long);
        let period = 1.0 / scene.excitation.frequency;
        size = match rng.u8(..6) {
            0 if size > 0.0 => size,
            1 => period,
            2 => 5.0 * period,
            // To the rounding, as many as from which the integrator ends a step with the communication step.
            3 => f64::from_bits((4.0 * own_step).to_bits().saturating_add_signed(rng.i64(-4..4))),
            _ => period * 10_f64.powf(-3.0 * rng.f64()),
        }
        .clamp(1e-9, 0.3 * duration);
        let done = simulation.step(&inputs(time, size), time, size);
        done.unwrap_or_else(|error| panic!("{case}, step of {size:e} s: {error}"));
        let after = read(&simulation);
        for (before, after) in before.iter().zip(&after) {
            let what = disagreement(*before, *after, bonded);
            assert!(what.is_none(), "{case}, step of {size:e} s: {what:?}: {before:?} {after:?}");
        }
        let now = count(&simulation);
        let [_, longest, total] = now;
        let in_all = longest < scene.chatter.minimum_duration || longest <= total * (1.0 + 1e-12);
        let interrupted = simulation.real(RealOutput::StepMaximumResistance) >= threshold;
        let never_less = now.iter().zip(counted).all(|(now, before)| *now >= before);
        assert!(
            never_less && in_all && (total == counted[2] || interrupted),
            "{case}, step of {size:e} s: interruptions {counted:?} {now:?}"
        );
        (before, counted) = (after, now);
    }
}

#[test]
fn outputs_of_random_relays_agree_with_each_other() {
    for (kind, _, draw) in KINDS {
        for number in 50_000..50_030 {
            let mut relay = draw(number);
            relay.scene.effects.extremes = true;
            let (size, count) = relay.steps;
            let case = format!("{kind} {number}");
            let duration = (size * f64::from(count)).min(20.0 / relay.scene.excitation.frequency);
            let rng = &mut Rng::with_seed(number);
            ride(&case, &relay.scene, rng, duration, |time, size| relay.inputs(time, size));
        }
    }
}

#[test]
fn outputs_of_the_projects_scenes_agree_with_each_other() {
    for path in scenes::files() {
        let file = SceneFile::read(&path).unwrap();
        // A step that passes over rows of a table is refused: there they are held.
        let held = |time| {
            let mut inputs = file.inputs_over(time, 1e-7).unwrap();
            inputs.hold();
            inputs
        };
        let inputs = |time, size| file.inputs_over(time, size).unwrap_or_else(|_| held(time));
        let mut scene = file.scene.clone();
        scene.effects.extremes = true;
        for seed in 0..3 {
            let case = path.display().to_string();
            ride(&case, &scene, &mut Rng::with_seed(seed), file.stop.min(0.02), inputs);
        }
    }
}

/// Found in steps of a period after one of five: the integrator's own steps are a quarter of a period there.
#[test]
fn closed_contacts_at_any_frequency_stay_closed_in_what_is_read() {
    let rng = &mut Rng::with_seed(1);
    for number in 0..100 {
        let frequency = 1800.0 + 2200.0 * rng.f64();
        let scene = scenes::shaken(294.1995, frequency);
        let case = format!("{number}: {frequency} Hz");
        ride(&case, &scene, &mut Rng::with_seed(number), 30.0 / frequency, |_, _| Inputs::default());
    }
}
