//! What a step is computed from, and a step computed but not yet accepted.

use bytemuck::{Zeroable, zeroed_box};

use crate::beam::mode::ModeStates;
use crate::force_error::{Deviation, MODES};
use crate::integrator::collocation::coefficients::NodalMotion;
use crate::integrator::collocation::elimination::Equations;
use crate::integrator::collocation::newton::{FEW, Joined, Tangent};
use crate::link::{MAX_LINKS, MAX_PORTS, MAX_UNKNOWNS};
use crate::math::nodal::Nodal;
use crate::model::Model;

/// A step computed but not yet accepted.
#[derive(Clone, Debug, Zeroable)]
pub struct Trial<const S: usize> {
    /// The links, in the order of the model.
    pub links: [LinkNodes<S>; MAX_LINKS],
    /// Base acceleration at the nodes, m/s2.
    pub accelerations: Nodal<S>,
    /// Slip of the first contact at the nodes.
    pub slip: SlipNodes<S>,
    /// The modes at the end.
    pub modes: ModeStates,
    /// The deviation there ([`crate::integrator::deviation`]).
    pub deviation: Deviation,
    /// What the deviation adds to the slip at the nodes.
    pub slip_deviation: SlipNodes<S>,
    /// Estimate of the error this step adds to the contact force, N.
    pub error: Estimate,
    /// Estimate of the same at instants inside the step, N.
    pub inner_error: Estimate,
    /// Part of the first that slow modes feel, as a mean over the step, N.
    pub slow_error: f64,
    /// Rounding of the forces, N: an error estimate below it is meaningless.
    pub rounding: f64,
    /// Greatest defect of the force polynomials at the start: difference from the force there, N.
    pub start_defect: f64,
    /// Estimate of the terms beyond it, N.
    pub next_terms: f64,
    /// Newton iterations.
    pub iterations: u64,
}

/// A link in a trial step; all as deviations from the preload.
#[derive(Clone, Copy, Debug, Zeroable)]
pub struct LinkNodes<const S: usize> {
    /// Nodal forces, N.
    pub forces: Nodal<S>,
    /// Those that the deviation makes.
    pub deviation: Nodal<S>,
    /// Approach at the nodes, m.
    pub approaches: Nodal<S>,
    /// Its velocity at the nodes, m/s.
    pub rates: Nodal<S>,
    /// At the end.
    pub end: LinkEnd,
    /// Tangent of its law.
    pub tangent: Tangent,
}

/// A link at the end of a step; deviations from the preload.
#[derive(Clone, Copy, Debug, Default, Zeroable)]
pub struct LinkEnd {
    /// Force, N: the last of the nodal forces, unless the step ends inside the one that was computed.
    pub force: f64,
    /// Approach, m.
    pub approach: f64,
    /// Its velocity, m/s.
    pub rate: f64,
}

/// Where the forces of a step come from.
#[derive(Clone, Copy, Debug)]
pub enum Source {
    /// The laws at the nodes, with this Newton tolerance, N; no force of open contacts.
    Laws(f64),
    /// The nodal forces that stand in the trial.
    Given,
}

/// Room for a trial while it is computed; all but the first only where a model needs it.
#[derive(Clone, Debug)]
pub struct Scratch<const S: usize> {
    pub(super) free: Box<FreeResponse<S>>,
    pub(super) joined: Joined<S>,
    /// Equations of more than [`FEW`] unknown forces.
    pub(super) many: Option<Box<Equations<S, MAX_UNKNOWNS>>>,
    pub(crate) axial: AxialLoads<S>,
}

impl<const S: usize> Scratch<S> {
    /// For the model.
    pub fn new(model: &Model) -> Self {
        let count = if model.axial.is_some() { model.modes.len() } else { 0 };
        let on_modes = || vec![[0.0; S]; count];
        let deviation = vec![[0.0; S]; count.min(MODES)];
        Self {
            free: Box::default(),
            joined: Joined::new(model),
            many: (model.links.len() > FEW).then(zeroed_box),
            axial: AxialLoads { loads: on_modes(), motion: on_modes(), next: on_modes(), deviation },
        }
    }
}

/// Response to all that is known beforehand.
#[derive(Clone, Debug)]
pub(crate) struct FreeResponse<const S: usize> {
    /// Motion of the ports.
    pub(crate) ports: [NodalMotion<S>; MAX_PORTS],
    /// Defect of the polynomial of the base acceleration at the start, m/s2.
    pub(crate) start_defect: f64,
    /// Mean over the step of what that polynomial misses, m/s2.
    pub(crate) missed_mean: f64,
    /// Approach of the contact that the defects of base acceleration and axial loads make, where there are such loads.
    pub(crate) axial: Option<NodalMotion<S>>,
}

impl<const S: usize> Default for FreeResponse<S> {
    fn default() -> Self {
        Self { ports: [NodalMotion::ZERO; MAX_PORTS], start_defect: 0.0, missed_mean: 0.0, axial: None }
    }
}

/// Slip at the nodes of a step ([`crate::integrator::collocation::slip`]).
#[derive(Clone, Copy, Debug, Zeroable)]
pub struct SlipNodes<const S: usize> {
    /// Deflection of the tangential spring, m, without what fades at once.
    pub deflections: Nodal<S>,
    /// Slip velocity, m/s, without that.
    pub rates: Nodal<S>,
    /// Deflection at the start that fades at once, m.
    pub fading: f64,
}

/// Loads of an axial force that follows the deflection, at each node for each mode.
#[derive(Clone, Debug)]
pub struct AxialLoads<const S: usize> {
    /// On the modes at the nodes of a trial.
    pub(crate) loads: Vec<Nodal<S>>,
    /// The modes at the nodes, while the loads are sought.
    pub(super) motion: Vec<Nodal<S>>,
    /// The loads of that motion.
    pub(super) next: Vec<Nodal<S>>,
    /// What the deviation adds to the loads, on its modes.
    pub(crate) deviation: Vec<Nodal<S>>,
}

/// Estimate of an error, N.
#[derive(Clone, Copy, Debug, Default, Zeroable)]
pub struct Estimate {
    /// All of it.
    pub total: f64,
    /// Without what the dampers of the contacts take back.
    pub lasting: f64,
}

impl Estimate {
    /// Of which nothing is known to die out sooner.
    pub fn lasting(total: f64) -> Self {
        Self { total, lasting: total }
    }

    /// The larger of two.
    pub fn or(self, other: Self) -> Self {
        if other.total > self.total { other } else { self }
    }

    /// With this share of what the contacts' dampers take back.
    pub fn with(&self, share: f64) -> f64 {
        self.lasting + share * (self.total - self.lasting)
    }
}
