//! Exact steps of any length where beam and contact are linear.
//!
//! With the contact as a spring and damper at the tip, the eigenvalues come in pairs
//! ([`crate::closed_loop::eigenvectors`]). Each pair is an independent damped oscillator
//! ([`crate::closed_loop::oscillator`]), propagated exactly ([`crate::closed_loop::propagator`]). The modes of the
//! cantilever are transformed to these oscillators before the first exact step of many, and back after the last.
//!
//! Constant and linear loads (base acceleration held or linear, fixed contact moving linearly) are covered by a
//! particular solution, which is bounded as every oscillator has a stiffness. The generator's sine is covered by the
//! response from rest, which is valid even at a resonance without damping.

use bytemuck::zeroed_box;

use crate::beam::mode::{MAX_MODES, Mode, Rayleigh};
use crate::beam::resolution::Resolution;
use crate::closed_loop::eigenvectors::EigenPair;
use crate::closed_loop::oscillator::{Coordinates, Oscillator, set};
use crate::closed_loop::problem::Problem;
use crate::closed_loop::propagator::Propagator;
use crate::contact::law::Law;
use crate::excitation::generator::Generator;
use crate::math::free_motion::FreeMotion;
use crate::math::simd::{Arithmetic, Simd, compiled_for};

/// Largest error of transforming the motion of a single mode to the oscillators and back, relative to its amplitude. It
/// is largest for high modes, which move least: the contact force is then accurate to some 1e-13 of its scale.
const ROUNDING: f64 = 1e-10;

/// Beam and linear contact as uncoupled oscillators.
#[derive(Clone, Debug)]
pub struct ClosedLoop {
    pub(crate) contact: Law,
    pub(crate) oscillators: Vec<Oscillator>,
    /// Transformation from oscillators (displacement, then velocity of each) to modes.
    pub(crate) to_modes: Columns,
    /// Transformation from modes (displacement and velocity of each) to oscillators.
    pub(crate) to_oscillators: Columns,
    /// Displacement and velocity of the tip per displacement, then per velocity, of each oscillator.
    pub(crate) tip: Box<[Coordinates; 2]>,
    /// What the modes left out do, of the motion of each oscillator.
    pub(crate) resolution: Resolution,
    /// Particular solutions at their start: under unit base acceleration, under one that grows linearly with time, and the same
    /// under a tip force.
    particular: Box<[Coordinates; 4]>,
    /// Steady state under the generator with unit amplitude, per sine and per cosine of its phase; zero at a resonance
    /// without damping.
    steady: Box<[Coordinates; 2]>,
    /// Contact force of these five motions; of the last its amplitude, infinite at a resonance without damping.
    forces: [f64; 5],
}

/// A square matrix by columns, padded with zero columns to a multiple of four.
#[derive(Clone, Debug)]
pub(crate) struct Columns {
    size: usize,
    entries: Vec<f64>,
}

impl Columns {
    fn new(size: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let mut entries: Vec<_> = (0..size * size).map(|n| entry(n % size, n / size)).collect();
        entries.resize(size * size.next_multiple_of(4), 0.0);
        Self { size, entries }
    }

    pub(crate) fn times(&self, simd: Simd, factors: &Coordinates) -> Coordinates {
        compiled_for!(simd, A => self.compute::<A>(factors))
    }

    /// Matrix-vector product, four columns at a time to reduce memory traffic.
    #[inline(always)]
    fn compute<A: Arithmetic>(&self, factors: &Coordinates) -> Coordinates {
        let mut sums = [0.0; 2 * MAX_MODES];
        for (columns, factors) in self.entries.chunks_exact(4 * self.size).zip(factors.chunks_exact(4)) {
            let (a, columns) = columns.split_at(self.size);
            let (b, columns) = columns.split_at(self.size);
            let (c, d) = columns.split_at(self.size);
            if let [p, q, r, s] = factors {
                for ((((sum, a), b), c), d) in sums.iter_mut().zip(a).zip(b).zip(c).zip(d) {
                    *sum += A::mul_add(*a, *p, b * q) + A::mul_add(*c, *r, d * s);
                }
            }
        }
        sums
    }
}

