//! The moving spring with its tongues, and the one that carries the fixed contact (`fixed.file`), clamped to the frame beside it
//! and deflecting along the same axis.
//!
//! A deflection of the fixed contact's spring closes the contact, and the contact force bends it back: with its modes `j`,
//! shapes `T_j` and participations `g_j`,
//!
//! ```text
//! d - d_0 = u - sum T_i q_i + sum T_j q_j
//! q_j'' + c_j q_j' + omega_j^2 q_j = -T_j (F - F_0) - g_j a
//! ```
//!
//! so that they join the modes of the moving spring with the opposite sign at the contact. `support.displacement` moves the
//! contact point as if its spring were rigid: the inertia of a clamp that moves is left out.

use std::iter;

use nalgebra::DVector;

use crate::armature::Armature;
use crate::beam::mode::{Last, MAX_MODES, Mode, SPRINGS};
use crate::beam::mode_count::Blow;
use crate::beam::resolution::Resolution;
use crate::beam::spring::{Basis, Spring, frequency_modes};
use crate::beam::statics::AtPlace;
use crate::beam::tongues;
use crate::error::Remark;
use crate::math::simd::LANES;
use crate::scene::Scene;
use crate::variables::{PusherKind, StringParameter};

#[derive(Clone, Debug)]
pub struct Springs {
    pub moving: Spring,
    /// That of the fixed contact, if it is not rigid.
    pub fixed: Option<Spring>,
    /// The tongues of the moving one as they move against each other, if it forks.
    pub tongues: Option<Spring>,
    /// The armature, which joins their modes.
    pub armature: Option<Armature>,
}

/// Numbers of modes: of the moving spring, of that of the fixed contact, and of the tongues against each other.
pub type Counts = [usize; SPRINGS];

/// As many as there is room for, in the same ratio.
fn within([moving, fixed, tongues]: Counts, room: usize) -> Counts {
    let (others, sum) = (fixed + tongues, moving + fixed + tongues);
    if sum <= room {
        return [moving, fixed, tongues];
    }
    let share = |count: usize, room: usize, sum: usize| room * count / sum / LANES * LANES;
    let most = room - others.min(2 * LANES);
    let moving = share(moving, room, sum).clamp(LANES.min(most), most);
    let room = room - moving;
    let fixed = match (fixed, tongues) {
        (_, 0) => room,
        (0, _) => 0,
        _ => share(fixed, room, others).clamp(LANES, room - LANES),
    };
    [moving, fixed, if tongues == 0 { 0 } else { room - fixed }]
}

impl Springs {
    pub fn new(scene: &Scene) -> Self {
        Self {
            moving: Spring::new(scene),
            fixed: fixed(scene).map(|own| Spring::new(&own)),
            tongues: tongues::scene(scene).map(|own| Spring::new(&own)),
            armature: Armature::new(scene),
        }
    }

    /// The springs that there are, in the order of [`Counts`].
    fn each(&self) -> [Option<&Spring>; SPRINGS] {
        [Some(&self.moving), self.fixed.as_ref(), self.tongues.as_ref()]
    }

    /// Static stiffness of both at the contact, N/m.
    pub fn stiffness(&self) -> f64 {
        let moving = self.moving.statics.section.tip_stiffness();
        match &self.fixed {
            Some(fixed) => 1.0 / (1.0 / moving + fixed.statics.tip_compliance(0.0)),
            None => moving,
        }
    }

    /// Deflection of the moving tip per force there, m/N, under an axial compression of the moving one (N).
    pub fn tip_compliance(&self, axial_force: f64) -> f64 {
        self.moving.statics.tip_compliance(axial_force) + self.tongue_compliance(axial_force)
    }

    /// What tongues add to that of the spring as a whole, m/N.
    fn tongue_compliance(&self, axial_force: f64) -> f64 {
        let tongues = self.tongues.as_ref();
        tongues.map_or(0.0, |tongues| tongues.statics.tip_compliance(axial_force))
    }

    /// Deflection of the moving spring at a parallel contact per load, under an axial compression of it (N).
    pub(crate) fn at_parallel(&self, axial_force: f64) -> AtPlace {
        let whole = self.moving.statics.at_parallel(axial_force);
        let tongues = self.tongue_compliance(axial_force);
        AtPlace { own: whole.own + tongues, across: whole.across - tongues, ..whole }
    }

    /// Numbers of modes for a tolerance in blows of the contact, of a parallel one, which presses the fixed contact's spring too,
    /// and of others on the moving spring; where `asked` is not 0 that number of each that there is.
    pub fn counts(&self, blows: &[Blow; 4], tolerance: f64, asked: usize) -> Counts {
        let (at_fixed, _) = blows.split_at(2);
        let most = |spring: Option<&Spring>, blows: &[Blow]| {
            let counts = blows.iter().filter_map(|blow| Some(spring?.count(blow, tolerance)));
            counts.max().unwrap_or_default()
        };
        let [moving, fixed, tongues] = self.each();
        let needed = [most(moving, blows), most(fixed, at_fixed), most(tongues, blows)];
        let counts = if asked == 0 { needed } else { self.of_each(asked) };
        within(counts, self.room())
    }

