//! Step lengths: the length of the next step by the error of this one, and with how many nodes.

use serde::{Deserialize, Serialize};

use crate::contact::friction::Phase;
use crate::integrator::constants::{GROWING, LEAST_SHRINK, LONGER, MOST_SHRINK, ROUNDED, SAFETY, STEP_GROWTH, WORTH};

/// The step lengths that the error estimate allows, s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepLengths {
    /// Longest step with few nodes.
    pub short: f64,
    /// Longest step with many nodes while a contact is closed.
    pub long: f64,
    /// Longest step in flight.
    pub flight: f64,
    /// Longest leap after a closing.
    pub leap: f64,
    /// Length of the last step; 0: none from which the next one could be guessed.
    pub last: f64,
    /// Length of the first step after slip has begun, and after it has ended: as long as the last of them that was taken;
    /// 0: none was.
    pub after_change: [f64; 2],
}

/// The next step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Proposal {
    /// With few nodes, of this length (s).
    Short(f64),
    /// With many nodes, of this length (s).
    Long(f64),
}

/// Outcome of a step: accepted or rejected, and the size of the next one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepOutcome {
    /// Whether it was accepted.
    pub(crate) accepted: bool,
    /// Whether a contact opened or closed with it, or began or ceased to slip: short steps begin anew.
    pub(crate) switched: bool,
    /// Factor to its length that its error would have allowed.
    pub(crate) growth: f64,
    /// Proposed length of the next step, s.
    pub(crate) length: f64,
}

impl StepOutcome {
    /// After an accepted step of `length` seconds where `requested` seconds were proposed. The growth is that which its error would have
    /// allowed, and the most there is.
    pub(crate) fn accepted(length: f64, requested: f64, (growth, most): (f64, f64)) -> Self {
        let next = growth.min(most) * length;
        Self {
            accepted: true,
            switched: false,
            // Leaving a kink just behind it, a step would have any factor.
            growth: growth.min(MOST_GROWTH),
            // A step shortened by the grid keeps the size proposed before.
            length: if length < SAFETY * requested { requested.max(next) } else { next },
        }
    }
}

/// Most factor on the length after a step: no proposal makes use of more, 1.
const MOST_GROWTH: f64 = LONGER * STEP_GROWTH;

impl StepLengths {
    /// All of this length (s), at the start.
    pub fn new(length: f64) -> Self {
        Self { short: length, long: length, flight: length, leap: length, last: 0.0, after_change: [0.0; 2] }
    }

    /// Whether a simulation can reach these numbers.
    pub(crate) fn is_sound(&self) -> bool {
        let Self { short, long, flight, leap, last, after_change } = self;
        [short, flight, leap].into_iter().all(|length| *length > 0.0 && length.is_finite())
            && [long, last].into_iter().chain(after_change).all(|length| (0.0..f64::INFINITY).contains(length))
    }

    /// The longest step that is possible now, s.
    pub(crate) fn own(&self) -> f64 {
        self.short.max(self.long)
    }

    /// The next step: with few nodes where they suffice, else with many. `smooth`: length over which the force is smooth enough for
    /// many while a contact is closed, s.
    pub(crate) fn propose(&self, closed: bool, smooth: f64, remaining: f64) -> Proposal {
        // In flight the force is known.
        let long = if closed { self.long.min(smooth) } else { self.flight };
        if remaining <= self.short || closed && long < WORTH * self.short {
            Proposal::Short(self.short)
        } else {
            Proposal::Long(long)
        }
    }

    /// Keeps what a step has shown. `remaining`: what was left to integrate (s) before it; `driven`: inputs change in each
    /// communication step; `blows`: a contact has closed before.
    pub(crate) fn keep(
        &mut self,
        proposal: Proposal,
        outcome: &StepOutcome,
        closed: bool,
        remaining: f64,
        (driven, blows): (bool, bool),
    ) {
        match proposal {
            Proposal::Short(_) if outcome.switched => {}
            Proposal::Short(_) => {
                self.short = outcome.length;
                if outcome.accepted && outcome.growth < GROWING {
                    self.long = self.long.max(2.0 * WORTH * outcome.length);
                }
            }
            Proposal::Long(long) => {
                let short = self.short;
                if closed {
                    self.long = outcome.length;
                    if !outcome.accepted && blows {
                        // Nor would a short one reach as far.
                        self.short = short.min(outcome.length / WORTH);
                    }
                } else {
                    self.flight = outcome.length;
                }
                // A long step cut far below its possible size: a short one will do next time.
                if outcome.accepted && !outcome.switched {
                    // Where inputs change, whether a little more would do shows when it is tried.
                    let again = if driven { short / SAFETY } else { short };
                    self.short = again.max(outcome.growth * remaining.min(long) / LONGER);
                }
            }
        }
    }

    /// The length of the first step in this phase of friction.
    pub(crate) fn after_change(&mut self, phase: Phase) -> &mut f64 {
        let [of_slip, of_stick] = &mut self.after_change;
        if phase == Phase::Stick { of_stick } else { of_slip }
    }
}

/// Factor on the length after a step of the relative error `ratio`.
pub(crate) fn growth<const S: usize>(ratio: f64) -> f64 {
    if ratio < ROUNDED { MOST_GROWTH } else { (SAFETY * step_factor::<S>(ratio)).max(MOST_SHRINK) }
}

/// The relative error after which [`growth`] is this factor.
#[expect(clippy::cast_possible_wrap, clippy::cast_possible_truncation, reason = "few nodes")]
pub(crate) fn error_of_growth<const S: usize>(factor: f64) -> f64 {
    (SAFETY / factor).powi(S as i32 + 1)
}

/// Factor on the length after a rejection for the relative error `ratio`, with the safety factor applied twice; the largest where
/// Newton's method has failed, which tells nothing of the error.
pub(crate) fn shrinkage<const S: usize>(ratio: f64) -> f64 {
    if ratio.is_finite() {
        (SAFETY * SAFETY * step_factor::<S>(ratio)).clamp(LEAST_SHRINK, MOST_SHRINK)
    } else {
        MOST_SHRINK
    }
}

/// Factor to the step size at which the relative error `ratio` becomes 1: the error estimate is of order `S + 1`.
fn step_factor<const S: usize>(ratio: f64) -> f64 {
    ratio.powf(-1.0 / (S as f64 + 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::nodal::{LONG, SHORT};

    #[test]
    fn a_step_grows_by_the_factor_of_its_error() {
        for factor in [1.0, 1.5, 2.0] {
            let of_both =
                [growth::<SHORT>(error_of_growth::<SHORT>(factor)), growth::<LONG>(error_of_growth::<LONG>(factor))];
            // A power and a root round.
            assert!(of_both.iter().all(|growth| (growth / factor - 1.0).abs() < 1e-14), "{of_both:?}");
        }
    }
}