impl ClosedLoop {
    /// From the modes, their damping and the contact; `None` if the eigenvectors are too close to be separated
    /// accurately.
    pub fn new(
        (modes, resolution): (&[Mode], &Resolution),
        damping: Rayleigh,
        contact: Law,
        generator: &Generator,
    ) -> Option<Self> {
        let problem = Problem {
            modes: modes.iter().map(|mode| (mode.omega_squared, mode.tip)).collect(),
            mass_damping: damping.alpha,
            stiffness_damping: damping.beta,
            contact_stiffness: contact.coefficient,
            contact_damping: contact.damping,
        };
        let pairs = problem.solve()?;
        let count = pairs.len();
        // Load on an oscillator per load on the modes.
        let load = |pair: &EigenPair, of_mode: fn(&Mode) -> f64| {
            let parts = pair.components.iter().zip(modes);
            parts.fold([0.0, 0.0], |[kick, push], (component, mode)| {
                let ([_, x], [_, x_rate]) = (component.x, component.x_rate);
                [kick + x * of_mode(mode), push + x_rate * of_mode(mode)]
            })
        };
        let oscillators = pairs.iter().map(|pair| Oscillator {
            load: load(pair, |mode| -mode.participation),
            push: load(pair, |mode| mode.tip),
            ..pair.oscillator
        });
        let component = |pair: usize, mode: usize| pairs.get(pair % count)?.components.get(mode / 2);
        let pick = |values: [f64; 2], n: usize| values.get(n).copied().unwrap_or(f64::NAN);
        let right = |mode: usize, x: usize| {
            component(x, mode)
                .map_or(f64::NAN, |part| pick(if mode.is_multiple_of(2) { part.q } else { part.v }, x / count))
        };
        let left = |x: usize, mode: usize| {
            component(x, mode).map_or(f64::NAN, |part| pick(if x < count { part.x } else { part.x_rate }, mode % 2))
        };
        let mut closed_loop = Self {
            contact,
            to_modes: Columns::new(2 * count, right),
            to_oscillators: Columns::new(2 * count, left),
            oscillators: oscillators.collect(),
            tip: zeroed_box(),
            resolution: Resolution::default(),
            particular: zeroed_box(),
            steady: zeroed_box(),
            forces: [0.0; 5],
        };
        let resonant = closed_loop.set_particular(generator);
        closed_loop.set_tip(modes, resolution);
        let force = |motion: &Coordinates| closed_loop.force_of(motion);
        let [per_sine, per_cosine] = closed_loop.steady.each_ref().map(force);
        let [acceleration, jerk, push, growth] = closed_loop.particular.each_ref().map(force);
        let generated = if resonant { f64::INFINITY } else { per_sine.hypot(per_cosine) };
        closed_loop.forces = [acceleration, jerk, push, growth, generated];
        closed_loop.is_exact(modes).then_some(closed_loop)
    }

    /// Sets the particular solutions; whether there is a resonance without damping.
    fn set_particular(&mut self, generator: &Generator) -> bool {
        let (mut resonant, count) = (false, self.oscillators.len());
        for (n, oscillator) in self.oscillators.iter().enumerate() {
            let motions = [oscillator.load, oscillator.push].into_iter();
            let motions = motions.flat_map(|load| [oscillator.at_rest(load), oscillator.at_ramp(load)]);
            for (particular, motion) in self.particular.iter_mut().zip(motions) {
                set(particular, n, count, motion);
            }
            if let Some(frequency) = generator.frequency() {
                let steady = oscillator.loaded(oscillator.steady(frequency));
                resonant |= !steady.iter().all(|motion| motion.is_finite());
                let [per_sine, per_cosine] = &mut *self.steady;
                set(per_sine, n, count, steady.map(|motion| motion.re));
                set(per_cosine, n, count, steady.map(|motion| motion.im));
            }
        }
        if resonant {
            self.steady = zeroed_box();
        }
        resonant
    }

