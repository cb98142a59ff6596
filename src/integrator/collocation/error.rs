//! The error estimate of a trial step.

#![expect(clippy::needless_range_loop, reason = "several arrays have a value for each unknown or node")]

use crate::integrator::collocation::coefficients::{NodalMotion, StepCoefficients};
use crate::integrator::collocation::elimination::in_use;
use crate::integrator::collocation::newton::{Linked, Solution, Tangent, Unknown};
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::shapes::Variable;
use crate::integrator::collocation::trial::{Estimate, FreeResponse, Trial};
use crate::integrator::constants::{FORCE_ROUNDING, KINKED};
use crate::integrator::rounding::magnitude;
use crate::link::{LinkLaw, MAX_LINKS};
use crate::math::nodal::{Nodal, dot, end, greatest};
use crate::math::simd::Arithmetic;
use crate::model::Model;
use crate::state::State;

/// What the polynomials of the forces miss at the start of a step, link by link, N.
#[derive(Clone, Copy, Debug, Default)]
struct Defects([f64; MAX_LINKS]);

/// What a step is estimated from: its links, its coefficients, and what moves it beside the unknown forces.
pub(super) struct Judged<'a, const S: usize, const L: usize> {
    pub(super) linked: &'a Linked<'a, S, L>,
    pub(super) step: StepCoefficients<'a, S>,
    pub(super) collocation: &'a Collocation<S>,
    pub(super) free: &'a FreeResponse<S>,
    /// Whether inputs, or their slopes, may just have changed, which bends the forces.
    pub(super) bent: bool,
}

