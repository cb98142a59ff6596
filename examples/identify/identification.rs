//! Identification of the parameters of the specimen that are not published, from published results.
//!
//! Each step finds the root of one function of the library, without axial force, which is negligible by the publication's
//! own beam theory:
//!
//! 1. camber radius: the Hertz contact has the published tangent stiffness at the published static force;
//! 2. bending stiffness: the static equilibrium has the published force at the published overtravel;
//! 3. damping times: the published coefficient over 4 pi^2, see [`Published::damping`];
//! 4. mass per length: beam and contact spring have the published first frequency, for any rivet mass;
//! 5. rivet mass: the linear response has the published force amplitude, the mass per length following it.

use std::f64::consts::{PI, TAU};

use relay_contact::reference::{self, Model, Power, Preload, Section, Spring};
use relay_contact::scene::Scene;
use relay_contact::variables::AxialForceKind;

mod quantities;

pub use self::quantities::{PARAMETERS, SOURCES};

/// Reason why the parameters cannot be identified.
pub type Error = Box<dyn std::error::Error + Send + Sync>;

/// Base vibration of the published force amplitude, m/s2 (Table 3).
pub const ACCELERATION: f64 = 98.0;
/// Its frequency, Hz.
pub const FREQUENCY: f64 = 1000.0;

/// Values of [`SOURCES`], in their units.
#[derive(Clone, Copy, Debug)]
pub struct Published {
    /// In the order and units of [`SOURCES`].
    pub values: [f64; 5],
    /// Interpretation of the published force amplitude.
    pub amplitude: Amplitude,
}

/// Which force has the published amplitude.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Amplitude {
    /// The whole contact force.
    Whole,
    /// Its elastic part, without what the damping of the contact adds.
    Elastic,
}

impl Amplitude {
    /// Amplitude of this force in the linear response to the published acceleration at a frequency (Hz), cN.
    pub fn of(self, model: &Model, frequency: f64) -> f64 {
        let omega = TAU * frequency;
        let whole = 100.0 * ACCELERATION * reference::response(model, omega).force.norm();
        match self {
            Self::Whole => whole,
            Self::Elastic => whole / f64::hypot(1.0, omega * model.law().damping()),
        }
    }
}

/// Values of [`PARAMETERS`].
#[derive(Clone, Copy, Debug)]
pub struct Specimen {
    /// In the units of the table.
    pub values: [f64; 7],
}

impl Default for Published {
    fn default() -> Self {
        Self {
            values: SOURCES.map(|source| source.value),
            amplitude: Amplitude::Whole,
        }
    }
}

impl Published {
    /// One value changed by a fraction of it.
    #[must_use]
    pub fn changed(mut self, source: usize, part: f64) -> Self {
        self.values[source] *= 1.0 + part;
        self
    }

    /// Damping times of beam and contact, s. The published coefficient is used as if it belonged to frequencies in Hz: its
    /// own relation to the mass coefficient, alpha = 1610065 beta, has the square of 1268.9, near the first frequency in Hz.
    pub fn damping(&self) -> f64 {
        self.values[4] / (4.0 * PI * PI)
    }
}

impl Specimen {
    /// Those of a scene.
    pub fn of(scene: &Scene) -> Self {
        let section = Section::new(scene);
        let values = [
            scene.contact.curvature_radius,
            section.bending_stiffness,
            section.mass_per_length,
            scene.beam.width,
            scene.beam.thickness,
            scene.tip.mass,
            scene.beam.stiffness_damping,
        ];
        let mut scaled = values;
        for (value, parameter) in scaled.iter_mut().zip(PARAMETERS) {
            *value /= parameter.scale;
        }
        Self { values: scaled }
    }

    /// Those identified from published results. Published geometry and materials are in the start values.
    ///
    /// # Errors
    /// The step that has no solution.
    pub fn identify(published: &Published) -> Result<Self, Error> {
        scene(published).map(|scene| Self::of(&scene))
    }
}

