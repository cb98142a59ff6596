//! Frequency domain: the linear response about the preload to a harmonic base acceleration, by modal superposition.
//!
//! Machines 2025, 13(1), 52, eqs. (16) to (25). The deflection is a sum of mode shapes with amplitudes `q_i` (eq. 16)
//! that are normalised to the mass (eqs. 17 to 19). Beam damping `C = alpha M + beta K` leaves them uncoupled (eqs. 20
//! to 24), with `c_i = alpha + beta omega_i^2 = 2 xi_i omega_i` (eqs. 22, 23), and under loads `r_i` of angular
//! frequency `omega` (eq. 25)
//!
//! `(omega_i^2 - omega^2 + i omega c_i) q_i = r_i`.
//!
//! The modes are those of the cantilever without contact; the contact, linearised at the preload, loads them as an
//! external force: `r_i = T_i F - g_i a`, `F = -(k_j + i omega beta_c k_j) sum T_i q_i`. One scalar equation for `F`
//! remains. With `beta_c = beta` and `alpha = 0` this equals the publication's superposition of the modes of beam and
//! contact spring; here `beta_c` may differ from `beta`, which would couple those modes. Mass damping acts on the beam
//! only: the contact has no mass.
//!
//! Amplitudes are complex, `x(t) = Re(x exp(i omega t))`, and per base acceleration.

use nalgebra::Complex;

use crate::model::Model;

/// The contact force about the preload force at the angular frequency `omega` (rad/s), N per m/s2, with the contact held closed. If it
/// is open at rest, the contact force is 0.
///
/// It is infinite or not a number at a resonance without damping.
pub fn response(model: &Model, omega: f64) -> Complex<f64> {
    let stiffness = model.preload.contact_stiffness;
    let contact = Complex::new(stiffness, omega * model.law.damping * stiffness);
    let zero = Complex::new(0.0, 0.0);
    // Displacement of the tip per force on it, and per base acceleration.
    let (compliance, shaken) = model.modes.iter().fold((zero, zero), |(compliance, shaken), mode| {
        let dynamic = 1.0 / Complex::new(mode.omega_squared - omega * omega, omega * mode.damping);
        (compliance + dynamic * mode.tip * mode.tip, shaken - dynamic * mode.tip * mode.participation)
    });
    -contact * shaken / (contact * compliance + 1.0)
}

/// Base acceleration (m/s2) whose linear response at the angular frequency `omega` (rad/s) has an amplitude of the
/// contact force as large as the preload force: the contact is about to open.
pub fn opening_threshold(model: &Model, omega: f64) -> f64 {
    model.preload.force / response(model, omega).norm()
}
