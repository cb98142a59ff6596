//! Newton's method for the nodal forces of the links whose laws are at work: each is that of its law at the motion that all of
//! them cause.
//!
//! The approach of link `a` at node `k` is linear in the nodal forces of all links `b`,
//!
//! ```text
//! d_ak = d_ak(free) - sum_bj D_abkj F_bj,   D_ab = s_a s_b sum_i b_ia b_ib (response of mode i at x_k to l_j)
//! ```
//!
//! and so is its velocity. While a contact slips its friction force is a share of the contact force: each contact force then
//! moves the modes with its friction force, and the friction forces are no unknowns. While it sticks they are.

#![expect(clippy::needless_range_loop, reason = "several arrays have a value for each unknown or node")]

use bytemuck::Zeroable;

use crate::integrator::collocation::coefficients::{Columns, NodalMotion, Response, StepCoefficients};
use crate::integrator::collocation::elimination::{Equations, Stacked, in_use};
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::shapes::Variable;
use crate::integrator::constants::{ITERATIONS, MOTION_ROUNDING, STALE};
use crate::integrator::rounding::motion_rounding;
use crate::link::{CONTACT, LinkLaw, MAX_UNKNOWNS};
use crate::math::nodal::{Nodal, add, add_products, end, greatest, scaled, unit};
use crate::math::simd::{Arithmetic, Separate};
use crate::model::Model;
use crate::state::State;

/// Unknown forces of which the equations stand on the stack.
pub(super) const FEW: usize = 3;

/// A link whose force is unknown, and what follows it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Unknown {
    pub(crate) link: usize,
    /// Friction that slips: its link, and its force per contact force.
    pub(crate) follower: Option<(usize, f64)>,
}

/// The links whose forces are unknown in a step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Unknowns {
    list: [Unknown; MAX_UNKNOWNS],
    pub(crate) count: usize,
}

impl Unknowns {
    /// Contacts that are closed, friction that sticks, and a magnet that draws over a gap.
    #[inline(always)]
    pub(crate) fn of(model: &Model, state: &State) -> Self {
        let mut unknowns = Self::default();
        let friction = model.friction();
        for (index, (link, at)) in model.links.iter().zip(&state.links).enumerate() {
            let Some((rubbing, friction)) = friction.filter(|_| index == CONTACT) else {
                let is_unknown = match &link.law {
                    LinkLaw::Contact(_) => at.closed,
                    LinkLaw::Magnet(_) => !model.is_on_core(state) && indented(model, state, index).is_none(),
                    LinkLaw::Friction(_) | LinkLaw::Gauge => false,
                };
                if is_unknown {
                    unknowns.push(index, None);
                }
                continue;
            };
            if !at.closed {
                continue;
            }
            let slips = state.slip.phase.sign();
            unknowns.push(index, slips.map(|sign| (rubbing, sign * friction.coefficient)));
            if slips.is_none() {
                unknowns.push(rubbing, None);
            }
        }
        unknowns
    }

    fn push(&mut self, link: usize, follower: Option<(usize, f64)>) {
        if let Some(entry) = self.list.get_mut(self.count) {
            *entry = Unknown { link, follower };
            self.count += 1;
        }
    }

    /// One after the other.
    #[inline(always)]
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Unknown> {
        self.list.iter().take(self.count)
    }

    /// An unknown that is in use.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "unknowns in use")]
    pub(crate) fn get(&self, a: usize) -> &Unknown {
        &self.list[a]
    }
}

/// The gap (m) of a magnet that counts as none, if its own is less: the armature is indented, and the force constant.
pub(crate) fn indented(model: &Model, state: &State, index: usize) -> Option<f64> {
    let (link, at) = model.links.get(index).zip(state.links.get(index))?;
    let LinkLaw::Magnet(magnet) = &link.law else { return None };
    let (rounding, _) = motion_rounding(model, (link, at), state);
    let unsure = magnet.gap_of(model.tolerance.at_event, state.coil).max(rounding);
    // Found to `unsure`, the instant of the gap must not be one of indentation again.
    (link.approach + at.approach < -2.0 * unsure).then_some(unsure)
}

/// Responses between unknown links, where they are not simply that of a port to itself.
#[derive(Clone, Debug)]
pub(crate) struct Joined<const S: usize>(Vec<[Response<S>; MAX_UNKNOWNS]>);