    /// Sets the motion of the tip per oscillator.
    fn set_tip(&mut self, modes: &[Mode], resolution: &Resolution) {
        let size = 2 * self.oscillators.len();
        let columns = self.to_modes.entries.chunks_exact(size);
        let displacements = columns.clone().take(size).map(|column| column.iter().step_by(2));
        self.resolution = resolution.of_motions(&displacements);
        let [displacement, velocity] = &mut *self.tip;
        for ((displacement, velocity), column) in displacement.iter_mut().zip(velocity).zip(columns).take(size) {
            for (mode, motion) in modes.iter().zip(column.chunks_exact(2)) {
                if let [q, v] = motion {
                    *displacement += mode.tip * q;
                    *velocity += mode.tip * v;
                }
            }
        }
    }

    /// Contact force of a motion of the oscillators without loads.
    fn force_of(&self, motion: &Coordinates) -> f64 {
        let (x, v) = motion.split_at(self.oscillators.len());
        let motions = self.oscillators.iter().zip(x.iter().zip(v));
        let forces = motions.map(|(oscillator, (x, v))| oscillator.force[0] * x + oscillator.force[1] * v);
        forces.sum()
    }

    /// Whether the transformations are inverse to each other, and the oscillators have the right contact force, to the
    /// accuracy required.
    fn is_exact(&self, modes: &[Mode]) -> bool {
        let scales: Vec<f64> = modes.iter().flat_map(|mode| [mode.omega_squared.sqrt(), 1.0]).collect();
        let survives = scales.iter().enumerate().all(|(n, scale)| {
            let mut motion = [0.0; 2 * MAX_MODES];
            if let Some(entry) = motion.get_mut(n) {
                *entry = 1.0 / scale;
            }
            let oscillators = self.to_oscillators.times(Simd::Portable, &motion);
            let again = self.to_modes.times(Simd::Portable, &oscillators);
            let mut motions = again.iter().zip(&motion).zip(&scales);
            motions.all(|((again, motion), scale)| ((again - motion) * scale).abs() < ROUNDING)
        });
        let Law { coefficient: stiffness, damping, .. } = self.contact;
        // Error of the contact force of a modal motion, and the magnitude of its terms.
        let residual = |motion: &[f64], expected: f64| {
            modes.iter().zip(motion.chunks_exact(2)).fold(
                (expected, expected.abs()),
                |(residual, size), (mode, motion)| {
                    let [spring, damper] = match motion {
                        [q, v] => [q, &(damping * v)].map(|length| stiffness * mode.tip * length),
                        _ => [f64::NAN; 2],
                    };
                    (residual + (spring + damper), size + (spring.abs() + damper.abs()))
                },
            )
        };
        let columns = || self.to_modes.entries.chunks_exact(self.to_modes.size);
        let pairs = columns().zip(columns().skip(modes.len()));
        survives
            && self.oscillators.iter().zip(pairs).all(|(oscillator, (at_x, at_v))| {
                let [(x, x_size), (v, v_size)] =
                    [residual(at_x, oscillator.force[0]), residual(at_v, oscillator.force[1])];
                let frequency = oscillator.omega_squared.sqrt();
                let size = x_size + frequency * v_size;
                x.abs() < ROUNDING * size && frequency * v.abs() < ROUNDING * size
            })
    }

    /// Motion of the oscillators at the end of a step, from the free motion at its start and the particular solution at
    /// the end.
    /// `phasor`: sine and cosine of the generator's phase at the start, times its amplitude.
    pub(crate) fn moved(
        &self,
        propagator: &Propagator,
        free: &Coordinates,
        steady: &Steady,
        (sine, cosine): (f64, f64),
    ) -> Coordinates {
        let count = self.oscillators.len();
        let (x, v) = free.split_at(count);
        let mut moved = [0.0; 2 * MAX_MODES];
        let (x_end, v_end) = moved.split_at_mut(count);
        let FreeMotion { q_from_q, q_from_v, v_from_q, v_from_v } = &propagator.free;
        for (ends, from_x, from_v) in [(x_end, q_from_q, q_from_v), (v_end, v_from_q, v_from_v)] {
            let steps = from_x.iter().zip(from_v);
            for (((end, x), v), (from_x, from_v)) in ends.iter_mut().zip(x).zip(v).zip(steps) {
                *end = from_x * x + from_v * v;
            }
        }
        self.add_particular(&mut moved, steady, 1.0);
        let generated = propagator.from_sine.iter().zip(&propagator.from_cosine);
        for (end, (from_sine, from_cosine)) in moved.iter_mut().zip(generated).take(2 * count) {
            *end += sine * from_sine + cosine * from_cosine;
        }
        moved
    }

