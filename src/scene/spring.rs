//! A spring other than the uniform section: by its segments and masses, or by its modes. What a spring file holds.

use serde::{Deserialize, Serialize};

use crate::error::SceneError;

/// The spring of a file, checked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpringFile {
    /// The file as it was named.
    pub name: String,
    /// What it describes.
    pub shape: Shape,
}

/// A spring, SI units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Shape {
    /// By what it is made of.
    Segments(Segments),
    /// By how it moves.
    Modes(Modes),
}

/// A spring by its geometry.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Segments {
    /// From the clamp on.
    pub segments: Vec<Segment>,
    /// What it carries beside the mass at the contact.
    pub masses: Vec<PointMass>,
    /// Distance of the contact from the clamp, m; the end without one.
    pub contact_position: Option<f64>,
    /// Distance from the clamp at which the spring forks into two equal tongues, m, each with half the width and half of each
    /// mass; both contacts sit at one end without one.
    pub fork_position: Option<f64>,
    /// Stiffness of the clamp against rotation, N m/rad; rigid without one.
    pub clamp_stiffness: Option<f64>,
}

/// A stretch whose width and thickness are constant or change linearly.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Segment {
    /// Length, m.
    pub length: f64,
    /// Width at start and end, m.
    pub width: [f64; 2],
    /// Thickness at start and end, m.
    pub thickness: [f64; 2],
    /// Young's modulus, Pa; that of the scene without one.
    pub youngs_modulus: Option<f64>,
    /// Density, kg/m3; that of the scene without one.
    pub density: Option<f64>,
}

/// A mass on the spring.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PointMass {
    /// Distance from the clamp, m.
    pub position: f64,
    /// Mass, kg.
    pub mass: f64,
    /// Rotary inertia, kg m2.
    pub rotary_inertia: f64,
}

/// A spring by the modes of the free spring: contact open, all that rides on it included.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Modes {
    /// Static deflection of the contact point per force there, m/N.
    pub compliance: f64,
    /// The same of a parallel contact; that of the contact without it.
    pub parallel_compliance: Option<f64>,
    /// In any order.
    pub modes: Vec<GivenMode>,
}

/// A mode, normalised to a modal mass of 1 kg.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GivenMode {
    /// Frequency, Hz.
    pub frequency: f64,
    /// Displacement of the contact point, 1/sqrt(kg).
    pub contact: f64,
    /// Load per base acceleration, sqrt(kg).
    pub participation: f64,
    /// Share of critical damping, 1; that of the scene without one.
    pub damping: Option<f64>,
    /// Rotation at the contact, 1/(m sqrt(kg)).
    pub rotation: Option<f64>,
    /// Displacement where the pusher touches, 1/sqrt(kg).
    pub pusher: Option<f64>,
    /// Displacement of a parallel contact, 1/sqrt(kg).
    pub parallel: Option<f64>,
}

/// A key of a spring file that holds a number: its unit and range.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Field {
    pub(crate) name: &'static str,
    unit: &'static str,
    min: f64,
    max: f64,
}

const fn field(name: &'static str, unit: &'static str, min: f64, max: f64) -> Field {
    Field { name, unit, min, max }
}

