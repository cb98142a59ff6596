//! The promise of `solver.tolerance` on random plausible relays ([`testing::relays`]): contact force and extremes are right
//! to the tolerance, relative to the larger of the force scale and the largest force so far. The reference is the same
//! relay at the tightest tolerance with the most modes.

#![allow(clippy::unwrap_used)]

use relay_contact::reference::MAX_MODES;
use relay_contact::scene::Solver;
use testing::relays::{Course, Relay};

/// The course of the relay with all modes at a tolerance; `None` if it is refused or takes too many steps.
fn reference(relay: &Relay, tolerance: f64, stronger: f64) -> Option<Course> {
    let course = relay.run(|scene| {
        scene.solver.tolerance = tolerance;
        scene.solver.modes = i32::try_from(MAX_MODES).unwrap();
        scene.excitation.amplitude *= 1.0 + stronger;
        scene.excitation.spectral_density *= (1.0 + stronger).powi(2);
        scene.contact.curvature_radius *= 1.0 + stronger;
    });
    match course {
        Ok((course, None)) => Some(course),
        _ => None,
    }
}

#[test]
fn sixty_relays_keep_their_tolerance() {
    let (mut kept, mut ill, mut opening) = (0, 0, 0);
    for number in 0..60 {
        let relay = Relay::draw(number);
        let tolerance = relay.scene.solver.tolerance;
        let Some(reference_course) = reference(&relay, Solver::TOLERANCE_FLOOR, 0.0) else {
            continue;
        };
        opening += u32::from(reference_course.opens());
        let (course, failure) = relay.run(|_| {}).unwrap();
        assert_eq!(failure, None, "relay {number}");
        let (force, extremes) = course.error(&reference_course);
        if force.max(extremes) <= tolerance {
            kept += 1;
            continue;
        }
        // Errors of one part in 250 of the tolerance are allowed in each step. A relay in which such a change of
        // excitation and contact moves the result by more than the tolerance cannot keep it.
        let change = tolerance / 250.0;
        let changed = reference(&relay, Solver::TOLERANCE_FLOOR, change).unwrap();
        let (by_force, by_extremes) = changed.error(&reference_course);
        assert!(
            by_force.max(by_extremes) > tolerance,
            "relay {number}: force wrong by {force:e}, extremes by {extremes:e}, asked {tolerance:e}; a change of the input by \
             {change:e} moves them by {by_force:e} and {by_extremes:e}"
        );
        ill += 1;
    }
    println!("{kept} kept, {ill} ill-conditioned, {opening} open");
    assert!(opening > 20 && kept > 50 && ill < 3, "{opening} {kept} {ill}");
}
