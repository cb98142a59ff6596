//! The uniform section of the spring and the rivet at its tip.

use crate::scene::Scene;

/// See [`Section::is_taut`], in E I / L^2: a hundred times the quarter of the square of pi.
const TAUT: f64 = 247.0;

/// Stiffness and mass of the spring, and the rivet at its tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// Free length L, m.
    pub length: f64,
    /// Bending stiffness E I, N m2.
    pub bending_stiffness: f64,
    /// Mass per length rho A, kg/m.
    pub mass_per_length: f64,
    /// Mass of the rivet m, kg.
    pub tip_mass: f64,
    /// Rotary inertia of the rivet J, kg m2.
    pub tip_inertia: f64,
}

impl Section {
    /// Rectangular section of the scene.
    pub fn new(scene: &Scene) -> Self {
        let beam = &scene.beam;
        Self {
            length: beam.length,
            bending_stiffness: beam.youngs_modulus * beam.width * beam.thickness.powi(3) / 12.0,
            mass_per_length: beam.density * beam.width * beam.thickness,
            tip_mass: scene.tip.mass,
            tip_inertia: scene.tip.rotary_inertia,
        }
    }

    /// Half the mass (kg) and eight times the bending stiffness over the cubed length (N/m): the units of functions on [-1, 1].
    pub(super) fn halves(&self) -> (f64, f64) {
        (self.mass_per_length * self.length / 2.0, 8.0 * self.bending_stiffness / self.length.powi(3))
    }

    /// Rate of its bending waves, the root of E I / (rho A L^4), 1/s: 3.516 of it is the first angular frequency without rivet.
    pub fn rate(&self) -> f64 {
        (self.bending_stiffness / self.mass_per_length).sqrt() / (self.length * self.length)
    }

    /// Whether an axial compression (N) is a tension of more than a hundred buckling loads: it bends shapes so sharply at clamp and contact
    /// that it takes more functions to represent them.
    pub(super) fn is_taut(&self, axial_force: f64) -> bool {
        axial_force < -TAUT * self.bending_stiffness / self.length.powi(2)
    }

    /// Tip stiffness 3 E I / L^3 without axial force, N/m.
    pub fn tip_stiffness(&self) -> f64 {
        3.0 * self.bending_stiffness / self.length.powi(3)
    }
}
