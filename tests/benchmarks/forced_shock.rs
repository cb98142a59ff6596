//! code_aster SDND121: an oscillator under a sine that strikes a stiff stop (V5.01.121).
//!
//! m = 156 kg, k = 2e6 N/m, stop 1e10 N/m, gap 1 mm, force 3000 sin(2 pi 5 t) N, from rest. The instants were computed from
//! the closed form between switchings.

use super::digits;
use relay_contact::inputs::Inputs;
use testing::rig::{Rig, compose, oscillator, stop};

/// Touch and release, s: the first three contacts, and the last one within the first period.
const PUBLISHED: [(f64, f64); 4] = [
    (0.024_867_875_567, 0.025_260_517_928),
    (0.046_328_519_419, 0.046_722_721_425),
    (0.066_252_239_536, 0.066_645_834_145),
    (0.208_191_407_846, 0.208_581_390_739),
];

#[test]
fn touch_and_release() {
    let (mass, force) = (156.0, 3000.0);
    for tolerance in [1e-7, 1e-9, 1e-11] {
        let model = compose(&[oscillator(mass, 2e6)], stop(1e10), 1e-3, tolerance, force);
        let mut rig = Rig::shaken(model, force / mass, 5.0);
        let mut found: Vec<(f64, f64)> = Vec::new();
        for k in 1..=2100 {
            rig.run_to(&Inputs::default(), f64::from(k) * 1e-4).unwrap();
            let Some((touch, release)) = rig.state.contact().last_closing.zip(rig.state.contact().last_opening) else {
                continue;
            };
            if release > touch && found.last().is_none_or(|(last, _)| *last != touch) {
                found.push((touch, release));
            }
        }
        for (touch, release) in PUBLISHED {
            let nearest = |instant: f64| {
                let distance = |x: &(f64, f64)| (x.0 - instant).abs();
                *found.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap()
            };
            let (found_touch, found_release) = nearest(touch);
            // Displaced by the error allowed for all the time before, met at 0.2 m/s or more.
            let shift = 0.5 * tolerance * force * release * release / mass / 0.2;
            digits(found_touch, touch, 1e-12, shift);
            digits(found_release, release, 1e-12, shift);
        }
    }
}
