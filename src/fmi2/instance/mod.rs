//! One instance of the component: the values set, the simulation once it exists, and the state in the life cycle.

pub(super) mod snapshot;
pub(super) mod variables;

use std::ffi::CString;
use std::path::{Path, PathBuf};

use snapshot::{Experiment, LARGEST_TOLERANCE, SavedMotion, Snapshot};

use super::failure::Failure;
use super::logger::Logger;
use super::report;
use super::resources::Identity;
use super::saved::SavedStates;
use super::states::{Function, State};
use super::types::{fmi2ComponentEnvironment, fmi2OK, fmi2Status, fmi2StepFinished, fmi2Warning};
use crate::error::{SceneError, number};
use crate::inputs::Inputs;
use crate::scene::Scene;
use crate::simulation::{Kept, Simulation};
use crate::variables::StringParameter;

#[derive(Debug)]
pub(super) struct Instance {
    pub(super) state: State,
    scene: Scene,
    inputs: Inputs,
    experiment: Experiment,
    /// In Initialization Mode: created when an output is read, dropped when a value is set.
    pub(super) simulation: Option<Box<Simulation>>,
    /// For the next one after a reset.
    _kept: Kept,
    /// The last successful time, s.
    pub(super) time: f64,
    pub(super) logger: Logger,
    resources: Option<PathBuf>,
    /// Whether all numbers are Reals.
    plain: bool,
    /// The start values, with the spring that the component may carry.
    start: Scene,
    /// The strings read last, one of each variable.
    texts: [CString; StringParameter::ALL.len()],
    told: Told,
    pub(super) step_finished: StepFinished,
    /// Those made by this instance.
    pub(super) saved_states: SavedStates,
}

/// What the importer has been told, which is told once.
#[derive(Clone, Copy, Debug, Default)]
struct Told {
    /// That its time differs.
    of_offset: bool,
    /// That the tolerance may not be kept.
    of_error: bool,
    /// That derivatives of inputs above order 1 have no effect.
    of_order: bool,
}

/// The importer's callback at the end of a communication step, and its first argument.
pub(super) type StepFinished = (fmi2StepFinished, fmi2ComponentEnvironment);

impl Instance {
    /// An instance with start values, and the spring that the component may carry.
    pub(super) fn new(
        logger: Logger,
        step_finished: StepFinished,
        resources: Option<PathBuf>,
        identity: Identity,
    ) -> Result<Self, SceneError> {
        let mut instance = Self {
            state: State::Instantiated,
            scene: Scene::default(),
            inputs: Inputs::default(),
            experiment: Experiment::default(),
            simulation: None,
            _kept: Kept::default(),
            time: 0.0,
            logger,
            resources,
            plain: identity.plain,
            start: Scene::default(),
            texts: Default::default(),
            told: Told::default(),
            step_finished,
            saved_states: SavedStates::default(),
        };
        if let Some(spring) = identity.spring {
            let mut start = Scene::default();
            instance.set_string(&mut start, StringParameter::BeamFile, &spring)?;
            (instance.scene, instance.start) = (start.clone(), start);
        }
        Ok(instance)
    }

    /// Sets a string parameter of a scene, and reads the file that it names.
    fn set_string(&self, scene: &mut Scene, parameter: StringParameter, value: &str) -> Result<(), SceneError> {
        let nowhere = self.resources.is_none() && !value.is_empty() && Path::new(value).is_relative();
        if nowhere {
            return Err(SceneError::Unreadable {
                file: value.to_owned(),
                cause: "a relative path is one in the resources of the component, and fmuResourceLocation of \
                        fmi2Instantiate names no folder"
                    .to_owned(),
            });
        }
        scene.set_string(parameter, value, self.resources.as_deref().unwrap_or(Path::new("")))
    }

    /// Logs a failure, changes the state accordingly, and returns its status.
    pub(super) fn fail(&mut self, function: Function, failure: &Failure) -> fmi2Status {
        if failure.ends_instance() {
            self.state = State::Error;
        }
        let status = failure.status();
        self.logger.log_status(status, &format!("{}: {failure}", function.name));
        // Importers end a run at fmi2Warning, so what was done is fmi2OK: the log and `solver.forceError` tell the rest.
        if status == fmi2Warning { fmi2OK } else { status }
    }

    pub(super) fn setup_experiment(
        &mut self,
        tolerance: Option<f64>,
        start_time: f64,
        stop_time: Option<f64>,
    ) -> Result<(), Failure> {
        if !start_time.is_finite() {
            return refused("startTime", start_time, "allowed is any finite number");
        }
        if let Some(stop) = stop_time.filter(|stop| stop.is_nan() || *stop < start_time) {
            let start = number(start_time);
            return refused("stopTime", stop, format!("allowed is startTime = {start} s or more"));
        }
        let usable = tolerance.filter(|tolerance| tolerance.is_finite() && *tolerance > 0.0);
        self.experiment =
            Experiment { tolerance: usable.map(|tolerance| tolerance.min(LARGEST_TOLERANCE)), start_time, stop_time };
        self.time = start_time;
        match tolerance {
            Some(unusable) if usable.is_none() => Err(Failure::Tolerance(unusable)),
            _ => Ok(()),
        }
    }

    pub(super) fn exit_initialization_mode(&mut self) -> Result<(), Failure> {
        self.prepare().map_err(Failure::Scene)?;
        self.state = State::StepComplete;
        // Also of a state saved before: the run begins anew.
        self.told.of_error = false;
        let Some(simulation) = &self.simulation else { return Ok(()) };
        if self.logger.debugs() {
            report::model(&self.logger, simulation.model());
        }
        let remarks = simulation.model().remarks();
        if remarks.is_empty() { Ok(()) } else { Err(Failure::Remarks(remarks)) }
    }

