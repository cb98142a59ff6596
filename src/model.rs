//! The model: everything computed once from a scene.

use std::array;
use std::ops::{Range, RangeInclusive};

use crate::armature::Armature;
use crate::assembly::{Assembly, Laws, Roles};
use crate::beam::axial::Feedback;
use crate::beam::mode::{MAX_MODES, Modal, Mode, ModeStates};
use crate::beam::resolution::Resolution;
use crate::beam::section::Section;
use crate::closed_loop::system::ClosedLoop;
use crate::contact::friction::Friction;
use crate::contact::law::Law;
use crate::error::{HELD, Remark, SOFTEST};
use crate::excitation::generator::Generator;
use crate::integrator::constants::MOTION_ROUNDING;
use crate::integrator::step_length::StepLengths;
use crate::integrator::tolerance::Tolerance;
use crate::link::{CONTACT, Link, LinkLaw, Port};
use crate::math::free_motion::Roots;
use crate::math::simd::{LANES, Simd};
use crate::preload::{Initial, Preload};
use crate::scene::Scene;
use crate::scene::spring::{Shape, SpringFile};
use crate::slip_stability::{self, Unstable};
use crate::state::State;
use crate::variables::{ContactLawKind, RealParameter, StringParameter, Variable};

/// Deflection at the preload, in lengths of the spring, above which the user is told what a linear beam misses, 1.
const BENT_FAR: f64 = 0.1;

/// Exponents of the stiffness with which friction keeps the tolerance where the contact opens: of 100 random relays two do not
/// at 0.54, eight at 0.7.
const RUBBING: Range<f64> = 0.1..0.6;

/// Damping of the lowest mode of a contact spring that is hardly ever reached, 1: the specimen of the paper has 0.34.
const MOST_DAMPING: f64 = 0.5;

/// Young's modulus (Pa) and density (kg/m3) of springs: from soft plastics to tungsten; rivets (kg) and their radii (m) of relays from
/// reed switches to contactors, flat ones with the radius of their waviness; the damping time (s) fitted to the paper is 8e-5.
const USUAL: [(RealParameter, RangeInclusive<f64>); 7] = [
    (RealParameter::BeamYoungsModulus, 1e9..=1e12),
    (RealParameter::BeamDensity, 500.0..=25_000.0),
    (RealParameter::TipMass, 0.0..=5e-3),
    (RealParameter::ContactCurvatureRadius, 5e-5..=0.2),
    (RealParameter::SecondCurvatureRadius, 5e-5..=0.2),
    (RealParameter::ParallelCurvatureRadius, 5e-5..=0.2),
    (RealParameter::ContactDamping, 0.0..=5e-3),
];

/// Everything that is constant during a simulation.
#[derive(Clone, Debug)]
pub struct Model {
    /// The scene.
    pub scene: Scene,
    /// The uniform section of the spring, or that of a spring as stiff at its contact.
    pub section: Section,
    /// The law of the first contact.
    pub law: Law,
    pub(crate) ports: Vec<Port>,
    pub(crate) links: Vec<Link>,
    /// Which link is what, beside the contact.
    pub(crate) roles: Roles,
    /// Load on each mode per base acceleration, with opposite sign.
    pub(crate) participations: Modal,
    /// The modes as oscillators; a last group that is not full has its first mode once more.
    pub(crate) roots: Vec<Roots<LANES>>,
    /// The static equilibrium, the reference of the motion.
    pub preload: Preload,
    /// The modes of all springs and of the armature, frequency ascending.
    pub modes: Vec<Mode>,
    /// The axial force, if it follows the deflection continuously.
    pub(crate) axial: Option<Box<Feedback>>,
    /// Modes and contact as one linear system, if the scene is linear, the generator harmonic, and nothing within a
    /// step is requested.
    pub(crate) closed_loop: Option<Box<ClosedLoop>>,
    /// Generated base acceleration.
    pub generator: Generator,
    /// What is part of the preload of the inputs at the start.
    pub(crate) initial: Initial,
    pub(crate) armature: Option<Armature>,
    /// Force scale of the tolerance, N: max(F_0, 3 E I max(|s|, 0.1 mm) / L^3).
    pub force_scale: f64,
    /// What the modes left out do.
    pub(crate) resolution: Resolution,
    /// Force at the held tip per base acceleration that varies slowly, kg.
    pub(crate) inertia: f64,
    /// Time in which a velocity of the open spring becomes a displacement, s: 1 / omega_1.
    pub(crate) memory: f64,
    /// Lowest natural frequency with the closed contacts as springs, Hz.
    pub frequency: f64,
    /// What a user should know of a spring file with too few modes.
    pub(crate) few_modes: Option<Remark>,
    /// Length of the spring, if it is known, m.
    pub(crate) spring_length: Option<f64>,
    /// The directions in which slip is unstable.
    pub(crate) unstable_slip: Vec<Unstable>,
    pub(crate) tolerance: Tolerance,
    /// Instruction set used for the steps.
    pub(crate) simd: Simd,
}