impl<const S: usize> Joined<S> {
    /// Room for those of the model: none where it has a single link.
    pub(super) fn new(model: &Model) -> Self {
        let unknowns = if model.links.len() > 1 { MAX_UNKNOWNS } else { 0 };
        Self(vec![[Response::zeroed(); MAX_UNKNOWNS]; unknowns])
    }
}

/// Tangent of the law of a link within a step; zero if its force does not depend on the motion.
#[derive(Clone, Copy, Debug, Default, Zeroable)]
pub struct Tangent {
    /// Greatest stiffness at start and nodes, N/m; of a magnet its magnitude.
    pub stiffness: f64,
    /// Greatest damping there, N s/m.
    pub damping: f64,
    /// Loop gain: change of the force at the end, at this tangent, per constant force of the link over the step; its magnitude.
    pub gain: f64,
}

/// The nodal forces of the unknown links, and the linearised laws with which an error estimate is made of them.
pub(crate) struct Solution<'a, const S: usize, const L: usize> {
    /// Forces as deviations from those of the preload, N.
    pub(crate) forces: Stacked<S, L>,
    /// Motion under them.
    pub(crate) motions: [NodalMotion<S>; L],
    pub(crate) iterations: u64,
    laws: Laws<S, L>,
    factors: &'a Equations<S, L>,
}

/// The laws at the nodes: derivatives by the own approach, its velocity, and the approach of the contact that rubs.
#[derive(Clone, Copy)]
struct Laws<const S: usize, const L: usize> {
    stiffness: Stacked<S, L>,
    damping: Stacked<S, L>,
    coupling: Stacked<S, L>,
}

impl<const S: usize, const L: usize> Laws<S, L> {
    /// Change of the forces of link `a` with the motions of all links.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "friction comes after its contact")]
    fn change<A: Arithmetic>(&self, a: usize, motion: impl Fn(usize) -> NodalMotion<S>) -> Nodal<S> {
        let own = motion(a);
        let mut forces = [0.0; S];
        add_products::<S, A>(&mut forces, &self.stiffness[a], &own.d);
        add_products::<S, A>(&mut forces, &self.damping[a], &own.rate);
        if L > 1 && a > 0 {
            add_products::<S, A>(&mut forces, &self.coupling[a], &motion(a - 1).d);
        }
        forces
    }
}

