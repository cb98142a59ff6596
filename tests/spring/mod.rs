//! Springs of segments and of modes: against closed forms, against the uniform spring that they contain, and what is wrong
//! in their files.

mod files;
mod modes;
pub mod reference;

use std::f64::consts::TAU;

use reference::{Stretch, frequencies};
use relay_contact::reference::{Mode, Model, Section, Spring, Statics, frequencies as uniform_frequencies};
use relay_contact::scene::Scene;
use relay_contact::scene::spring::{PointMass, Segment, Segments, Shape};
use relay_contact::variables::AxialForceKind;
use testing::close;
use testing::scenes::{forces, largest_difference, shaken};
use testing::springs::{of_segments, segment, spring_file};

fn with(mut scene: Scene, shape: Shape) -> Scene {
    scene.spring = spring_file("spring.toml", shape);
    scene
}

fn uniform(length: f64, width: f64, thickness: f64) -> Segment {
    segment(length, [width; 2], [thickness; 2])
}

/// The scene with its spring as segments of its section, of these shares of the length.
fn cut(scene: &Scene, shares: &[f64]) -> Scene {
    let beam = &scene.beam;
    let part = |share: &f64| uniform(share * beam.length, beam.width, beam.thickness);
    with(scene.clone(), of_segments(shares.iter().map(part)))
}

/// Bending stiffness and mass per length of a rectangle of the scene's materials.
fn section(scene: &Scene, width: f64, thickness: f64) -> (f64, f64) {
    (scene.beam.youngs_modulus * width * thickness.powi(3) / 12.0, scene.beam.density * width * thickness)
}

/// The angular frequencies of the free spring, rad/s.
fn found(scene: &Scene) -> Vec<f64> {
    let basis = Spring::new(scene).modes(40, 0.0).unwrap();
    basis.modes.iter().map(|mode| mode.omega_squared.sqrt()).collect()
}

fn no_rivet() -> Scene {
    let mut scene = Scene::default();
    scene.tip.mass = 0.0;
    scene
}

/// The lowest frequencies agree: the rounding of the reference, of a determinant that loses digits at the higher ones.
fn agree(scene: &Scene, expected: &[f64]) {
    let found = found(scene);
    for (n, (found, expected)) in found.iter().zip(expected).enumerate() {
        close(format_args!("frequency {n}"), *found, *expected, 1e-9);
    }
}

#[test]
fn segments_of_the_uniform_section_are_the_uniform_spring() {
    for axial in
        [AxialForceKind::FromPreload, AxialForceKind::None, AxialForceKind::FromDeflection, AxialForceKind::Prescribed]
    {
        let mut scene = shaken(400.0, 1000.0);
        scene.effects.axial_force = axial;
        scene.beam.axial_force = 4.0;
        scene.environment.gravity = 9.81;
        scene.tip.rotary_inertia = 1e-12;
        // Newton's method leaves less than what is compared.
        scene.solver.tolerance = 1e-8;
        let plain = Model::new(&scene, 0.0).unwrap();
        let expected = forces(&scene, 2e-5, 200);
        let largest = expected.iter().copied().fold(0.0, f64::max);
        for shares in [&[1.0][..], &[0.3, 0.7], &[0.2; 5]] {
            let scene = cut(&scene, shares);
            let model = Model::new(&scene, 0.0).unwrap();
            assert_eq!(model.modes.len(), plain.modes.len());
            for (found, expected) in [
                (model.preload.force, plain.preload.force),
                (model.preload.indentation, plain.preload.indentation),
                (model.frequency, plain.frequency),
                (model.force_scale, plain.force_scale),
            ] {
                close(format_args!("{axial:?} {shares:?}"), found, expected, 1e-10);
            }
            let difference = largest_difference(&forces(&scene, 2e-5, 200), &expected);
            assert!(difference < 1e-10 * largest, "{axial:?} {shares:?}: {difference:e}");
        }
    }
}

