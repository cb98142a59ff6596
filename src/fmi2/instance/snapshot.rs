//! What a saved state holds of an instance.

use serde::{Deserialize, Serialize};

use crate::fmi2::states::State;
use crate::inputs::Inputs;
use crate::integrator::motion::{Motion, on_heap};
use crate::preload::Initial;
use crate::scene::Scene;

/// Larger tolerances of the experiment are reduced to this one, the largest that `solver.tolerance` allows.
pub(super) const LARGEST_TOLERANCE: f64 = 0.1;

/// The arguments of `fmi2SetupExperiment`; without a call start time zero, no tolerance, no stop time.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(super) struct Experiment {
    pub(super) tolerance: Option<f64>,
    pub(super) start_time: f64,
    pub(super) stop_time: Option<f64>,
}

impl Experiment {
    /// The scene, with the tolerance of the experiment if it has none of its own.
    pub(super) fn scene(&self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        if let Some(tolerance) = self.tolerance.filter(|_| scene.solver.tolerance == 0.0) {
            scene.solver.tolerance = tolerance;
        }
        scene
    }
}

/// A snapshot of an instance, without the log settings, which belong to the importer.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::fmi2) struct Snapshot {
    pub(super) state: State,
    pub(super) scene: Scene,
    pub(super) inputs: Inputs,
    pub(super) experiment: Experiment,
    /// The state of the simulation, and the inputs that belong to its preload.
    pub(super) simulation: Option<SavedMotion>,
    pub(super) time: f64,
}

/// The state of a simulation, and the inputs that belong to its preload.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::fmi2) struct SavedMotion {
    #[serde(deserialize_with = "on_heap")]
    pub(super) motion: Box<Motion>,
    pub(super) initial: Initial,
}

impl Snapshot {
    /// Whether an instance can reach these numbers. The scene itself is checked by the model.
    pub(in crate::fmi2) fn is_sound(&self) -> bool {
        let Experiment { tolerance, start_time, stop_time } = self.experiment;
        let simulation = self.simulation.as_ref();
        let simulates = simulation.is_some() || !matches!(self.state, State::StepComplete | State::Terminated);
        simulates
            && self.inputs.are_sound()
            && tolerance.is_none_or(|tolerance| tolerance > 0.0 && tolerance <= LARGEST_TOLERANCE)
            && start_time.is_finite()
            && stop_time.is_none_or(|stop| stop >= start_time)
            && self.time >= start_time
            && self.time.is_finite()
            && simulation.is_none_or(|SavedMotion { motion, initial }| {
                motion.is_sound() && motion.time == self.time && initial.is_finite()
            })
    }
}