    /// Displacement and velocity of the tip of a motion of the oscillators.
    pub(crate) fn tip_of(&self, motion: &Coordinates) -> (f64, f64) {
        let [displacement, velocity] = &*self.tip;
        let rows = displacement.iter().zip(velocity).take(2 * self.oscillators.len());
        let parts = motion.iter().zip(rows).map(|(motion, (x, v))| (x * motion, v * motion));
        parts.fold((0.0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1))
    }

    /// Adds the particular solution under the loads, times `sign`.
    pub(crate) fn add_particular(&self, motion: &mut Coordinates, steady: &Steady, sign: f64) {
        if steady.is_zero() {
            return;
        }
        let (a, j) = (sign * steady.acceleration, sign * steady.jerk);
        let (f, g) = (sign * steady.force, sign * steady.growth);
        let count = 2 * self.oscillators.len();
        let [acceleration, jerk, force, growth] = &*self.particular;
        let by_base = acceleration.iter().zip(jerk);
        let by_tip = force.iter().zip(growth);
        let columns = by_base.zip(by_tip);
        for (motion, ((acceleration, jerk), (force, growth))) in motion.iter_mut().zip(columns).take(count) {
            *motion += a * acceleration + j * jerk + f * force + g * growth;
        }
    }

    /// Lower bound of the contact force over a step of a length (s) without transients, N.
    pub(crate) fn least_steady_force(
        &self,
        preload: f64,
        steady: &Steady,
        (sine, cosine): (f64, f64),
        length: f64,
    ) -> f64 {
        let [acceleration, jerk, force, growth, generated] = self.forces;
        let start = steady.force * (1.0 + force)
            + steady.acceleration * acceleration
            + steady.jerk * jerk
            + steady.growth * growth;
        let grown = steady.growth * (1.0 + force) + steady.jerk * acceleration;
        let swing = match sine.hypot(cosine) {
            0.0 => 0.0,
            amplitude => amplitude * generated,
        };
        preload + start.min(start + grown * length) - swing
    }

    /// Upper bound of the contact force of the transients in the free motion, N, or a number above `enough` (N) if the
    /// bound is.
    pub(crate) fn swing(&self, free: &Coordinates, (sine, cosine): (f64, f64), enough: f64) -> f64 {
        let count = self.oscillators.len();
        let (x, v) = free.split_at(count);
        let [per_sine, per_cosine] = self.steady.each_ref().map(|steady| steady.split_at(count));
        let steady = per_sine.0.iter().zip(per_cosine.0).zip(per_sine.1.iter().zip(per_cosine.1));
        let mut swing = 0.0;
        for ((oscillator, (x, v)), ((x_sine, x_cosine), (v_sine, v_cosine))) in
            self.oscillators.iter().zip(x.iter().zip(v)).zip(steady)
        {
            let x = x - (sine * x_sine + cosine * x_cosine);
            let v = v - (sine * v_sine + cosine * v_cosine);
            swing += oscillator.largest_force(x, v);
            // The first ones reveal most motions.
            if swing > enough {
                break;
            }
        }
        swing
    }
}

/// Constant and linear loads of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Steady {
    /// Base acceleration at the start of the step, m/s2.
    pub(crate) acceleration: f64,
    /// Its rate, m/s3.
    pub(crate) jerk: f64,
    /// Force on the tip at rest at the start of the step, N.
    pub(crate) force: f64,
    /// Its rate, N/s.
    pub(crate) growth: f64,
}

impl Steady {
    fn is_zero(&self) -> bool {
        [self.acceleration, self.jerk, self.force, self.growth] == [0.0; 4]
    }

    /// The loads `length` seconds later.
    pub(crate) fn after(self, length: f64) -> Self {
        Self { acceleration: self.acceleration + self.jerk * length, force: self.force + self.growth * length, ..self }
    }
}
