//! The expected state of an instance.

use crate::description::DESCRIPTION;
use crate::states::Phase;

/// The expected state of an instance, which a saved state restores.
#[derive(Clone, Debug)]
pub struct Moment {
    pub phase: Phase,
    /// Values of the inputs and parameters, in the order of the description.
    pub values: Vec<f64>,
    /// Derivatives of the inputs over the next step, in the same order.
    pub rates: Vec<f64>,
    /// Of the instance, s.
    pub time: f64,
    /// s.
    pub stop: f64,
    /// Whether outputs have been computed.
    pub computed: bool,
    /// Whether the parameters are consistent, once known.
    pub fits: Option<bool>,
    /// Whether inputs were so extreme that a step may fail.
    pub extreme: bool,
    /// The bits of the outputs, if read at this communication point.
    pub outputs: Option<Vec<u64>>,
}

impl Default for Moment {
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
        DESCRIPTION.position(reference).map_or(f64::NAN, |position| self.values[position])
    }

    /// Whether inputs and parameters have their start values.
    pub fn is_untouched(&self) -> bool {
        let mut pairs = DESCRIPTION.variables.iter().zip(&self.values);
        pairs.all(|(variable, value)| *value == variable.start)
    }

    /// Whether the inputs exceed the ranges of the generated excitation.
    pub fn pushed_hard(&self) -> bool {
        let acceleration = DESCRIPTION.reference("base.acceleration");
        let rate = DESCRIPTION.position(acceleration).map_or(0.0, |position| self.rates[position]);
        self.value(acceleration).abs() > 1e6 || rate.abs() > 1e12
    }
}
