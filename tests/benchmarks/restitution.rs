//! Coefficient of restitution with the dissipation of Kuwabara and Kono, `F = x^(3/2) + (3/2) A x^(1/2) x'`, which lets go
//! where F reaches zero.
//!
//! Series in A: Ramirez, Poeschel, Brilliantov, Schwager, Phys. Rev. E 60 (1999) 4465. The digits are for unit mass,
//! stiffness and speed, computed by a Runge-Kutta method with the square root of the indentation as unknown, in which
//! the equation is smooth.

use super::digits;
use relay_contact::inputs::Inputs;
use testing::rig::{Rig, compose, hertz, oscillator};

#[test]
fn restitution_at_release_without_tension() {
    for (damping, published) in
        [(0.001, 0.998_271_644_2), (0.01, 0.982_883_290_4), (0.1, 0.845_143_806_3), (0.3, 0.623_642_991_4)]
    {
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            let model = compose(&[oscillator(1.0, 0.0)], hertz(1.0, damping), 0.5, tolerance, 1.0);
            let mut rig = Rig::new(model);
            rig.launch(&[-1.0]);
            rig.run_to(&Inputs::default(), 20.0).unwrap();
            assert!(!rig.state.contact().closed);
            // The contact lasts less than 4 s.
            digits(-rig.state.contact().rate, published, 1e-10, 4.0 * tolerance);
        }
    }
}
