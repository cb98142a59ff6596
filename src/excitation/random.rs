//! Random vibration with a flat spectral density: a sum of sines of equal power.
//!
//! The band is divided into equal intervals, one for each sine. Each sine has a random frequency in its interval, so
//! that the sum does not repeat, and a random phase. The mean square over a long time is exactly the density times the
//! width of the band; over a short time it scatters as that of noise.

use std::f64::consts::TAU;

use crate::excitation::waveform::{Accelerations, Rotation};
use crate::excitation::window::Window;
use crate::math::nodal::{Nodal, add};
use crate::math::simd::{Arithmetic, Separate, Simd, compiled_for};
use crate::scene::Excitation;

/// Number of sines.
pub const SINES: usize = 256;

/// Partial sums computed in parallel.
const LANES: usize = 8;

/// A value for each sine.
type Each = [f64; SINES];

/// `a sin(2 pi (f_j tau + p_j))` summed over j, `tau = t - t0 >= 0`.
#[derive(Clone, Debug, PartialEq)]
pub struct Random {
    /// a, m/s2.
    amplitude: f64,
    /// f_j, Hz.
    frequencies: Each,
    /// p_j, turns.
    phases: Each,
    /// End of the band, Hz.
    pub highest: f64,
    /// Interval of time in which it acts.
    pub window: Window,
}

impl Random {
    /// From the start time on; the band must not be empty. Phase and displacement limit do not apply.
    pub fn new(excitation: &Excitation) -> Self {
        let width = excitation.end_frequency - excitation.frequency;
        let mut generator = SplitMix64(excitation.seed.unsigned_abs().into());
        let (mut frequencies, mut phases) = ([0.0; SINES], [0.0; SINES]);
        for (j, (frequency, phase)) in frequencies.iter_mut().zip(&mut phases).enumerate() {
            let place = (j as f64 + generator.next_part()) / SINES as f64;
            *frequency = excitation.frequency + place * width;
            *phase = generator.next_part();
        }
        Self {
            amplitude: (2.0 * excitation.spectral_density * width / SINES as f64).sqrt(),
            frequencies,
            phases,
            highest: excitation.end_frequency,
            window: Window::from(excitation.start_time),
        }
    }

    /// Acceleration at `time` (s), m/s2.
    pub fn value(&self, time: f64) -> f64 {
        let tau = time - self.window.start;
        let (sin, _) = phasors::<Separate>(&self.frequencies, tau, &self.phases);
        self.amplitude * sum(&sin)
    }

    /// Computes in place the rotation of each sine at the times (s) after the start of a step.
    #[inline(never)]
    pub fn turn<const S: usize>(&self, simd: Simd, times: &Nodal<S>, rotations: &mut [Rotation<S>]) {
        compiled_for!(simd, A => {
            for (node, time) in times.iter().enumerate() {
                let (sin, cos) = phasors::<A>(&self.frequencies, *time, &[0.0; SINES]);
                for (rotation, (sin, cos)) in rotations.iter_mut().zip(sin.iter().zip(&cos)) {
                    if let (Some(to_sin), Some(to_cos)) = (rotation.sin.get_mut(node), rotation.cos.get_mut(node)) {
                        (*to_sin, *to_cos) = (*sin, *cos);
                    }
                }
            }
        });
    }

    /// Accelerations over a step that begins at `time` (s), with the rotations of the sines at the nodes.
    pub fn over_step<const S: usize>(&self, simd: Simd, time: f64, rotations: &[Rotation<S>]) -> Accelerations<S> {
        compiled_for!(simd, A => self.compute::<S, A>(time, rotations))
    }

    #[inline(always)]
    fn compute<const S: usize, A: Arithmetic>(&self, time: f64, rotations: &[Rotation<S>]) -> Accelerations<S> {
        let (sin, cos) = phasors::<A>(&self.frequencies, time - self.window.start, &self.phases);
        let (mut from_sin, mut from_cos) = ([0.0; S], [0.0; S]);
        for (rotation, (sin, cos)) in rotations.iter().zip(sin.iter().zip(&cos)) {
            add::<S, A>(&mut from_sin, *sin, &rotation.cos);
            add::<S, A>(&mut from_cos, *cos, &rotation.sin);
        }
        let mut nodes = from_sin;
        for (node, from_cos) in nodes.iter_mut().zip(&from_cos) {
            *node = self.amplitude * (*node + from_cos);
        }
        Accelerations {
            start: self.amplitude * sum(&sin),
            nodes,
        }
    }
}

