//! Extreme accelerations. Every [`Ride::shaken`] has jumps at communication points.

use anyhow::Result;
use relay_contact::scene::Scene;
use relay_contact::variables::ExcitationKind;

use crate::case::{Check, cases};
use crate::contact::with_damping;
use crate::energy_balance::balances;
use crate::ride::{Ride, Segment};

cases! { CASES:
    "Base acceleration of ±10 000 g", "free flight and impacts"
        => shaken_by_ten_thousand_g(8.063e-5);
    "Base acceleration of ±10 000 g, undamped contact", "free flight and impacts on a contact without dissipation"
        => shaken_by_ten_thousand_g(0.0);
    "Shock of 10⁶ m/s² (100 000 g), 0.1 ms", "forces up to 150 N, then free flight and impacts"
        => shock();
    "A jump of the base acceleration every 10 µs", "each jump excites every mode"
        => jumps();
}

fn shaken_by_ten_thousand_g(damping: f64) -> Result<Vec<Check>> {
    let wave = [98_066.5, -98_066.5, 98_066.5, 0.0];
    let segments = wave.map(|acceleration| Segment::accelerated(1e-4, acceleration));
    // Each blow of some newtons amplifies what the flight before it has left.
    Ride::new(with_damping(damping), segments).checks_of_large_forces()
}

fn shock() -> Result<Vec<Check>> {
    let mut scene = Scene::default();
    scene.effects.excitation = ExcitationKind::HalfSine;
    scene.excitation.amplitude = 1e6;
    scene.excitation.duration = 1e-4;
    balances(scene, 2e-3, |_| 0.0)
}

fn jumps() -> Result<Vec<Check>> {
    let jump = |k| Segment::accelerated(1e-5, if k % 3 == 0 { -2000.0 } else { 1000.0 });
    Ride::new(Scene::default(), (0..200).map(jump).collect::<Vec<_>>()).checks()
}
