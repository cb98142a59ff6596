//! Contact resistance as a function of contact force.
//!
//! Machines 2025, 13(1), 52, eqs. (28), (29): `R_c = H F^(-n)`. The film lies in series, the open resistance beside both:
//! `G = 1 / (R_c + R_film) + 1 / R_open`, the first term 0 where the force is. Arcs are outside the model.

use crate::scene::Resistance;

/// Conductance of the contact at the force (N), S; never 0.
pub fn conductance(resistance: &Resistance, force: f64) -> f64 {
    let closed = if force > 0.0 {
        1.0 / (resistance.coefficient * force.powf(-resistance.exponent) + resistance.film)
    } else {
        0.0
    };
    closed + 1.0 / resistance.open
}

/// Its derivative, S/N.
pub fn conductance_slope(resistance: &Resistance, force: f64) -> f64 {
    if force <= 0.0 {
        return 0.0;
    }
    let constriction = resistance.coefficient * force.powf(-resistance.exponent);
    let closed = 1.0 / (constriction + resistance.film);
    resistance.exponent * (constriction * closed) * (closed / force)
}
