//! A steel sphere falls on the middle of a simply supported steel beam.
//!
//! S. Timoshenko, Z. Math. Phys. 62 (1913) 198; W. Goldsmith, Impact (1960), section 4.4: beam 10 x 10 x 153.5 mm,
//! E = 215.8 GPa, rho = 7960 kg/m3, nu = 0.3, sphere of 10 mm radius at 10 mm/s. Digits computed from the equations: greatest force
//! 4.9777 N at 72.55 us, contact 156.39 us.

use std::f64::consts::PI;

use super::digits;
use relay_contact::inputs::Inputs;
use relay_contact::reference::Mode;
use testing::rig::{Rig, compose, hertz, oscillator};

#[test]
fn greatest_force_its_instant_and_the_duration() {
    let (width, length, modulus, density, poisson) = (0.01_f64, 0.1535, 215.8e9, 7960.0, 0.3);
    let (radius, speed, gap) = (0.01_f64, 0.01, 1e-6);
    let (bending, per_length) = (modulus * width.powi(4) / 12.0, density * width * width);
    // Only symmetric modes move the middle.
    let beam = (0..39_u8).map(|k| {
        let wave = f64::from(2 * k + 1) * PI / length;
        Mode {
            omega_squared: wave.powi(4) * bending / per_length,
            damping: 0.0,
            tip: (2.0 / (per_length * length)).sqrt(),
            participation: 0.0,
            ..Mode::default()
        }
    });
    let sphere = oscillator(density * 4.0 / 3.0 * PI * radius.powi(3), 0.0);
    let modes: Vec<Mode> = std::iter::once(sphere).chain(beam).collect();
    let coefficient = 4.0 / 3.0 * (modulus / (2.0 * (1.0 - poisson * poisson))) * radius.sqrt();

    let model = compose(&modes, hertz(coefficient, 0.0), gap, 1e-9, 5.0);
    let mut rig = Rig::new(model);
    rig.launch(&[-speed / sphere.tip]);
    let touch = gap / speed;
    let (mut greatest, mut instant) = (0.0, 0.0);
    for k in 0..4000 {
        let time = f64::from(k) * 5e-8;
        rig.run_to(&Inputs::default(), touch + time + 1e-9).unwrap();
        if rig.state.contact().force > greatest {
            (greatest, instant) = (rig.state.contact().force, rig.state.time - touch);
        }
    }
    digits(greatest, 4.9777, 1e-4, 1e-9 * 5.0);
    // Sampled every 50 ns.
    digits(instant, 72.55e-6, 1e-8, 2.5e-8);
    let (closing, opening) = rig.touch();
    digits(opening - closing, 156.39e-6, 1e-8, 0.0);
}