#[test]
fn a_wedge_has_the_frequencies_of_its_bessel_functions() {
    // omega L^2 sqrt(rho A / E I) at the clamp of a beam of constant width whose thickness falls linearly to this share:
    // zeros of the determinant of J, Y, I and K of order 2 and 3 at 2 sqrt(lambda z), computed with 30 digits; the first
    // three at 0.5 are those of H. H. Mabie, C. B. Rogers, J. Acoust. Soc. Am. 36 (1964) 463.
    #[rustfmt::skip]
    let cases = [
        (0.5, [3.823_784_847_290_28, 18.317_260_904_174_7, 47.264_827_010_480_6, 90.450_477_658_643_7]),
        (0.1, [4.630_723_862_396_02, 14.930_792_667_860_2, 32.833_121_135_886_3, 58.917_067_490_655_4]),
        (0.02, [5.123_986_890_986_4, 14.824_498_584_841_9, 29.802_548_057_934_8, 50.471_115_658_264]),
    ];
    for (share, expected) in cases {
        let scene = no_rivet();
        let (length, width, thickness) = (0.02, 4e-3, 4e-4);
        let (stiffness, mass) = section(&scene, width, thickness);
        let unit = (stiffness / mass).sqrt() / (length * length);
        let whole = segment(length, [width; 2], [thickness, share * thickness]);
        let half = f64::midpoint(1.0, share) * thickness;
        let halves = [
            segment(0.5 * length, [width; 2], [thickness, half]),
            segment(0.5 * length, [width; 2], [half, share * thickness]),
        ];
        for segments in [vec![whole], halves.to_vec()] {
            agree(&with(scene.clone(), of_segments(segments)), &expected.map(|value| value * unit));
        }
    }
}

#[test]
fn steps_masses_and_a_soft_clamp_have_their_exact_frequencies() {
    let (a, b, c) = ((0.007, 4e-3, 3e-4), (0.005, 6e-3, 1.5e-4), (0.008, 2e-3, 2e-4));
    for clamp in [f64::INFINITY, 10.0, 0.1, 1e-3] {
        let mut scene = Scene::default();
        scene.tip.mass = 2e-5;
        scene.tip.rotary_inertia = 3e-12;
        let stretch = |(length, width, thickness): (f64, f64, f64)| {
            let (stiffness, mass) = section(&scene, width, thickness);
            Stretch::uniform(length, stiffness, mass)
        };
        // A mass on the first step, one inside the second segment, the rivet 3 mm short of the end.
        let expected = [
            Stretch { mass: 1e-5, inertia: 2e-11, ..stretch(a) },
            Stretch { mass: 4e-6, ..stretch((0.002, b.1, b.2)) },
            stretch((0.003, b.1, b.2)),
            Stretch { mass: 2e-5, inertia: 3e-12, ..stretch((0.005, c.1, c.2)) },
            stretch((0.003, c.1, c.2)),
        ];
        let point = |position, mass, rotary_inertia| PointMass { position, mass, rotary_inertia };
        let segments = Segments {
            segments: [a, b, c].map(|(length, width, thickness)| uniform(length, width, thickness)).to_vec(),
            masses: vec![point(0.009, 4e-6, 0.0), point(0.007, 1e-5, 2e-11)],
            contact_position: Some(0.017),
            fork_position: None,
            clamp_stiffness: Some(clamp).filter(|clamp| clamp.is_finite()),
        };
        let scene = with(scene, Shape::Segments(segments));
        agree(&scene, &frequencies(&expected, clamp, 20.0, 6));
        // With the contact closed, as `preload.frequency` reports it.
        let mut free = scene.clone();
        free.effects.axial_force = AxialForceKind::None;
        let model = Model::new(&free, 0.0).unwrap();
        let mut closed = expected;
        closed[3].support = model.preload.contact_stiffness;
        close(clamp, TAU * model.frequency, frequencies(&closed, clamp, 20.0, 1)[0], 1e-9);
        // Statics: M^2 / (E I), and the rotation of the clamp.
        let mut compliance = if clamp.is_finite() { 0.017_f64.powi(2) / clamp } else { 0.0 };
        let mut left = 0.017;
        for part in &expected[..4] {
            let right: f64 = left - part.length;
            compliance += (left.powi(3) - right.powi(3)) / (3.0 * part.bending_stiffness);
            left = right;
        }
        let spring = Spring::new(&scene);
        close("compliance, m/N", spring.statics.tip_compliance(0.0), compliance, 1e-12);
        let sum: f64 = model.modes.iter().map(Mode::compliance).sum();
        close("of all modes", sum, spring.statics.tip_compliance(model.preload.axial_force), 1e-9);
    }
}

