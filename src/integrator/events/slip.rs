//! Event location of slip: where the contact begins or ceases to slip. A step ends there.
//!
//! While the contact sticks, the friction force of the step is the trial force, and slip begins where it exceeds the limit,
//! `mu` times the contact force, by either sign. While it slips, it sticks again where the slip velocity would turn. Both
//! are polynomials through the nodes; between the places where they turn they are monotone, so that nothing is missed.

use crate::contact::friction::{Friction, Phase};
use crate::contact::law::Law;
use crate::integrator::collocation::part::{Instant, Whole};
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::slip::is_long;
use crate::integrator::constants::MOTION_ROUNDING;
use crate::integrator::course::turning_points;
use crate::integrator::events::{Cut, Event, Locator, engagement_rounding};
use crate::integrator::rounding::motion_rounding;
use crate::link::{CONTACT, Link};
use crate::math::nodal::{dot, scaled};
use crate::math::prediction::{value_and_slope, value_at};
use crate::math::roots;
use crate::math::simd::{Separate, Simd};
use crate::state::LinkState;

/// Where in a step the contact begins or ceases to slip.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Change {
    /// After its start, s.
    pub(crate) at: f64,
    /// From then on.
    phase: Phase,
    /// Slope there of what passes zero, N/s.
    slope: f64,
}

/// A contact that rubs.
struct Rubbing<'a> {
    contact: (&'a Link, &'a LinkState),
    along: (&'a Link, &'a LinkState),
    index: usize,
    friction: &'a Friction,
    law: &'a Law,
}