impl Model {
    /// Sets ports and links, with these laws of the contacts.
    pub(crate) fn link(&mut self, laws: Laws) {
        for (participation, mode) in self.participations.iter_mut().zip(&self.modes) {
            *participation = mode.participation;
        }
        let roots = |group: &[Mode]| {
            let of = |value: fn(&Mode) -> f64| array::from_fn(|i| group.get(i).or(group.first()).map_or(0.0, value));
            Roots::of(of(|mode| mode.omega_squared), of(|mode| mode.damping))
        };
        self.roots = self.modes.chunks(LANES).map(roots).collect();
        let Assembly { ports, mut links, roles } =
            Assembly::new((&self.scene, &self.modes, &self.preload), laws, self.armature.as_ref());
        let tolerance = self.scene.solver.effective_tolerance();
        for link in &mut links {
            if let LinkLaw::Contact(law) = &mut link.law {
                *law = law.judged(tolerance, self.force_scale);
            }
        }
        let at_rest: f64 = links.iter().map(|link| link.force.abs()).sum();
        self.tolerance.newton = self.tolerance.newton.max(MOTION_ROUNDING * at_rest);
        self.law = links.get(CONTACT).and_then(Link::contact).copied().unwrap_or(laws.contact);
        (self.ports, self.links, self.roles) = (ports, links, roles);
        if let Some((_, friction)) = self.friction() {
            // Of a contact open at rest the force scale.
            let at_rest = self.preload.force;
            let usual = if at_rest > 0.0 { at_rest } else { self.force_scale };
            self.unstable_slip = slip_stability::unstable(&self.modes, friction, &self.law, usual);
        }
    }

    /// The same model with another law of the contact, other modes, preload, generator or force scale, for test problems without a
    /// spring. It takes no exact steps.
    #[must_use]
    pub fn with(mut self, change: impl FnOnce(&mut Self)) -> Self {
        let law_of = |role: Option<usize>| self.links.get(role?)?.contact().copied();
        let (parallel, second) = (law_of(self.roles.parallel), law_of(self.roles.second));
        change(&mut self);
        self.modes.truncate(MAX_MODES);
        self.closed_loop = None;
        self.resolution = Resolution::default();
        let tolerance = self.scene.solver.effective_tolerance();
        self.tolerance = Tolerance::new(tolerance, self.force_scale);
        // Friction keeps its share of the force that the scene has.
        self.link(Laws { contact: self.law, parallel, second });
        self
    }

    /// What a user should know of the scene.
    pub fn remarks(&self) -> Vec<Remark> {
        let unstable = self.unstable_slip.iter();
        let unstable = unstable.filter_map(|unstable| unstable.remark(&self.scene));
        let not_used = self.scene.spring.iter().flat_map(|spring| self.not_used(spring));
        let of_scene = [self.bent_far(), self.friction_at_touch(), self.no_interruption()];
        let remarks = of_scene.into_iter().flatten().chain(unstable).chain(not_used);
        remarks
            .chain(self.of_files())
            .chain(self.damped())
            .chain(self.unusual())
            .chain(self.few_modes.clone())
            .collect()
    }

    /// A spring bent by more than a tenth of its length. Under a load `P` that keeps its direction the elastica has
    /// `P L^2 / EI = 3 y + (108/35) y^3`, `y = w(L) / L`, to third order (from `EI theta' = P (x(L) - x)`, expanded in `P`).
    fn bent_far(&self) -> Option<Remark> {
        let length = self.spring_length?;
        let bent = (self.preload.deflection / length).abs();
        (bent > BENT_FAR).then(|| Remark::BentFar {
            overtravel: self.scene.contact.overtravel,
            length,
            bent,
            stiffer: 100.0 * 36.0 / 35.0 * bent * bent,
        })
    }

