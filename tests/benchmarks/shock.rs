//! code_aster SDND101: an oscillator thrown against a stop (V5.01.101).
//!
//! m = 100 kg, k = 1e4 N/m, stop 1e6 N/m, v = 1 m/s, gap 0. On the stop it is a faster oscillator,
//! `omega^2 = (1e4 + 1e6) / 100`: contact `pi / omega` = 31.2600 ms, force `1e6 v / omega` = 9950.3719 N, impulse
//! `2e6 v / omega^2` = 198.0198 N s.

use super::digits;
use relay_contact::inputs::Inputs;
use testing::rig::{Rig, compose, oscillator, stop};

/// The oscillator at 1 m/s, `gap` (m) in front of the stop.
fn thrown(gap: f64, tolerance: f64) -> Rig {
    let mut rig = Rig::new(compose(&[oscillator(100.0, 1e4)], stop(1e6), gap, tolerance, SCALE));
    rig.launch(&[-10.0]);
    rig
}

/// What the tolerance is relative to, N.
const SCALE: f64 = 1e4;

#[test]
fn duration_force_and_impulse_of_the_shock() {
    let rest = Inputs::default();
    // A gap of 1e-10 m changes no digit, its spring force being 1e-6 N.
    let gap = 1e-10;
    for tolerance in [1e-3, 1e-6, 1e-9] {
        let allowed = tolerance * SCALE;
        let mut rig = thrown(gap, tolerance);
        rig.run_to(&rest, 0.1).unwrap();
        let (touch, opening) = rig.touch();
        let duration = opening - touch;
        digits(touch, gap, 1e-12, 0.0);
        digits(duration, 31.2600e-3, 1e-7, 0.5 * allowed * 0.0313 * 0.0313 / 100.0);

        // The force is smooth between touch and release and zero at both: Simpson's rule takes its impulse.
        let mut rig = thrown(gap, tolerance);
        let mut impulse = 0.0;
        let parts = 400_u32;
        for k in 1..parts {
            rig.run_to(&rest, touch + duration * f64::from(k) / f64::from(parts)).unwrap();
            let weight = if k % 2 == 1 { 4.0 } else { 2.0 } / 3.0;
            impulse += weight * duration / f64::from(parts) * rig.state.contact().force;
            if 2 * k == parts {
                // The middle, where the force is greatest.
                digits(rig.state.contact().force, 9950.3719, 1e-4, allowed);
            }
        }
        digits(impulse, 198.0198, 1e-4, allowed * duration);
    }
}

/// With no gap the surfaces touch at the start, without overlap.
#[test]
fn a_mass_thrown_from_touch_returns_at_the_published_instant() {
    let mut rig = thrown(0.0, 1e-6);
    rig.run_to(&Inputs::default(), 0.1).unwrap();
    let (closing, opening) = rig.touch();
    digits(closing, 0.0, 1e-12, 0.0);
    digits(opening, 31.2600e-3, 1e-7, 0.0);
}