impl<'a, const S: usize> Locator<'a, S> {
    fn rubbing(&self) -> Option<Rubbing<'a>> {
        let (index, friction) = self.whole.model.friction()?;
        let contact = self.link(CONTACT)?;
        Some(Rubbing { contact, along: self.link(index)?, index, friction, law: contact.0.contact()? })
    }

    fn is_damped(&self) -> bool {
        self.rubbing().is_some_and(|rubbing| rubbing.law.damping > 0.0)
    }

    /// Where in the trial the contact first begins or ceases to slip.
    pub(crate) fn slip_change(&mut self) -> Option<Change> {
        let Rubbing { contact: (contact, contact_at), along: (along, along_at), index, friction, law } =
            self.rubbing()?;
        let whole = self.whole;
        let (normal, nodes) = whole.trial.links.get(CONTACT).zip(whole.trial.links.get(index))?;
        let z = -along_at.approach - whole.state.slip.way;
        let mut first = |start: f64, values: &[f64; S], beside: &dyn Fn(f64) -> f64, phase: Phase| {
            let exceeds = |y: f64, value: f64| self.is_beyond((1.0 + y) * whole.length, value, phase);
            passage((whole.collocation, whole.model.simd), start, values, beside, exceeds)
        };
        let ((y, slope), phase) = if let Some(sign) = whole.state.slip.phase.sign() {
            // The friction force that is missing for the slip velocity.
            let damping = law.damping;
            let stiffness = friction.ratio * law.firm;
            let per_velocity = sign * stiffness * (damping + whole.length);
            let wrong = scaled(&whole.trial.slip.rates, per_velocity);
            let fades = |y: f64| per_velocity * whole.trial.slip.fading_rate((1.0 + y) * whole.length, damping);
            let before = if is_long::<S>(whole.length, damping) {
                dot::<S, Separate>(&wrong, &whole.collocation.at_start)
            } else {
                // As a jump of the contact force has left it.
                let across = (contact.approach + contact_at.approach, contact_at.rate);
                let turned = friction.turned(law, sign, across, (z, -along_at.rate));
                (stiffness * (1.0 + whole.length / damping) * turned).min(0.0)
            };
            (first(before, &wrong, &fades, Phase::Stick)?, Phase::Stick)
        } else {
            let [back, forth] = [1.0, -1.0].map(|sign| {
                let phase = Phase::slip(sign);
                let excess = |along: f64, force: f64| sign * along - friction.coefficient * force;
                let mut values = nodes.forces;
                for (value, force) in values.iter_mut().zip(&normal.forces) {
                    *value = excess(along.force + *value, contact.force + force);
                }
                let before = excess(along_at.force, contact_at.force);
                first(before, &values, &|_| 0.0, phase).map(|found| (found, phase))
            });
            match (back, forth) {
                (Some(back), Some(forth)) if forth.0.0 < back.0.0 => forth,
                (Some(back), _) => back,
                (None, forth) => forth?,
            }
        };
        let at = (1.0 + y) * whole.length;
        Some(Change { at: if at <= self.resolution { 0.0 } else { at }, phase, slope: slope / whole.length })
    }

    /// The end of the trial at a change: on the polynomials; without a damper as it begins to slip then on the exact motion under them, as
    /// what is missing there would stay in the tangential spring. With one what the polynomials miss would be made many times larger:
    /// their forces answer to it at the nodes alone.
    pub(crate) fn cut_at_change(&mut self, change: &Change) -> Cut {
        let (mut at, mut event) = (change.at, Event::Slides(change.phase));
        if change.at > 0.0 && change.slope > 0.0 && change.phase != Phase::Stick && !self.is_damped() {
            let beyond = |this: &Self, now: &Instant| this.beyond(now, change.phase);
            let (before, guess) = ((0.0, -f64::MIN_POSITIVE), (change.at, change.slope));
            let (latest, allowed) = (self.whole.length, self.whole.model.tolerance.step);
            let end = self.refined(CONTACT, beyond, before, guess, latest, allowed);
            at = end.at;
            // Else it changes after the trial: the next step starts here.
            if end.at >= latest && beyond(self, &end) < -allowed {
                event = Event::Bends;
            }
        }
        Cut { at, time: self.whole.state.time + at, event }
    }

    /// Whether the contact is beyond the change to a phase `at` seconds after the start, where the polynomial has this value (N): more
    /// than it is sure of, and on the exact motion, as just behind its start it may overshoot. Without a damper there is no such
    /// force for the slip velocity.
    fn is_beyond(&mut self, at: f64, value: f64, phase: Phase) -> bool {
        let rounding = self.slip_rounding();
        if value <= rounding.max(self.whole.model.tolerance.at_event) {
            return false;
        }
        if phase == Phase::Stick && !self.is_damped() {
            return true;
        }
        let now = self.inside(CONTACT, at);
        self.beyond(&now, phase) > rounding
    }

    /// How far the contact is beyond the change to a phase, at the instant looked at last, N: the trial force beyond the limit, or
    /// the friction force that the slip velocity takes.
    fn beyond(&self, end: &Instant, phase: Phase) -> f64 {
        let Some(rubbing) = self.rubbing() else { return 0.0 };
        let Rubbing { contact: (contact, _), along: (_, along_at), index, friction, law } = rubbing;
        let whole = self.whole;
        let along = self.whole.link(index, end.at, &self.search.modes);
        let d = contact.approach + end.d;
        if let Some(sign) = whole.state.slip.phase.sign() {
            let slip = &whole.trial.slip;
            let start = -along_at.approach - whole.state.slip.way - slip.fading;
            let course = whole.collocation.through(whole.model.simd, start, &slip.deflections);
            let z = value_at(&course, end.at / whole.length - 1.0) + slip.left(end.at, law.damping);
            friction.ratio * law.stiffness(d) * friction.turned(law, sign, (d, end.rate), (z, -along.rate))
        } else {
            let stick = friction.trial(law, d, -along.d - whole.state.slip.way, -along.rate);
            let limit = friction.coefficient * law.closed_branch(d, end.rate).force;
            phase.sign().unwrap_or_default() * stick.force - limit
        }
    }

    /// Rounding of the trial force and of the limit, N.
    fn slip_rounding(&self) -> f64 {
        let Whole { model, state, .. } = self.whole;
        let Some(Rubbing { contact: (contact, contact_at), along, friction, law, .. }) = self.rubbing() else {
            return 0.0;
        };
        let (displacement, velocity) = motion_rounding(model, along, state);
        let slip = MOTION_ROUNDING * state.slip.way.abs();
        let moved = slip + displacement + law.damping * velocity;
        let stiffness = law.stiffness(contact.approach + contact_at.approach);
        let engagement = engagement_rounding(model, (contact, contact_at), state);
        stiffness * (friction.ratio * moved + friction.coefficient * engagement)
    }
}

/// Where the polynomial through `start` and the nodal values, with what there is `beside` it, passes zero before it first `exceeds` it, as
/// is asked where the polynomial turns and at the end: relative to the end of the step in step lengths, and the slope of the polynomial
/// there.
fn passage<const S: usize>(
    (collocation, simd): (&Collocation<S>, Simd),
    start: f64,
    values: &[f64; S],
    beside: &dyn Fn(f64) -> f64,
    mut exceeds: impl FnMut(f64, f64) -> bool,
) -> Option<(f64, f64)> {
    let mut before = (-1.0, start + beside(-1.0));
    let mut nodal = scaled(values, -1.0);
    for (value, node) in nodal.iter_mut().zip(&collocation.nodes) {
        *value -= beside(node - 1.0);
    }
    if !Collocation::comes_near_zero(-before.1, &nodal) {
        return None;
    }
    let polynomial = collocation.through(simd, start, values);
    let value = |y: f64| value_at(&polynomial, y) + beside(y);
    for y in turning_points(simd, &polynomial).iter().chain([0.0]) {
        let now = (y, value(y));
        if now.1 > 0.0 && exceeds(y, now.1) {
            let y = roots::between(value, before, now, 1e-12).unwrap_or(before.0);
            return Some((y, value_and_slope(&polynomial, y).1));
        }
        before = (y, now.1.min(0.0));
    }
    None
}