    /// Friction between contacts soft at first touch: what sticks and what slips under a force far below the error allowed
    /// decides the deflection of the tangential spring, and so the friction force when the force has grown. Stiff ones: both
    /// forces begin with a jump.
    fn friction_at_touch(&self) -> Option<Remark> {
        let exponent = self.scene.contact.stiffness_exponent;
        let other = self.scene.effects.contact_law == ContactLawKind::Rough && !RUBBING.contains(&exponent);
        (other && self.friction().is_some()).then_some(Remark::FrictionAtTouch { exponent, range: RUBBING })
    }

    fn no_interruption(&self) -> Option<Remark> {
        let electrical = self.links.get(CONTACT)?.electrical.is_some();
        let (threshold, open) = (self.scene.chatter.resistance_threshold, self.scene.resistance.open);
        let none = self.scene.effects.chatter && electrical && !self.counts_interruptions();
        none.then_some(Remark::NoInterruption { threshold, open })
    }

    /// What does not describe the spring of a file, and is set all the same: the uniform section; beside modes also the material,
    /// if no other spring is of it, and what the spring carries and where it is pushed.
    fn not_used(&self, spring: &SpringFile) -> impl Iterator<Item = Remark> {
        use RealParameter::{BeamDensity, BeamLength, BeamThickness, BeamWidth, BeamYoungsModulus};
        use RealParameter::{PusherPosition, TipMass, TipRotaryInertia};
        let is_by_modes = |spring: &SpringFile| matches!(spring.shape, Shape::Modes(_));
        let by_modes = is_by_modes(spring);
        let shared = self.scene.fixed_spring.as_ref().is_some_and(|fixed| !is_by_modes(fixed));
        let sizes = [
            (true, &[BeamLength, BeamWidth, BeamThickness][..]),
            (by_modes && !shared, &[BeamYoungsModulus, BeamDensity]),
            (by_modes, &[TipMass, TipRotaryInertia, PusherPosition]),
        ];
        let others = sizes.into_iter().filter(|(is_other, _)| *is_other);
        let set = others.flat_map(|(_, sizes)| sizes.iter().copied());
        let set = set.filter(|size| self.scene.real(*size) != size.variable().start);
        set.map(|size| Remark::NotUsed {
            name: size.variable().name,
            value: self.scene.real(size),
            unit: size.variable().unit,
            file: spring.name.clone(),
        })
    }

    /// Springs of a file whose tongues move as one, or whose modes may be in other units.
    fn of_files(&self) -> impl Iterator<Item = Remark> {
        let forks = self.scene.effects.parallel_contact;
        let files = [
            (&self.scene.spring, StringParameter::BeamFile, forks),
            (&self.scene.fixed_spring, StringParameter::FixedFile, false),
        ];
        files.into_iter().filter_map(|(spring, parameter, forks)| {
            let (name, file) = (parameter.variable().name, self.scene.string(parameter).to_owned());
            match &spring.as_ref()?.shape {
                Shape::Segments(segments) => {
                    segments.fork_position.filter(|_| !forks).map(|fork| Remark::Joined { name, file, fork })
                }
                Shape::Modes(modes) => {
                    let (compliance, held) = (modes.compliance, modes.held());
                    let usual = compliance <= SOFTEST && held >= HELD * compliance;
                    (!usual).then_some(Remark::Compliance { name, file, compliance, held })
                }
            }
        })
    }

    /// Springs whose damping may be meant in per cent, or in another unit than s.
    fn damped(&self) -> impl Iterator<Item = Remark> {
        [("beam", false), ("fixed", true)].into_iter().filter_map(|(spring, fixed)| {
            let lowest = self.modes.iter().find(|mode| mode.tip != 0.0 && (mode.fixed != 0.0) == fixed)?;
            let damping = lowest.damping / (2.0 * lowest.omega_squared.sqrt());
            (damping >= MOST_DAMPING).then_some(Remark::Damped { spring, damping })
        })
    }

    /// What may be meant in another unit, of the scene or the material of a segment.
    fn unusual(&self) -> impl Iterator<Item = Remark> {
        let springs = [&self.scene.spring, &self.scene.fixed_spring].into_iter().flatten();
        let segments = springs.filter_map(|spring| match &spring.shape {
            Shape::Segments(shape) => Some(&shape.segments),
            Shape::Modes(_) => None,
        });
        let own: Vec<_> = segments.flatten().map(|segment| [segment.youngs_modulus, segment.density]).collect();
        USUAL.into_iter().enumerate().filter_map(move |(k, (parameter, usual))| {
            let of_segments = own.iter().filter_map(|segment| segment.get(k).copied().flatten());
            let value = of_segments.chain([self.scene.real(parameter)]).find(|value| !usual.contains(value))?;
            let Variable { name, unit, .. } = parameter.variable();
            Some(Remark::Unusual { name, value, unit, usual })
        })
    }

