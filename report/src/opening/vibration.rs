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

/// Thresholds are found to this part of them.
pub const RESOLUTION: f64 = 1e-4;

/// Standard acceleration of free fall, m/s2.
pub const G: f64 = 9.80665;

/// What came of shaking.
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

    /// Of a run up to now, whose least force is known.
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

/// What a threshold is sought of.
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

/// Shakes with a frequency (Hz) and an amplitude (m/s2), to the end or until the answer is yes.
pub fn shake(frequency: f64, amplitude: f64, until: Option<Question>) -> Result<Outcome> {
    let mut contact = Simulation::new(&shaken(frequency, amplitude), &Inputs::default(), 0.0)?;
    let preload = contact.real(RealOutput::PreloadForce);
    let (duration, periods) = DWELL;
    let periods = (duration * frequency).max(periods).ceil();
    let mut outcome = Outcome {
        opened: false,
        least_force: 1.0,
        interruptions: 0,
        longest: 0.0,
    };
    let mut period = 0.0;
    while period < periods && !until.is_some_and(|question| question.answer(&outcome)) {
        period += 1.0;
        let time = contact.time();
        contact.step(&Inputs::default(), time, period / frequency - time)?;
        let least_force = contact.real(RealOutput::StepMinimumForce) / preload;
        outcome = Outcome::of(&contact, outcome.least_force.min(least_force));
    }
    Ok(outcome)
}

/// Accelerations at a frequency (Hz) from which on the contact opens, m/s2.
#[derive(Clone, Copy, Debug)]
pub struct Thresholds {
    pub frequency: f64,
    /// By linear theory.
    pub linear: f64,
    pub opens: f64,
    pub interrupts: f64,
}

/// All thresholds at a frequency (Hz).
pub fn thresholds(frequency: f64) -> Result<Thresholds> {
    let model = Model::new(&Scene::default(), 0.0)?;
    let linear = reference::opening_threshold(&model, TAU * frequency);
    let opens = threshold(frequency, 0.5 * linear, 1.1, Question::Opens)?;
    // From just below, as 60 Ohm are reached before the force is zero. In small steps: an interruption must not be missed
    // where a stronger vibration would close the contact earlier.
    let interrupts = threshold(frequency, 0.99 * opens, 1.01, Question::Interrupts)?;
    Ok(Thresholds {
        frequency,
        linear,
        opens,
        interrupts,
    })
}

/// Least acceleration for which the answer is yes: by steps of a factor from one for which it is no, then by bisection.
fn threshold(frequency: f64, mut low: f64, factor: f64, question: Question) -> Result<f64> {
    let yes = |amplitude: f64| Ok::<_, anyhow::Error>(question.answer(&shake(frequency, amplitude, Some(question))?));
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
        for (threshold, question) in [(found.opens, Question::Opens), (found.interrupts, Question::Interrupts)] {
            for (factor, answer) in [(1.0 - 2.0 * RESOLUTION, false), (1.0 + RESOLUTION, true)] {
                let outcome = shake(1000.0, factor * threshold, None)?;
                assert_eq!(question.answer(&outcome), answer, "{factor}: {outcome:?}");
            }
        }
        Ok(())
    }
}
