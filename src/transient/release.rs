//! The contact opens: the instant within a step at which the force reaches zero.

use crate::model::{Model, State};
use crate::transient::collocation::Collocation;
use crate::transient::nodal::Trial;

/// Points at which the force polynomial is looked at where it comes near zero.
const LOOKS: u32 = 32;

impl Model {
    /// `g = d + (3/2) beta_c d'` at the end of the trial, m: negative once the contact has opened.
    pub fn engagement(&self, trial: &Trial) -> f64 {
        self.hertz
            .engagement(self.preload.indentation + trial.indentation, trial.rate)
    }

    /// Where in the step (in steps) the contact first looks open: a node or the end with no force left, or a place where
    /// the polynomial through the nodes dips below zero between them.
    pub fn first_open(&self, state: &State, trial: &Trial, collocation: &Collocation) -> Option<f64> {
        let d0 = self.preload.indentation;
        let open = |d: &f64, rate: &f64| self.hertz.engagement(d0 + d, *rate) <= 0.0 || d0 + d <= 0.0;
        let nodes = collocation
            .nodes
            .iter()
            .zip(trial.indentations.iter().zip(&trial.rates));
        let node = nodes
            .clone()
            .find(|(_, (d, rate))| open(d, rate))
            .map(|(node, _)| *node);
        let sure = node.or_else(|| open(&trial.indentation, &trial.rate).then_some(1.0));

        let lowest = trial.forces.iter().fold(f64::INFINITY, |low, force| low.min(*force)) + self.preload.force;
        let highest = trial
            .forces
            .iter()
            .fold(state.force, |high, force| high.max(force + self.preload.force));
        if sure.is_none() && lowest > 0.25 * highest {
            return None;
        }
        let dip = (1..LOOKS)
            .map(|k| f64::from(k) / f64::from(LOOKS))
            .take_while(|x| sure.is_none_or(|sure| *x < sure))
            .find(|x| self.preload.force + collocation.interpolate(&trial.forces, *x) < 0.0);
        dip.or(sure)
    }
}
