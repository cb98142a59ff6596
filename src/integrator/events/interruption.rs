//! Event location of interruptions: where a contact force passes that of the threshold resistance within a step. The
//! step goes on.

use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::shapes::Variable;
use crate::integrator::course::{Places, turning_points};
use crate::integrator::events::Locator;
use crate::link::MAX_LINKS;
use crate::math::prediction::{value_and_slope, value_at};
use crate::math::roots;

/// Where in a step the forces of the links pass those of interruptions.
pub(crate) type Passages = [Places; MAX_LINKS];

impl<const S: usize> Locator<'_, S> {
    /// Finds where in the trial the forces of closed contacts pass those of interruptions; `false` where the step is too long to
    /// tell, unless it `must` be told.
    pub(crate) fn find_passages(&mut self, must: bool, passages: &mut Passages) -> bool {
        let count = self.whole.model.links.len();
        let mut links = passages.iter_mut().take(count).enumerate();
        links.all(|(index, places)| self.add_passages(index, must, places))
    }

    /// The force polynomial is monotone between the places where it turns, so that a dip of any length is found. Where it
    /// is not accurate, the law gives the force at the exact motion under it.
    fn add_passages(&mut self, index: usize, must: bool, passages: &mut Places) -> bool {
        let whole = self.whole;
        let Some((link, start)) = self.link(index).filter(|(_, start)| start.closed) else { return true };
        let (Some(criterion), Some(law), Some(nodes)) = (&link.criterion, link.contact(), whole.trial.links.get(index))
        else {
            return true;
        };
        let mut interrupted = whole.state.circuits.is_interrupted(index);
        let excess = |force: f64| link.force + force - criterion.force;
        let at_start = start.force - link.force;
        let ahead = |force: f64| if interrupted { -excess(force) } else { excess(force) };
        if !Collocation::comes_near_zero(ahead(at_start), &nodes.forces.map(ahead)) {
            return true;
        }
        let polynomial = whole.collocation.through(whole.model.simd, at_start, &nodes.forces);
        let value = |y: f64| excess(value_at(&polynomial, y));
        let turns = turning_points(whole.model.simd, &polynomial);
        let allowed = whole.readable();
        let inaccuracy = whole.inaccuracy_of_forces(allowed);
        let is_accurate = inaccuracy <= 1.0;
        if !is_accurate && whole.collocation.variable == Variable::Root {
            return false;
        }
        let unsure = inaccuracy * allowed;
        if !is_accurate && !must && turns.iter().any(|y| value(y).abs() < unsure) {
            return false;
        }
        let end = law.without_pull(link.force + nodes.end.force) < criterion.force;
        let mut before = (-1.0, value(-1.0));
        for (y, is_end) in turns.iter().map(|y| (y, false)).chain([(0.0, true)]) {
            let now = (y, value(y));
            let below = if is_end { end } else { now.1 < 0.0 };
            if below != interrupted {
                let place = if is_accurate {
                    // Only rounding leaves both on one side.
                    let course = |y: f64| {
                        let (force, slope) = value_and_slope(&polynomial, y);
                        (excess(force), slope)
                    };
                    if (before.1 < 0.0) == (now.1 < 0.0) {
                        if (now.1 < 0.0) == below { before.0 } else { y }
                    } else {
                        roots::newton(course, before, now, 1e-12)
                    }
                } else {
                    let force = |d, rate| link.force_at(d, rate) - criterion.force;
                    let from = ((1.0 + before.0) * whole.length, before.1);
                    let rounding = whole.model.tolerance.at_event;
                    let found = self.instant(index, force, from, (1.0 + y) * whole.length, rounding);
                    found.at / whole.length - 1.0
                };
                let [part] = whole.collocation.variable.times(&[1.0 + place.clamp(before.0, y)]);
                passages.push(part - 1.0);
                interrupted = below;
            }
            before = now;
        }
        true
    }
}
