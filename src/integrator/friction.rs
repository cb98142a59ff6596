//! Friction from step to step: what a step leaves of it, and where the contact begins or ceases to slip. A step ends there.
//!
//! While the contact sticks, the friction force of the step is the trial force, and slip begins where it exceeds the limit,
//! `mu` times the contact force, by either sign. While it slips, it sticks again where the slip velocity would turn. Both
//! are polynomials through the nodes; between the places where they turn they are monotone, so that nothing is missed.

use crate::friction::{Friction, Phase};
use crate::integrator::collocation::error::sum_rounding;
use crate::integrator::collocation::part::Instant;
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::step::Trial;
use crate::integrator::constants::{INHERITED, LOCATED, MOST_CHANGES, MOST_SHRINK, SUM_ROUNDINGS, WORTH};
use crate::integrator::course::turning_points;
use crate::integrator::events::{Cut, motion_rounding};
use crate::integrator::grid::Target;
use crate::integrator::integration::Integration;
use crate::integrator::step_length::growth;
use crate::integrator::workspace::{Room, Workspace};
use crate::math::nodal::{Nodal, add_columns, dot, end, scaled};
use crate::math::prediction::value_and_slope;
use crate::math::roots;
use crate::math::simd::{Separate, Simd};
use crate::model::Model;
use crate::state::State;

/// Where in a step the contact begins or ceases to slip.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Change {
    /// After its start, s.
    pub(crate) at: f64,
    /// From then on.
    phase: Phase,
    /// Slope there of what [`Integration::beyond`] gives, N/s.
    slope: f64,
}

