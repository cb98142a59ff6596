//! Friction at the nodes of a step.

use bytemuck::Zeroable;

use crate::integrator::collocation::polynomial::Collocation;
use crate::math::nodal::Nodal;
use crate::math::prediction::value_and_slope;
use crate::math::simd::Simd;
use crate::state::State;

/// Friction at the nodes of a step.
#[derive(Clone, Copy, Debug, Zeroable)]
pub struct TangentialNodes<const S: usize> {
    /// Friction force as deviation from that of the preload, N.
    pub forces: Nodal<S>,
    /// Displacement of the contact point along the spring, m.
    pub displacements: Nodal<S>,
    /// Its velocity, m/s.
    pub rates: Nodal<S>,
    /// Deflection of the tangential spring, m.
    pub deflections: Nodal<S>,
    /// Slip velocity, m/s.
    pub slip_rates: Nodal<S>,
}

impl<const S: usize> TangentialNodes<S> {
    pub(crate) const ZERO: Self = Self {
        forces: [0.0; S],
        displacements: [0.0; S],
        rates: [0.0; S],
        deflections: [0.0; S],
        slip_rates: [0.0; S],
    };

    /// The first part of the step, up to the share `part` of it.
    pub(crate) fn first_part(&self, (collocation, simd): (&Collocation<S>, Simd), state: &State, part: f64) -> Self {
        let nodes = collocation.nodes.map(|node| node * part);
        let nodal = |values: &Nodal<S>| nodes.map(|x| collocation.interpolate(values, x));
        let with_start = |start: f64, values: &Nodal<S>| {
            let polynomial = collocation.through(simd, start, values);
            nodes.map(|x| value_and_slope(&polynomial, x - 1.0).0)
        };
        let start = &state.tangential;
        Self {
            forces: nodal(&self.forces),
            displacements: with_start(start.displacement, &self.displacements),
            rates: with_start(start.rate, &self.rates),
            deflections: with_start(start.deflection(), &self.deflections),
            slip_rates: nodal(&self.slip_rates),
        }
    }
}