pub(crate) const LENGTH: Field = field("length", "m", 1e-6, 0.2);
pub(crate) const WIDTH: [Field; 3] = ends(["width", "width_start", "width_end"], 1e-5, 1.0);
pub(crate) const THICKNESS: [Field; 3] = ends(["thickness", "thickness_start", "thickness_end"], 1e-6, 5e-3);
pub(crate) const YOUNGS_MODULUS: Field = field("youngs_modulus", "Pa", 1e8, 1e13);
pub(crate) const DENSITY: Field = field("density", "kg/m3", 1.0, 1e5);
pub(crate) const POSITION: Field = field("position", "m", 1e-6, LONGEST);
pub(crate) const MASS: Field = field("mass", "kg", 0.0, 0.1);
pub(crate) const ROTARY_INERTIA: Field = field("rotary_inertia", "kg.m2", 0.0, 1e-4);
const TOTAL: Field = field("length of all segments", "m", SHORTEST, LONGEST);
pub(crate) const CONTACT_POSITION: Field = field("contact_position", "m", SHORTEST, LONGEST);
pub(crate) const FORK_POSITION: Field = field("fork_position", "m", 0.0, LONGEST);
pub(crate) const CLAMP_STIFFNESS: Field = field("clamp_stiffness", "N.m/rad", 1e-9, 1e9);
pub(crate) const COMPLIANCE: Field = field("compliance", "m/N", 1e-9, 1e6);
pub(crate) const PARALLEL_COMPLIANCE: Field = field("parallel_compliance", "m/N", 1e-9, 1e6);
pub(crate) const FREQUENCY: Field = field("frequency", "Hz", 1e-3, 1e9);
pub(crate) const CONTACT: Field = field("contact", "1/sqrt(kg)", -1e9, 1e9);
pub(crate) const PARTICIPATION: Field = field("participation", "sqrt(kg)", -1.0, 1.0);
pub(crate) const DAMPING: Field = field("damping", "1", 0.0, 100.0);
pub(crate) const PUSHER: Field = field("pusher", "1/sqrt(kg)", -1e9, 1e9);
pub(crate) const PARALLEL: Field = field("parallel", "1/sqrt(kg)", -1e9, 1e9);
pub(crate) const ROTATION: Field = field("rotation", "1/(m sqrt(kg))", -1e12, 1e12);

