//! The random acceleration: its power, its spectrum, its seed.

use std::f64::consts::{PI, TAU};
use testing::close;
use testing::scenes::largest_difference;

use super::{Generator, random, with};

#[test]
fn random_acceleration_has_the_power_asked_for() {
    let (low, high, density) = (20.0, 2000.0, 3.0);
    let generator = Generator::new(&random(0.0, low, high, density));
    let (rate, count) = (10_007.0, 100_000_u32);
    let time = f64::from(count) / rate;
    let power = (0..count).map(|k| generator.acceleration(f64::from(k) / rate).powi(2)).sum::<f64>() / f64::from(count);
    let expected = density * (high - low);
    // Noise of this bandwidth scatters by 1 / sqrt(B T); four times that.
    close("power, (m/s2)^2", power, expected, 4.0 / ((high - low) * time).sqrt());
}

#[test]
fn random_acceleration_has_a_flat_spectrum_and_nothing_outside_its_band() {
    let (low, high, density) = (500.0, 2000.0, 3.0);
    let (rate, count) = (8000.0, 400_u32);
    let seeds = 200;
    let frequencies = [100.0, 250.0, 600.0, 800.0, 1000.0, 1250.0, 1500.0, 1900.0, 2300.0, 3000.0];
    let window = |k: u32| (PI * (f64::from(k) + 0.5) / f64::from(count)).sin().powi(2);
    let squares: f64 = (0..count).map(|k| window(k).powi(2)).sum();
    let mut spectrum = [0.0; 10];
    for seed in 0..seeds {
        let generator = Generator::new(&with(random(0.0, low, high, density), |noise| noise.seed = seed));
        let course: Vec<f64> =
            (0..count).map(|k| window(k) * generator.acceleration(1.7 + f64::from(k) / rate)).collect();
        for (power, frequency) in spectrum.iter_mut().zip(frequencies) {
            let (mut re, mut im) = (0.0, 0.0);
            for (k, a) in course.iter().enumerate() {
                let (sin, cos) = (TAU * frequency * k as f64 / rate).sin_cos();
                re += a * cos;
                im += a * sin;
            }
            *power += 2.0 * (re * re + im * im) / (rate * squares) / f64::from(seeds);
        }
    }
    let mut inside = Vec::new();
    for (power, frequency) in spectrum.into_iter().zip(frequencies) {
        if (low..high).contains(&frequency) {
            // A periodogram scatters as much as it is; four times that over the root of how many there are.
            close(format_args!("{frequency} Hz"), power, density, 4.0 / f64::from(seeds).sqrt());
            inside.push(power / density);
        } else {
            // Twelve and more lines of the window away, where it falls with the third power.
            assert!(power < 1e-5 * density, "{frequency} Hz: {power}");
        }
    }
    let mean = inside.iter().sum::<f64>() / inside.len() as f64;
    assert!((mean - 1.0).abs() < 4.0 / (f64::from(seeds) * inside.len() as f64).sqrt(), "{mean}");
}

#[test]
fn a_seed_chooses_the_course() {
    let course = |seed: i32| -> Vec<f64> {
        let generator = Generator::new(&with(random(1e-4, 20.0, 2000.0, 2.0), |noise| noise.seed = seed));
        (0..20).map(|k| generator.acceleration(2e-4 * f64::from(k))).collect()
    };
    let (first, again, other) = (course(7), course(7), course(8));
    assert_eq!(first, again);
    let difference = largest_difference(&first, &other);
    assert!(difference > 30.0, "{difference}");
}
