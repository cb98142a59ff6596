//! Random vibration with a flat spectral density: a sum of sines of equal power.
//!
//! The band is divided into equal intervals, one for each sine. Each sine has a random frequency in its interval, so
//! that the sum does not repeat, and a random phase. The mean square over a long time is exactly the density times the
//! width of the band; over a short time it scatters as that of noise.
//!
//! For steps, time is divided into pieces of the order of the shortest period, and the sum is expanded into a Chebyshev
//! series over the piece in which a step begins, to rounding: many steps share its cost.

use std::f64::consts::TAU;

use bytemuck::zeroed_box;

use crate::excitation::waveform::{Accelerations, Window};
use crate::math::elementary::sin_cos;
use crate::math::nodal::{Nodal, add, add_products};
use crate::math::simd::{Arithmetic, Separate, Simd, compiled_for};
use crate::scene::Excitation;

pub const SINES: usize = 256;

/// Partial sums computed in parallel.
const LANES: usize = 8;

/// Length of a piece of time in shortest periods, and from the start of one to that of the next: the longest step, a
/// quarter of the shortest period, fits into the piece in which it starts.
const PIECE: f64 = 4.0;
/// See [`PIECE`].
const STRIDE: f64 = 3.75;

/// Terms of the Chebyshev series over a piece. The angle of a sine changes by at most `z = 4 pi` from the middle to the
/// ends; what is left out is at most `2 J_40(z) + 2 J_41(z) + ... < 2e-16` of each amplitude.
const TERMS: usize = 40;

type Each = [f64; SINES];

/// `a sin(2 pi (f_j tau + p_j))` summed over j, `tau = t - t0 >= 0`.
#[derive(Clone, Debug, PartialEq)]
pub struct Random {
    /// a, m/s2.
    amplitude: f64,
    /// f_j, Hz, each as sum of two numbers of half the digits.
    frequencies: Box<[Each; 2]>,
    /// p_j, turns.
    phases: Box<Each>,
    /// For each term of the Chebyshev series, its factors of `sin phi_j` (even terms) or `cos phi_j` (odd ones), with
    /// the phases `phi_j` in the middle of a piece, m/s2.
    factors: Vec<Each>,
    /// End of the band, Hz.
    pub highest: f64,
    pub window: Window,
}

/// The acceleration over a piece of time, as a Chebyshev series. Kept from step to step; a function of the number of
/// the piece alone, so results do not depend on it.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Its number; negative: none yet.
    number: f64,
    /// Its middle, s after the start.
    middle: f64,
    /// The series, m/s2.
    series: [f64; TERMS],
}

impl Default for Piece {
    fn default() -> Self {
        Self { number: -1.0, middle: 0.0, series: [0.0; TERMS] }
    }
}

impl Piece {
    /// Values at the times `x` in half lengths after the middle (Clenshaw's algorithm).
    #[inline(always)]
    fn values<const S: usize, A: Arithmetic>(&self, x: &Nodal<S>) -> Nodal<S> {
        let (mut above, mut value) = ([0.0; S], [0.0; S]);
        for coefficient in self.series.iter().rev() {
            for ((above, value), x) in above.iter_mut().zip(&mut value).zip(x) {
                (*above, *value) = (*value, A::mul_add(2.0 * x, *value, coefficient - *above));
            }
        }
        for ((value, above), x) in value.iter_mut().zip(&above).zip(x) {
            *value -= x * above;
        }
        value
    }
}

impl Random {
    /// From the start time on; the band must not be empty. Phase and displacement limit do not apply.
    pub fn new(excitation: &Excitation) -> Self {
        let width = excitation.end_frequency - excitation.frequency;
        let mut generator = SplitMix64(excitation.seed.unsigned_abs().into());
        let (mut frequencies, mut phases): (Box<[Each; 2]>, Box<Each>) = (zeroed_box(), zeroed_box());
        let [highs, lows] = &mut *frequencies;
        for (j, (frequency, phase)) in highs.iter_mut().zip(&mut *phases).enumerate() {
            let place = (j as f64 + generator.next_part()) / SINES as f64;
            *frequency = excitation.frequency + place * width;
            *phase = generator.next_part();
        }
        let amplitude = (2.0 * excitation.spectral_density * width / SINES as f64).sqrt();
        let highest = excitation.end_frequency;
        // sin(phi + z x) by the expansion of Jacobi and Anger: J_0(z) sin(phi), then 2 J_k(z) T_k(x) times cos(phi),
        // -sin(phi), -cos(phi), sin(phi), ...
        let mut factors = vec![[0.0; SINES]; TERMS];
        for (j, frequency) in highs.iter().enumerate() {
            let values = bessel(0.5 * TAU * PIECE * frequency / highest);
            for (k, (factors, value)) in factors.iter_mut().zip(values).enumerate() {
                let sign = if k % 4 < 2 { amplitude } else { -amplitude };
                let factor = if k == 0 { sign } else { 2.0 * sign };
                if let Some(entry) = factors.get_mut(j) {
                    *entry = factor * value;
                }
            }
        }
        for (high, low) in highs.iter_mut().zip(lows) {
            [*high, *low] = split(*high);
        }
        Self { amplitude, factors, frequencies, phases, highest, window: Window::from(excitation.start_time) }
    }

    /// Acceleration at `time` (s), m/s2.
    pub fn value(&self, time: f64) -> f64 {
        let tau = time - self.window.start;
        let mut phasors = [[0.0; SINES]; 2];
        set_phasors::<Separate>(&mut phasors, &self.frequencies, tau, &self.phases);
        let [sin, _] = &phasors;
        self.amplitude * dot::<Separate>(sin, &[1.0; SINES])
    }

