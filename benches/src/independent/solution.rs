//! The motion of the finite elements, by the C program `sundials/beam.c`.

use std::fmt::Write as _;

use nalgebra::DMatrix;
use relay_contact::scene::Scene;
use relay_contact::variables::{AxialForceKind, ContactLawKind, ExcitationKind};
use testing::relays::{Course, Relay};

use super::elements::{BAND, Cantilever};
use super::equilibrium::Equilibrium;
use crate::c_program::Program;
use crate::integrator::Failure;

/// Processor time that a run may take, s.
const BUDGET: f64 = 200.0;

/// How finely a relay is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolution {
    /// Number of elements.
    pub elements: usize,
    /// Local error of the contact force in a step, relative to the force scale.
    pub tolerance: f64,
}

/// Solves relays by finite elements.
pub struct Solver {
    program: Program,
}

impl Solver {
    /// Compiles the program.
    pub fn new() -> Self {
        Self {
            program: Program::new("beam", &["arkode", "sunmatrixband", "sunlinsolband"]),
        }
    }

    /// Contact force at the communication points and its greatest between them; no least.
    ///
    /// # Errors
    /// A [`Failure`] if the relay is refused or the program fails.
    pub fn solve(&self, relay: &Relay, resolution: Resolution) -> Result<Course, Failure> {
        let (question, scale) = question(relay, resolution)?;
        let answer = self.program.ask(&question)?;
        Ok(Course {
            contacts: 1,
            force: answer.numbers("forces")?,
            greatest: answer.numbers("greatest")?,
            events: answer.numbers("events")?,
            scale,
            ..Course::default()
        })
    }
}

impl Default for Solver {
    fn default() -> Self {
        Self::new()
    }
}

/// The relay as the C program reads it, and its force scale, N.
fn question(relay: &Relay, resolution: Resolution) -> Result<(String, f64), Failure> {
    let scene = &relay.scene;
    let refused = |why: &str| Failure::Stopped(why.to_owned());
    let cantilever = Cantilever::new(scene, resolution.elements);
    let rest = Equilibrium::new(scene, &cantilever).ok_or_else(|| refused("the spring buckles"))?;
    let damping = if scene.effects.contact_damping {
        scene.contact.damping
    } else {
        0.0
    };
    let stiffness = rest.contact_stiffness(rest.force);
    let law = match scene.effects.contact_law {
        ContactLawKind::Hertz | ContactLawKind::Rough => [0.0, rest.coefficient, damping, rest.exponent],
        ContactLawKind::Linearised => [1.0, stiffness, damping, rest.indentation - rest.force / stiffness],
        ContactLawKind::Bonded => return Err(refused("a bonded contact does not open")),
    };
    let excitation = &scene.excitation;
    let generator = match scene.effects.excitation {
        ExcitationKind::None => 0.0,
        ExcitationKind::Sine => 1.0,
        ExcitationKind::LogSweep => 2.0,
        ExcitationKind::HalfSine => 3.0,
        ExcitationKind::Random => return Err(refused("no random excitation without the component's code")),
    };
    let axial_stiffness = match scene.effects.axial_force {
        AxialForceKind::FromDeflection => cantilever.tip_stiffness(),
        _ => 0.0,
    };
    let scale = rest
        .force
        .max(cantilever.tip_stiffness() * scene.contact.overtravel.abs().max(1e-4));

    let mut text = format!("{} {BAND} {}\n", cantilever.load.len(), cantilever.tip);
    for matrix in [
        &cantilever.mass,
        &cantilever.stiffness(rest.axial_force),
        &cantilever.geometric,
    ] {
        write_band(&mut text, matrix);
    }
    let mut line = |numbers: &[f64]| write_numbers(&mut text, numbers.iter().copied());
    line(cantilever.load.as_slice());
    line(rest.at_rest.as_slice());
    line(&[scene.beam.mass_damping, scene.beam.stiffness_damping]);
    line(&[axial_stiffness, cantilever.length, rest.deflection, rest.axial_force]);
    line(&law);
    line(&[rest.force, rest.indentation]);
    line(&[generator, excitation.amplitude, excitation.frequency, excitation.phase]);
    line(&[excitation.end_frequency, excitation.duration]);
    line(&[relay.shake.0, relay.shake.1, relay.travel.0, relay.travel.1]);
    line(&[relay.steps.0, f64::from(relay.steps.1)]);
    let (displacement, velocity) = tolerances(scene, &rest, damping, scale);
    line(&[
        scale,
        resolution.tolerance * displacement,
        resolution.tolerance * velocity,
        BUDGET,
    ]);
    Ok((text, scale))
}

/// The displacement (m) and velocity (m/s) of the tip that change the contact force by the force scale: the velocity by the
/// contact's damping, or by the displacement that follows when the spring rings on the contact.
fn tolerances(scene: &Scene, rest: &Equilibrium, damping: f64, scale: f64) -> (f64, f64) {
    let stiffness = rest.contact_stiffness(scale);
    let beam = &scene.beam;
    let mass = scene.tip.mass + 0.25 * beam.density * beam.width * beam.thickness * beam.length;
    let displacement = scale / stiffness;
    (
        displacement,
        displacement * (stiffness / mass).sqrt().min(1.0 / damping),
    )
}

/// The upper half of a band matrix, row by row.
fn write_band(text: &mut String, matrix: &DMatrix<f64>) {
    for i in 0..matrix.nrows() {
        write_numbers(text, (i..matrix.ncols().min(i + BAND + 1)).map(|j| matrix[(i, j)]));
    }
}

fn write_numbers(text: &mut String, numbers: impl Iterator<Item = f64>) {
    for number in numbers {
        let _ = write!(text, "{number:e} ");
    }
    text.push('\n');
}

/// Damping of the first mode of the free cantilever, relative to critical.
pub fn damping_ratio(scene: &Scene) -> Option<f64> {
    let omega = Cantilever::new(scene, 4).lowest_frequency()?;
    Some(0.5 * (scene.beam.mass_damping / omega + scene.beam.stiffness_damping * omega))
}
