//! The essential numbers of the sections, to the digits published or to those that other solutions of the model agree on.

use std::f64::consts::TAU;

use relay_contact::reference::Model;
use relay_contact::scene::Scene;
use relay_contact::variables::AxialForceKind;

use super::runs::{self, Periodic};
use super::{contact, elastic, published as paper};
use crate::content::{Arguments, Block};
use identify::{PARAMETERS, Published, Specimen};

/// Equal to within half a unit of the last digit that is known of a value.
fn close(value: f64, known: f64, digit: f64) {
    assert!(
        (value - known).abs() <= 0.5 * digit,
        "{value}, not {known} +- {}",
        0.5 * digit
    );
}

fn without_axial_force() -> Scene {
    let mut scene = runs::specimen(paper::BEST);
    scene.effects.axial_force = AxialForceKind::None;
    scene
}

#[test]
fn what_was_fitted_has_the_published_digits() {
    let model = Model::new(&Scene::default(), 0.0).unwrap();
    close(model.preload().force, paper::FORCE, 0.001);
    close(model.preload().contact_stiffness, paper::STIFFNESS, 0.01e6);
    close(model.frequency(), paper::WITH_PRESTRESS, 0.1);
    let run = runs::periodic(&runs::specimen(paper::BEST), 1000.0).unwrap();
    assert!(run.repeats && !run.opens);
    close(run.amplitude(), paper::FORCE_AMPLITUDE, 0.001);
}

#[test]
fn two_other_solutions_of_the_model_agree() {
    // Two solutions of the model that share no code with this one, without axial force, to the digits they agree on.
    let scene = without_axial_force();
    let model = Model::new(&scene, 0.0).unwrap();
    close(model.preload().force, 0.152_026_1, 1e-7);
    close(model.preload().indentation, 64.418e-9, 1e-12);
    close(model.preload().contact_stiffness, 3.539_968e6, 1.0);
    close(model.frequency(), 1354.5397, 1e-4);
    close(runs::linear_force(&model, 500.0), 3.6295, 1e-4);
    close(runs::linear_force(&model, 1000.0), 4.8122, 1e-4);
    let run = runs::periodic(&scene, 1000.0).unwrap();
    close(run.least, 0.103_905, 1e-6);
    close(run.greatest, 0.200_149, 1e-6);
    close(runs::resistance(run.greatest), 34.25, 0.01);
    close(runs::resistance(run.least), 63.9, 0.1);
}

#[test]
fn the_linear_response_is_the_limit_of_small_forces() {
    // The force amplitude is a third of the static force; what its square adds is below a thousandth of it.
    for frequency in [250.0, 1250.0, 2000.0] {
        let scene = runs::specimen(paper::BEST);
        let linear = runs::linear_force(&runs::model(&scene).unwrap(), frequency);
        let periodic = runs::periodic(&scene, frequency).unwrap().amplitude();
        assert!(
            (periodic / linear - 1.0).abs() < 1e-3,
            "{frequency} Hz: {periodic}, {linear}"
        );
    }
}

#[test]
fn the_printed_beta_gives_the_same_force_at_every_frequency() {
    let amplitude = |frequency| runs::periodic(&runs::with_damping(paper::BETAS[3]), frequency).unwrap();
    let (low, high) = (amplitude(250.0), amplitude(2000.0));
    for run in [&low, &high] {
        assert!(run.repeats);
        close(run.amplitude(), 3.27, 0.01);
    }
    close(paper::ALPHA_PER_BETA.sqrt(), 1268.9, 0.1);
}

#[test]
fn equation_9_shifts_the_frequency_by_a_fortieth_of_a_hertz() {
    let (with, without) = (runs::specimen(paper::BEST), without_axial_force());
    let with = runs::model(&with).unwrap();
    close(1e3 * with.preload().axial_force, 2.94, 0.01);
    close(with.preload().force, 0.151_980_6, 1e-7);
    close(with.frequency(), 1354.5151, 1e-4);
    close(
        runs::model(&without).unwrap().frequency() - with.frequency(),
        0.025,
        0.001,
    );
    // The force that is needed is found: it gives the frequency.
    let mut scene = Scene::default();
    scene.effects.axial_force = AxialForceKind::Prescribed;
    scene.beam.axial_force = runs::axial_force_for(1312.0).unwrap();
    close(runs::model(&scene).unwrap().frequency(), 1312.0, 1e-6);
}

#[test]
fn the_start_values_are_what_is_identified_rounded() {
    let found = Specimen::identify(&Published::default()).unwrap();
    let start = Specimen::of(&Scene::default());
    // Rounded to four or five digits, of the rivet mass to three.
    for ((parameter, found), start) in PARAMETERS.iter().zip(found.values).zip(start.values) {
        let allowed = if parameter.symbol == "m" { 2.5e-3 } else { 3e-4 };
        assert!(
            (start / found - 1.0).abs() < allowed,
            "{}: {found}, {start}",
            parameter.name
        );
    }
}