    /// Accelerations over a step that begins at `time` (s), at the nodes the given times (s) after it. `piece` is kept
    /// from step to step.
    #[inline(never)]
    pub fn over_step<const S: usize>(
        &self,
        simd: Simd,
        time: f64,
        times: &Nodal<S>,
        piece: &mut Piece,
    ) -> Accelerations<S> {
        compiled_for!(simd, A => self.compute::<S, A>(time, times, piece))
    }

    #[inline(always)]
    fn compute<const S: usize, A: Arithmetic>(
        &self,
        time: f64,
        times: &Nodal<S>,
        piece: &mut Piece,
    ) -> Accelerations<S> {
        let tau = time - self.window.start;
        let stride = STRIDE / self.highest;
        let number = (tau / stride).floor();
        if piece.number != number {
            self.set_piece::<A>(piece, number, number * stride + 0.5 * PIECE / self.highest);
        }
        let per_half = 2.0 * self.highest / PIECE;
        let start = (tau - piece.middle) * per_half;
        let mut nodes = [start; S];
        add::<S, A>(&mut nodes, per_half, times);
        let [start] = piece.values::<1, A>(&[start]);
        Accelerations { start, nodes: piece.values::<S, A>(&nodes) }
    }

    /// Makes a piece the one with this number and its middle (s after the start).
    #[inline(always)]
    fn set_piece<A: Arithmetic>(&self, piece: &mut Piece, number: f64, middle: f64) {
        let mut phasors = [[0.0; SINES]; 2];
        set_phasors::<A>(&mut phasors, &self.frequencies, middle, &self.phases);
        let [sin, cos] = &phasors;
        for (k, (coefficient, factors)) in piece.series.iter_mut().zip(&self.factors).enumerate() {
            *coefficient = dot::<A>(factors, if k.is_multiple_of(2) { sin } else { cos });
        }
        (piece.number, piece.middle) = (number, middle);
    }
}

#[inline(always)]
fn dot<A: Arithmetic>(a: &Each, b: &Each) -> f64 {
    let mut sums = [0.0; LANES];
    for (a, b) in a.as_chunks::<LANES>().0.iter().zip(b.as_chunks::<LANES>().0) {
        add_products::<LANES, A>(&mut sums, a, b);
    }
    sums.iter().sum()
}

/// Bessel functions J_0, J_1, ... of an argument up to [`PIECE`] pi, by downward recurrence (J. C. P. Miller).
fn bessel(z: f64) -> [f64; TERMS] {
    let mut values = [0.0; TERMS];
    let (mut above, mut value, mut sum) = (0.0, 1.0, 0.0);
    for k in (0..2 * TERMS).rev() {
        values.iter_mut().skip(k).take(1).for_each(|entry| *entry = value);
        sum += match k {
            0 => value,
            _ if k.is_multiple_of(2) => 2.0 * value,
            _ => 0.0,
        };
        (above, value) = (value, 2.0 * k as f64 / z * value - above);
        if value.abs() > 1e200 {
            let scaled = values.iter_mut().chain([&mut above, &mut value, &mut sum]);
            scaled.for_each(|entry| *entry *= 1e-200);
        }
    }
    // J_0 + 2 J_2 + 2 J_4 + ... = 1.
    values.map(|value| value / sum)
}

/// A number as the sum of two with half the digits (T. J. Dekker, Numerische Mathematik 18 (1971) 224).
fn split(value: f64) -> [f64; 2] {
    let scaled = 134_217_729.0 * value;
    let high = scaled - (scaled - value);
    [high, value - high]
}

/// The nearest integer of a number below 2^51, or one near it; unlike the library's without a call on any processor.
#[inline(always)]
fn rounded(value: f64) -> f64 {
    const SHIFT: f64 = 6_755_399_441_055_744.0;
    (value + SHIFT) - SHIFT
}

/// Sines and cosines of the phases (turns) after `tau` seconds at the frequencies (Hz).
#[inline(always)]
fn set_phasors<A: Arithmetic>([sines, cosines]: &mut [Each; 2], [high, low]: &[Each; 2], tau: f64, phases: &Each) {
    let [tau_high, tau_low] = split(tau);
    let phasors = sines.as_chunks_mut::<LANES>().0.iter_mut().zip(cosines.as_chunks_mut::<LANES>().0);
    let frequencies = high.as_chunks::<LANES>().0.iter().zip(low.as_chunks::<LANES>().0);
    for ((sines, cosines), ((high, low), phases)) in phasors.zip(frequencies.zip(phases.as_chunks::<LANES>().0)) {
        let mut angles = [0.0; LANES];
        for (angle, ((high, low), phase)) in angles.iter_mut().zip(high.iter().zip(low).zip(phases)) {
            // Whole turns are removed before rounding, as in `waveform::turned`.
            let product = (high + low) * tau;
            let lost = ((high * tau_high - product) + high * tau_low + low * tau_high) + low * tau_low;
            let turns = (product - rounded(product)) + (lost + phase);
            *angle = TAU * (turns - rounded(turns));
        }
        (*sines, *cosines) = sin_cos::<LANES, A>(&angles);
    }
}

/// SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014): the same numbers on every platform.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SplitMix64(pub(crate) u64);

impl SplitMix64 {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in [0, 1).
    pub(crate) fn next_part(&mut self) -> f64 {
        (self.next() >> 11) as f64 * (-53.0_f64).exp2()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_published_generator() {
        // The first outputs of the reference implementation in C, <https://prng.di.unimi.it/splitmix64.c>, from
        // 1234567.
        let mut generator = SplitMix64(1_234_567);
        for expected in [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423] {
            assert_eq!(generator.next(), expected);
        }
    }
}
