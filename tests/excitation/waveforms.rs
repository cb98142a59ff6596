//! The accelerations themselves, against limits of their closed forms and the standards.

use std::f64::consts::TAU;

use relay_contact::variables::ExcitationKind;

use super::{G, Generator, excited, half_sine, sweep, with};

#[test]
fn a_sweep_between_like_frequencies_is_the_sine() {
    let sine = Generator::new(&excited(ExcitationKind::Sine, 0.0, |sine| sine.phase = 0.3));
    // Turns that the sweep is ahead: f tau (r - 1) tau / 2 D.
    for (end_frequency, part) in
        [(1000.0, 0.0), (1000.0 + 2e-12, 2e-15), (1000.0 + 1e-9, 1e-12), (1000.0 - 1e-9, -1e-12)]
    {
        let near = Generator::new(&with(sweep(0.0, 1000.0, end_frequency, 1e9), |sweep| sweep.phase = 0.3));
        for tau in [0.0, 1e-4, 0.77, 1234.567, 1e6, 3.3e8 + 0.125] {
            let ahead = TAU * 1000.0 * tau * part * tau / 2e9;
            let difference = (near.acceleration(tau) - sine.acceleration(tau)).abs();
            // The end frequency is rounded to its spacing, 1e-13 Hz, and what is ahead is within a few parts of it.
            let allowed = 98.0 * (1.1 * ahead.abs() + TAU * tau * 1e-13 * tau / 1e9 + 1e-12);
            assert!(difference <= allowed, "{end_frequency} {tau}: {difference} {allowed}");
        }
    }
}

#[test]
fn the_displacement_limit_crosses_over_where_the_standard_does() {
    // MIL-STD-202 method 204 condition A: the lesser of 0.06 in double amplitude and 10 g crosses over at 57.10 Hz.
    let limit = 0.5 * 0.06 * 0.0254;
    let scene = with(sweep(0.0, 10.0, 500.0, 450.0), |sweep| {
        (sweep.amplitude, sweep.displacement_limit) = (10.0 * G, limit);
    });
    let crossover = Generator::new(&scene).next_break(0.0).unwrap();
    let frequency = 10.0 * 50_f64.powf(crossover / 450.0);
    assert!((frequency - 57.10).abs() < 0.005, "{frequency}");
    // Up to there the displacement amplitude is the limit, from there on the acceleration is the amplitude.
    let generator = Generator::new(&scene);
    for (time, expected) in [(20.0, None), (crossover - 2.0, None), (crossover + 2.0, Some(10.0 * G))] {
        let frequency = 10.0 * 50_f64.powf(time / 450.0);
        let course = (0..2000).map(|k| generator.acceleration(time + f64::from(k) * 1e-3 / frequency));
        let found = course.fold(0.0_f64, |largest, a| largest.max(a.abs()));
        let expected = expected.unwrap_or((TAU * frequency).powi(2) * limit);
        // Over two periods the frequency grows by 2 ln(50) / (450 f), the amplitude with its square at the most; the
        // largest is at most half a thousandth of a period from an instant looked at.
        let allowed = 4.0 * 50_f64.ln() / (450.0 * frequency) + 0.5 * (TAU * 5e-4).powi(2);
        assert!((found / expected - 1.0).abs() < allowed, "{time} s: {found} {expected}");
    }
}

#[test]
fn a_shock_changes_the_velocity_as_the_standard_says() {
    // MIL-STD-202 method 213 condition A: 50 g, 11 ms, half sine, to which nothing else applies.
    let scene = with(half_sine(0.02, 50.0 * G, 0.011), |shock| {
        (shock.phase, shock.displacement_limit, shock.rise_time) = (1.0, 1e-6, 1e-3);
    });
    let generator = Generator::new(&scene);
    let size = 1e-6;
    let change: f64 = (0..50_000).map(|k| size * generator.acceleration(size * (f64::from(k) + 0.5))).sum();
    assert!((change - 3.434).abs() < 5e-4, "{change}");
    assert_eq!((generator.next_break(0.0), generator.next_break(0.02)), (Some(0.02), Some(0.031)));
    assert_eq!(generator.next_break(0.031), None);
}
