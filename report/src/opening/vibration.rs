//! The specimen shaken with a sine, from rest: whether its contact opens, and from which acceleration on.

use std::f64::consts::TAU;

use anyhow::{Result, bail};
use relay_contact::inputs::Inputs;
use relay_contact::reference::{self, Model};
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ExcitationKind, IntegerOutput, RealOutput};

/// Least time and least number of periods for which it is shaken, s: what the start leaves behind dies away at 2900 1/s, so
/// after 30 ms nothing of it is left.
pub const DWELL: (f64, f64) = (0.03, 10.0);

/// The same of the ramp before.
pub const RAMP: (f64, f64) = (0.01, 10.0);

/// Linear pieces of a period in which the ramp is given: off it by 1e-3 of the amplitude, and exact at its end.
const PIECES: f64 = 64.0;

/// Thresholds are found to this part of them.
pub const RESOLUTION: f64 = 1e-4;

/// Standard acceleration of free fall, m/s2.
pub const G: f64 = 9.80665;

/// The result of a vibration or shock.
#[derive(Clone, Copy, Debug)]
pub struct Outcome {
    pub opened: bool,
    /// Least contact force, of the preload force.
    pub least_force: f64,
    /// Interruptions that count.
    pub interruptions: i32,
    /// s.
    pub longest: f64,
}

impl Outcome {
    /// Whether it opens at all, whether for long enough to count, the longest interruption, the least force.
    pub fn cells(&self) -> [String; 4] {
        let yes = |answer: bool| if answer { "yes" } else { "no" }.to_owned();
        [
            yes(self.opened),
            yes(self.interruptions > 0),
            if self.longest > 0.0 {
                format!("{:.1} µs", 1e6 * self.longest)
            } else {
                "none".to_owned()
            },
            format!("{:.1} %", 100.0 * self.least_force),
        ]
    }

    /// Of a run so far, with its least force.
    pub fn of(contact: &Simulation, least_force: f64) -> Self {
        Self {
            opened: contact.real(RealOutput::ContactLastOpening) >= 0.0,
            least_force,
            interruptions: contact.integer(IntegerOutput::ChatterCount),
            longest: contact.real(RealOutput::ChatterLongestInterruption),
        }
    }
}

/// Titles of [`Outcome::cells`].
pub const COLUMNS: [&str; 4] = [
    "opens at all",
    "opens for 10 µs or more",
    "longest interruption",
    "smallest force, relative to the preload",
];

/// How a vibration begins.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// Its amplitude grows, so that no transient is left and what is seen is the steady vibration.
    Ramped,
    /// With its whole amplitude.
    Sudden,
}

/// Criterion of a threshold.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Question {
    /// The contact force reaches zero.
    Opens,
    /// The resistance is high for as long as counts as an interruption.
    Interrupts,
}

impl Question {
    fn answer(self, outcome: &Outcome) -> bool {
        match self {
            Self::Opens => outcome.opened,
            Self::Interrupts => outcome.interruptions > 0,
        }
    }
}

fn shaken(frequency: f64, amplitude: f64) -> Scene {
    let mut scene = Scene::default();
    scene.effects.excitation = ExcitationKind::Sine;
    scene.excitation.frequency = frequency;
    scene.excitation.amplitude = amplitude;
    scene
}

/// The number of periods that last at least a time (s) and are at least a number.
fn periods(frequency: f64, (time, number): (f64, f64)) -> f64 {
    (time * frequency).max(number).ceil()
}

/// Vibrates at a frequency (Hz) with an amplitude (m/s2), to the end or until the criterion is met.
pub fn shake(frequency: f64, amplitude: f64, start: Start, until: Option<Question>) -> Result<Outcome> {
    let mut contact = Simulation::new(&shaken(frequency, amplitude), &Inputs::default(), 0.0)?;
    let preload = contact.real(RealOutput::PreloadForce);
    let ramp = match start {
        Start::Ramped => periods(frequency, RAMP),
        Start::Sudden => 0.0,
    };
    let end = ramp + periods(frequency, DWELL);
    // What the ramp lacks of the generated sine, at a time in periods.
    let lacking = |period: f64| {
        let part = (period / ramp).min(1.0);
        (part - (TAU * part).sin() / TAU - 1.0) * amplitude * (TAU * period).sin()
    };
    let mut outcome = Outcome {
        opened: false,
        least_force: 1.0,
        interruptions: 0,
        longest: 0.0,
    };
    let mut period = 0.0;
    while period < end && !until.is_some_and(|question| question.answer(&outcome)) {
        let (time, mut inputs, mut length) = (contact.time(), Inputs::default(), 1.0);
        if period < ramp {
            length = 1.0 / PIECES;
            inputs.base_acceleration = lacking(period);
            inputs.base_acceleration_rate = (lacking(period + length) - lacking(period)) / length * frequency;
        }
        period += length;
        contact.step(&inputs, time, period / frequency - time)?;
        let least_force = contact.real(RealOutput::StepMinimumForce) / preload;
        outcome = Outcome::of(&contact, outcome.least_force.min(least_force));
    }
    Ok(outcome)
}

