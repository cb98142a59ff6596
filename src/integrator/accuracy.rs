//! How accurate a trial is where it is read inside.

use crate::integrator::collocation::error::of_rounding;
use crate::integrator::collocation::part::Whole;
use crate::integrator::collocation::shapes::Variable;
use crate::integrator::constants::{FORCE_ROUNDING, FREE_ROUNDING, UNSEEN_TERMS};
use crate::link::CONTACT;
use crate::math::nodal::greatest;
use crate::math::prediction::value_and_slope;

impl<const S: usize> Whole<'_, S> {
    /// Error allowed in what is read inside the trial, N: relative to the forces in it, where they are larger than the force scale. Nothing
    /// follows from what is read.
    pub(crate) fn readable(&self) -> f64 {
        let contacts = self.model.links.iter().zip(&self.state.links).zip(&self.trial.links);
        let contacts = contacts.filter(|((link, at), _)| at.closed && link.circuit.is_some());
        let largest = contacts.fold(0.0_f64, |most, ((link, at), nodes)| {
            let of_nodes = nodes.forces.iter().map(|force| (link.force + force).abs());
            of_nodes.fold(most.max(at.force.abs()), f64::max)
        });
        self.model.tolerance.read(largest)
    }

    /// Error of what is read inside the trial, in the error allowed there: of the force, in flight of the indentation.
    pub(crate) fn inaccuracy(&self) -> f64 {
        let (trial, allowed) = (self.trial, self.readable());
        if !self.state.is_closed() {
            self.misread() / allowed
        } else if self.collocation.variable == Variable::Root {
            // By the root of time the polynomial goes through the force at the start. At its first node it is as steep as the inverse
            // of a root there, beside the mean.
            let steepest = 0.5 / self.collocation.places.first().copied().unwrap_or(1.0);
            let rounding = of_rounding::<S>(self.model, self.state, trial, FREE_ROUNDING * steepest);
            (trial.next_terms - rounding).max(0.0) / allowed
        } else if UNSEEN_TERMS * trial.next_terms > allowed {
            // Only rejects: a length chosen by it would be too short by a twentieth.
            UNSEEN_TERMS * trial.next_terms / allowed
        } else {
            trial.start_defect / allowed
        }
    }

    /// Error of the indentation between the nodes of the trial as it would be read there, as the force that makes it of the spring, N.
    /// The polynomial through the indentations has slopes at the nodes that differ from the velocities there; between two nodes its
    /// error is the cubic with these slopes.
    fn misread(&self) -> f64 {
        let Self {
            model,
            collocation,
            length,
            ..
        } = *self;
        let (Some(start), Some(nodes)) = (self.state.links.get(CONTACT), self.trial.links.get(CONTACT)) else {
            return 0.0;
        };
        let polynomial = collocation.through(model.simd, start.approach, &nodes.approaches);
        let wrong = |x: f64, rate: f64| (rate * length - value_and_slope(&polynomial, x - 1.0).1).abs();
        let mut before = (0.0, wrong(0.0, start.rate));
        let mut most = 0.0_f64;
        for (x, rate) in collocation.nodes.iter().zip(&nodes.rates) {
            let now = (*x, wrong(*x, *rate));
            most = most.max(0.125 * (now.0 - before.0) * (now.1 + before.1));
            before = now;
        }
        if most <= FORCE_ROUNDING * greatest(&nodes.approaches).max(start.approach.abs()) {
            // Rounding of the polynomial, which no shorter step reduces.
            return 0.0;
        }
        most / model.compliance
    }
}
