//! The continuous inputs, as they stand at the start of a communication step.

use crate::error::SceneError;
use crate::scene::check_range;
use crate::variables::RealInput;
use serde::{Deserialize, Serialize};

/// Values of the inputs. SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    /// Acceleration of the frame, positive presses the contact, m/s2.
    pub base_acceleration: f64,
    /// Displacement of the fixed contact, positive closes, m. Reached linearly at the end of the step.
    pub support_displacement: f64,
    /// Current through the contact, A.
    pub contact_current: f64,
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
            RealInput::ContactCurrent => &mut self.contact_current,
        }
    }
}