    /// Restores the state after instantiation. States that the importer has saved remain.
    pub(super) fn reset(&mut self) {
        self.state = State::Instantiated;
        self.scene = self.start.clone();
        self.inputs = Inputs::default();
        self.experiment = Experiment::default();
        self.simulation = None;
        self.time = 0.0;
        self.logger.reset();
        self.told = Told::default();
    }

    pub(super) fn snapshot(&self) -> Snapshot {
        let simulation = self.simulation.as_ref();
        Snapshot {
            state: self.state,
            scene: self.scene.clone(),
            inputs: self.inputs,
            experiment: self.experiment,
            simulation: simulation.map(|simulation| SavedMotion {
                motion: simulation.copied_motion(),
                initial: simulation.model().initial,
            }),
            time: self.time,
        }
    }

    /// Restores a snapshot. If the model is the same, only the state of the simulation is replaced.
    pub(super) fn restore(&mut self, snapshot: &Snapshot) -> Result<(), Failure> {
        let Snapshot { state, ref scene, inputs, experiment, ref simulation, time } = *snapshot;
        let wanted = experiment.scene(scene);
        match (&mut self.simulation, simulation) {
            (Some(present), Some(SavedMotion { motion, initial }))
                if present.model().scene == wanted && present.model().initial == *initial =>
            {
                present.go_on_from(motion);
            }
            (present, Some(SavedMotion { motion, initial })) => {
                let resumed = Simulation::resume(&wanted, initial, motion);
                *present = Some(Box::new(resumed.map_err(Failure::Scene)?));
            }
            (present, None) => *present = None,
        }
        (self.state, self.scene, self.inputs) = (state, scene.clone(), inputs);
        (self.experiment, self.time) = (experiment, time);
        Ok(())
    }

    /// The simulation of the values set.
    fn prepare(&mut self) -> Result<&Simulation, SceneError> {
        let made = || {
            let scene = self.experiment.scene(&self.scene);
            Simulation::new(&scene, &self.inputs, self.experiment.start_time).map(Box::new)
        };
        let simulation = self.simulation.take().map_or_else(made, Ok)?;
        Ok(self.simulation.insert(simulation))
    }

    /// Advances to the end of one communication step.
    pub(super) fn step(&mut self, point: f64, size: f64) -> Result<(), Failure> {
        let (now, end) = (self.time, point + size);
        if !(size.is_finite() && size > 0.0 && (!end.is_finite() || end > point)) {
            let allowed = "allowed is a positive finite number above the floating-point spacing of time";
            return refused("communicationStepSize", size, allowed);
        }
        let (slack, off) = (rounding(point, size), (point - now).abs());
        let tolerated = slack.max(LARGEST_OFFSET * size);
        if !(end.is_finite() && off <= tolerated) {
            let allowed =
                format!("the time of the instance is {} s, allowed difference {tolerated:.1e} s", number(now));
            return refused("currentCommunicationPoint", point, allowed);
        }
        // What is more than rounding is time that passes, or has passed already: on to the importer's end of the step.
        let is_off = off > slack;
        let (start, size) = if is_off { (now, end - now) } else { (point, size) };
        // Importers that sum up their steps accumulate rounding errors, far below a thousandth of a step in any run.
        let stop = self.experiment.stop_time;
        if let Some(stop) = stop.filter(|stop| end > stop + slack.max(1e-3 * size)) {
            let (end, stop) = (number(end), number(stop));
            let allowed = format!("the step ends at {end} s, after the stop time {stop} s of the experiment");
            return refused("communicationStepSize", size, allowed);
        }
        let held = self.inputs.are_held();
        if !held {
            self.inputs.check_after(size).map_err(Failure::Course)?;
        }
        let Some(simulation) = &mut self.simulation else {
            return Err(Failure::Panic("no simulation after initialisation".to_owned()));
        };
        let before = self.logger.debugs().then(|| report::effort(simulation));
        simulation.step(&self.inputs, start, size).map_err(Failure::Step)?;
        self.time = simulation.time();
        if !held {
            self.inputs.hold();
        }
        if let Some(before) = before {
            report::step(&self.logger, simulation, before);
        }
        if is_off && !std::mem::replace(&mut self.told.of_offset, true) {
            return Err(Failure::Offset { point, time: now });
        }
        if !self.told.of_error {
            let tolerance = simulation.model().scene.solver.effective_tolerance();
            let error = simulation.force_error();
            self.told.of_error = error > ANNOUNCED * tolerance;
            if self.told.of_error {
                return Err(Failure::Inaccurate { time: end, tolerance, error, modes: simulation.model().modes.len() });
            }
        }
        Ok(())
    }
}

fn refused(name: &'static str, value: f64, allowed: impl Into<String>) -> Result<(), Failure> {
    let allowed = allowed.into();
    Err(Failure::Argument { name, value, allowed })
}

/// The estimate of the error over the tolerance from which on the importer is told: for half of the relays it is that far
/// above the error.
const ANNOUNCED: f64 = 30.0;

/// Largest difference between the importer's time and that of the instance, as a fraction of the step. Importers that add
/// up steps in single precision are off by half a spacing of these numbers: by this much after 1600 equal steps.
const LARGEST_OFFSET: f64 = 1e-4;

/// Largest difference of two times that are the same communication point, s.
/// An importer computes the end of a step as `t + h`, as `n h` or from a grid in another unit: three or four roundings
/// of half a floating-point spacing at that time, on both sides. The second term is for importers that store the step
/// size with fewer digits; a shift of 1e-9 of a step does not affect the result.
fn rounding(point: f64, size: f64) -> f64 {
    8.0 * f64::EPSILON * point.abs().max((point + size).abs()) + 1e-9 * size
}
