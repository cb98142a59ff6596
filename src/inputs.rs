//! The continuous inputs at the start of a communication step, and their rates over it, generated from `modelDescription.xml` by
//! `build.rs`.

use crate::error::SceneError;
use crate::link::{INPUTS, Ways};
use crate::scene::check_range;
use crate::variables::{RealInput, Variable};
use serde::{Deserialize, Serialize};

include!(concat!(env!("OUT_DIR"), "/inputs.rs"));

impl Inputs {
    /// Inputs that move bodies.
    pub const MOVING: [RealInput; INPUTS] =
        [RealInput::SupportDisplacement, RealInput::SecondDisplacement, RealInput::PusherDisplacement];

    /// Value of an input.
    pub fn real(&self, input: RealInput) -> f64 {
        let mut inputs = *self;
        *inputs.course_mut(input).0
    }

    /// Sets an input.
    ///
    /// # Errors
    /// [`SceneError::OutOfRange`] outside the range of `modelDescription.xml`; the inputs are then unchanged.
    pub fn set_real(&mut self, input: RealInput, value: f64) -> Result<(), SceneError> {
        check_range(input.variable(), value)?;
        *self.course_mut(input).0 = value;
        Ok(())
    }

    /// Sets the rate of an input, in its unit per second.
    ///
    /// # Errors
    /// [`SceneError::OutOfRange`] for a value that is not finite; the inputs are then unchanged.
    pub fn set_rate(&mut self, input: RealInput, rate: f64) -> Result<(), SceneError> {
        if !rate.is_finite() {
            let Variable { name, unit, .. } = *input.variable();
            let allowed = "allowed as derivative is any finite number".to_owned();
            return Err(SceneError::OutOfRange { name, value: rate, unit, allowed });
        }
        *self.course_mut(input).1 = rate;
        Ok(())
    }

    /// Rate of an input, in its unit per second.
    pub fn rate(&self, input: RealInput) -> f64 {
        let mut inputs = *self;
        *inputs.course_mut(input).1
    }

    /// Value of an input after `size` seconds.
    pub fn after(&self, input: RealInput, size: f64) -> f64 {
        self.real(input) + self.rate(input) * size
    }

    /// Displacements of the bodies that inputs move after `size` seconds, m, in the order of [`Self::MOVING`].
    pub fn displacements_after(&self, size: f64) -> Ways {
        Self::MOVING.map(|input| self.after(input, size))
    }

    /// Checks that the values after `size` seconds are in range.
    ///
    /// # Errors
    /// [`SceneError::OutOfRange`] for the first that is not.
    pub fn check_after(&self, size: f64) -> Result<(), SceneError> {
        let mut changing = RealInput::ALL.iter().filter(|input| self.rate(**input) != 0.0);
        changing.try_for_each(|input| check_range(input.variable(), self.after(*input, size)))
    }

    /// Whether every value is in its range and every rate is finite.
    pub fn are_sound(&self) -> bool {
        let mut inputs = RealInput::ALL.iter();
        inputs.all(|input| check_range(input.variable(), self.real(*input)).is_ok() && self.rate(*input).is_finite())
    }

    /// Whether the inputs are constant over the step.
    pub fn are_held(&self) -> bool {
        RealInput::ALL.iter().all(|input| self.rate(*input) == 0.0)
    }

    /// Holds the inputs at their values.
    pub fn hold(&mut self) {
        for input in RealInput::ALL {
            *self.course_mut(*input).1 = 0.0;
        }
    }
}