/// The sum of the values.
#[inline(always)]
fn sum(values: &Each) -> f64 {
    let mut sums = [0.0; LANES];
    for values in values.as_chunks::<LANES>().0 {
        for (sum, value) in sums.iter_mut().zip(values) {
            *sum += value;
        }
    }
    sums.iter().sum()
}

/// Sines and cosines of the phases (turns) after `tau` seconds at the frequencies (Hz). Branch-free, so that the loop
/// is vectorised.
#[inline(always)]
fn phasors<A: Arithmetic>(frequencies: &Each, tau: f64, phases: &Each) -> (Each, Each) {
    let (mut sines, mut cosines) = ([0.0; SINES], [0.0; SINES]);
    let phasors = sines.iter_mut().zip(&mut cosines);
    for ((sine, cosine), (frequency, phase)) in phasors.zip(frequencies.iter().zip(phases)) {
        // Whole turns are removed before rounding, as in `waveform::turned`.
        let product = frequency * tau;
        let lost = frequency.mul_add(tau, -product);
        let turns = (product - product.round_ties_even()) + (lost + phase);
        (*sine, *cosine) = unit::<A>(turns);
    }
    (sines, cosines)
}

/// Terms of the power series of sine and cosine in an eighth of a turn: the next one is below 1e-19.
const TERMS: usize = 10;

/// `1 / n!`.
#[expect(clippy::indexing_slicing, reason = "the indices are those of the table")]
const INVERSE_FACTORIALS: [f64; 2 * TERMS] = {
    let mut values = [1.0; 2 * TERMS];
    let mut n = 1;
    while n < 2 * TERMS {
        values[n] = values[n - 1] / n as f64;
        n += 1;
    }
    values
};

/// Sine and cosine of an angle in turns: the power series in the eighth of a turn around the nearest quarter.
#[expect(clippy::indexing_slicing, reason = "the indices are those of the table")]
#[inline(always)]
fn unit<A: Arithmetic>(turns: f64) -> (f64, f64) {
    let turns = turns - turns.round_ties_even();
    let quarters = (4.0 * turns).round_ties_even();
    let angle = TAU * A::mul_add(-0.25, quarters, turns);
    let z = -angle * angle;
    let (mut sin, mut cos) = (0.0, 0.0);
    for n in (0..TERMS).rev() {
        sin = A::mul_add(sin, z, INVERSE_FACTORIALS[2 * n + 1]);
        cos = A::mul_add(cos, z, INVERSE_FACTORIALS[2 * n]);
    }
    sin *= angle;
    // Sine and cosine of the quarters: -2 to 2.
    let cos_quarters = 1.0 - quarters.abs();
    let sin_quarters = quarters * (2.0 - quarters.abs());
    (
        sin * cos_quarters + cos * sin_quarters,
        cos * cos_quarters - sin * sin_quarters,
    )
}

/// SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014): the same numbers on every platform.
#[derive(Clone, Copy, Debug)]
struct SplitMix64(u64);

impl SplitMix64 {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in [0, 1).
    fn next_part(&mut self) -> f64 {
        (self.next() >> 11) as f64 * (-53.0_f64).exp2()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::simd::Fused;

    #[test]
    fn numbers_are_those_of_the_published_generator() {
        // The first outputs of the reference implementation in C, <https://prng.di.unimi.it/splitmix64.c>, from
        // 1234567.
        let mut generator = SplitMix64(1_234_567);
        for expected in [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
        ] {
            assert_eq!(generator.next(), expected);
        }
    }

    #[test]
    fn sine_and_cosine_are_those_of_the_library() {
        for k in -4000..4000 {
            let turns = f64::from(k) * 1.234_567e-3;
            let (sin, cos) = (TAU * (turns - turns.round())).sin_cos();
            for found in [unit::<Separate>(turns), unit::<Fused>(turns)] {
                // A few roundings of numbers up to 1, and of the angle up to pi.
                assert!(
                    (found.0 - sin).abs().max((found.1 - cos).abs()) < 1e-15,
                    "{turns} {found:?}"
                );
            }
        }
    }
}
