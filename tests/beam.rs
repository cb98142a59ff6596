//! The beam against closed forms: exact frequencies against Galerkin's, published eigenvalues, static compliance.

use relay_contact::error::Remark;
use relay_contact::reference::{self, Mode, Model, Section, Space, Statics};
use relay_contact::scene::Scene;
use testing::{close, near};

/// E I = rho A = L = 1, so that omega = (beta L)^2.
const UNIT: Section =
    Section { length: 1.0, bending_stiffness: 1.0, mass_per_length: 1.0, tip_mass: 0.0, tip_inertia: 0.0 };

#[test]
fn published_eigenvalues_of_the_plain_beam() {
    // Tip spring k L^3 / (E I) and beta L: cantilever, elastically supported, clamped-pinned (tables of beam vibration).
    let cases: [(f64, &[f64]); 6] = [
        (0.0, &[1.875_104_07, 4.694_091_13, 7.854_757_44]),
        (1.0, &[2.010_003_32]),
        (10.0, &[2.638_924_70]),
        (100.0, &[3.640_541_72]),
        (1000.0, &[3.897_800_81]),
        // A support so stiff that it is pinned to nine digits: the eigenvalue differs by about beta^3 / (2 k).
        (1e13, &[3.926_602_31, 7.068_582_75, 10.210_176_12]),
    ];
    for (support, published) in cases {
        let exact = reference::frequencies(&UNIT, 0.0, support, published.len());
        for (omega, published) in exact.iter().zip(published) {
            near(format_args!("k = {support}"), omega.sqrt(), *published, 1e-8);
        }
    }
}

#[test]
fn exact_frequencies_agree_with_galerkin() {
    for (tip_mass, tip_inertia) in [(0.0, 0.0), (0.3, 0.0), (0.0, 0.02), (2.0, 0.1)] {
        let section = Section { tip_mass, tip_inertia, ..UNIT };
        for axial_force in [-1500.0, -30.0, -1.0, 0.0, 1e-4, 1.0, 2.4] {
            for support in [0.0, 1.0, 5000.0, 1e7] {
                let exact = reference::frequencies(&section, axial_force, support, 4);
                let galerkin = Space::new(40).modes(&section, axial_force, support);
                assert_eq!(exact.len(), 4);
                for (exact, mode) in exact.iter().zip(&galerkin.unwrap()) {
                    let of = format!("m {tip_mass} J {tip_inertia} N {axial_force} k {support}");
                    close(of, mode.omega_squared.sqrt(), *exact, 1e-9);
                }
            }
        }
    }
}

#[test]
fn static_compliance_follows_the_beam_column() {
    let statics = Statics::new(&UNIT, 0.0);
    // Tip load: (tan(l) / l - 1) / N with l^2 = N / (E I); tension takes tanh.
    for n in [0.5, 1.0, 2.0, 2.4, 2.46] {
        let l = f64::sqrt(n);
        close(n, statics.tip_compliance(n), (l.tan() / l - 1.0) / n, 1e-11);
        close(-n, statics.tip_compliance(-n), (1.0 - l.tanh() / l) / n, 1e-11);
    }
    assert!((statics.tip_compliance(0.0) - 1.0 / 3.0).abs() < 1e-15);
    // Uniform load: q L^4 / (8 E I).
    assert!((statics.gravity_compliance(0.0) + 1.0 / 8.0).abs() < 1e-15);
    // A static tip load is met exactly by any number of modes of two or more.
    for count in [2, 3, 7, 40] {
        let modes = Space::new(count).modes(&UNIT, 0.0, 0.0).unwrap();
        near(count, modes.iter().map(Mode::compliance).sum(), 1.0 / 3.0, 1e-14);
    }
}

/// An elastica clamped at one end: its load `P L^2 / EI` of constant direction at the other, and deflection over length there.
/// By elliptic integrals (K. E. Bisshopp, D. C. Drucker, Quart. Appl. Math. 3 (1945) 272).
const ELASTICA: [(f64, f64); 5] = [
    (0.2, 0.066_364_482_145),
    (0.31, 0.102_221_167_991),
    (0.4, 0.130_975_242_085),
    (0.6, 0.192_350_279_687),
    (0.9, 0.276_207_748_829),
];

#[test]
fn what_a_linear_beam_misses_of_a_spring_bent_far_is_told() {
    for (load, bent) in ELASTICA {
        let missed = 100.0 * (load / (3.0 * bent) - 1.0);
        let mut scene = Scene::default();
        // What the contact gives way is a part of 1e-3 of it at most.
        scene.contact.overtravel = bent * scene.beam.length;
        let model = Model::new(&scene, 0.0).unwrap();
        match model.remarks().as_slice() {
            [] => assert!(bent < 0.1, "{bent}: nothing told"),
            // The next order has (deflection over length)^4, and a factor of 1.2 to 1.4 up to 0.35 (by a solution with collocation).
            [Remark::BentFar { stiffer, bent: told, .. }] => assert!(
                bent > 0.0999
                    && (told / bent - 1.0).abs() < 2e-3
                    && (stiffer - missed).abs() < 100.0 * 1.4 * bent.powi(4) + 0.02,
                "{bent}: {stiffer} told, {missed} is right"
            ),
            others => panic!("{others:?}"),
        }
    }
}
