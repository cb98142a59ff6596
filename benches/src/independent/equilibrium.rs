//! Contact law and static equilibrium of spring and contact, solved in the finite elements.

use nalgebra::DVector;
use relay_contact::scene::{Contact, Scene};
use relay_contact::variables::{AxialForceKind, ContactLawKind};

use super::elements::Cantilever;

/// The equilibrium before any vibration.
#[derive(Clone, Debug)]
pub struct Equilibrium {
    /// Factor `c` of the law `F = c d^p`, N/m^p.
    pub coefficient: f64,
    /// Its exponent `p`.
    pub exponent: f64,
    /// Contact force, N.
    pub force: f64,
    /// Indentation, m; negative: a gap.
    pub indentation: f64,
    /// Deflection of the tip, m.
    pub deflection: f64,
    /// Axial compression, N.
    pub axial_force: f64,
    /// All unknowns of the elements.
    pub at_rest: DVector<f64>,
}

impl Equilibrium {
    /// That of a scene; none if the spring buckles.
    pub fn new(scene: &Scene, cantilever: &Cantilever) -> Option<Self> {
        let (coefficient, exponent) = match scene.effects.contact_law {
            ContactLawKind::Rough => rough(&scene.contact),
            _ => (hertz(&scene.contact), 1.5),
        };
        let axial = |y: f64| match scene.effects.axial_force {
            AxialForceKind::None => 0.0,
            AxialForceKind::Prescribed => scene.beam.axial_force,
            AxialForceKind::FromPreload | AxialForceKind::FromDeflection => {
                cantilever.tip_stiffness() * y * (1.5 * y / cantilever.length).sin()
            }
        };
        let (gravity, overtravel) = (scene.environment.gravity, scene.contact.overtravel);
        let mut found = Self {
            coefficient,
            exponent,
            force: 0.0,
            indentation: 0.0,
            deflection: overtravel.max(0.0),
            axial_force: 0.0,
            at_rest: DVector::zeros(cantilever.load.len()),
        };
        // The axial force hardly changes with the indentation, so this converges in a few rounds.
        for round in 0..50 {
            let axial_force = axial(found.deflection);
            if round > 0 && axial_force == found.axial_force {
                break;
            }
            let (by_force, by_gravity) = cantilever.compliances(&cantilever.solver(axial_force)?);
            let compliance = by_force[cantilever.tip];
            let overlap = overtravel - by_gravity[cantilever.tip] * gravity;
            let indentation = indentation((coefficient, exponent), compliance, overlap);
            let force = coefficient * indentation.max(0.0).powf(exponent);
            found = Self {
                coefficient,
                exponent,
                force,
                indentation,
                deflection: overtravel - indentation,
                axial_force,
                at_rest: force * by_force + gravity * by_gravity,
            };
        }
        Some(found)
    }

    /// Tangent stiffness of the contact at a force (N), N/m.
    pub fn contact_stiffness(&self, force: f64) -> f64 {
        let p = self.exponent;
        p * self.coefficient.powf(1.0 / p) * force.powf(1.0 - 1.0 / p)
    }
}

/// `(4/3) E* sqrt(R)`.
fn hertz(contact: &Contact) -> f64 {
    let plane = [contact.moving, contact.fixed].map(|body| (1.0 - body.poisson_ratio.powi(2)) / body.youngs_modulus);
    4.0 / 3.0 / (plane[0] + plane[1]) * contact.curvature_radius.sqrt()
}

/// `F = F_r (d / d_r)^p` with `d_r = p F_r / k_r`.
fn rough(contact: &Contact) -> (f64, f64) {
    let p = 1.0 / (1.0 - contact.stiffness_exponent);
    let depth = p * contact.stiffness_force / contact.stiffness;
    (contact.stiffness_force * depth.powf(-p), p)
}

/// The root of `C c d^p + d = overlap`, `C` the compliance of the spring, by bisection down to neighbouring numbers; without overlap the gap.
fn indentation((coefficient, exponent): (f64, f64), compliance: f64, overlap: f64) -> f64 {
    if overlap <= 0.0 {
        return overlap;
    }
    let (mut low, mut high) = (0.0, overlap);
    loop {
        let middle = f64::midpoint(low, high);
        if middle <= low || middle >= high {
            return middle;
        }
        if compliance * coefficient * middle.powf(exponent) + middle > overlap {
            high = middle;
        } else {
            low = middle;
        }
    }
}