/// The scene with the parameters identified from published results, without axial force.
///
/// # Errors
/// The step that has no solution.
pub fn scene(published: &Published) -> Result<Scene, Error> {
    let [force, stiffness, frequency, amplitude, _] = published.values;
    let mut scene = Scene::default();
    scene.effects.axial_force = AxialForceKind::None;

    let contact = |radius: f64| {
        let mut contact = scene.contact;
        contact.curvature_radius = radius;
        Power::hertz(&contact)
    };
    let excess = |radius: f64| {
        let hertz = contact(radius);
        hertz.tangent_stiffness(hertz.indentation(force)) - stiffness
    };
    scene.contact.curvature_radius =
        reference::bracketed(excess, 1e-3, 1.0).ok_or("no camber radius from 1 mm to 1 m")?;

    let excess = |bending: f64| {
        let scene = with_section(&scene, bending, 0.05);
        let hertz = Power::hertz(&scene.contact);
        Preload::new(&scene, &Spring::uniform(&Section::new(&scene)), &hertz, 0.0)
            .map_or(f64::NAN, |preload| preload.force - force)
    };
    let bending = reference::bracketed(excess, 1e-5, 1e-1).ok_or("no bending stiffness from 1e-5 to 1e-1 N m2")?;

    scene.beam.stiffness_damping = published.damping();
    scene.contact.damping = published.damping();

    let excess = |mass: f64| {
        let model = with_rivet(&scene, bending, mass, frequency).map(|scene| Model::new(&scene, 0.0));
        match model {
            Some(Ok(model)) => published.amplitude.of(&model, FREQUENCY) - amplitude,
            _ => f64::NAN,
        }
    };
    let mass = reference::bracketed(excess, 0.0, 200e-6).ok_or("no rivet mass up to 200 mg")?;
    with_rivet(&scene, bending, mass, frequency).ok_or_else(|| "no mass per length".into())
}

/// With the section that has a bending stiffness (N m2) and a mass per length (kg/m).
fn with_section(scene: &Scene, bending: f64, mass: f64) -> Scene {
    let mut scene = scene.clone();
    let beam = &mut scene.beam;
    beam.thickness = (12.0 * bending * beam.density / (beam.youngs_modulus * mass)).sqrt();
    beam.width = mass / (beam.density * beam.thickness);
    scene
}

/// With a rivet mass (kg), and the mass per length that gives the first frequency (Hz) with it.
fn with_rivet(scene: &Scene, bending: f64, mass: f64, frequency: f64) -> Option<Scene> {
    let mut scene = scene.clone();
    scene.tip.mass = mass;
    let excess = |per_length: f64| {
        let scene = with_section(&scene, bending, per_length);
        first_frequency(&scene).map_or(f64::NAN, |found| found - frequency)
    };
    let per_length = reference::bracketed(excess, 5e-3, 0.5)?;
    Some(with_section(&scene, bending, per_length))
}

/// Of beam and contact spring, Hz.
fn first_frequency(scene: &Scene) -> Option<f64> {
    let section = Section::new(scene);
    let preload = Preload::new(scene, &Spring::uniform(&section), &Power::hertz(&scene.contact), 0.0).ok()?;
    let found = reference::frequencies(&section, 0.0, preload.contact_stiffness, 1);
    found.first().map(|omega| omega / TAU)
}

/// Change of a published value for the derivatives, relative.
const STEP: f64 = 1e-3;

/// Change of each parameter with each published result: relative change per relative change, for small ones.
///
/// # Errors
/// A step that has no solution.
pub fn sensitivities() -> Result<Vec<[f64; 7]>, Error> {
    (0..SOURCES.len())
        .map(|source| {
            let part = change(source, STEP)?;
            Ok(part.map(|part| part / (2.0 * STEP)))
        })
        .collect()
}

/// Uncertainty of each parameter, +- %, due to the rounding of a published result to its last digit.
///
/// # Errors
/// A step that has no solution.
pub fn precision() -> Result<Vec<[f64; 7]>, Error> {
    let sources = SOURCES.iter().enumerate();
    sources
        .map(|(index, source)| {
            let part = change(index, 0.5 * source.digit / source.value)?;
            Ok(part.map(|part| 50.0 * part.abs()))
        })
        .collect()
}

/// Relative change of each parameter where a published result goes from a part below its value to a part above.
fn change(source: usize, part: f64) -> Result<[f64; 7], Error> {
    let above = Specimen::identify(&Published::default().changed(source, part))?;
    let below = Specimen::identify(&Published::default().changed(source, -part))?;
    let mut changes = above.values;
    for (change, below) in changes.iter_mut().zip(below.values) {
        *change = (*change / below).ln();
    }
    Ok(changes)
}
