//! The continuous inputs at the start of a communication step, and their rates over it.

use crate::error::SceneError;
use crate::link::Ways;
use crate::scene::check_range;
use crate::variables::RealInput;
use serde::{Deserialize, Serialize};

/// Values of the inputs and their rates. SI units. With rates of 0 the inputs are held.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    /// Acceleration of the frame, positive presses the contact, m/s2.
    pub base_acceleration: f64,
    /// Displacement of the fixed contact, positive closes, m. Over the step the contact moves linearly from its
    /// present position to this value plus rate times step size: without a rate it lags one step behind.
    pub support_displacement: f64,
    /// Displacement of the second fixed contact relative to the first, positive closes, m. It moves as that does.
    pub second_displacement: f64,
    /// Position of the pusher, positive presses, m. It moves as the fixed contact does.
    pub pusher_displacement: f64,
    /// Current of the coil, relative to that of the hold force. Over the step its mean counts.
    pub coil_relative_current: f64,
    /// Current through the contact, A.
    pub contact_current: f64,
    /// Rate of the acceleration, m/s3.
    pub base_acceleration_rate: f64,
    /// Rate of the displacement, m/s.
    pub support_displacement_rate: f64,
    /// Rate of the displacement of the second fixed contact, m/s.
    pub second_displacement_rate: f64,
    /// Rate of the position of the pusher, m/s.
    pub pusher_displacement_rate: f64,
    /// Rate of the current of the coil, 1/s.
    pub coil_relative_current_rate: f64,
    /// Rate of the current, A/s.
    pub contact_current_rate: f64,
}

impl Default for Inputs {
    /// The start values of `modelDescription.xml`: nothing moves, and the coil has its current.
    fn default() -> Self {
        Self {
            base_acceleration: 0.0,
            support_displacement: 0.0,
            second_displacement: 0.0,
            pusher_displacement: 0.0,
            coil_relative_current: 1.0,
            contact_current: 0.0,
            base_acceleration_rate: 0.0,
            support_displacement_rate: 0.0,
            second_displacement_rate: 0.0,
            pusher_displacement_rate: 0.0,
            coil_relative_current_rate: 0.0,
            contact_current_rate: 0.0,
        }
    }
}

impl Inputs {
    /// Value of an input.
    pub fn real(&self, input: RealInput) -> f64 {
        let mut inputs = *self;
        *inputs.real_mut(input)
    }

    /// Sets an input.
    ///
    /// # Errors
    /// [`SceneError::OutOfRange`] outside the range of `modelDescription.xml`; the inputs are then unchanged.
    pub fn set_real(&mut self, input: RealInput, value: f64) -> Result<(), SceneError> {
        check_range(input.variable(), value, false)?;
        *self.real_mut(input) = value;
        Ok(())
    }

    fn real_mut(&mut self, input: RealInput) -> &mut f64 {
        match input {
            RealInput::BaseAcceleration => &mut self.base_acceleration,
            RealInput::SupportDisplacement => &mut self.support_displacement,
            RealInput::SecondDisplacement => &mut self.second_displacement,
            RealInput::PusherDisplacement => &mut self.pusher_displacement,
            RealInput::CoilRelativeCurrent => &mut self.coil_relative_current,
            RealInput::ContactCurrent => &mut self.contact_current,
        }
    }

    /// Sets the rate of an input, in its unit per second.
    ///
    /// # Errors
    /// [`SceneError::OutOfRange`] for a value that is not finite; the inputs are then unchanged.
    pub fn set_rate(&mut self, input: RealInput, rate: f64) -> Result<(), SceneError> {
        if !rate.is_finite() {
            let allowed = "allowed as derivative is any finite number";
            return Err(SceneError::out_of_range(input.variable(), rate, allowed.to_owned()));
        }
        *self.rate_mut(input) = rate;
        Ok(())
    }

    fn rate(&self, input: RealInput) -> f64 {
        let mut inputs = *self;
        *inputs.rate_mut(input)
    }

    fn rate_mut(&mut self, input: RealInput) -> &mut f64 {
        match input {
            RealInput::BaseAcceleration => &mut self.base_acceleration_rate,
            RealInput::SupportDisplacement => &mut self.support_displacement_rate,
            RealInput::SecondDisplacement => &mut self.second_displacement_rate,
            RealInput::PusherDisplacement => &mut self.pusher_displacement_rate,
            RealInput::CoilRelativeCurrent => &mut self.coil_relative_current_rate,
            RealInput::ContactCurrent => &mut self.contact_current_rate,
        }
    }

    /// Checks that the values after `size` seconds are in range.
    ///
    /// # Errors
    /// [`SceneError::OutOfRange`] for the first that is not.
    pub fn check_after(&self, size: f64) -> Result<(), SceneError> {
        let mut changing = RealInput::ALL.iter().filter(|input| self.rate(**input) != 0.0);
        changing.try_for_each(|input| {
            let value = self.real(*input) + self.rate(*input) * size;
            check_range(input.variable(), value, false)
        })
    }

    /// Whether every value is in its range and every rate is finite.
    pub fn are_sound(&self) -> bool {
        RealInput::ALL.iter().all(|input| {
            check_range(input.variable(), self.real(*input), false).is_ok() && self.rate(*input).is_finite()
        })
    }

    /// Whether the inputs are constant over the step.
    pub fn are_held(&self) -> bool {
        RealInput::ALL.iter().all(|input| self.rate(*input) == 0.0)
    }

    /// Holds the inputs at their values.
    pub fn hold(&mut self) {
        for input in RealInput::ALL {
            *self.rate_mut(*input) = 0.0;
        }
    }

    /// Displacements of the bodies that inputs move after `size` seconds, m.
    pub fn displacements_after(&self, size: f64) -> Ways {
        [
            self.support_displacement + self.support_displacement_rate * size,
            self.second_displacement + self.second_displacement_rate * size,
            self.pusher_displacement + self.pusher_displacement_rate * size,
        ]
    }

    /// Current after `size` seconds, A.
    pub fn contact_current_after(&self, size: f64) -> f64 {
        self.contact_current + self.contact_current_rate * size
    }
}