impl<const S: usize, const L: usize> Judged<'_, S, L> {
    /// Estimates the error that a step adds to the contact force: if it is taken to its end, and if it ends inside (*Error
    /// estimate* of [`integrator`](crate::integrator)). What the defects do to the nodal forces is known to first order
    /// ([`Linked::wrong`]). Inside the step the shape of the estimate is not orthogonal to anything: slow modes get its impulse up to
    /// there.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "links of the model, and unknowns in use")]
    pub(super) fn estimate<A: Arithmetic>(&self, solution: &Solution<'_, S, L>, trial: &mut Trial<S>) {
        let Self { linked, step, collocation, free, .. } = *self;
        let Linked { model, state, .. } = *linked;
        let parting = self.parting(trial);
        let defects = self.defects::<A>(trial, parting.is_some());
        let mut own = [NodalMotion::ZERO; L];
        for a in 0..in_use::<L>(linked.unknowns.count) {
            let unknown = linked.unknowns.get(a);
            own[a] = self.under_defects::<A>(unknown.link, &defects);
        }
        let wrong = linked.wrong::<A>(solution, &own);

        // What a wrong way does, what a wrong velocity does until a damper takes it back, and where there is no damper.
        let (mut of_way, mut passing, mut kept) = (0.0, 0.0, 0.0);
        let (mut squares, mut sum, mut largest) = (0.0, 0.0, f64::MIN_POSITIVE);
        let (mut inside, mut gain, mut rounding) = (0.0, 0.0_f64, 0.0_f64);
        for a in 0..in_use::<L>(linked.unknowns.count) {
            let unknown = linked.unknowns.get(a);
            let (link, (d, rate)) = (&model.links[unknown.link], wrong.ends[a]);
            let nodes = &mut trial.links[unknown.link];
            let tangent = linked.tangent(collocation, solution, a);
            nodes.tangent = tangent;
            of_way += (tangent.stiffness * d).abs();
            passing += (tangent.damping * rate).abs();
            gain = gain.max(tangent.gain);
            largest = largest.max(greatest(&nodes.forces.map(|force| link.force + force)));
            rounding = rounding.max(FORCE_ROUNDING * largest.max(link.force));
            let mut missed = defects.0[unknown.link].abs();
            squares += missed * missed;
            // Where a contact has just parted there is no force, but for what rounding misses.
            largest = largest.max(missed);
            inside += greatest(&wrong.forces[a]);
            if let Some((follower, share)) = unknown.follower {
                let along = defects.0[follower].abs();
                squares += along * along;
                missed += along;
                inside += share.abs() * greatest(&wrong.forces[a]);
                if let LinkLaw::Friction(friction) = &model.links[follower].law {
                    // What slips has no force that answers, but when it turns depends on its motion: that counts as what bends
                    // the spring.
                    let (v, rate) =
                        self.at_end_of_follower::<A>(&defects, unknown, (follower, share), &wrong.forces[a]);
                    of_way += friction.stiffness * v.abs();
                    kept += friction.stiffness * model.memory * rate.abs();
                }
            }
            sum += missed;
        }
        // Contacts that are open, or hardly touch, will answer what slow modes do, too.
        for link in &model.links {
            let Some(law) = link.contact() else { continue };
            let (d, rate) = step.response(link.port, link.port).columns.at_end(&[1.0; S]);
            gain = gain.max(law.firm * (d + law.damping * rate));
        }
        let reaction = gain / (1.0 + gain);
        let base = free.start_defect.abs();
        let missed = model.inertia * free.missed_mean;
        let along = model.friction().map_or(0.0, |(_, friction)| friction.inertia);
        let since = (state.time - state.last_kink) / step.length;
        let kinked = kinked(collocation, parting.map_or(since, |ahead| since.min(ahead)), sum);
        let slow = 3.0 * squares / largest + kinked + missed;
        trial.slow_error = slow;
        let lasting = of_way + along * free.missed_mean + kept + slow * reaction;
        trial.error = Estimate { total: passing + lasting, lasting };
        // With an axial force the other defects are in `inside` alone.
        let of_base = if free.axial.is_some() { 0.0 } else { model.inertia * base };
        let impulse = collocation.impulse * (sum + of_base) + missed;
        let slow = impulse * reaction + along * (collocation.impulse * base + free.missed_mean);
        // The contacts' dampers take back what a wrong velocity makes, not a wrong way.
        let share = (of_way + kept) / (of_way + kept + passing).max(f64::MIN_POSITIVE);
        trial.inner_error = Estimate { total: inside + slow, lasting: share * inside + slow };
        trial.rounding = rounding;
    }

    /// In how many further steps of this length a contact will be indented no longer, if in less than one. A law that is softer the less
    /// it is indented lets the approach go there like the power `1 / p` of the time left.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "links of the model")]
    fn parting(&self, trial: &Trial<S>) -> Option<f64> {
        let mut parting = 1.0_f64;
        for a in 0..in_use::<L>(self.linked.unknowns.count) {
            let index = self.linked.unknowns.get(a).link;
            let (link, nodes) = (&self.linked.model.links[index], &trial.links[index]);
            let Some(law) = link.contact() else { continue };
            let (d, way) = (link.approach + end(&nodes.approaches), self.step.length * end(&nodes.rates));
            if law.exponent > 1.0 && d > 0.0 && way < 0.0 {
                parting = parting.min(-d / (law.exponent * way));
            }
        }
        (parting < 1.0).then_some(parting)
    }

    /// The defects of the unknown forces, and of those that follow them. Where forces bend, or a contact is about to part (`parting`), a
    /// defect that passes through zero shows nothing of it.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "links of the model")]
    fn defects<A: Arithmetic>(&self, trial: &mut Trial<S>, parting: bool) -> Defects {
        let mut defects = Defects::default();
        (trial.start_defect, trial.next_terms) = (0.0, 0.0);
        for a in 0..in_use::<L>(self.linked.unknowns.count) {
            let unknown = self.linked.unknowns.get(a);
            defects.0[unknown.link] = self.defect::<A>(unknown.link, trial, parting);
            if let Some((follower, _)) = unknown.follower {
                defects.0[follower] = self.defect::<A>(follower, trial, parting);
            }
        }
        defects
    }

    /// The defect of the force of a link, N; noted in the trial. Not a closure, which may not be inlined and would then be
    /// compiled for the generic processor.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "links of the model")]
    fn defect<A: Arithmetic>(&self, index: usize, trial: &mut Trial<S>, parting: bool) -> f64 {
        let Linked { model, state, .. } = *self.linked;
        let start = state.links[index].force - model.links[index].force;
        let forces = &trial.links[index].forces;
        let defect = start - dot::<S, A>(forces, &self.collocation.at_start);
        let (expected, next) = self.collocation.next_terms::<A>(start, forces, defect);
        trial.next_terms = trial.next_terms.max(next);
        let least = match (self.bent, parting) {
            (true, _) => expected,
            (false, true) => next,
            (false, false) => 0.0,
        };
        let defect = defect.abs().max(least).copysign(defect);
        trial.start_defect = trial.start_defect.max(defect.abs());
        defect
    }

    /// Motion of a link at the nodes that the defects make, with nodal forces as they are.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "links of the model")]
    fn under_defects<A: Arithmetic>(&self, index: usize, defects: &Defects) -> NodalMotion<S> {
        let Self { linked, step, free, .. } = *self;
        let links = &linked.model.links;
        let link = &links[index];
        let mut motion = NodalMotion::ZERO;
        if let Some(of_loads) = &free.axial {
            motion.add::<A>(link.sense, of_loads);
        } else {
            let of_base = &step.acceleration(link.port).defect;
            motion.add::<A>(link.sense * free.start_defect, of_base);
        }
        for (other, defect) in links.iter().zip(&defects.0) {
            if *defect != 0.0 {
                let column = &step.response(link.port, other.port).defect;
                motion.add::<A>(-link.sense * other.sense * defect, column);
            }
        }
        motion
    }

    /// What the defects do to approach (m) and velocity (m/s) of friction that slips, where they do this to the contact forces.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "links of the model")]
    fn at_end_of_follower<A: Arithmetic>(
        &self,
        defects: &Defects,
        unknown: &Unknown,
        (follower, share): (usize, f64),
        wrong: &Nodal<S>,
    ) -> (f64, f64) {
        let links = &self.linked.model.links;
        let own = self.under_defects::<A>(follower, defects);
        let at_end = |of: usize| {
            let response = self.step.response(links[follower].port, links[of].port);
            let (d, rate) = response.columns.at_end(wrong);
            let sign = links[follower].sense * links[of].sense;
            (sign * d, sign * rate)
        };
        let (by_contact, by_own) = (at_end(unknown.link), at_end(follower));
        (end(&own.d) - by_contact.0 - share * by_own.0, end(&own.rate) - by_contact.1 - share * by_own.1)
    }
}

