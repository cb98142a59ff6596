//! False makes, extremes and the smallest gap, against what is read at short intervals.

use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ExcitationKind, IntegerOutput, RealOutput};

use super::changeover;

/// What is read every `EVERY` seconds.
const EVERY: f64 = 2e-7;

fn shaken() -> Scene {
    let mut scene = changeover(1.5e-5);
    scene.effects.excitation = ExcitationKind::Sine;
    scene.excitation.amplitude = 200.0;
    scene.excitation.frequency = 600.0;
    scene.solver.tolerance = 1e-7;
    scene
}

/// Makes of at least `least` (s) in the resistances read; an open start.
fn makes(resistances: &[f64], threshold: f64, least: f64) -> (i32, f64, f64) {
    let (mut count, mut longest, mut total) = (0, 0.0_f64, 0.0);
    for make in resistances.split(|resistance| *resistance >= threshold) {
        let lasted = make.len() as f64 * EVERY;
        longest = longest.max(lasted);
        if lasted >= least {
            count += 1;
            total += lasted;
        }
    }
    (count, longest, total)
}

#[test]
fn false_makes_of_both_contacts() {
    let scene = shaken();
    let read = |size: f64| {
        let mut simulation = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
        let mut resistances = [vec![], vec![]];
        while simulation.time() < 6e-3 - 0.5 * size {
            simulation.step(&Inputs::default(), simulation.time(), size).unwrap();
            resistances[0].push(simulation.real(RealOutput::ContactResistance));
            resistances[1].push(simulation.real(RealOutput::SecondResistance));
        }
        let real = |output| simulation.real(output);
        let found = [
            (
                simulation.integer(IntegerOutput::ChatterFalseMakes),
                real(RealOutput::ChatterLongestFalseMake),
                real(RealOutput::ChatterTotalFalseMake),
            ),
            (
                simulation.integer(IntegerOutput::SecondFalseMakes),
                real(RealOutput::SecondLongestFalseMake),
                real(RealOutput::SecondTotalFalseMake),
            ),
        ];
        (found, resistances)
    };
    let (whole, _) = read(1e-3);
    let (parts, resistances) = read(EVERY);
    for n in 0..2 {
        let (count, longest, total) = whole[n];
        let threshold = scene.chatter.resistance_threshold;
        let (seen, seen_longest, seen_total) = makes(&resistances[n], threshold, scene.second.minimum_duration);
        assert!(seen > 3, "{seen} makes seen");
        assert_eq!((count, parts[n].0), (seen, seen));
        // Each make is read with an error of one interval at each end.
        let rows = [(longest, seen_longest, 1), (total, seen_total, seen)];
        for (found, seen, number) in rows {
            assert!(
                (found - seen).abs() <= 2.0 * EVERY * f64::from(number),
                "{found} s, {seen} s seen"
            );
        }
        // Instants of communication points do not matter but for the tolerance.
        assert!((longest - parts[n].1).abs() < 1e-9, "{longest} s, {} s", parts[n].1);
    }
}

/// A contact that is closed at the start has not been made; each make after an interruption counts.
#[test]
fn a_closed_start_is_no_false_make() {
    let mut scene = Scene::default();
    scene.effects.excitation = ExcitationKind::Sine;
    let run = |scene: &Scene| {
        let mut simulation = Simulation::new(scene, &Inputs::default(), 0.0).unwrap();
        simulation.step(&Inputs::default(), 0.0, 5e-3).unwrap();
        let makes = simulation.integer(IntegerOutput::ChatterFalseMakes);
        (simulation.integer(IntegerOutput::ChatterCount), makes)
    };
    assert_eq!(run(&scene), (0, 0));
    scene.excitation.amplitude = 400.0;
    let (interruptions, makes) = run(&scene);
    assert!(
        interruptions > 2 && (0..=1).contains(&(interruptions - makes)),
        "{interruptions}, {makes}"
    );
    // The minimum duration is that of makes.
    scene.second.minimum_duration = 1.0;
    assert_eq!(run(&scene), (interruptions, 0));
}

#[test]
fn extremes_are_those_of_the_course() {
    let scene = shaken();
    let inputs = |time: f64| Inputs {
        second_displacement: 1e-3 * time,
        second_displacement_rate: 1e-3,
        ..Inputs::default()
    };
    let mut fine = Simulation::new(&scene, &inputs(0.0), 0.0).unwrap();
    let mut longest = 0.0_f64;
    for size in [2e-4, 3e-5] {
        let mut simulation = Simulation::new(&scene, &inputs(0.0), 0.0).unwrap();
        fine = Simulation::new(&scene, &inputs(0.0), 0.0).unwrap();
        while simulation.time() < 3e-3 {
            let time = simulation.time();
            simulation.step(&inputs(time), time, size).unwrap();
            let gap = |simulation: &Simulation| {
                let open = simulation.real(RealOutput::ContactIndentation) - simulation.model().preload().indentation;
                scene.second.gap + open - inputs(simulation.time()).second_displacement
            };
            let mut seen = (gap(&fine), fine.real(RealOutput::SecondForce));
            while fine.time() < simulation.time() - 0.5 * EVERY {
                fine.step(&inputs(fine.time()), fine.time(), EVERY).unwrap();
                seen.0 = seen.0.min(gap(&fine));
                seen.1 = seen.1.max(fine.real(RealOutput::SecondForce));
            }
            let least = simulation.real(RealOutput::StepMinimumGap);
            let greatest = simulation.real(RealOutput::SecondMaximumForce);
            // What is read every so often is no more than the extreme, and less by what the tip does in between: velocities are
            // below 0.5 m/s in flight, and overlaps below a micrometre turn within many intervals.
            assert!(
                least <= seen.0 + 1e-10 && least >= seen.0 - 0.25 * 0.5 * EVERY,
                "{size} s at {time} s: {least} m, {} m seen",
                seen.0
            );
            let scale = 1e-7 * simulation.model().force_scale().max(greatest);
            assert!(
                greatest >= seen.1 - 2.0 * scale && greatest <= 1.05 * seen.1 + 2.0 * scale,
                "{size} s at {time} s: {greatest} N, {} N seen",
                seen.1
            );
            longest = longest.max(greatest);
        }
    }
    assert!(longest > 0.01 && fine.time() > 2e-3, "{longest} N");
}
