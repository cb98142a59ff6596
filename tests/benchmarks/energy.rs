//! Energy without damping: nothing takes any away, nothing may add to it.
//!
//! A contact force wrong by at most `e` along a path of length `s` of the tip changes the energy by at most `e s`.

use relay_contact::inputs::Inputs;
use relay_contact::reference::Model;
use relay_contact::variables::ContactLawKind;
use testing::rig::{Rig, undamped};

#[test]
fn energy_stays_without_damping() {
    for tolerance in [1e-3, 1e-6, 1e-9] {
        // From a swing that stays closed to blows that open the contact for most of the time.
        for speed in [1e-5, 1e-3, 0.1] {
            for law in [
                ContactLawKind::Hertz,
                ContactLawKind::Rough,
                ContactLawKind::Linearised,
                ContactLawKind::Bonded,
            ] {
                let mut scene = undamped();
                scene.effects.contact_law = law;
                scene.solver.tolerance = tolerance;
                scene.solver.modes = 6;
                let mut rig = Rig::new(Model::new(&scene, 0.0).unwrap());
                let velocities: Vec<f64> = rig
                    .model
                    .modes()
                    .iter()
                    .map(|mode| speed * mode.participation)
                    .collect();
                rig.launch(&velocities);
                let start = rig.energy();
                let (mut worst, mut path) = (0.0_f64, 0.0);
                for k in 1..=5000 {
                    let before = rig.state.contact().approach;
                    rig.run_to(&Inputs::default(), f64::from(k) * 2e-6).unwrap();
                    path += (rig.state.contact().approach - before).abs();
                    let excess =
                        (rig.energy() - start).abs() / (tolerance * rig.model.force_scale() * path + 1e-13 * start);
                    worst = worst.max(excess);
                }
                println!("tolerance {tolerance:e}, {law:?} at {speed} m/s: {worst:.1e} of the energy allowed");
                assert!(worst <= 1.0, "tolerance {tolerance:e}, {law:?} at {speed} m/s: {worst}");
            }
        }
    }
}
