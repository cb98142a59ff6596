//! How accurate a trial is where it is read inside.

use crate::integrator::collocation::part::Whole;
use crate::integrator::collocation::shapes::Variable;
use crate::integrator::constants::FORCE_ROUNDING;
use crate::link::CONTACT;
use crate::math::nodal::greatest;
use crate::math::prediction::value_and_slope;

impl<const S: usize> Whole<'_, S> {
    /// Error of what is read inside the trial, in tolerances: of the force, in flight of the indentation.
    pub(crate) fn inaccuracy(&self) -> f64 {
        let (trial, tolerance) = (self.trial, self.model.tolerance.force);
        if !self.state.is_closed() {
            self.misread()
        } else if trial.next_terms > tolerance || self.collocation.variable == Variable::Root {
            // Only rejects: a length chosen by it would be too short by a twentieth. By the root of time the polynomial goes through
            // the force at the start.
            trial.next_terms / tolerance
        } else {
            trial.start_defect / tolerance
        }
    }

    /// Error of the indentation between the nodes of the trial as it would be read there, in that which a force wrong by the
    /// tolerance makes of the spring. The polynomial through the indentations has slopes at the nodes that differ from the
    /// velocities there; between two nodes its error is the cubic with these slopes.
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
        most / (model.tolerance.force * model.compliance)
    }
}
