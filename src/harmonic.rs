//! Frequency domain: the linear response about the preload, by modal superposition.
//!
//! Machines 2025, 13(1), 52, eqs. (16) to (25). In the modes of the cantilever without contact
//! `(omega_i^2 - omega^2 + i omega c_i) q_i = T_i F - g_i a` with `c_i = alpha + beta omega_i^2`, and the contact acts as
//! `F = -(k_j + i omega beta_c k_j) sum T_i q_i`.

use nalgebra::Complex;

use crate::model::Model;

/// Complex amplitude of the contact force per base acceleration, N per m/s2, at the angular frequency `omega` (rad/s).
pub fn force_response(model: &Model, omega: f64) -> Complex<f64> {
    let stiffness = model.preload.contact_stiffness;
    let contact = Complex::new(stiffness, omega * model.law.damping() * stiffness);
    let (compliance, forcing) = model.modes.iter().fold(
        (Complex::new(0.0, 0.0), Complex::new(0.0, 0.0)),
        |(compliance, forcing), mode| {
            let dynamic = 1.0 / Complex::new(mode.omega_squared - omega * omega, omega * mode.damping);
            (
                compliance + dynamic * mode.tip * mode.tip,
                forcing + dynamic * mode.tip * mode.participation,
            )
        },
    );
    contact * forcing / (contact * compliance + 1.0)
}