/// The same of a step in which no force is unknown: of the approach that is read, searched for a contact, or left at an instant
/// inside, as the force that the hardest contact would make of it.
#[inline(always)]
pub(super) fn estimate_in_flight<const S: usize>(
    model: &Model,
    step: StepCoefficients<'_, S>,
    free: &FreeResponse<S>,
    trial: &mut Trial<S>,
) {
    let missed_velocity = free.missed_mean * step.length;
    let (mut at_end, mut inside) = (0.0_f64, 0.0_f64);
    for link in &model.links {
        let Some(law) = link.contact() else { continue };
        let rows = free.axial.as_ref().unwrap_or(&step.acceleration(link.port).defect);
        let defect = if free.axial.is_some() { 1.0 } else { free.start_defect.abs() };
        let most = |values: &Nodal<S>| greatest(values) * defect;
        let wrong = most(&rows.d) + law.damping * most(&rows.rate) + missed_velocity * (model.memory + law.damping);
        at_end = at_end.max(law.firm * wrong);
        // At the end the velocity is that of the quadrature.
        inside = inside.max(law.firm * (wrong + model.memory * most(&rows.rate)));
    }
    trial.error = Estimate::lasting(at_end);
    trial.slow_error = model.inertia * free.missed_mean;
    trial.inner_error = Estimate::lasting(inside);
    trial.rounding = FORCE_ROUNDING * model.preload.force;
    (trial.start_defect, trial.next_terms) = (0.0, 0.0);
}

/// Error that rounding of the motion of the links, relative to all that it is made of, makes of the nodal forces of a trial, N.
pub(crate) fn of_rounding<const S: usize>(model: &Model, state: &State, trial: &Trial<S>, rounding: f64) -> f64 {
    let links = model.links.iter().zip(&state.links).zip(&trial.links);
    let of_links = links.map(|(link, nodes)| {
        let (displacement, velocity) = magnitude(model, link, state);
        let Tangent { stiffness, damping, gain } = nodes.tangent;
        // The force at the first node feeds back only over the time up to it, some 1 / S^2 of the step.
        let reaction = 1.0 + gain / (S * S) as f64;
        (stiffness * displacement + damping * velocity) / reaction
    });
    rounding * of_links.sum::<f64>()
}

/// Error of slow modes, N, that a defect (N) of the force at the start of a step makes so many steps before or after a kink, where the
/// force is not smooth; by the root of time it is.
#[inline(always)]
fn kinked<const S: usize>(collocation: &Collocation<S>, distance: f64, defect: f64) -> f64 {
    match collocation.variable {
        Variable::Time => KINKED * defect * analytic::<S>(distance),
        Variable::Root => 0.0,
    }
}

/// Ratio of the quadrature error to the interpolation error with `S` nodes for a square root of time whose branch point
/// lies `distance` step lengths before the step. Interpolation converges with the power `S` of the size of the
/// Bernstein ellipse, quadrature with the power `2 S - 1` (L. N. Trefethen, Approximation Theory and Approximation
/// Practice, 2013, chapters 8 and 19).
fn analytic<const S: usize>(distance: f64) -> f64 {
    let ellipse = 1.0 + 2.0 * distance + 2.0 * (distance * (distance + 1.0)).sqrt();
    ellipse.powi(1 - i32::try_from(S).unwrap_or(i32::MAX))
}
