//! Event location of opening: the instant within a step at which the contact force reaches zero.

use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::step::Trial;
use crate::integrator::events::Cut;
use crate::integrator::integration::Integration;
use crate::integrator::workspace::{Room, Workspace};

impl Integration<'_> {
    /// Locates the opening in the trial of `length` seconds, suspected within its first `latest` seconds; `None` if the
    /// step need not be shortened.
    pub(crate) fn opening<const S: usize>(&mut self, trial: &Trial<S>, length: f64, latest: f64) -> Option<Cut>
    where
        Workspace: Room<S>,
    {
        let model = self.model;
        let engagement = |d, rate| model.engagement(d, rate);
        // Closed at the start; just after first touch rounding may give a negative engagement.
        let start = engagement(self.state.indentation, self.state.indentation_rate).max(f64::MIN_POSITIVE);
        let rounding = self.located();
        let end = self.instant(trial, length, engagement, (0.0, start), latest, rounding);
        // Else the polynomial dips below zero, the force does not: the next step starts here, where it is lowest.
        let switches = end.at < latest || engagement(end.d, end.rate) <= rounding;
        (switches || latest < length).then(|| self.cut(end, switches))
    }

    /// Where in the step the contact may first open, 0 to 1: a node or the end where it is open, or a place between
    /// nodes where the force polynomial is below zero.
    pub(crate) fn first_open<const S: usize>(&mut self, trial: &Trial<S>) -> Option<f64>
    where
        Workspace: Room<S>,
    {
        let preload = self.model.preload;
        let model = self.model;
        let traces = model.law.traces();
        let start = self.state.force + traces;
        let collocation = self.collocation::<S>();
        let open = |d: f64, rate: f64| model.engagement(d, rate) <= 0.0;
        let node = collocation
            .nodes
            .iter()
            .zip(trial.indentations.iter().zip(&trial.rates))
            .find(|(_, (d, rate))| open(**d, **rate))
            .map(|(node, _)| *node);
        let sure = node.or_else(|| open(trial.indentation, trial.rate).then_some(1.0));

        let forces = trial.forces.map(|force| preload.force + traces + force);
        if sure.is_none() && (model.law.never_opens() || !Collocation::comes_near_zero(start, &forces)) {
            return None;
        }
        collocation.first_dip(&forces, sure.unwrap_or(f64::INFINITY)).or(sure)
    }
}