#[test]
fn a_column_on_a_soft_clamp_buckles_at_its_root() {
    // l tan(l L) = k / (E I), N = E I l^2.
    let scene = no_rivet();
    let (length, width, thickness) = (0.015, 4e-3, 2e-4);
    let (stiffness, _) = section(&scene, width, thickness);
    for clamp in [1e-3, 0.1, 10.0] {
        let segments = Segments {
            segments: vec![uniform(length, width, thickness)],
            clamp_stiffness: Some(clamp),
            ..Segments::default()
        };
        let spring = Spring::new(&with(scene.clone(), Shape::Segments(segments)));
        let rest = |l: f64| l * (l * length).tan() - clamp / stiffness;
        let l = relay_contact::reference::bracketed(rest, 0.0, 0.999_999_999 * TAU / 4.0 / length).unwrap();
        let expected = stiffness * l * l;
        close("buckling load, N", spring.statics.buckling_load(), expected, 1e-10);
    }
}

#[test]
fn the_uniform_column_of_segments_follows_the_closed_form_under_axial_force() {
    let scene = Scene::default();
    let plain = Section::new(&scene);
    let spring = Spring::new(&cut(&scene, &[0.4, 0.6]));
    let buckling_load = (0.25 * TAU / plain.length).powi(2) * plain.bending_stiffness;
    close("buckling load, N", Statics::new(&plain, 0.0).buckling_load(), buckling_load, 1e-10);
    for share in [-3.0, 0.3, 0.9, 0.99] {
        let force = share * buckling_load;
        let exact = uniform_frequencies(&plain, force, 1e6, 1)[0];
        close(share, spring.frequency(force, 1e6).unwrap(), exact, 1e-9);
        let exact = Statics::new(&plain, 0.0).tip_compliance(force);
        close(share, spring.statics.tip_compliance(force), exact, 1e-9);
    }
    assert!(spring.frequency(1.001 * buckling_load, 0.0).is_none());
    // Before more functions are taken, and with them.
    for share in [-3.0, -99.0, -1e3, -1e4] {
        let tension = -share * buckling_load;
        let l = (tension / plain.bending_stiffness).sqrt();
        let exact = (plain.length - (l * plain.length).tanh() / l) / tension;
        let mut scene = scene.clone();
        scene.effects.axial_force = AxialForceKind::Prescribed;
        scene.beam.axial_force = -tension;
        for statics in [Statics::new(&plain, -tension), Spring::new(&cut(&scene, &[0.4, 0.6])).statics] {
            // A rounding of each function.
            close(share, statics.tip_compliance(-tension), exact, 64.0 * f64::EPSILON);
        }
    }
}

#[test]
fn a_spring_that_goes_on_beyond_its_contact_has_its_frequency_under_tension() {
    // Zeros of the determinant of both stretches in closed form, with 80 digits: buckling loads, and rad/s on a support of 1e6 N/m.
    let mut scene = Scene::default();
    scene.tip.mass = 2e-5;
    let segments =
        Segments { segments: vec![uniform(0.018, 4e-3, 1e-4)], contact_position: Some(0.015), ..Segments::default() };
    let spring = Spring::new(&with(scene, Shape::Segments(segments)));
    let buckling_load = 0.453_270_720_642_622;
    close("buckling load, N", spring.statics.buckling_load(), buckling_load, 1e-10);
    // Last what 64 functions leave, which fewer exceed twenty times.
    let cases = [
        (-3.0, 8_505.834_853_845_14, 1e-13),
        (-300.0, 32_467.861_801_025, 2e-6),
        (-1000.0, 36_608.690_949_775_7, 1e-4),
        (-3000.0, 39_047.825_950_428_7, 5e-4),
    ];
    for (share, exact, bound) in cases {
        close(share, spring.frequency(share * buckling_load, 1e6).unwrap(), exact, bound);
    }
}