/// The links of a step and the responses between them.
pub(crate) struct Linked<'a, const S: usize, const L: usize> {
    pub(crate) model: &'a Model,
    pub(crate) state: &'a State,
    pub(crate) unknowns: &'a Unknowns,
    responses: [[&'a Response<S>; L]; L],
}

impl<'a, const S: usize, const L: usize> Linked<'a, S, L> {
    /// Joins the responses of ports to those of links.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "links and ports of the model, and unknowns in use")]
    pub(crate) fn new<A: Arithmetic>(
        (model, state): (&'a Model, &'a State),
        step: StepCoefficients<'a, S>,
        unknowns: &'a Unknowns,
        joined: &'a mut Joined<S>,
    ) -> Self {
        let first = unknowns.list[0];
        let plain = unknowns.count == 1 && first.follower.is_none();
        let port = model.links[first.link].port;
        let mut linked = Self { model, state, unknowns, responses: [[step.response(port, port); L]; L] };
        if plain {
            return linked;
        }
        // As it is, or with the sign and what follows.
        let of = |a: &Unknown, link: usize| {
            let (own, other) = (&model.links[a.link], &model.links[link]);
            (step.response(own.port, other.port), own.sense * other.sense)
        };
        let direct = |a: &Unknown, b: &Unknown| {
            let (response, sign) = of(a, b.link);
            (sign > 0.0 && b.follower.is_none()).then_some(response)
        };
        for (a, row) in unknowns.iter().zip(&mut joined.0) {
            for (b, joined) in unknowns.iter().zip(row) {
                if direct(a, b).is_none() {
                    let (response, sign) = of(a, b.link);
                    *joined = *response;
                    if sign < 0.0 {
                        joined.scale(-1.0);
                    }
                    if let Some((follower, share)) = b.follower {
                        let (response, sign) = of(a, follower);
                        joined.add::<A>(sign * share, response);
                    }
                }
            }
        }
        let joined = &*joined;
        for (a, (row, joined)) in unknowns.iter().zip(linked.responses.iter_mut().zip(&joined.0)) {
            for (b, (response, joined)) in unknowns.iter().zip(row.iter_mut().zip(joined)) {
                *response = direct(a, b).unwrap_or(joined);
            }
        }
        linked
    }

    /// Motion of the unknown links under forces, from that without a change of them.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "unknowns in use")]
    pub(super) fn under<A: Arithmetic>(
        &self,
        free: &[NodalMotion<S>; L],
        forces: &Stacked<S, L>,
    ) -> [NodalMotion<S>; L] {
        let mut motions = *free;
        for b in 0..in_use::<L>(self.unknowns.count) {
            let less = scaled(&forces[b], -1.0);
            for a in 0..in_use::<L>(self.unknowns.count) {
                motions[a].respond::<A>(&self.responses[a][b].columns, &less);
            }
        }
        motions
    }

    /// What the forces differ from those of the laws, and the laws there.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "unknowns in use")]
    fn residuals(&self, forces: &Stacked<S, L>, motions: &[NodalMotion<S>; L]) -> (Stacked<S, L>, Laws<S, L>) {
        let mut residuals = *forces;
        let mut laws = Laws { stiffness: [[0.0; S]; L], damping: [[0.0; S]; L], coupling: [[0.0; S]; L] };
        let [contact, ..] = self.model.links.as_slice() else { return (residuals, laws) };
        for a in 0..in_use::<L>(self.unknowns.count) {
            let link = &self.model.links[self.unknowns.get(a).link];
            let motion = &motions[a];
            match &link.law {
                LinkLaw::Contact(law) => {
                    let d = motion.d.map(|d| link.approach + d);
                    let branch = law.closed_branches(&d, &motion.rate);
                    for (residual, force) in residuals[a].iter_mut().zip(&branch.force) {
                        *residual -= force - link.force;
                    }
                    (laws.stiffness[a], laws.damping[a]) = (branch.stiffness, branch.damping);
                }
                // It comes after its contact.
                LinkLaw::Friction(friction) if L > 1 && a > 0 => {
                    let Some(law) = contact.contact() else { continue };
                    for k in 0..S {
                        let z = -motion.d[k] - self.state.slip.way;
                        let d = contact.approach + motions[a - 1].d[k];
                        let stick = friction.trial(law, d, z, -motion.rate[k]);
                        residuals[a][k] -= stick.force - link.force;
                        laws.stiffness[a][k] = stick.stiffness;
                        laws.damping[a][k] = stick.stiffness * law.damping;
                        laws.coupling[a][k] = stick.by_indentation;
                    }
                }
                LinkLaw::Magnet(magnet) => {
                    for k in 0..S {
                        let (force, stiffness) = magnet.force(link.approach + motion.d[k], self.state.coil);
                        residuals[a][k] -= force - link.force;
                        laws.stiffness[a][k] = stiffness;
                    }
                }
                LinkLaw::Friction(_) | LinkLaw::Gauge => {}
            }
        }
        (residuals, laws)
    }

    /// Solves for the nodal forces from a guess, given the motion without a change of them, to residuals of at most `newton` (N)
    /// or rounding; `None` if the iteration does not converge.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "unknowns in use")]
    pub(super) fn solve<'f, A: Arithmetic>(
        &self,
        free: &[NodalMotion<S>; L],
        mut forces: Stacked<S, L>,
        newton: f64,
        factors: &'f mut Equations<S, L>,
    ) -> Option<Solution<'f, S, L>> {
        let (mut factorised, mut before) = (false, 0.0);
        let sizes = free.each_ref().map(|free| (greatest(&free.d), greatest(&free.rate)));
        for iterations in 0..=ITERATIONS {
            let motions = self.under::<A>(free, &forces);
            let (mut residuals, laws) = self.residuals(&forces, &motions);
            // Convergence is judged by the residual of the law, not by the change of the nodal forces, which on a stiff
            // contact hardly depend on the law. Rounding of the motion limits the residual.
            let (mut wrong, mut rounding) = (0.0_f64, 0.0);
            for a in 0..in_use::<L>(self.unknowns.count) {
                wrong = wrong.max(greatest(&residuals[a]));
                let (size, speed) = sizes[a];
                rounding += greatest(&laws.stiffness[a]) * size + greatest(&laws.damping[a]) * speed;
            }
            if factorised && wrong <= newton.max(MOTION_ROUNDING * rounding) {
                return Some(Solution { forces, motions, iterations, laws, factors });
            }
            if L > 1 && factorised && wrong <= STALE * before {
                factors.solve::<A>(&mut residuals);
            } else {
                self.equate::<A>(&laws, factors);
                factors.factorise::<A>(&mut residuals)?;
                factorised = true;
            }
            before = wrong;
            for a in 0..in_use::<L>(self.unknowns.count) {
                let finite = residuals[a].iter().fold(true, |all, force| all & force.is_finite());
                if !finite {
                    return None;
                }
                add::<S, A>(&mut forces[a], -1.0, &residuals[a]);
            }
        }
        None
    }

    /// Sets the derivatives of the residuals by each nodal force.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "unknowns in use")]
    fn equate<A: Arithmetic>(&self, laws: &Laws<S, L>, equations: &mut Equations<S, L>) {
        for b in 0..in_use::<L>(self.unknowns.count) {
            for j in 0..S {
                for a in 0..in_use::<L>(self.unknowns.count) {
                    equations.columns[b][j][a] = laws.change::<A>(a, |of| {
                        let Columns { displacement, velocity } = &self.responses[of][b].columns;
                        NodalMotion { d: displacement[j], rate: velocity[j] }
                    });
                }
                add::<S, Separate>(&mut equations.columns[b][j][b], 1.0, unit(j));
            }
        }
    }

    /// What the forces answer to a motion that is added to that with forces as they are.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "unknowns in use")]
    pub(crate) fn answer<A: Arithmetic>(
        &self,
        solution: &Solution<'_, S, L>,
        own: &[NodalMotion<S>; L],
    ) -> Stacked<S, L> {
        let mut forces = [[0.0; S]; L];
        for a in 0..in_use::<L>(self.unknowns.count) {
            forces[a] = solution.laws.change::<A>(a, |of| own[of]);
        }
        solution.factors.solve::<A>(&mut forces);
        forces
    }

    /// What defects of the loads at the start do to the forces at the nodes, and to the motion at the end, from the motion that
    /// they make with forces as they are.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "unknowns in use")]
    pub(crate) fn wrong<A: Arithmetic>(&self, solution: &Solution<'_, S, L>, own: &[NodalMotion<S>; L]) -> Wrong<S, L> {
        let forces = self.answer::<A>(solution, own);
        let mut ends = [(0.0, 0.0); L];
        for a in 0..in_use::<L>(self.unknowns.count) {
            ends[a] = (end(&own[a].d), end(&own[a].rate));
            for b in 0..in_use::<L>(self.unknowns.count) {
                let (d, rate) = self.responses[a][b].columns.at_end(&forces[b]);
                ends[a] = (ends[a].0 - d, ends[a].1 - rate);
            }
        }
        Wrong { forces, ends }
    }

    /// Tangent of an unknown link: the greatest, with that at the start. In a leap the mean: at touch that of the dissipative part is
    /// infinite.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "unknowns in use")]
    pub(crate) fn tangent(&self, collocation: &Collocation<S>, solution: &Solution<'_, S, L>, a: usize) -> Tangent {
        let index = self.unknowns.get(a).link;
        let link = &self.model.links[index];
        let (mut stiffness, mut damping) = (greatest(&solution.laws.stiffness[a]), greatest(&solution.laws.damping[a]));
        if collocation.variable == Variable::Root {
            let Laws { stiffness: of_way, damping: of_rate, .. } = &solution.laws;
            (stiffness, damping) = (collocation.mean(&of_way[a]).abs(), collocation.mean(&of_rate[a]));
        } else if let Some(law) = link.contact() {
            let start = law.stiffness(link.approach + self.state.links[index].approach);
            (stiffness, damping) = (stiffness.max(start), damping.max(law.damping * start));
        }
        let (d, rate) = self.responses[a][a].columns.at_end(&[1.0; S]);
        let gain = (stiffness * d + damping * rate).max(0.0);
        Tangent { stiffness, damping, gain }
    }
}

/// What defects of the loads at the start do.
pub(crate) struct Wrong<const S: usize, const L: usize> {
    /// To the nodal forces, N.
    pub(crate) forces: Stacked<S, L>,
    /// To approach (m) and velocity (m/s) at the end.
    pub(crate) ends: [(f64, f64); L],
}
