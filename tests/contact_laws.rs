//! The contact laws: force, stiffness, energy and divided differences of powers of the indentation.

use fastrand::Rng;
use relay_contact::reference::{Branch, Law, gauss, reduced_modulus};
use relay_contact::scene::Scene;

#[test]
fn an_open_contact_has_no_force_however_fast_it_moves() {
    for law in [Law::hertz(&Scene::default().contact), Law::rough(&Scene::default().contact), Law::linear(1e5, 1.0)] {
        for (d, rate) in [(0.0, -1e20), (-1e-9, 1e20), (-1.0, 0.0)] {
            assert_eq!(law.closed_branch(d, rate), Branch::default(), "{law:?} {d} {rate}");
        }
    }
}

/// Laws of several exponents through the same point: 1e5 N/m at 0.1 N.
fn laws() -> impl Iterator<Item = (f64, Law)> {
    [0.0, 0.1, 1.0 / 3.0, 0.54, 0.75, 0.9].into_iter().map(|n| {
        let mut contact = Scene::default().contact;
        (contact.stiffness, contact.stiffness_force) = (1e5, 0.1);
        contact.stiffness_exponent = n;
        (n, Law::rough(&contact))
    })
}

fn close(a: f64, b: f64, relative: f64) {
    assert!((a - b).abs() <= relative * b.abs(), "{a:e} and {b:e}");
}

#[test]
fn the_stiffness_is_the_given_power_of_the_force() {
    for (n, law) in laws() {
        for force in [1e-6, 0.1, 3.0] {
            let d = law.indentation(force);
            close(law.elastic_force(d), force, 1e-13);
            close(law.stiffness(d), 1e5 * (force / 0.1_f64).powf(n), 1e-13);
            let (factor, exponent) = law.stiffness_by_force();
            close(factor * force.powf(exponent), law.stiffness(d), 1e-13);
            // Indentation by the integral of dF / k: F / ((1 - n) k).
            close(d, force / ((1.0 - n) * law.stiffness(d)), 1e-13);
        }
    }
}

#[test]
fn a_third_is_hertz() {
    let contact = Scene::default().contact;
    let hertz = Law::hertz(&contact);
    let mut rough = contact;
    rough.stiffness_exponent = 1.0 / 3.0;
    // k_r = (6 E*^2 R F_r)^(1/3).
    let modulus = reduced_modulus(&contact);
    rough.stiffness = (6.0 * modulus * modulus * contact.curvature_radius * contact.stiffness_force).cbrt();
    let rough = Law::rough(&rough);
    close(rough.coefficient, hertz.coefficient, 1e-14);
    assert_eq!(rough.exponent, 1.5);
    // The general formulas beside those in square roots.
    let general = Law { exponent: 1.5 + 1e-15, ..hertz };
    for (a, b) in [(-1e-8, 5e-8), (0.0, 5e-8), (1e-8, 5e-8), (5e-8, 5.000_000_1e-8), (4e-8, 4e-8)] {
        close(general.mean_elastic_force(a, b), hertz.mean_elastic_force(a, b), 1e-13);
        close(general.mean_stiffness(a, b), hertz.mean_stiffness(a, b), 1e-13);
        close(general.energy_above_tangent(a, b - a), hertz.energy_above_tangent(a, b - a), 1e-13);
        close(general.energy_above_tangent(b, a - b), hertz.energy_above_tangent(b, a - b), 1e-13);
    }
    let (a, b) = (general.closed_branch(4e-8, -1e-4), hertz.closed_branch(4e-8, -1e-4));
    close(a.force, b.force, 1e-13);
    close(a.stiffness, b.stiffness, 1e-13);
    close(a.damping, b.damping, 1e-13);
}

#[test]
fn energy_and_divided_differences_are_integrals_of_the_force() {
    for (_, law) in laws() {
        let d0 = law.indentation(0.1);
        for (a, b) in [(-0.5, 0.7), (0.0, 1.0), (0.9, 1.0), (1.0, 1.3), (1.0, 2.5), (1.0, -1.0)] {
            let (a, b) = (a * d0, b * d0);
            // By Gauss-Legendre over the closed part, whose smooth powers 20 points integrate to rounding, but for
            // those that begin at zero.
            let closed = |f: &dyn Fn(f64) -> f64| {
                let (from, to) = (a.max(0.0), b.max(0.0));
                let (half, middle) = (0.5 * (to - from), f64::midpoint(from, to));
                gauss(20).map(|(x, w)| w * half * f(middle + half * x)).sum::<f64>()
            };
            let tolerance = if a <= 0.0 || b <= 0.0 { 1e-4 } else { 1e-12 };
            let force = |d: f64| law.elastic_force(d);
            close(law.mean_elastic_force(a, b), closed(&force) / (b - a), tolerance);
            close(law.mean_stiffness(a, b), (force(b) - force(a)) / (b - a), 1e-12);
            let above = closed(&force) - force(a) * (b - a);
            close(law.energy_above_tangent(a, b - a), above, tolerance.max(1e-11));
        }
        // Small deviations: k r^2 / 2.
        let deviation = 1e-7 * d0;
        let parabola = 0.5 * law.stiffness(d0) * deviation * deviation;
        close(law.energy_above_tangent(d0, deviation), parabola, 1e-5);
    }
}

