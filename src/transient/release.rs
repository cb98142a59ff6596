//! The contact opens: the instant within a step at which the force reaches zero.

use crate::math::roots;
use crate::transient::advance::{Cut, Integration, Room, Workspace};
use crate::transient::nodal::Trial;

/// Points at which the force polynomial is looked at where it comes near zero.
const LOOKS: u32 = 32;

impl Integration<'_> {
    /// Where the step of `length` seconds has to end because the contact opens, which it has done after `latest` seconds
    /// if it does at all.
    pub(super) fn release<const S: usize>(&mut self, latest: f64, length: f64) -> Option<Cut>
    where
        Workspace: Room<S>,
    {
        let end = self.probe::<S>(latest);
        if end.is_some_and(|end| self.model.engagement(end.indentation, end.rate) > 0.0) {
            // The polynomial dips below zero, the force does not: the next step starts here, where it is lowest.
            return (latest < length).then_some(Cut {
                length: latest,
                switches: false,
            });
        }
        let start = self
            .model
            .engagement(self.state.indentation, self.state.indentation_rate);
        let engagement = |at: f64| {
            if at > 0.0 {
                self.probe::<S>(at)
                    .map_or(f64::NAN, |trial| self.model.engagement(trial.indentation, trial.rate))
            } else {
                // The contact is closed there; just after a touch rounding could hide it.
                start.max(f64::MIN_POSITIVE)
            }
        };
        let length = roots::bracketed(engagement, 0.0, latest).unwrap_or(latest);
        Some(Cut { length, switches: true })
    }

    /// Where in the step (in steps) the contact first looks open: a node or the end with no force left, or a place where
    /// the polynomial through the nodes dips below zero between them.
    pub(super) fn first_open<const S: usize>(&mut self, trial: &Trial<S>) -> Option<f64>
    where
        Workspace: Room<S>,
    {
        let preload = self.model.preload;
        let model = self.model;
        let highest = self.state.force;
        let collocation = self.collocation::<S>();
        let open = |d: f64, rate: f64| model.engagement(d, rate) <= 0.0;
        let node = collocation
            .nodes
            .iter()
            .zip(trial.indentations.iter().zip(&trial.rates))
            .find(|(_, (d, rate))| open(**d, **rate))
            .map(|(node, _)| *node);
        let sure = node.or_else(|| open(trial.indentation, trial.rate).then_some(1.0));

        let forces = trial.forces.map(|force| preload.force + force);
        let lowest = forces.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = forces.iter().copied().fold(highest, f64::max);
        if sure.is_none() && (lowest > 0.25 * highest || model.law.never_opens()) {
            return None;
        }
        let dip = (1..LOOKS)
            .map(|k| f64::from(k) / f64::from(LOOKS))
            .take_while(|x| sure.is_none_or(|sure| *x < sure))
            .find(|x| collocation.interpolate(&forces, *x) < 0.0);
        dip.or(sure)
    }
}