impl Integration<'_> {
    /// Friction at the end of a step of `length` seconds that has been taken, in the phase in which it began.
    pub(crate) fn follow_friction<const S: usize>(&mut self, length: f64)
    where
        Workspace: Room<S>,
    {
        let Self { model, state, .. } = self;
        let Some(friction) = model.friction() else {
            return;
        };
        let (cache, ends, _) = Room::<S>::parts(self.workspace);
        let (collocation, nodes) = (cache.collocation(), &ends.tangential);
        let start = state.tangential;
        let forces = nodes.forces.map(|force| friction.preload + force);
        let slips = difference(&nodes.displacements, &nodes.deflections);
        let mut dissipated = [start.dissipated; S];
        if let Some(integrals) = collocation.shapes.integrals.first() {
            let mut powers = nodes.slip_rates;
            for (power, force) in powers.iter_mut().zip(&forces) {
                *power *= -length * force;
            }
            add_columns::<S, Separate>(&mut dissipated, &integrals.nodal, &powers);
        }
        if let Some((read, dense)) = &mut self.dense
            && state.time > *read
        {
            dense.friction.slip = collocation.through(model.simd, start.slip, &slips);
            dense.friction.dissipated = collocation.through(model.simd, start.dissipated, &dissipated);
        }
        let tangential = &mut state.tangential;
        tangential.course = collocation.through(model.simd, start.force, &forces);
        (tangential.displacement, tangential.rate) = friction.motion(&state.modes, model.modes.len());
        if !state.closed {
            tangential.slip = tangential.displacement;
        } else if start.phase.sign().is_some() {
            tangential.slip = tangential.displacement - end(&nodes.deflections);
            tangential.distance += (tangential.slip - start.slip).abs();
            tangential.dissipated = start.dissipated.max(end(&dissipated));
        }
        state.tangential.force = model.friction_force(state);
    }

    /// Where in the trial of `length` seconds the contact first begins or ceases to slip.
    pub(crate) fn slip_change<const S: usize>(&mut self, trial: &Trial<S>, length: f64) -> Option<Change>
    where
        Workspace: Room<S>,
    {
        let (model, state) = (self.model, &*self.state);
        let friction = model.friction().filter(|_| self.changes <= MOST_CHANGES)?;
        let (cache, ends, _) = Room::<S>::parts(self.workspace);
        let (collocation, nodes) = (cache.collocation(), &ends.tangential);
        let start = state.tangential;
        let allowed = LOCATED * self.allowed;
        let unsure = || allowed.max(rounding(model, friction, state));
        let first = |start: f64, values: &Nodal<S>| passage((collocation, model.simd), start, values, unsure);
        let damping = model.law.damping();
        let ((y, slope), phase) = if let Some(sign) = start.phase.sign() {
            // The friction force that is missing for the slip velocity.
            let stiffness = friction.ratio * model.law.tangent_stiffness(model.force_scale);
            let wrong = scaled(&nodes.slip_rates, sign * stiffness * (damping + length));
            let before = match model.law.power() {
                // As a jump of the contact force has left it.
                Some(law) if damping > 0.0 => {
                    let across = (model.preload.indentation + state.indentation, state.indentation_rate);
                    let turned = friction.turned(law, sign, across, (start.deflection(), start.rate));
                    stiffness * (1.0 + length / damping) * turned
                }
                _ => dot::<S, Separate>(&wrong, &collocation.at_start),
            };
            let (y, slope) = first(before.min(0.0), &wrong)?;
            ((y, slope * damping / (damping + length)), Phase::Stick)
        } else {
            let [back, forth] = [1.0, -1.0].map(|sign| {
                let excess = |friction_force: f64, force: f64| sign * friction_force - friction.coefficient * force;
                let mut values = nodes.forces;
                for (value, force) in values.iter_mut().zip(&trial.forces) {
                    *value = excess(friction.preload + *value, model.preload.force + force);
                }
                first(excess(start.force, state.force), &values).map(|found| (found, Phase::slip(sign)))
            });
            match (back, forth) {
                (Some(back), Some(forth)) if forth.0.0 < back.0.0 => forth,
                (Some(back), _) => back,
                (None, forth) => forth?,
            }
        };
        let at = (1.0 + y) * length;
        Some(Change {
            at: if at <= self.resolution() { 0.0 } else { at },
            phase,
            slope: slope / length,
        })
    }

    /// Whether the trial may end at a change inside. No blow follows.
    pub(crate) fn may_change_inside<const S: usize>(&self, trial: &Trial<S>, target: &Target) -> bool {
        INHERITED * trial.inner_error.total <= self.allowed.max(trial.rounding) || self.is_shortest(target)
    }

    /// The end of the trial of `length` seconds at a change: on the polynomials, then on the exact motion under them, as what
    /// is missing there would stay in the tangential spring.
    pub(crate) fn cut_at_change<const S: usize>(&mut self, trial: &Trial<S>, length: f64, change: &Change) -> Cut
    where
        Workspace: Room<S>,
    {
        let beyond = |integration: &mut Self, now: &Instant| integration.beyond::<S>(now, length, change.phase);
        let (before, guess) = ((0.0, -f64::MIN_POSITIVE), (change.at, change.slope));
        // Without a damper there is no such force for the slip velocity, nor a slope.
        let end = if change.at > 0.0 && change.slope > 0.0 {
            self.refined(trial, length, beyond, before, guess, length, self.allowed)
        } else {
            self.inside(trial, length, change.at)
        };
        Cut {
            slides: Some(change.phase),
            ..self.cut(end, false)
        }
    }

    /// How far the contact is beyond the change to a phase, at the instant looked at last in a trial of `length` seconds, N:
    /// the trial force beyond the limit, or the friction force that the slip velocity takes.
    fn beyond<const S: usize>(&mut self, end: &Instant, length: f64, phase: Phase) -> f64
    where
        Workspace: Room<S>,
    {
        let (model, state) = (self.model, &*self.state);
        let (Some(friction), Some(law)) = (model.friction(), model.law.power()) else {
            return 0.0;
        };
        let (cache, ends, inside) = Room::<S>::parts(self.workspace);
        let (displacement, rate) = friction.motion(inside, model.modes.len());
        let d = model.preload.indentation + end.d;
        let start = &state.tangential;
        if let Some(sign) = start.phase.sign() {
            let deflections = &ends.tangential.deflections;
            let course = cache.collocation().through(model.simd, start.deflection(), deflections);
            let z = value_and_slope(&course, end.at / length - 1.0).0;
            friction.ratio * law.tangent_stiffness(d) * friction.turned(law, sign, (d, end.rate), (z, rate))
        } else {
            let trial = friction.trial(law, d, displacement - start.slip, rate).force;
            phase.sign().unwrap_or_default() * trial - friction.coefficient * law.closed_branch(d, end.rate).force
        }
    }

    /// Begins or ends slip at the instant of the state. The slope of the friction force jumps, and the spring answers as
    /// steeply as its highest modes do: the next step is as long as the last one after such a change.
    pub(crate) fn change_phase(&mut self, phase: Phase) {
        let before = self.state.tangential.phase.sign();
        let (model, state) = (self.model, &mut *self.state);
        if let (Some(friction), Some(law), Some(sign)) = (model.friction(), model.law.power(), phase.sign().or(before))
        {
            // The trial force is the limit, to the last digit.
            let d = model.preload.indentation + state.indentation;
            let limit = friction.limit_deflection(law, sign, d, state.indentation_rate);
            let lag = law.damping * state.tangential.rate;
            state.tangential.slip = state.tangential.displacement - (limit - lag);
        }
        state.tangential.phase = phase;
        state.tangential.force = model.friction_force(state);
        state.last_kink = state.time;
        state.tangential.last_change = Some(state.time);
        let first = *state.tangential.first_step();
        let length = if first > 0.0 {
            first
        } else {
            0.1 * model.first_step(state.time)
        };
        state.long_step = state.long_step.min(length);
        state.short_step = state.short_step.min(length / WORTH);
    }

    /// Whether the contact begins or ceases to slip at the start of the next step.
    pub(crate) fn changes_now(&self) -> bool {
        self.model.friction().is_some() && self.state.tangential.last_change == Some(self.state.time)
    }

    /// Keeps the length (s) of a step about to be taken, if it is the first one after a change, with the factor that its error
    /// would have allowed.
    pub(crate) fn keep_first_step<const S: usize>(&mut self, length: f64, ratio: f64) {
        if !self.changes_now() {
            return;
        }
        *self.state.tangential.first_step() = length * growth::<S>(ratio).clamp(MOST_SHRINK, 1.0 / MOST_SHRINK);
    }
}