#[test]
fn the_identified_scene_has_the_published_results() {
    // Roots are found to rounding; 1e-9 of it is lost in the functions.
    let scene = identify::scene(&Published::default()).unwrap();
    let model = runs::model(&scene).unwrap();
    for (value, known) in [
        (model.preload().force, paper::FORCE),
        (model.preload().contact_stiffness, paper::STIFFNESS),
        (model.frequency(), paper::WITH_PRESTRESS),
        (runs::linear_force(&model, 1000.0), paper::FORCE_AMPLITUDE),
    ] {
        assert!((value / known - 1.0).abs() < 1e-9, "{value}, {known}");
    }
}

#[test]
fn the_elastic_part_fits_both_amplitudes_it_is_fitted_to() {
    let model = elastic::fit().unwrap();
    close(runs::elastic_force(&model, 1000.0), paper::FORCE_AMPLITUDE, 1e-6);
    close(runs::elastic_force(&model, 1250.0), paper::PEAKS[0].2, 1e-6);
}

#[test]
fn contact_damping_is_not_what_separates_the_domains() {
    // The contact is stiff against the spring: what it has of the force is what the spring brings.
    for (ratio, _, _) in paper::EQUIVALENT {
        let scene = runs::specimen(ratio);
        let mut without = scene.clone();
        without.contact.damping = 0.0;
        let [with, without] = [scene, without].map(|scene| runs::model(&scene).unwrap());
        for frequency in paper::FREQUENCIES {
            let ratio = runs::linear_force(&without, frequency) / runs::linear_force(&with, frequency);
            assert!((ratio - 1.0).abs() < 0.01, "{frequency} Hz: {ratio}");
        }
    }
}

#[test]
fn displacement_and_phase_are_those_of_the_linear_response() {
    let scene = runs::specimen(paper::BEST);
    let run = runs::periodic(&scene, 1000.0).unwrap();
    let response = relay_contact::reference::response(&runs::model(&scene).unwrap(), TAU * 1000.0);
    let shaken = paper::ACCELERATION * response.displacement - runs::excitation(1000.0);
    // Harmonics are some thousandths of the nanometres by which the tip moves in the base.
    close(1e6 * run.displacement, 1e6 * shaken.norm(), 1e-3);
    let phase = (response.force.arg() - shaken.arg()).to_degrees().rem_euclid(360.0);
    close(run.phase, phase.min(360.0 - phase), 0.1);
}

#[test]
fn every_figure_has_curves_of_finite_points() {
    let sections = super::sections(Arguments {
        quick: true,
        ..Arguments::default()
    })
    .unwrap();
    let blocks: Vec<_> = sections.iter().flat_map(|section| &section.blocks).collect();
    let mut ids = Vec::new();
    for block in blocks {
        if let Block::Figure(figure) = block {
            ids.push(figure.id);
            for curve in &figure.curves {
                assert!(
                    !curve.x.is_empty() && curve.x.len() == curve.y.len(),
                    "{}: {}",
                    figure.id,
                    curve.name
                );
                let mut numbers = curve.x.iter().chain(&curve.y);
                assert!(
                    numbers.all(|number| number.is_finite()),
                    "{}: {}",
                    figure.id,
                    curve.name
                );
            }
        }
    }
    assert_eq!(ids.len(), 13);
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), 13);
}

#[test]
fn a_force_that_opens_the_contact_is_told() {
    let run: Periodic = runs::periodic(&runs::specimen(0.1), 1250.0).unwrap();
    assert!(run.opens);
}

#[test]
fn the_fitted_numbers_are_those_published() {
    let numbers = contact::compared().unwrap();
    let has = |quantity: &str, value: f64| {
        let all: Vec<_> = numbers
            .iter()
            .filter(|each| each.quantity.starts_with(quantity))
            .collect();
        assert!(!all.is_empty(), "{quantity}");
        assert!(
            all.iter().all(|each| (each.published - value).abs() < 1e-9),
            "{quantity}: {value}"
        );
    };
    has("first frequency, L = 15.5 mm", paper::WITH_PRESTRESS);
    for (length, overtravel, frequency) in paper::SHORT {
        has(
            &format!("first frequency, L = {length} mm, s = {overtravel} mm"),
            frequency,
        );
    }
    has("force amplitude, 1000 Hz, ratio 10", paper::FORCE_AMPLITUDE);
    for (ratio, frequency, force) in paper::PEAKS {
        has(&format!("force amplitude, {frequency} Hz, ratio {ratio}"), force);
    }
    for (alpha, _, force) in paper::FREQUENCY_DOMAIN_PEAKS {
        has(&format!("maximum force amplitude, alpha = {alpha} 1/s"), force);
    }
    for (ratio, displacement) in paper::RATIOS.into_iter().zip(paper::DISPLACEMENTS) {
        let quantity = format!("displacement amplitude, 1000 Hz, ratio {ratio}");
        let own = numbers.iter().find(|each| each.quantity == quantity).unwrap();
        close(own.published, displacement, 1e-6);
    }
    for (ratio, percent) in paper::DISPLACEMENT_DEVIATIONS {
        has(
            &format!("displacement amplitude over the base's, 1250 Hz, ratio {ratio}"),
            1.0 + 0.01 * percent,
        );
    }
    assert_eq!(numbers.iter().filter(|each| each.fitted == 1).count(), 17);
}
