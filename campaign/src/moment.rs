//! What is true of an instance at a moment.

use crate::description::DESCRIPTION;
use crate::states::Phase;

/// All that is true of an instance at a moment, and that a saved state brings back.
#[derive(Clone, Debug)]
pub struct Moment {
    /// Where in its life.
    pub phase: Phase,
    /// Values of the inputs and parameters, in the order of the description.
    pub values: Vec<f64>,
    /// Derivatives of the inputs over the next step, in the same order.
    pub rates: Vec<f64>,
    /// Where it stands, s.
    pub time: f64,
    /// End of the experiment, s.
    pub stop: f64,
    /// Whether outputs have been computed.
    pub computed: bool,
    /// Whether the parameters fit together, once that is known.
    pub fits: Option<bool>,
    /// Whether it was driven by more than numbers can follow, so that a step may fail.
    pub extreme: bool,
    /// The bits of the outputs, once read at this communication point.
    pub outputs: Option<Vec<u64>>,
}

impl Default for Moment {
    /// A new instance.
    fn default() -> Self {
        Self {
            phase: Phase::Instantiated,
            values: DESCRIPTION.variables.iter().map(|variable| variable.start).collect(),
            rates: vec![0.0; DESCRIPTION.variables.len()],
            time: 0.0,
            stop: f64::INFINITY,
            computed: false,
            fits: None,
            extreme: false,
            outputs: None,
        }
    }
}

impl Moment {
    /// The value of an input or parameter.
    pub fn value(&self, reference: u32) -> f64 {
        DESCRIPTION
            .position(reference)
            .map_or(f64::NAN, |position| self.values[position])
    }

    /// Whether inputs and parameters are as they were at the start.
    pub fn is_untouched(&self) -> bool {
        let mut pairs = DESCRIPTION.variables.iter().zip(&self.values);
        pairs.all(|(variable, value)| *value == variable.start)
    }

    /// Whether the inputs are beyond what the ranges of the generated excitation allow, which are meant to be wide.
    pub fn pushed_hard(&self) -> bool {
        let acceleration = DESCRIPTION.reference("base.acceleration");
        let rate = DESCRIPTION
            .position(acceleration)
            .map_or(0.0, |position| self.rates[position]);
        self.value(acceleration).abs() > 1e6 || rate.abs() > 1e12
    }
}
