//! A scene under way: the model, its state, and the scratch the steps need.

use crate::error::{SceneError, StepError};
use crate::inputs::Inputs;
use crate::scene::Scene;
use crate::variables::{BooleanOutput, IntegerOutput, RealOutput};

/// A simulation from its preload onwards.
#[derive(Clone, Debug)]
pub struct Simulation {
    time: f64,
}

impl Simulation {
    /// The scene at rest in its preload at `start_time`, s. The initial `support.displacement` belongs to the preload.
    ///
    /// # Errors
    /// A [`SceneError`] where the scene cannot be simulated.
    pub fn new(scene: &Scene, _inputs: &Inputs, start_time: f64) -> Result<Self, SceneError> {
        scene.validate()?;
        Ok(Self { time: start_time })
    }

    /// Advances over the communication step from `time` to `time + step_size`, s, with inputs held.
    ///
    /// `time` may differ from [`Simulation::time`] by rounding.
    ///
    /// # Errors
    /// A [`StepError`]; the state is then what it was before the call.
    pub fn step(&mut self, _inputs: &Inputs, time: f64, step_size: f64) -> Result<(), StepError> {
        self.time = time + step_size;
        Ok(())
    }

    /// The instant reached, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// A real output or calculated parameter, in its SI unit.
    pub fn real(&self, _output: RealOutput) -> f64 {
        0.0
    }

    /// An integer output or calculated parameter.
    pub fn integer(&self, _output: IntegerOutput) -> i32 {
        0
    }

    /// A Boolean output.
    pub fn boolean(&self, _output: BooleanOutput) -> bool {
        false
    }
}
