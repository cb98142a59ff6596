//! Event location of opening: the instant within a step at which the force of a contact reaches zero.

use crate::integrator::collocation::part::Whole;
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::events::{Cut, Event, Locator};

impl<const S: usize> Locator<'_, S> {
    /// Locates the opening of a contact suspected within the first part `latest` of the trial; `None` if the step need not be
    /// shortened.
    pub(crate) fn opening(&mut self, index: usize, latest: f64) -> Option<Cut> {
        let (link, at) = self.link(index)?;
        let Whole { length, state, .. } = self.whole;
        let latest = latest * length;
        let engagement = |d, rate| link.engagement(d, rate);
        // Closed at the start; just after first touch rounding may give a negative engagement.
        let start = engagement(at.approach, at.rate).max(f64::MIN_POSITIVE);
        let rounding = self.located((link, at));
        let end = self.instant(index, engagement, (0.0, start), latest, rounding);
        // Else the polynomial dips below zero, the force does not: the next step starts here, where it is lowest.
        let opens = end.at < latest || engagement(end.d, end.rate) <= rounding;
        (opens || latest < length).then_some(Cut {
            at: end.at,
            time: state.time + end.at,
            event: if opens { Event::Switches(index) } else { Event::Bends },
        })
    }

    /// Where in the step a contact may first open, 0 to 1: a node or the end where it is open, or a place between
    /// nodes where the force polynomial is below zero.
    pub(crate) fn first_open(&self, index: usize) -> Option<f64> {
        let (link, at) = self.link(index)?;
        let Whole { collocation, trial, .. } = self.whole;
        let nodes = trial.links.get(index)?;
        let law = link.contact()?;
        let traces = law.traces;
        let open = |d: f64, rate: f64| link.engagement(d, rate) <= 0.0;
        let motion = nodes.approaches.iter().zip(&nodes.rates);
        let node = collocation.nodes.iter().zip(motion).find(|(_, (d, rate))| open(**d, **rate)).map(|(node, _)| *node);
        let sure = node.or_else(|| open(nodes.end.approach, nodes.end.rate).then_some(1.0));

        let forces = nodes.forces.map(|force| link.force + traces + force);
        let near = || Collocation::comes_near_zero(at.force + traces, &forces);
        if sure.is_none() && (law.never_opens() || !near()) {
            return None;
        }
        collocation.first_dip(&forces, sure.unwrap_or(f64::INFINITY)).or(sure)
    }
}