/// A law from the whole range of a scene, its ends included.
fn any_law(rng: &mut Rng) -> Law {
    let mut contact = Scene::default().contact;
    let ends = [0.0, f64::MIN_POSITIVE, 1e-17, 1e-9, 1.0 / 3.0, 1.0 / 3.0 + 1e-12, 0.9];
    contact.stiffness_exponent = ends.get(rng.usize(..2 * ends.len())).copied().unwrap_or(0.9 * rng.f64());
    contact.stiffness = logarithmic(rng, 1.0, 1e10);
    contact.stiffness_force = logarithmic(rng, 1e-6, 1e3);
    contact.curvature_radius = logarithmic(rng, 1e-5, 10.0);
    contact.moving.youngs_modulus = logarithmic(rng, 1e8, 1e13);
    contact.damping = if rng.bool() { logarithmic(rng, 1e-9, 1.0) } else { 0.0 };
    if rng.bool() { Law::rough(&contact) } else { Law::hertz(&contact) }
}

fn logarithmic(rng: &mut Rng, least: f64, greatest: f64) -> f64 {
    least * (greatest / least).powf(rng.f64())
}

fn any_rate(rng: &mut Rng) -> f64 {
    [0.0, 1.0, -1.0][rng.usize(..3)] * logarithmic(rng, 1e-25, 1e4)
}

/// However small the indentation: down to the smallest number, whose reciprocal is infinite.
#[test]
fn every_indentation_has_a_force() {
    let rng = &mut Rng::with_seed(1);
    for _ in 0..20_000 {
        let (law, rate) = (any_law(rng), any_rate(rng));
        let least = [0.0, 5e-324, 1e-310, f64::MIN_POSITIVE];
        let d = least.get(rng.usize(..8)).copied().unwrap_or(logarithmic(rng, 1e-300, 1.0));
        let Branch { force, stiffness, damping } = law.closed_branch(d, rate);
        let case = format!("{law:?} at {d:e} with {rate:e}: {force} {stiffness} {damping}");
        assert!(force.is_finite() && stiffness.is_finite() && damping.is_finite(), "{case}");
        assert!(force * (d + law.exponent * law.damping * rate) >= 0.0 && damping >= 0.0, "{case}");
        let others = [law.force(d, rate), law.elastic_force(d), law.stiffness(d), law.mean_force(-d, d, rate)];
        assert!(others.iter().all(|value| (0.0..f64::INFINITY).contains(value)), "{case}: {others:?}");
    }
}

#[test]
fn force_stiffness_energy_and_resistance_agree_in_the_whole_range() {
    let rng = &mut Rng::with_seed(2);
    for _ in 0..20_000 {
        let (law, rate) = (any_law(rng), any_rate(rng));
        let force = logarithmic(rng, 1e-100, 1e6);
        let d = law.indentation(force);
        close(law.elastic_force(d), force, 1e-12);
        // The resistance of Barber goes by this one.
        let (factor, exponent) = law.stiffness_by_force();
        close(factor * force.powf(exponent), law.stiffness(d), 1e-11);
        let at = |d: f64| law.closed_branch(d, rate);
        let (branch, way) = (at(d), 1e-5 * d);
        let slope = (at(d + way).force - at(d - way).force) / (2.0 * way);
        assert!(
            (slope - branch.stiffness).abs() < 1e-7 * (branch.force.abs() / d + law.stiffness(d)),
            "{law:?} {d:e} {rate:e}"
        );
        // Force and stiffness grow with the indentation, and their means lie between.
        let a = d * [-logarithmic(rng, 1e-3, 1e3), 0.0, rng.f64(), 1.0 - logarithmic(rng, 1e-16, 1.0)][rng.usize(..4)];
        let (small, large) = (1.0 - 1e-12, 1.0 + 1e-12);
        let between = |mean: f64, of: &dyn Fn(f64) -> f64| mean >= small * of(a) && mean <= large * of(d);
        assert!(between(law.mean_elastic_force(a, d), &|d| law.elastic_force(d)), "{law:?} {a:e} {d:e}");
        assert!(between(law.mean_stiffness(a, d), &|d| law.stiffness(d)), "{law:?} {a:e} {d:e}");
        // The energies above both tangents add up to the rectangle of the differences.
        let energies = law.energy_above_tangent(a, d - a) + law.energy_above_tangent(d, a - d);
        let rectangle = (force - law.elastic_force(a)) * (d - a);
        assert!((energies - rectangle).abs() < 1e-9 * rectangle + 1e-14 * force * d, "{law:?} {a:e} {d:e}");
    }
}
