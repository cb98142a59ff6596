//! Event location of a gap: the instant at which an armature that has left its core is no longer indented, from which on the force of the
//! magnet falls.

use crate::integrator::collocation::newton::indented;
use crate::integrator::events::{Cut, Event, Locator};

impl<const S: usize> Locator<'_, S> {
    /// Where a magnet without a gap has one at the end of the trial, while the core does not hold its armature.
    pub(crate) fn gap(&mut self, index: usize) -> Option<Cut> {
        let (model, state, length) = (self.whole.model, self.whole.state, self.whole.length);
        let (link, at) = self.link(index)?;
        let unsure = indented(model, state, index)?;
        let gap = |deviation: f64, _: f64| link.approach + deviation;
        if model.is_on_core(state) || gap(self.whole.trial.links.get(index)?.end.approach, 0.0) <= 0.0 {
            return None;
        }
        let end = self.instant(index, gap, (0.0, gap(at.approach, 0.0)), length, unsure);
        Some(Cut { at: end.at, time: state.time + end.at, event: Event::Bends })
    }
}
