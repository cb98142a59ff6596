//! The linear motion of the spring between clamp and contact, in closed form.
//! The displacement including the base, `W e^(i omega t)`, obeys `E I (1 + i omega beta) W'''' = rho A omega^2 W`
//! without mass damping and axial force. It is a sum of `cos, sin, cosh, sinh(g x)`, `g^4 = rho A omega^2 / (E I (1 +
//! i omega beta))`, with `W = W_0`, `W' = 0` at the clamp, and at the tip `W'' = 0`, `E I (1 + i omega beta) W''' = -m
//! omega^2 W + k (W - W_0)`, `k` the contact's stiffness with its damping. `W_0` is the displacement of the base.

use std::f64::consts::TAU;

use anyhow::{Context, Result};
use nalgebra::{Complex, Matrix4, Vector4};
use relay_contact::reference::Model;

use super::published::ACCELERATION;

/// Displacement including the base at a fraction of the spring's length, under the published vibration at a frequency (Hz),
/// m; the phase of the base acceleration is 0.
pub fn motion(model: &Model, frequency: f64, part: f64) -> Result<Complex<f64>> {
    let section = model.section();
    let omega = TAU * frequency;
    let real = |value: f64| Complex::new(value, 0.0);
    let damped = |value: f64, time: f64| Complex::new(value, omega * time * value);
    let base = real(-ACCELERATION / (omega * omega));
    let bending = damped(section.bending_stiffness, model.scene().beam.stiffness_damping);
    let contact = damped(model.preload().contact_stiffness, model.law().damping());
    let g = (real(section.mass_per_length * omega * omega) / bending).sqrt().sqrt();

    let z = g * section.length;
    let (cos, sin, cosh, sinh) = (z.cos(), z.sin(), z.cosh(), z.sinh());
    let shear = bending * g * g * g;
    let tip = contact - section.tip_mass * omega * omega;
    let (one, zero) = (real(1.0), real(0.0));
    #[rustfmt::skip]
    let conditions = Matrix4::new(
        one, zero, one, zero,
        zero, one, zero, one,
        -cos, -sin, cosh, sinh,
        shear * sin - tip * cos, -shear * cos - tip * sin, shear * sinh - tip * cosh, shear * cosh - tip * sinh,
    );
    let sides = Vector4::new(base, zero, zero, -contact * base);
    let factors = conditions
        .lu()
        .solve(&sides)
        .context("no steady motion of the spring")?;
    let at = z * part;
    Ok(factors.dot(&Vector4::new(at.cos(), at.sin(), at.cosh(), at.sinh())))
}

#[cfg(test)]
mod tests {
    use relay_contact::reference;

    use super::super::runs;
    use super::*;

    #[test]
    fn it_moves_with_the_base_at_the_clamp_and_with_the_contact_at_the_tip() {
        let model = runs::model(&runs::specimen(10.0)).unwrap();
        let base = runs::excitation(1000.0);
        assert!((motion(&model, 1000.0, 0.0).unwrap().norm() / base - 1.0).abs() < 1e-12);
        // The library has the tip from its modes, with the axial force of eq. 9, which is 3e-4 of the buckling load.
        let relative = ACCELERATION * reference::response(&model, TAU * 1000.0).displacement;
        let tip = (relative - base).norm();
        assert!((motion(&model, 1000.0, 1.0).unwrap().norm() / tip - 1.0).abs() < 1e-6);
    }
}
