//! The spring as the rest of the model sees it: statics, modes, and how many of them. Uniform, by segments, or by modes.

use std::{array, iter};

use nalgebra::DVector;

use crate::beam::characteristic;
use crate::beam::galerkin::Space;
use crate::beam::given::Given;
use crate::beam::mode::{Last, MAX_MODES, Mode, Rayleigh, SPRINGS, lowest_frequency};
use crate::beam::mode_count::{Blow, MOST};
use crate::beam::pieces::Pieces;
use crate::beam::ritz;
use crate::beam::section::Section;
use crate::beam::statics::{self, Statics, axial_force_from_deflection};
use crate::math::simd::LANES;
use crate::scene::spring::{Segment, Segments, Shape};
use crate::scene::{Beam, Scene};
use crate::shared::{Found, Home, Shared};
use crate::variables::AxialForceKind;

/// A spring with its rivet.
#[derive(Clone, Debug)]
pub struct Spring {
    /// Its section, and its static compliance at the contact.
    pub statics: Statics,
    /// Damping of its modes, if a file does not give them one of their own.
    pub damping: Rayleigh,
    form: Form,
    /// Whether friction turns it at its contact.
    rubs: bool,
}

#[derive(Clone, Debug, PartialEq)]
enum Form {
    Uniform,
    Segments(Pieces),
    Modes(Given),
}

/// The modes of a spring.
#[derive(Clone, Debug)]
pub struct Basis {
    /// Frequency ascending.
    pub modes: Vec<Mode>,
    /// Their shapes in `space`.
    pub shapes: Vec<DVector<f64>>,
    /// The space they are found in, in units of the section.
    pub space: Space,
    /// Coefficients of each mode in the last functions of the space of each spring, sqrt(J) per displacement: this spring first.
    pub last: Vec<[Last; SPRINGS]>,
}

/// Quarters of the number of modes that steps, masses, tapers or an end beyond the contact take in addition, 1. Found on 200
/// random springs of segments. Pinned: 0, `tests/promise.rs`.
const IRREGULAR: usize = 5;

/// Modes for the lowest frequency of springs: what the others add to the flexibility there, beyond their static share, is less than
/// rounding of the compliance. Under a large tension twice as many show how the slope turns at a contact before the end, to 4e-4 of the
/// frequency at thousands of buckling loads.
pub(super) fn frequency_modes(section: &Section, axial_force: f64) -> usize {
    if section.is_taut(axial_force) { 64 } else { 32 }
}

impl Spring {
    /// The spring of a scene.
    pub fn new(scene: &Scene) -> Self {
        let (statics, form) = match scene.spring.as_ref().map(|file| &file.shape) {
            None if scene.pushed_at().is_some() => of_segments(&uniform(&scene.beam), scene),
            None => (Statics::new(&Section::new(scene), prescribed(scene)), Form::Uniform),
            Some(Shape::Segments(segments)) => of_segments(segments, scene),
            Some(Shape::Modes(modes)) => {
                let given = Given::new(modes);
                let space = given.space(&given.modes(MAX_MODES, Rayleigh::default()));
                (Statics::of(&given.equivalent(), space), Form::Modes(given))
            }
        };
        let damping = Rayleigh { alpha: scene.beam.mass_damping, beta: scene.beam.stiffness_damping };
        Self { statics, form, damping, rubs: scene.rubs() }
    }

    /// Axial force at a deflection of the tip (m), N.
    pub fn axial_force(&self, scene: &Scene, y: f64) -> f64 {
        if self.given().is_some() {
            return 0.0;
        }
        match scene.effects.axial_force {
            AxialForceKind::None | AxialForceKind::Prescribed => prescribed(scene),
            AxialForceKind::FromPreload | AxialForceKind::FromDeflection => {
                axial_force_from_deflection(&self.statics.section, y)
            }
        }
    }

    /// The modes, where they are given.
    fn given(&self) -> Option<&Given> {
        match &self.form {
            Form::Modes(given) => Some(given),
            Form::Uniform | Form::Segments(_) => None,
        }
    }

    /// Length, of a spring of segments that of the uniform one with the same deflection and slope under a load at the
    /// contact, m; modes do not tell it.
    pub fn length(&self) -> Option<f64> {
        self.given().is_none().then_some(self.statics.section.length)
    }

    /// Number of modes for a tolerance; all where they are given.
    pub fn count(&self, blow: &Blow, tolerance: f64) -> usize {
        match &self.form {
            Form::Uniform => blow.modes(&self.statics.section, self.damping, tolerance),
            Form::Segments(pieces) => {
                let count = blow.modes(&pieces.at_contact(), self.damping, tolerance);
                let more = if pieces.are_uniform() { 0 } else { count * IRREGULAR / 4 };
                (count + more).next_multiple_of(LANES).min(MOST)
            }
            Form::Modes(given) => given.count(),
        }
    }

    /// Residual flexibilities among its modes, where they are given.
    pub fn residuals(&self) -> usize {
        self.given().map_or(0, Given::residuals)
    }

    /// The highest frequency of the modes given, and that up to which a blow excites the spring, if it is higher, Hz.
    pub fn missed(&self, blow: &Blow) -> Option<(f64, f64)> {
        self.given()?.missed(blow)
    }

