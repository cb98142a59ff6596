//! A sine whose frequency sweeps exponentially from one value to another.
//!
//! At `tau = t - t0` the frequency is `f e^x`, `x = ln(r) tau / D`, `r = f_end / f`, and the phase has advanced
//! by `f tau (e^x - 1) / x` cycles. For `r` towards 1 this is the sine.

use std::f64::consts::TAU;

use crate::excitation::waveform::{Accelerations, Window, displacement_limit, limited, turned};
use crate::math::nodal::Nodal;
use crate::scene::Excitation;

/// Exponent x up to which the cycles are computed as those of a sine plus a correction.
const SMALL: f64 = 0.5;

/// `A sin(2 pi f D / ln(r) (r^(tau/D) - 1) + phase)` for the duration D: the phase is that of a sine at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogSweep {
    /// A, m/s2.
    amplitude: f64,
    /// f, Hz.
    frequency: f64,
    /// ln(r) / D, 1/s; negative where the sweep goes down.
    rate: f64,
    /// Phase at the start, rad.
    phase: f64,
    /// Largest displacement amplitude, m; it sets the amplitude below the crossover frequency. Infinite: no limit.
    displacement_limit: f64,
    /// The instant within the sweep at which the displacement limit begins or ceases to set the amplitude, s.
    crossover: Option<f64>,
    pub window: Window,
}

impl LogSweep {
    /// From the start time on, for the duration.
    pub fn new(excitation: &Excitation) -> Self {
        let (frequency, start) = (excitation.frequency, excitation.start_time);
        let rate = logarithm(excitation.end_frequency, frequency) / excitation.duration;
        let displacement_limit = displacement_limit(excitation);
        let crossing = (excitation.amplitude.abs() / displacement_limit).sqrt() / TAU;
        let window = Window { start, end: start + excitation.duration };
        Self {
            amplitude: excitation.amplitude,
            frequency,
            rate,
            phase: excitation.phase,
            displacement_limit,
            crossover: Some(start + logarithm(crossing, frequency) / rate)
                .filter(|crossover| window.start < *crossover && *crossover < window.end),
            window,
        }
    }

    /// Frequency `tau` seconds after the start, Hz.
    fn frequency_after(&self, tau: f64) -> f64 {
        self.frequency * (self.rate * tau).exp()
    }

    /// Amplitude at a frequency (Hz), m/s2.
    fn amplitude_at(&self, frequency: f64) -> f64 {
        limited(self.amplitude, self.displacement_limit, frequency)
    }

    /// Phase `tau` seconds after the start, reduced by most of its whole turns, rad. At late instants its rounding
    /// error is no larger than that caused by the rounding of time.
    fn phase_after(&self, tau: f64) -> f64 {
        let x = self.rate * tau;
        let turns = if x.abs() < SMALL {
            turned(self.frequency, tau) + (self.frequency * tau * excess(x)).fract()
        } else {
            let lost = self.rate.mul_add(tau, -x);
            let grown = x.exp_m1();
            let scale = self.frequency / self.rate;
            turned(scale, grown) + scale * (grown + 1.0) * lost
        };
        TAU * turns + self.phase
    }

    /// Acceleration at `time` (s), m/s2.
    pub fn value(&self, time: f64) -> f64 {
        let tau = time - self.window.start;
        self.amplitude_at(self.frequency_after(tau)) * self.phase_after(tau).sin()
    }

    /// Accelerations over a step that begins at `time` (s) with nodes at the times (s) after it. Phases at the nodes
    /// are relative to that at the start, so that only small numbers are rounded.
    pub fn over_step<const S: usize>(&self, time: f64, times: &Nodal<S>) -> Accelerations<S> {
        let tau = time - self.window.start;
        let (frequency, phase) = (self.frequency_after(tau), self.phase_after(tau));
        let at = |after: f64| {
            let x = self.rate * after;
            let excess = excess(x);
            let angle = phase + TAU * frequency * after * (1.0 + excess);
            self.amplitude_at(frequency * (1.0 + x * (1.0 + excess))) * angle.sin()
        };
        Accelerations { start: at(0.0), nodes: times.map(at) }
    }

    /// The next instant after `time` (s) at which it starts, crosses over or ends.
    #[inline(never)]
    pub fn next_break(&self, time: f64) -> Option<f64> {
        let crossover = self.crossover.filter(|crossover| *crossover > time);
        let end = self.window.next_end(time)?;
        Some(crossover.map_or(end, |crossover| end.min(crossover)))
    }

    /// The shorter of a quarter of the period at `time` (s) and the time in which the frequency changes by a factor of
    /// e, s.
    #[inline(never)]
    pub fn longest_step(&self, time: f64) -> f64 {
        let quarter = 0.25 / self.frequency_after(time - self.window.start);
        let x = self.rate * quarter;
        let turning = if x <= -1.0 {
            f64::INFINITY
        } else if x == 0.0 {
            quarter
        } else {
            x.ln_1p() / self.rate
        };
        turning.min(1.0 / self.rate.abs())
    }
}

/// `ln(a / b)`, accurate also if the two are close.
fn logarithm(a: f64, b: f64) -> f64 {
    let part = (a - b) / b;
    if part.abs() < 0.5 { part.ln_1p() } else { (a / b).ln() }
}

/// `(e^x - 1) / x - 1`.
fn excess(x: f64) -> f64 {
    if x.abs() >= SMALL {
        return (x.exp_m1() - x) / x;
    }
    let (mut term, mut sum) = (0.5 * x, 0.5 * x);
    for n in 3..20 {
        term *= x / f64::from(n);
        sum += term;
        if term.abs() < 1e-18 {
            break;
        }
    }
    sum
}
