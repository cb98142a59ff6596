//! A free mass hits a Hertzian contact: `m x'' = -k x^(3/2)` at the speed v.
//!
//! Closed form (K. L. Johnson, Contact Mechanics, 1985, section 11.4): greatest indentation `(5 m v^2 / (4 k))^0.4`, duration
//! 2.9432751843 times that over v.

use super::digits;
use relay_contact::inputs::Inputs;
use testing::rig::{Rig, compose, hertz, oscillator};

#[test]
fn greatest_force_and_duration() {
    let rest = Inputs::default();
    for tolerance in [1e-2, 1e-4, 1e-6, 1e-8, 1e-10] {
        // Units as in the formula, then a gram at 3 m/s on a contact like that of the specimen.
        for (mass, speed, coefficient, gap) in [(1.0_f64, 1.0_f64, 1.0, 1.0), (1e-3, 3.0, 9.3e9, 1e-4)] {
            let depth: f64 = (1.25 * mass * speed * speed / coefficient).powf(0.4);
            let force = coefficient * depth.powf(1.5);
            let duration = 2.943_275_184_3 * depth / speed;
            let allowed = tolerance * force;
            let touch = gap / speed;
            if mass == 1.0 {
                digits(force, 1.143_262_6, 1e-7, 0.0);
                digits(duration, 3.218_065_5, 1e-7, 0.0);
            }

            let model = compose(&[oscillator(mass, 0.0)], hertz(coefficient, 0.0), gap, tolerance, force);
            let mut rig = Rig::new(model);
            rig.launch(&[-speed * mass.sqrt()]);
            // The force is stationary at half the duration.
            rig.run_to(&rest, touch + 0.5 * duration).unwrap();
            digits(rig.state.contact().force, force, 0.0, allowed);
            rig.run_to(&rest, touch + 2.0 * duration).unwrap();
            let shift = 0.5 * allowed * duration * duration / (mass * speed);
            let rounding = 1e-10 * duration + 1e-14 * touch;
            let (closing, opening) = rig.touch();
            digits(closing, touch, 0.0, rounding);
            digits(opening - closing, duration, 0.0, shift + rounding);
            digits(rig.state.contact().rate, -speed, 0.0, allowed * duration / mass);
        }
    }
}
