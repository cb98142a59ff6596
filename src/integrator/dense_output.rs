//! Dense output of a step.

use serde::{Deserialize, Serialize};

use crate::integrator::course::Places;
use crate::link::MAX_LINKS;
use crate::math::prediction::Prediction;

/// Dense output of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct DenseOutput {
    /// The links.
    pub links: [DenseLink; MAX_LINKS],
    /// Slip of the first contact.
    pub slip: DenseSlip,
}

/// Polynomials of a link, as deviations from the preload.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct DenseLink {
    /// Force, N.
    pub force: Prediction,
    /// Approach, m; not of friction.
    pub approach: Prediction,
    /// Its velocity, m/s.
    pub rate: Prediction,
    /// Where the force turns, for its extremes.
    pub turns: Places,
    /// Where it passes that of an interruption.
    pub passages: Places,
}

/// Polynomials of slip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct DenseSlip {
    /// Slip, m.
    pub slip: Prediction,
    /// Energy dissipated so far, J.
    pub dissipated: Prediction,
}

impl DenseOutput {
    /// Takes over another with so many links.
    pub(crate) fn copy(&mut self, other: &Self, links: usize) {
        let own = self.links.iter_mut().zip(&other.links).take(links);
        own.for_each(|(own, other)| *own = *other);
        self.slip = other.slip;
    }

    /// Whether a simulation can reach these numbers.
    pub(crate) fn is_sound(&self) -> bool {
        let Self { links, slip } = self;
        let DenseSlip { slip, dissipated } = slip;
        let finite = |polynomial: &Prediction| polynomial.iter().all(|number| number.is_finite());
        finite(slip)
            && finite(dissipated)
            && links.iter().all(|link| {
                let DenseLink { force, approach, rate, turns, passages } = link;
                [force, approach, rate].into_iter().all(finite) && turns.is_sound() && passages.is_sound()
            })
    }
}