impl Model {
    /// Sets friction force and phase as they follow from the motion: after a jump, a closing, or in another phase than
    /// before.
    pub fn settle_friction(&self, state: &mut State) {
        let (Some(friction), Some(law)) = (self.friction(), self.law.power()) else {
            return;
        };
        let tangential = &mut state.tangential;
        if !state.closed {
            (tangential.force, tangential.slip, tangential.phase) = (0.0, tangential.displacement, Phase::Stick);
            return;
        }
        let d = self.preload.indentation + state.indentation;
        let trial = friction.trial(law, d, tangential.deflection(), tangential.rate).force;
        let limit = friction.coefficient * state.force;
        // As it closes both are zero: what they begin with decides.
        let closes = state.force <= 0.0;
        let slips = if closes {
            let slide = if law.damping > 0.0 { 1.0 } else { law.exponent };
            slide * friction.ratio * tangential.rate.abs() > friction.coefficient * state.indentation_rate.abs()
        } else {
            trial.abs() > limit
        };
        if slips {
            let against = if closes { -tangential.rate } else { trial };
            tangential.phase = Phase::slip(against);
            tangential.force = limit.copysign(against);
            if law.damping == 0.0 {
                tangential.slip = tangential.displacement - friction.limit_deflection(law, against.signum(), d, 0.0);
            }
        } else {
            tangential.phase = Phase::Stick;
            tangential.force = trial;
        }
    }

    /// The friction force of the phase of a state at its motion, N.
    pub(crate) fn friction_force(&self, state: &State) -> f64 {
        let (Some(friction), Some(law)) = (self.friction(), self.law.power()) else {
            return 0.0;
        };
        let tangential = state.tangential;
        match tangential.phase.sign() {
            _ if !state.closed => 0.0,
            Some(sign) => sign * friction.coefficient * state.force,
            None => {
                let d = self.preload.indentation + state.indentation;
                friction.trial(law, d, tangential.deflection(), tangential.rate).force
            }
        }
    }
}

/// Rounding of the trial force and of the limit by the sums over the modes, N.
fn rounding(model: &Model, friction: &Friction, state: &State) -> f64 {
    let (displacement, velocity) = sum_rounding(friction.levers.iter().copied(), state);
    let slip = SUM_ROUNDINGS * f64::EPSILON * state.tangential.slip.abs();
    let along = slip + displacement + model.law.damping() * velocity;
    let stiffness = model.law.stiffness(model.preload.indentation + state.indentation);
    stiffness * (friction.ratio * along + friction.coefficient * motion_rounding(model, state))
}

/// Where the polynomial through `start` and the nodal values first exceeds zero by more than `unsure`: where it passes zero
/// before, relative to the end of the step in step lengths, and the slope there.
fn passage<const S: usize>(
    (collocation, simd): (&Collocation<S>, Simd),
    start: f64,
    values: &Nodal<S>,
    unsure: impl Fn() -> f64,
) -> Option<(f64, f64)> {
    if !Collocation::comes_near_zero(-start, &scaled(values, -1.0)) {
        return None;
    }
    let polynomial = collocation.through(simd, start, values);
    let value = |y: f64| value_and_slope(&polynomial, y).0;
    let mut before = (-1.0, start);
    for y in turning_points(&polynomial).iter().chain([0.0]) {
        let now = (y, value(y));
        if now.1 > 0.0 && now.1 > unsure() {
            let y = roots::between(value, before, now, 1e-12).unwrap_or(before.0);
            return Some((y, value_and_slope(&polynomial, y).1));
        }
        before = now;
    }
    None
}

/// `a - b`.
fn difference<const S: usize>(a: &Nodal<S>, b: &Nodal<S>) -> Nodal<S> {
    let mut a = *a;
    for (a, b) in a.iter_mut().zip(b) {
        *a -= b;
    }
    a
}