    /// The damped modes under an axial compression (N); `None` at or above the buckling load.
    pub fn modes(&self, count: usize, axial_force: f64) -> Option<Basis> {
        if let Some(given) = self.given() {
            let modes = given.modes(count, self.damping);
            return Some(Basis {
                space: given.space(&modes),
                shapes: Vec::new(),
                last: given.last(&modes).map(|last| [last, NONE, NONE]).collect(),
                modes,
            });
        }
        let asked = (count, axial_force, self.rubs);
        let (undamped, space) = undamped(&self.form, &self.statics.section, asked)?;
        let (mut modes, shapes): (Vec<Mode>, Vec<DVector<f64>>) = undamped.into_iter().unzip();
        for mode in &mut modes {
            mode.damping = self.damping.of(mode.omega_squared);
        }
        let root = self.statics.section.halves().1.sqrt();
        let last = shapes.iter().map(|shape| last_of(shape).map(|entry| root * entry));
        Some(Basis { last: last.map(|last| [last, NONE, NONE]).collect(), modes, shapes, space })
    }

    /// Lowest angular frequency under an axial compression (N) with an elastic support of `stiffness` (N/m) at the tip,
    /// rad/s.
    pub fn frequency(&self, axial_force: f64, stiffness: f64) -> Option<f64> {
        let asked = (self.form.clone(), self.statics.section, (axial_force, stiffness));
        Shared::of(&KNOWN).frequencies.of(asked, |(form, section, (axial_force, stiffness))| {
            if let Form::Uniform = form {
                return characteristic::frequencies(section, *axial_force, *stiffness, 1).first().copied();
            }
            let (modes, _) = undamped(form, section, (frequency_modes(section, *axial_force), *axial_force, false))?;
            let modes: Vec<_> = modes.into_iter().map(|(mode, _)| mode).collect();
            let tip = array::from_fn(|i| modes.get(i).map_or(0.0, |mode| mode.tip));
            lowest_frequency(&modes, iter::once((*stiffness, tip)))
        })
    }
}

impl Form {
    /// A space of `count` functions for the modes under an axial compression (N), where `rubs` with a moment at the contact; that of
    /// all modes where they are given. `None` if it buckles.
    fn space(&self, section: &Section, count: usize, axial_force: f64, rubs: bool) -> Option<Space> {
        match self {
            Self::Uniform => Some(Space::new(count)),
            Self::Segments(pieces) => ritz::dynamic_space(pieces, section, count, axial_force, rubs),
            Self::Modes(given) => Some(given.space(&given.modes(MAX_MODES, Rayleigh::default()))),
        }
    }
}

/// What was found of springs, for all simulations of a process.
#[derive(Debug, Default)]
pub struct Known {
    /// Statics by so many functions, with the equivalent section.
    statics: Found<(Pieces, usize), Statics>,
    /// Modes without damping.
    modes: Found<(Form, Section, Asked), Option<Undamped>>,
    /// Lowest angular frequency (rad/s) under an axial compression (N) on an elastic support (N/m).
    frequencies: Found<(Form, Section, (f64, f64)), Option<f64>>,
}

/// Number of modes, axial compression (N), and whether the contact rubs.
type Asked = (usize, f64, bool);

/// Modes with their shapes in a space.
type Undamped = (Vec<(Mode, DVector<f64>)>, Space);

pub static KNOWN: Home<Known> = Home::new(None);

/// Modes without damping, with the space they are found in.
fn undamped(form: &Form, section: &Section, asked: Asked) -> Option<Undamped> {
    let asked = (form.clone(), *section, asked);
    Shared::of(&KNOWN).modes.of(asked, |(form, section, (count, axial_force, rubs))| {
        let space = form.space(section, *count, *axial_force, *rubs)?;
        Some((space.modes_with_shapes(section, *axial_force, 0.0)?, space))
    })
}

/// The axial compression, if it is prescribed, N.
fn prescribed(scene: &Scene) -> f64 {
    if scene.effects.axial_force == AxialForceKind::Prescribed { scene.beam.axial_force } else { 0.0 }
}

/// The statics of a spring of segments, and what it is made of.
fn of_segments(segments: &Segments, scene: &Scene) -> (Statics, Form) {
    let pieces = Pieces::new(segments, scene);
    let by = |count: usize| {
        Shared::of(&KNOWN).statics.of((pieces.clone(), count), |(pieces, count)| {
            let section = ritz::equivalent(pieces);
            Statics::of(&section, ritz::static_space(pieces, &section, *count))
        })
    };
    let few = by(statics::FEW);
    let count = statics::size(&few.section, prescribed(scene));
    let statics = if count > statics::FEW { by(count) } else { few };
    (statics, Form::Segments(pieces))
}

/// The uniform section as a spring of one segment.
fn uniform(beam: &Beam) -> Segments {
    let segment =
        Segment { length: beam.length, width: [beam.width; 2], thickness: [beam.thickness; 2], ..Segment::default() };
    Segments { segments: vec![segment], ..Segments::default() }
}

/// Of springs that a mode is not of.
const NONE: Last = [0.0; LANES];

fn last_of(shape: &DVector<f64>) -> Last {
    let place = |k: usize| (shape.len() + k).checked_sub(LANES);
    array::from_fn(|k| place(k).and_then(|place| shape.get(place)).copied().unwrap_or_default())
}