/// Accelerations at a frequency (Hz) from which on the contact opens, m/s2.
#[derive(Clone, Copy, Debug)]
pub struct Thresholds {
    pub frequency: f64,
    /// Steady vibration: by linear theory, at all, and for as long as counts as an interruption.
    pub linear: f64,
    pub opens: f64,
    pub interrupts: f64,
    /// For as long as counts as an interruption, after a sudden start.
    pub sudden: f64,
}

/// All thresholds at a frequency (Hz).
pub fn thresholds(frequency: f64) -> Result<Thresholds> {
    let model = Model::new(&Scene::default(), 0.0)?;
    let linear = reference::opening_threshold(&model, TAU * frequency);
    let both = |start| {
        let low = if start == Start::Ramped { 0.9 } else { 0.5 };
        let opens = threshold(frequency, low * linear, 1.1, start, Question::Opens)?;
        // From just below, as 60 Ohm are reached before the force is zero. In small steps: an interruption must not be missed
        // where a stronger vibration would close the contact earlier.
        let interrupts = threshold(frequency, 0.99 * opens, 1.01, start, Question::Interrupts)?;
        Ok::<_, anyhow::Error>((opens, interrupts))
    };
    let ((opens, interrupts), (_, sudden)) = (both(Start::Ramped)?, both(Start::Sudden)?);
    Ok(Thresholds {
        frequency,
        linear,
        opens,
        interrupts,
        sudden,
    })
}

/// Least acceleration for which the answer is yes: by steps of a factor from one for which it is no, then by bisection.
fn threshold(frequency: f64, mut low: f64, factor: f64, start: Start, question: Question) -> Result<f64> {
    let yes = |amplitude: f64| {
        let outcome = shake(frequency, amplitude, start, Some(question))?;
        Ok::<_, anyhow::Error>(question.answer(&outcome))
    };
    if yes(low)? {
        bail!("{low} m/s2 at {frequency} Hz: not expected to open the contact yet");
    }
    let mut high = factor * low;
    while !yes(high)? {
        (low, high) = (high, factor * high);
    }
    while high > (1.0 + RESOLUTION) * low {
        let middle = f64::midpoint(low, high);
        if yes(middle)? {
            high = middle;
        } else {
            low = middle;
        }
    }
    Ok(high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_thresholds_of_the_published_frequency() -> Result<()> {
        let found = thresholds(1000.0)?;
        // 400 m/s2 opens it for 380.6 us (two other methods); 98 m/s2 leave it two thirds of its force.
        assert!(found.opens > 98.0 && found.interrupts < 400.0, "{found:?}");
        for (threshold, start, question) in [
            (found.opens, Start::Ramped, Question::Opens),
            (found.interrupts, Start::Ramped, Question::Interrupts),
            (found.sudden, Start::Sudden, Question::Interrupts),
        ] {
            for (factor, answer) in [(1.0 - 2.0 * RESOLUTION, false), (1.0 + RESOLUTION, true)] {
                let outcome = shake(1000.0, factor * threshold, start, None)?;
                assert_eq!(question.answer(&outcome), answer, "{factor}: {outcome:?}");
            }
        }
        Ok(())
    }

    #[test]
    fn steady_vibration_above_the_resonance_opens_it_as_linear_theory_says_and_a_sudden_start_earlier() -> Result<()> {
        let found = thresholds(2000.0)?;
        // Linear theory is right to a thousandth where the force amplitude is a third of the preload (`paper::tests`), and its
        // error goes with the square of that amplitude.
        assert!((found.opens / found.linear - 1.0).abs() < 9e-3, "{found:?}");
        // Found by an importer's user: 52 g after a sudden start, 65 g in steady vibration.
        for (threshold, acceleration) in [(found.sudden, 52.0), (found.interrupts, 65.0)] {
            assert!((threshold / G - acceleration).abs() < 0.5, "{found:?}");
        }
        Ok(())
    }
}
