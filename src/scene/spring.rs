//! A spring other than the uniform section: by its segments and masses, or by its modes. What a spring file holds.

use serde::{Deserialize, Serialize};

use crate::error::{SceneError, number};

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
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
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

/// A key, and where its value goes.
pub(crate) type Key<'a> = (Field, Slot<'a>);

/// Where the value of a key goes.
pub(crate) enum Slot<'a> {
    Needed(&'a mut f64),
    /// Zero without the key.
    OrZero(&'a mut f64),
    Optional(&'a mut Option<f64>),
    /// Values at start and end: of this key where they are the same, else of two others.
    Ends(&'a mut [f64; 2], [&'static str; 2]),
}

const TOTAL: Field = field("length of all segments", "m", SHORTEST, LONGEST);
pub(crate) const CONTACT_POSITION: Field = field("contact_position", "m", SHORTEST, LONGEST);
pub(crate) const CLAMP_STIFFNESS: Field = field("clamp_stiffness", "N.m/rad", 1e-9, 1e9);
pub(crate) const COMPLIANCE: Field = field("compliance", "m/N", 1e-9, 1e6);
pub(crate) const PARALLEL_COMPLIANCE: Field = field("parallel_compliance", "m/N", 1e-9, 1e6);

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
        let allowed = format!("{} to {}", number(min), number(max));
        Err(SceneError::out_of_range(name, value, unit, &allowed))
    }

    fn check_any(self, value: Option<f64>) -> Result<(), SceneError> {
        value.map_or(Ok(()), |value| self.check(value))
    }

    /// Of another name.
    pub(crate) fn named(self, name: &'static str) -> Self {
        Self { name, ..self }
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
        checked.map_err(|error| SceneError::InFile { file: self.name.clone(), error: Box::new(error) })
    }
}

impl Segments {
    /// Length of all segments, m.
    pub fn length(&self) -> f64 {
        self.segments.iter().map(|segment| segment.length).sum()
    }

    /// The place where the spring forks: before the contact.
    pub(crate) fn fork(&self) -> Field {
        let contact = self.contact_position.unwrap_or(self.length());
        field("fork_position", "m", 0.0, contact - TONGUE)
    }

    pub(super) fn check(&self) -> Result<(), SceneError> {
        count("segment", self.segments.len(), 1)?;
        count("mass", self.masses.len(), 0)?;
        let mut segments = self.segments.iter().copied();
        segments.try_for_each(|mut segment| check(segment.keys()))?;
        let length = self.length();
        TOTAL.check(length)?;
        let mut masses = self.masses.iter().copied();
        masses.try_for_each(|mut mass| check(mass.keys(length)))?;
        CONTACT_POSITION.up_to(length).check_any(self.contact_position)?;
        self.fork().check_any(self.fork_position)?;
        CLAMP_STIFFNESS.check_any(self.clamp_stiffness)
    }
}

impl Segment {
    /// What a file tells of it.
    pub(crate) fn keys(&mut self) -> [Key<'_>; 5] {
        let (width, thickness) = (["width_start", "width_end"], ["thickness_start", "thickness_end"]);
        let modulus = field("youngs_modulus", "Pa", 1e8, 1e13);
        [
            (field("length", "m", 1e-6, 0.2), Slot::Needed(&mut self.length)),
            (field("width", "m", 1e-5, 1.0), Slot::Ends(&mut self.width, width)),
            (field("thickness", "m", 1e-6, 5e-3), Slot::Ends(&mut self.thickness, thickness)),
            (modulus, Slot::Optional(&mut self.youngs_modulus)),
            (field("density", "kg/m3", 1.0, 1e5), Slot::Optional(&mut self.density)),
        ]
    }
}

impl PointMass {
    /// What a file tells of it, on a spring of this length (m).
    pub(crate) fn keys(&mut self, length: f64) -> [Key<'_>; 3] {
        let inertia = field("rotary_inertia", "kg.m2", 0.0, 1e-4);
        [
            (field("position", "m", 1e-6, length), Slot::Needed(&mut self.position)),
            (field("mass", "kg", 0.0, 0.1), Slot::Needed(&mut self.mass)),
            (inertia, Slot::OrZero(&mut self.rotary_inertia)),
        ]
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
        PARALLEL_COMPLIANCE.check_any(self.parallel_compliance)?;
        count("mode", self.modes.len(), 1)?;
        let mut modes = self.modes.iter().copied();
        modes.try_for_each(|mut mode| check(mode.keys()))?;
        let of_parallel = self.held_by(|mode| mode.parallel.unwrap_or_default());
        let parallel = self.parallel_compliance.unwrap_or(f64::INFINITY);
        for (field, compliance, place, held) in [
            (COMPLIANCE, self.compliance, "contact", self.held()),
            (PARALLEL_COMPLIANCE, parallel, "parallel", of_parallel),
        ] {
            if held > compliance * (1.0 + PRINTED) {
                return Err(SceneError::Contradiction { name: field.name, compliance, place, held });
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

    /// What a file tells of it.
    pub(crate) fn keys(&mut self) -> [Key<'_>; 7] {
        let displacement = |name| field(name, "1/sqrt(kg)", -1e9, 1e9);
        let rotation = field("rotation", "1/(m sqrt(kg))", -1e12, 1e12);
        let participation = field("participation", "sqrt(kg)", -1.0, 1.0);
        [
            (field("frequency", "Hz", 1e-3, 1e9), Slot::Needed(&mut self.frequency)),
            (displacement("contact"), Slot::Needed(&mut self.contact)),
            (participation, Slot::Needed(&mut self.participation)),
            (field("damping", "1", 0.0, 100.0), Slot::Optional(&mut self.damping)),
            (rotation, Slot::Optional(&mut self.rotation)),
            (displacement("pusher"), Slot::Optional(&mut self.pusher)),
            (displacement("parallel"), Slot::Optional(&mut self.parallel)),
        ]
    }
}

/// Refuses values out of range.
fn check<const N: usize>(keys: [Key; N]) -> Result<(), SceneError> {
    keys.into_iter().try_for_each(|(field, slot)| match slot {
        Slot::Needed(value) | Slot::OrZero(value) => field.check(*value),
        Slot::Optional(value) => field.check_any(*value),
        Slot::Ends([at_start, at_end], [start, end]) => {
            field.named(start).check(*at_start)?;
            field.named(end).check(*at_end)
        }
    })
}

/// Refuses too few or too many entries.
pub(crate) fn count(name: &'static str, count: usize, least: usize) -> Result<(), SceneError> {
    if (least..=MOST_ENTRIES).contains(&count) {
        return Ok(());
    }
    let allowed = format!("allowed are {least} to {MOST_ENTRIES}");
    Err(SceneError::OutOfRange { name, value: count as f64, unit: "entries", allowed })
}
