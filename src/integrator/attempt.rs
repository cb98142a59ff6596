//! A step on trial, and whether its error is one that a step may have.

use crate::integrator::budget::work;
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::step::{Source, Trial};
use crate::integrator::grid::Target;
use crate::integrator::step_control::Integration;
use crate::integrator::workspace::{Room, Workspace};
use crate::math::nodal::SHORT;

/// Error of the contact force within a step, per force that its polynomial misses at the start.
pub(crate) const INSIDE: f64 = 0.3;

/// Largest difference that Newton's method leaves between a nodal force and that of the law, in errors allowed in a
/// step.
const NEWTON: f64 = 0.2;

impl Integration<'_> {
    /// Estimated error of a trial to the target, in errors allowed; none where it is rounding, which no shorter step
    /// makes smaller.
    pub(crate) fn relative_error<const S: usize>(&self, trial: &Trial<S>, target: &Target) -> f64 {
        let looked_into = self.span.as_ref().is_some_and(|(until, _)| *until < target.time);
        // Short steps may be wrong inside: `Span::good` then keeps them from being looked into.
        let inside = if looked_into && S != SHORT {
            INSIDE / self.tolerance
        } else {
            0.0
        };
        let (ratio, inside) = (trial.error / self.allowed.max(trial.rounding), trial.missed * inside);
        // Not `max`, which would hide what is not a number.
        let ratio = if ratio < inside { inside } else { ratio };
        if ratio > 1.0 && self.model.is_rounding(self.state, trial) {
            0.0
        } else {
            ratio
        }
    }

    /// Whether a step to the target may have this error: what is allowed, and any where it cannot be shorter.
    pub(crate) fn is_acceptable(&self, ratio: f64, target: &Target) -> bool {
        ratio <= 1.0 || self.is_shortest(target) && ratio.is_finite()
    }

    /// Whether the step is as short as steps get: half of it would be too short.
    pub(crate) fn is_shortest(&self, target: &Target) -> bool {
        target.length <= 2.0 * self.shortest()
    }

    /// Length below which no step is wanted, s.
    pub(crate) fn shortest(&self) -> f64 {
        8.0 * self.resolution()
    }

    /// The step to the target, with the modes at its end kept for [`Integration::take`].
    pub(crate) fn attempt<const S: usize>(&mut self, target: &Target) -> Option<Trial<S>>
    where
        Workspace: Room<S>,
    {
        self.trial(target.length, target.recurring, true)
    }

    /// A step of `length` seconds only to be looked at.
    pub(crate) fn probe<const S: usize>(&mut self, length: f64) -> Option<Trial<S>>
    where
        Workspace: Room<S>,
    {
        self.trial(length, false, false)
    }

    /// A step of `length` seconds, whose coefficients may be wanted again (`recurring`), and the modes at its end
    /// (`kept`).
    fn trial<const S: usize>(&mut self, length: f64, recurring: bool, kept: bool) -> Option<Trial<S>>
    where
        Workspace: Room<S>,
    {
        self.workspace.work += work(recurring);
        let (cache, end, probe) = self.workspace.parts();
        let (step, collocation) = cache.get(length, recurring, self.model);
        let source = Source::Law(NEWTON * self.allowed);
        let modes = if kept { end } else { probe };
        self.model
            .trial(self.state, &self.drive, step, collocation, source, modes)
    }

    /// Difference between instants that cannot be told apart, s.
    pub(crate) fn resolution(&self) -> f64 {
        f64::EPSILON * (self.progress.start.abs() + self.progress.size)
    }

    /// The polynomials of the steps.
    pub(crate) fn collocation<const S: usize>(&mut self) -> &Collocation<S>
    where
        Workspace: Room<S>,
    {
        self.workspace.parts().0.collocation()
    }
}

/// How many times as long a step could be that is wrong by `ratio` errors allowed: the error estimate grows with the
/// power `S + 1` of the length.
pub(crate) fn reach<const S: usize>(ratio: f64) -> f64 {
    ratio.powf(-1.0 / (S as f64 + 1.0))
}
