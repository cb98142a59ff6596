//! The tip at the nodes of an exact step, for dense output.

use bytemuck::zeroed_box;

use crate::closed_loop::oscillator::Coordinates;
use crate::closed_loop::propagator::Propagator;
use crate::closed_loop::system::ClosedLoop;
use crate::excitation::generator::Generator;
use crate::math::nodal::{LONG, Nodal, add};
use crate::math::simd::{Arithmetic, Simd, compiled_for};

/// Displacement and velocity of the tip at the nodes.
pub type TipAtNodes = [Nodal<LONG>; 2];

/// The motion over a step and the tip at its nodes: the coefficients, which depend on the step length only.
#[derive(Clone, Debug)]
pub struct DensePropagator {
    /// The motion to the end of the step.
    pub(crate) whole: Box<Propagator>,
    /// The tip per displacement of each oscillator at the start, then per velocity.
    free: Vec<TipAtNodes>,
    /// The tip from rest under the generator with unit amplitude, per sine and per cosine of its phase at the start.
    generated: [TipAtNodes; 2],
}

impl DensePropagator {
    pub(crate) fn room(oscillators: usize) -> Self {
        let none = [[0.0; LONG]; 2];
        Self { whole: zeroed_box(), free: vec![none; 2 * oscillators], generated: [none; 2] }
    }

    /// Computes the coefficients for a length (s) in place; the last of the nodes is the end of the step.
    #[expect(clippy::indexing_slicing, reason = "arrays of fixed size")]
    pub(crate) fn fill(&mut self, length: f64, closed_loop: &ClosedLoop, generator: &Generator, nodes: &Nodal<LONG>) {
        let count = closed_loop.oscillators.len();
        for (k, node) in nodes.iter().enumerate() {
            self.whole.fill(node * length, &closed_loop.oscillators, generator);
            let whole = &self.whole;
            let motions = &whole.free;
            for (quantity, row) in closed_loop.tip.iter().enumerate() {
                let (from_x, from_v) = self.free.split_at_mut(count);
                for (j, (from_x, from_v)) in from_x.iter_mut().zip(from_v).enumerate() {
                    let (x, v) = (row[j], row[count + j]);
                    from_x[quantity][k] = x * motions.q_from_q[j] + v * motions.v_from_q[j];
                    from_v[quantity][k] = x * motions.q_from_v[j] + v * motions.v_from_v[j];
                }
                for (generated, driven) in self.generated.iter_mut().zip([&whole.from_sine, &whole.from_cosine]) {
                    generated[quantity][k] = row.iter().zip(driven).map(|(row, driven)| row * driven).sum();
                }
            }
        }
    }

    /// The tip at the nodes, from the free motion at the start and sine and cosine of the generator's phase there times
    /// its amplitude, relative to the particular solution.
    pub(crate) fn tip_at_nodes(&self, simd: Simd, free: &Coordinates, phasor: (f64, f64)) -> TipAtNodes {
        compiled_for!(simd, A => self.compute::<A>(free, phasor))
    }

    #[inline(always)]
    fn compute<A: Arithmetic>(&self, free: &Coordinates, (sine, cosine): (f64, f64)) -> TipAtNodes {
        let mut tip = [[0.0; LONG]; 2];
        for (factor, columns) in free.iter().zip(&self.free) {
            add_both::<A>(&mut tip, *factor, columns);
        }
        for (factor, columns) in [sine, cosine].iter().zip(&self.generated) {
            add_both::<A>(&mut tip, *factor, columns);
        }
        tip
    }
}

#[inline(always)]
fn add_both<A: Arithmetic>(sums: &mut TipAtNodes, factor: f64, columns: &TipAtNodes) {
    let ([displacement, velocity], [to_displacement, to_velocity]) = (sums, columns);
    add::<LONG, A>(displacement, factor, to_displacement);
    add::<LONG, A>(velocity, factor, to_velocity);
}