    /// So many modes of each spring that there is, beside its residual flexibilities.
    fn of_each(&self, count: usize) -> Counts {
        self.each().map(|spring| spring.map_or(0, |spring| count + spring.residuals()))
    }

    /// What modes left out do in a blow of a contact at the tip.
    pub fn resolution(&self, basis: &Basis, blow: &Blow) -> Resolution {
        let dampings = self.each().map(|spring| spring.map_or(0.0, |spring| spring.damping.beta));
        Resolution::new(basis, blow, dampings)
    }

    /// What a user should know of a spring given by modes that end below the frequencies that a blow excites.
    pub fn few_modes(&self, scene: &Scene, blow: &Blow) -> Option<Remark> {
        let remark = |parameter: StringParameter, (highest, reached): (f64, f64)| Remark::FewModes {
            name: parameter.variable().name,
            file: scene.string(parameter).to_owned(),
            highest,
            reached,
        };
        let moving = self.moving.missed(blow).map(|missed| remark(StringParameter::BeamFile, missed));
        let fixed = || Some(remark(StringParameter::FixedFile, self.fixed.as_ref()?.missed(blow)?));
        moving.or_else(fixed)
    }

    /// The damped modes of both, frequency ascending, under an axial compression of the moving one (N); the rest of the basis is
    /// that of the moving one. `None` at or above the buckling load.
    pub fn modes(&self, [moving, fixed, tongues]: Counts, axial_force: f64) -> Option<Basis> {
        let own = self.moving.modes(moving, axial_force)?;
        let fixed = beside(self.fixed.as_ref(), (1, fixed), 0.0, |mode| {
            (mode.tip, mode.parallel, mode.fixed) = (-mode.tip, -mode.tip, mode.tip);
        });
        let tongues = beside(self.tongues.as_ref(), (2, tongues), axial_force, |mode| {
            (mode.parallel, mode.participation) = (-mode.tip, 0.0);
        });
        let springs = own.modes.into_iter().zip(own.last).chain(fixed).chain(tongues).take(self.room());
        let armature = self.armature.as_ref().map(|armature| (armature.mode(), Default::default()));
        // Modes of others have no part in the shapes of the moving spring.
        let none = DVector::zeros(own.shapes.first().map_or(0, DVector::len));
        let shapes = own.shapes.into_iter().chain(iter::repeat(none));
        let mut all: Vec<_> = springs.chain(armature).zip(shapes).collect();
        all.sort_by(|((a, _), _), ((b, _), _)| a.omega_squared.total_cmp(&b.omega_squared));
        let (modes, shapes): (Vec<_>, _) = all.into_iter().unzip();
        let (modes, last) = modes.into_iter().unzip();
        Some(Basis { modes, shapes, space: own.space, last })
    }

    /// Most modes of all of them, beside that of the armature.
    pub fn room(&self) -> usize {
        MAX_MODES - usize::from(self.armature.is_some())
    }

    /// Modes for the lowest frequency of all.
    pub fn many_modes(&self, axial_force: f64) -> Option<Vec<Mode>> {
        let counts = within(self.of_each(frequency_modes(&self.moving.statics.section, axial_force)), self.room());
        self.modes(counts, axial_force).map(|basis| basis.modes)
    }
}

/// The scene with the spring of the fixed contact in the place of the moving one, if it has one.
fn fixed(scene: &Scene) -> Option<Scene> {
    let spring = scene.fixed_spring.clone()?;
    let mut own = scene.clone();
    (own.spring, own.fixed_spring) = (Some(spring), None);
    (own.tip.mass, own.tip.rotary_inertia) = (0.0, 0.0);
    own.beam.mass_damping = scene.fixed.mass_damping;
    own.beam.stiffness_damping = scene.fixed.stiffness_damping;
    own.effects.pusher = PusherKind::None;
    Some(own)
}

/// The modes under an axial compression (N) of a spring beside the moving one, with their coefficients in its last functions: each
/// changed to what it does at the contacts, as those of the spring with this index.
fn beside(
    spring: Option<&Spring>,
    (index, count): (usize, usize),
    axial_force: f64,
    at_contacts: fn(&mut Mode),
) -> impl Iterator<Item = (Mode, [Last; SPRINGS])> {
    let basis = spring.and_then(|spring| spring.modes(count, axial_force));
    let modes = basis.into_iter().flat_map(|basis| basis.modes.into_iter().zip(basis.last));
    modes.map(move |(mut mode, mut last)| {
        at_contacts(&mut mode);
        last.swap(0, index);
        (mode, last)
    })
}