/// The value itself, that at the start, that at the end.
const fn ends(names: [&'static str; 3], min: f64, max: f64) -> [Field; 3] {
    let [whole, start, end] = names;
    [
        field(whole, "m", min, max),
        field(start, "m", min, max),
        field(end, "m", min, max),
    ]
}

/// Lengths of a spring up to its contact, m.
const SHORTEST: f64 = 1e-3;
const LONGEST: f64 = 0.2;

/// Shortest tongue of a forked spring, m.
const TONGUE: f64 = 1e-4;

/// Largest number of entries of each kind.
pub(crate) const MOST_ENTRIES: usize = 500;

/// Share by which a position may exceed the sum of lengths, 1.
const ROUNDING: f64 = 1e-9;

/// What modes may exceed the static compliance by, as a share of it: the digits that programs print.
const PRINTED: f64 = 1e-6;

impl Field {
    /// Refuses a value outside the range.
    pub(crate) fn check(self, value: f64) -> Result<(), SceneError> {
        let Self { name, unit, min, max } = self;
        if min <= value && value <= max * (1.0 + ROUNDING) {
            return Ok(());
        }
        Err(SceneError::OutOfRange {
            name,
            value,
            unit,
            allowed: format!(
                "allowed is {} to {}",
                crate::error::number(min),
                crate::error::number(max)
            ),
        })
    }

    /// With another upper end.
    pub(crate) fn up_to(self, max: f64) -> Self {
        Self { max, ..self }
    }
}

impl SpringFile {
    /// Checks everything, for springs that were not read from a file.
    ///
    /// # Errors
    /// The first [`SceneError`] met.
    pub fn check(&self) -> Result<(), SceneError> {
        let checked = match &self.shape {
            Shape::Segments(segments) => segments.check(),
            Shape::Modes(modes) => modes.check(),
        };
        checked.map_err(|error| SceneError::InFile {
            file: self.name.clone(),
            error: Box::new(error),
        })
    }
}

impl Segments {
    /// Length of all segments, m.
    pub fn length(&self) -> f64 {
        self.segments.iter().map(|segment| segment.length).sum()
    }

    /// Range of a position on the spring.
    pub(crate) fn on_spring(&self, position: Field) -> Field {
        position.up_to(self.length())
    }

    /// Distance of the contact from the clamp, m.
    pub(crate) fn contact(&self) -> f64 {
        self.contact_position.unwrap_or(self.length())
    }

    /// Range of the place where the spring forks.
    pub(crate) fn before_contact(&self, position: Field) -> Field {
        position.up_to(self.contact() - TONGUE)
    }

    pub(super) fn check(&self) -> Result<(), SceneError> {
        count("segment", self.segments.len(), 1)?;
        count("mass", self.masses.len(), 0)?;
        for segment in &self.segments {
            segment.check()?;
        }
        TOTAL.check(self.length())?;
        for mass in &self.masses {
            mass.check(self)?;
        }
        self.contact_position
            .map_or(Ok(()), |position| self.on_spring(CONTACT_POSITION).check(position))?;
        self.fork_position
            .map_or(Ok(()), |position| self.before_contact(FORK_POSITION).check(position))?;
        self.clamp_stiffness
            .map_or(Ok(()), |stiffness| CLAMP_STIFFNESS.check(stiffness))
    }
}

impl Segment {
    fn check(&self) -> Result<(), SceneError> {
        LENGTH.check(self.length)?;
        for (field, value) in WIDTH.iter().skip(1).zip(self.width) {
            field.check(value)?;
        }
        for (field, value) in THICKNESS.iter().skip(1).zip(self.thickness) {
            field.check(value)?;
        }
        self.youngs_modulus
            .map_or(Ok(()), |modulus| YOUNGS_MODULUS.check(modulus))?;
        self.density.map_or(Ok(()), |density| DENSITY.check(density))
    }
}

impl PointMass {
    fn check(&self, spring: &Segments) -> Result<(), SceneError> {
        spring.on_spring(POSITION).check(self.position)?;
        MASS.check(self.mass)?;
        ROTARY_INERTIA.check(self.rotary_inertia)
    }
}

impl Modes {
    /// The static compliance of the modes, m/N.
    pub fn held(&self) -> f64 {
        self.held_by(|mode| mode.contact)
    }

    /// The static deflection of a parallel contact per force there, m/N, digits that were not printed included; 0 where it has no
    /// part in the modes.
    pub fn parallel_compliance(&self) -> f64 {
        if self.modes.iter().all(|mode| mode.parallel.is_none()) {
            return 0.0;
        }
        let given = self.parallel_compliance.unwrap_or(self.compliance);
        given.max(self.held_by(|mode| mode.parallel.unwrap_or_default()))
    }

    fn held_by(&self, place: impl Fn(&GivenMode) -> f64) -> f64 {
        let parts = self.modes.iter().map(|mode| place(mode).powi(2) / mode.omega_squared());
        parts.sum()
    }

    pub(super) fn check(&self) -> Result<(), SceneError> {
        COMPLIANCE.check(self.compliance)?;
        self.parallel_compliance
            .map_or(Ok(()), |compliance| PARALLEL_COMPLIANCE.check(compliance))?;
        count("mode", self.modes.len(), 1)?;
        for mode in &self.modes {
            mode.check()?;
        }
        let of_parallel = self.held_by(|mode| mode.parallel.unwrap_or_default());
        let parallel = self.parallel_compliance.map(|compliance| (compliance, of_parallel));
        for (compliance, held) in [(self.compliance, self.held())].into_iter().chain(parallel) {
            if held > compliance * (1.0 + PRINTED) {
                return Err(SceneError::Contradiction { compliance, held });
            }
        }
        Ok(())
    }
}

impl GivenMode {
    /// Square of the angular frequency, 1/s2.
    pub fn omega_squared(&self) -> f64 {
        (std::f64::consts::TAU * self.frequency).powi(2)
    }

    /// Static deflection of the contact point in this mode per force there, m/N.
    pub fn compliance(&self) -> f64 {
        self.contact * self.contact / self.omega_squared()
    }

    fn check(&self) -> Result<(), SceneError> {
        FREQUENCY.check(self.frequency)?;
        CONTACT.check(self.contact)?;
        PARTICIPATION.check(self.participation)?;
        self.damping.map_or(Ok(()), |damping| DAMPING.check(damping))?;
        self.pusher.map_or(Ok(()), |pusher| PUSHER.check(pusher))?;
        self.parallel.map_or(Ok(()), |parallel| PARALLEL.check(parallel))?;
        self.rotation.map_or(Ok(()), |rotation| ROTATION.check(rotation))
    }
}

/// Refuses too few or too many entries.
pub(crate) fn count(name: &'static str, count: usize, least: usize) -> Result<(), SceneError> {
    if (least..=MOST_ENTRIES).contains(&count) {
        return Ok(());
    }
    Err(SceneError::OutOfRange {
        name,
        value: count as f64,
        unit: "entries",
        allowed: format!("allowed are {least} to {MOST_ENTRIES}"),
    })
}
