//! Exact natural frequencies of the continuum: the beam of Machines 2025, 13(1), 52, eqs. (2) to (6) and (10) to (11),
//! with rivet mass and rotary inertia, an elastic support at the tip, and axial force.
//!
//! With `w = W(x) e^(i omega t)` the equation `E I W'''' + N W'' = rho A omega^2 W` has the solutions
//! `sin, cos(s1 x)` and `sinh, cosh(s2 x)`, `s1^2, s2^2 = +-N/(2EI) + sqrt((N/(2EI))^2 + rho A omega^2/(EI))`. Those
//! that vanish with their slope at the clamp are `U = cos(s1 x) - cosh(s2 x)` and `V = s2 sin(s1 x) - s1 sinh(s2 x)`.
//! At the tip `E I W'' - J omega^2 W' = 0` and `E I W''' + N W' + (m omega^2 - k) W = 0`; a frequency is a zero of the
//! determinant of these two conditions. (The paper's printed eq. (12) cannot be used: signs and operators are lost.)

use crate::beam::section::Section;
use crate::math::roots;

/// Step in `z = L (rho A omega^2 / (E I))^(1/4)` of the search for sign changes. Neighbouring roots lie about pi apart,
/// except where rivet and support bring two close together; this step separates those too.
const STEP: f64 = 0.01;

/// The first `count` angular frequencies (rad/s), ascending, of the section under the axial compression (N) with an
/// elastic support of `stiffness` (N/m) at the tip.
pub fn frequencies(section: &Section, axial_force: f64, stiffness: f64, count: usize) -> Vec<f64> {
    let scale = section.rate();
    let determinant = |z: f64| determinant(section, axial_force, stiffness, z * z * scale);
    let mut found = Vec::with_capacity(count);
    let mut below = (1e-3, determinant(1e-3));
    let mut k = 0;
    while found.len() < count && k < 1_000_000 {
        k += 1;
        let z = 1e-3 + STEP * f64::from(k);
        let above = (z, determinant(z));
        if (below.1 > 0.0) != (above.1 > 0.0) {
            found.extend(roots::bracketed(determinant, below.0, above.0).map(|z| z * z * scale));
        }
        below = above;
    }
    found
}

/// The determinant of the conditions at the tip, divided by `e^(s2 L)` and made dimensionless.
fn determinant(section: &Section, axial_force: f64, stiffness: f64, omega: f64) -> f64 {
    let Section { length, bending_stiffness, mass_per_length, tip_mass, tip_inertia } = *section;
    let nu = axial_force * length * length / bending_stiffness;
    let z4 = mass_per_length * omega * omega * length.powi(4) / bending_stiffness;
    let root = (nu * nu / 4.0 + z4).sqrt();
    // s1 and s2 times L; the smaller square without cancellation.
    let (s1, s2) = if nu >= 0.0 {
        let larger = nu / 2.0 + root;
        (larger.sqrt(), (z4 / larger).sqrt())
    } else {
        let larger = root - nu / 2.0;
        ((z4 / larger).sqrt(), larger.sqrt())
    };
    let inertia = tip_inertia * omega * omega * length / bending_stiffness;
    let support = (tip_mass * omega * omega - stiffness) * length.powi(3) / bending_stiffness;
    let decay = (-s2).exp();
    let (sin, cos) = s1.sin_cos();
    // sin, cos, sinh, cosh, all divided by e^(s2 L).
    let (faded_sin, faded_cos) = (sin * decay, cos * decay);
    let (sinh, cosh) = ((1.0 - decay * decay) / 2.0, f64::midpoint(1.0, decay * decay));
    // [W, W', W'', W'''] at the tip, in units of L, of U and of V - s1 U: what grows like e^(s2 x) is in U alone, else the two would
    // be the same to rounding under a large tension.
    let u = [
        faded_cos - cosh,
        -s1 * faded_sin - s2 * sinh,
        -s1 * s1 * faded_cos - s2 * s2 * cosh,
        s1.powi(3) * faded_sin - s2.powi(3) * sinh,
    ];
    let v = [
        s2 * sin - s1 * (cos - decay),
        s1 * (s2 * (cos - decay) + s1 * sin),
        s1 * (s2 * s2 * decay - s1 * (s2 * sin - s1 * cos)),
        -s1 * (s2.powi(3) * decay + s1 * s1 * (s2 * cos + s1 * sin)),
    ];
    let moment = |w: [f64; 4]| w[2] - inertia * w[1];
    let shear = |w: [f64; 4]| w[3] + nu * w[1] + support * w[0];
    moment(u) * shear(v) - moment(v) * shear(u)
}
