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

/// A contact's outputs that have to agree.
#[derive(Clone, Copy, Debug)]
struct Outputs {
    time: f64,
    force: f64,
    least: f64,
    greatest: f64,
    last_opening: f64,
    last_closing: f64,
    closed: bool,
}

fn outputs(simulation: &Simulation, (names, closed): relays::Outputs) -> Outputs {
    let [force, least, greatest, last_opening, last_closing] = names.map(|name| simulation.real(name));
    Outputs {
        time: simulation.time(),
        force,
        least,
        greatest,
        last_opening,
        last_closing,
        closed: simulation.boolean(closed),
    }
}

/// Says what disagrees after a communication step.
fn disagreement(before: &Outputs, after: &Outputs, bonded: bool) -> Option<&'static str> {
    let Outputs {
        time,
        force,
        least,
        greatest,
        ..
    } = *after;
    let range = least..=greatest;
    let within = |instant: f64| (before.time..=time).contains(&instant);
    let opened = within(after.last_opening) && after.last_opening != before.last_opening;
    let closed = within(after.last_closing) && after.last_closing != before.last_closing;
    let was_open = opened || closed || before.force == 0.0;
    let was_closed = opened || closed || before.force != 0.0;
    [
        (
            !range.contains(&force),
            "the force at the end is not between the extremes",
        ),
        (!range.contains(&before.force), "that at the start is not"),
        (!bonded && least < 0.0, "a tensile force"),
        (least == 0.0 && !was_open, "no force, and no opening"),
        (was_open && least != 0.0, "open, with a force"),
        (greatest > 0.0 && !was_closed, "a force, and no closing"),
        (
            after.closed != (force > 0.0 || !bonded && after.last_closing == time),
            "closed is not a force",
        ),
        (after.last_opening < before.last_opening, "an opening taken back"),
        (after.last_closing < before.last_closing, "a closing taken back"),
        (
            after.last_opening.max(after.last_closing) > time,
            "an event in the future",
        ),
    ]
    .into_iter()
    .find_map(|(wrong, what)| wrong.then_some(what))
}

/// Steps through a scene, with lengths of all kinds, for `duration` seconds.
fn ride(case: &str, scene: &Scene, rng: &mut Rng, duration: f64, inputs: impl Fn(f64, f64) -> Inputs) {
    let Ok(mut simulation) = Simulation::new(scene, &inputs(0.0, 1e-6), 0.0) else {
        return;
    };
    let bonded = scene.effects.contact_law == ContactLawKind::Bonded;
    let contacts = relays::contacts(scene);
    let read =
        |simulation: &Simulation| -> Vec<_> { contacts.iter().map(|names| outputs(simulation, *names)).collect() };
    // Two in parallel are interrupted while each has more than the threshold.
    let threshold = scene.chatter.resistance_threshold / if scene.effects.parallel_contact { 2.0 } else { 1.0 };
    let mut before = read(&simulation);
    let count = |simulation: &Simulation| {
        let [longest, total] = [
            RealOutput::ChatterLongestInterruption,
            RealOutput::ChatterTotalInterruption,
        ]
        .map(|name| simulation.real(name));
        (
            f64::from(simulation.integer(IntegerOutput::ChatterCount)),
            longest,
            total,
        )
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
        if simulation.step(&inputs(time, size), time, size).is_err() {
            return;
        }
        let after = read(&simulation);
        for (before, after) in before.iter().zip(&after) {
            let what = disagreement(before, after, bonded);
            assert!(
                what.is_none(),
                "{case}, step of {size:e} s: {what:?}: {before:?} {after:?}"
            );
        }
        let now = count(&simulation);
        let (times, longest, total) = now;
        let in_all = longest < scene.chatter.minimum_duration || longest <= total * (1.0 + 1e-12);
        let interrupted = simulation.real(RealOutput::StepMaximumResistance) >= threshold;
        assert!(
            times >= counted.0
                && longest >= counted.1
                && total >= counted.2
                && in_all
                && (total == counted.2 || interrupted),
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
            ride(&case, &relay.scene, rng, duration, |time, size| {
                relay.inputs(time, size)
            });
        }
    }
}

#[test]
fn outputs_of_the_projects_scenes_agree_with_each_other() {
    for path in scenes::files() {
        let file = SceneFile::read(&path).unwrap();
        let inputs = |time, size| file.inputs_over(time, size).unwrap();
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
        ride(&case, &scene, &mut Rng::with_seed(number), 30.0 / frequency, |_, _| {
            Inputs::default()
        });
    }
}
