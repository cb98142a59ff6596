//! Event location of a gap: the instant at which an armature that has left its core is no longer indented, from which on the force of the
//! magnet falls.

use crate::integrator::collocation::newton::indented;
use crate::integrator::events::{Cut, Event, Locator};

impl<const S: usize> Locator<'_, S> {
    /// Where a magnet without a gap first has one in the trial, while the core does not hold its armature.
    pub(crate) fn gap(&mut self, index: usize) -> Option<Cut> {
        let (model, state) = (self.whole.model, self.whole.state);
        let (link, at) = self.link(index)?;
        let unsure = indented(model, state, index)?;
        if model.is_on_core(state) {
            return None;
        }
        let gap = |deviation: f64, _: f64| link.approach + deviation;
        let latest = self.apart(index, |deviation| gap(deviation, 0.0) > unsure)?;
        let end = self.instant(index, gap, (0.0, gap(at.approach, 0.0)), latest, unsure);
        Some(Cut { at: end.at, time: state.time + end.at, event: Event::Bends })
    }

    /// An instant at which there is a gap: a node, the end, or where the armature turns back between them.
    fn apart(&mut self, index: usize, is_gap: impl Fn(f64) -> bool) -> Option<f64> {
        let (length, nodes) = (self.whole.length, self.whole.trial.links.get(index)?);
        let (_, start) = self.link(index)?;
        let motion = nodes.approaches.iter().zip(&nodes.rates);
        let inner = self.whole.collocation.nodes.iter().zip(motion).map(|(node, (&d, &rate))| (node * length, d, rate));
        let end = (length, nodes.end.approach, nodes.end.rate);
        let mut from = (0.0, start.rate);
        for (at, d, rate) in inner.chain([end]) {
            if is_gap(d) {
                return Some(at);
            }
            if from.1 > 0.0 && rate <= 0.0 {
                let top = self.instant(index, |_, rate| rate, from, at, 0.0);
                if is_gap(top.d) {
                    return Some(top.at);
                }
            }
            from = (at, rate);
        }
        None
    }
}