    /// Distance of both fixed contacts with the second displaced by so much (m); infinite where there is but one.
    pub(crate) fn room(&self, displacement: f64) -> f64 {
        let left = self.scene.second.gap - displacement - self.preload.indentation;
        self.roles.second.map_or(f64::INFINITY, |_| left)
    }

    /// Whether interruptions of a contact are counted.
    pub(crate) fn counts_interruptions(&self) -> bool {
        self.links.iter().any(|link| link.criterion.is_some())
    }

    /// The index of friction among the links, where there is any.
    #[inline(always)]
    pub(crate) fn friction(&self) -> Option<(usize, &Friction)> {
        let index = self.roles.friction?;
        match &self.links.get(index)?.law {
            LinkLaw::Friction(friction) => Some((index, friction)),
            LinkLaw::Contact(_) | LinkLaw::Magnet(_) | LinkLaw::Gauge => None,
        }
    }

    /// Whether there is an armature on its core.
    pub(crate) fn is_on_core(&self, state: &State) -> bool {
        self.roles.core.and_then(|core| state.links.get(core)).is_some_and(|core| core.closed)
    }

    /// At rest in the preload.
    pub fn initial_state(&self, time: f64) -> State {
        // Set in place, for the sake of the stack.
        let mut state = State::empty();
        for (link, at) in self.links.iter().zip(&mut state.links) {
            at.force = link.force;
            at.closed = link.contact().is_some() && link.force > 0.0;
        }
        let sprung = self.friction().and_then(|(index, friction)| {
            let stiffness = friction.ratio * self.preload.contact_stiffness;
            (stiffness > 0.0).then_some(self.links.get(index)?.force / stiffness)
        });
        state.slip.way = sprung.unwrap_or_default();
        (state.time, state.last_kink, state.coil) = (time, time, self.initial.coil);
        state.lengths = StepLengths::new(self.first_step(time));
        let forces = state.links.iter().map(|link| link.force);
        state.circuits.note(&self.links, forces, time);
        state
    }

    /// Energy of a state relative to the preload, J.
    pub fn energy(&self, state: &State) -> f64 {
        self.energy_at(&state.modes, state.coil, |index| state.links.get(index).map_or(0.0, |link| link.approach))
    }

    /// Kinetic and strain energy of the modes, elastic energy of the contacts, and that of the magnet at a current of the coil
    /// (relative), at approaches given as deviations from the preload (m); relative to the preload, J.
    pub(crate) fn energy_at(&self, modes: &ModeStates, coil: f64, approach: impl Fn(usize) -> f64) -> f64 {
        let pairs = self.modes.iter().zip(modes);
        let beam = pairs.map(|(mode, at)| at.v * at.v + mode.omega_squared * at.q * at.q);
        let links = self.links.iter().enumerate().map(|(index, link)| match &link.law {
            LinkLaw::Contact(law) => law.energy_above_tangent(link.approach, approach(index)),
            LinkLaw::Magnet(magnet) => {
                let way = approach(index);
                magnet.energy(link.approach + way, coil) - magnet.energy(link.approach, coil) - link.force * way
            }
            LinkLaw::Friction(_) | LinkLaw::Gauge => 0.0,
        });
        0.5 * beam.sum::<f64>() + links.sum::<f64>()
    }

    /// Displacement of a port per coordinate of a mode, b_i, 1/sqrt(kg).
    #[inline(always)]
    pub(crate) fn displacement(&self, port: usize, mode: usize) -> f64 {
        let shape = self.ports.get(port).map(|port| &port.shape);
        shape.and_then(|shape| shape.get(mode)).copied().unwrap_or_default()
    }

    /// The port of a link.
    pub(crate) fn port_of(&self, link: usize) -> Option<&Port> {
        self.ports.get(self.links.get(link)?.port)
    }

    /// Longest step allowed from `time` (s) on by scene and generator, s.
    pub fn longest_step(&self, time: f64) -> f64 {
        let generated = self.generator.longest_step(time);
        let limit = self.scene.solver.maximum_step;
        if limit > 0.0 { generated.min(limit) } else { generated }
    }

    /// A step short compared with any motion that may begin at `time` (s), s.
    pub fn first_step(&self, time: f64) -> f64 {
        (0.02 / self.frequency.max(1.0)).min(0.1 * self.generator.longest_step(time))
    }
}
