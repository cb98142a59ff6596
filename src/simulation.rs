//! A running simulation: model, state, and workspace of the steps.

use crate::beam::spring;
use crate::chatter::{Criterion, Interruptions, Summary};
use crate::conduction;
use crate::error::{SceneError, StepError};
use crate::excitation::drive::Drive;
use crate::inputs::Inputs;
use crate::integrator::collocation::cache::{Left, OF_LONG, OF_SHORT};
use crate::integrator::communication_step;
use crate::integrator::extremes::{Extremes, Range};
use crate::integrator::with_contact;
use crate::integrator::workspace::Workspace;
use crate::link::CONTACT;
use crate::math::nodal::{LONG, SHORT};
use crate::memory;
use crate::model::Model;
use crate::preload::Initial;
use crate::scene::Scene;
use crate::shared::Shared;
use crate::slip_stability;
use crate::state::{LinkState, State};
use crate::variables::{BooleanOutput, Group, IntegerOutput, RealOutput, Variable};

pub use crate::integrator::events::log::Event;
use crate::integrator::motion::LinkNow;
pub use crate::integrator::motion::Motion;

/// A simulation, which starts at rest in the preload.
#[derive(Clone, Debug)]
pub struct Simulation {
    model: Box<Model>,
    motion: Box<Motion>,
    workspace: Workspace,
    _kept: Kept,
}

/// Keeps what simulations find of springs, slip and steps for the next ones, also while there is none.
#[derive(Clone, Debug)]
pub struct Kept {
    _springs: Shared<spring::Known>,
    _slip: Shared<slip_stability::Known>,
    _short: Shared<Left<SHORT>>,
    _long: Shared<Left<LONG>>,
}

impl Default for Kept {
    fn default() -> Self {
        Self {
            _springs: Shared::of(&spring::KNOWN),
            _slip: Shared::of(&slip_stability::KNOWN),
            _short: Shared::of(&OF_SHORT),
            _long: Shared::of(&OF_LONG),
        }
    }
}

impl Simulation {
    /// The scene at rest in its preload at `start_time`, s. To it belong the displacements and the current of the coil at the start.
    ///
    /// # Errors
    /// A [`SceneError`] if the scene cannot be simulated.
    pub fn new(scene: &Scene, inputs: &Inputs, start_time: f64) -> Result<Self, SceneError> {
        let [support, displacement, pusher] = inputs.displacements_after(0.0);
        let initial = Initial { displacements: [support, 0.0, pusher], coil: inputs.coil_relative_current };
        let mut simulation = Self::at_rest(scene, &initial, start_time)?;
        let Self { model, motion, .. } = &mut simulation;
        let room = model.room(displacement);
        if room.min(room + model.preload.indentation) <= 0.0 {
            return Err(SceneError::NoGap {
                gap: scene.second.gap,
                displacement,
                least: model.preload.indentation.max(0.0),
            });
        }
        if model.roles.second.is_some() {
            for state in [&mut motion.start, &mut motion.end] {
                state.displacements = [0.0, displacement, 0.0];
                for (link, at) in model.links.iter().zip(&mut state.links) {
                    at.approach = link.offset(&state.displacements);
                }
            }
            motion.drive = Drive::resting(motion.end.displacements);
        }
        motion.current = inputs.contact_current;
        Ok(simulation)
    }

    /// The scene at rest in the preload of these inputs; refused where there is no memory to simulate it.
    fn at_rest(scene: &Scene, initial: &Initial, start_time: f64) -> Result<Self, SceneError> {
        let kept = Kept::default();
        let model = Model::starting(scene, initial)?;
        memory::check(Workspace::size(&model))?;
        Ok(Self { motion: Motion::at_rest(&model, start_time), workspace: Workspace::new(&model), model, _kept: kept })
    }

    /// A model with any initial state: for reference runs, or to continue a run with other parameters.
    pub fn from_state(model: Model, state: &State) -> Self {
        let workspace = Workspace::new(&model);
        Self { model: Box::new(model), motion: Box::new(Motion::new(*state)), workspace, _kept: Kept::default() }
    }

    /// The state at the communication point; [`Simulation::state`] may be earlier.
    ///
    /// # Errors
    /// A [`StepError`] if it cannot be computed.
    pub fn state_now(&mut self) -> Result<State, StepError> {
        let mut state = communication_step::state(&self.model, &self.motion, &mut self.workspace)?;
        with_contact::leave(&self.model, &mut state);
        Ok(state)
    }

    /// Advances over the communication step from `time` to `time + step_size`, s, with inputs that are held or change
    /// linearly.
    ///
    /// `time` may differ from [`Simulation::time`] by rounding.
    ///
    /// # Errors
    /// A [`StepError`]; the state is then that before the call.
    pub fn step(&mut self, inputs: &Inputs, time: f64, step_size: f64) -> Result<(), StepError> {
        let Self { model, motion, .. } = self;
        communication_step::step(model, motion, &mut self.workspace, inputs, time, step_size)
    }

    /// With the state of another simulation of the same scene, which started with these inputs.
    ///
    /// # Errors
    /// A [`SceneError`] if the scene cannot be simulated.
    pub fn resume(scene: &Scene, initial: &Initial, motion: &Motion) -> Result<Self, SceneError> {
        let mut simulation = Self::at_rest(scene, initial, 0.0)?;
        simulation.go_on_from(motion);
        Ok(simulation)
    }

    /// The state: together with the scene and what the inputs at the start made of the preload, all that has to be saved.
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// A copy of [`Simulation::motion`], made on the heap.
    pub(crate) fn copied_motion(&self) -> Box<Motion> {
        self.motion.clone()
    }

    /// Continues from the state of a simulation of the same model.
    pub fn go_on_from(&mut self, motion: &Motion) {
        *self.motion = *motion;
        let events = &mut self.workspace.events;
        events.replace_after(f64::NEG_INFINITY, motion.events_ahead());
    }

    /// Openings and closings within the last communication step, at most a thousand, and the instant (s) of the first
    /// that was one too many. None after a state was set.
    pub fn events(&self) -> (impl Iterator<Item = &Event>, Option<f64>) {
        self.workspace.events.until(self.motion.time)
    }

    /// The time reached, s.
    pub fn time(&self) -> f64 {
        self.motion.time
    }

    /// The model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The last state that the integrator has reached, at or before [`Simulation::time`]; its modes may be those with
    /// the contact ([`State::with_contact`]).
    pub fn state(&self) -> &State {
        self.motion.state()
    }

    /// A real output or calculated parameter, in its SI unit.
    pub fn real(&self, output: RealOutput) -> f64 {
        let Self { model, motion, .. } = self;
        let roles = &model.roles;
        let (state, contact) = (motion.state(), || motion.link(model, CONTACT));
        let at = |role: Option<usize>| role.map_or_else(LinkNow::default, |index| motion.link(model, index));
        let force = |role: Option<usize>| role.map_or(0.0, |index| motion.force(model, index));
        match output {
            RealOutput::ContactForce => force(Some(CONTACT)),
            RealOutput::ContactElasticForce => motion.elastic_force(model).0,
            RealOutput::ContactConductance
            | RealOutput::ContactResistance
            | RealOutput::ContactVoltage
            | RealOutput::ContactTemperature
            | RealOutput::SecondConductance
            | RealOutput::SecondResistance => conduction::output(model, motion, output),
            RealOutput::StepMaximumResistance => conduction::greatest_resistance(model, motion),
            RealOutput::StepMinimumForce => self.range(Some(CONTACT)).least,
            RealOutput::StepMaximumForce => self.range(Some(CONTACT)).greatest,
            RealOutput::StepMinimumGap => {
                let seen = self.extremes().filter(|_| roles.second.is_some());
                seen.map_or(0.0, |extremes| -extremes.nearest)
            }
            RealOutput::ParallelForce => force(roles.parallel),
            RealOutput::ParallelLastOpening => self.event(roles.parallel, |link| link.last_opening),
            RealOutput::ParallelLastClosing => self.event(roles.parallel, |link| link.last_closing),
            RealOutput::ParallelMinimumForce => self.range(roles.parallel).least,
            RealOutput::ParallelMaximumForce => self.range(roles.parallel).greatest,
            RealOutput::PusherForce => force(roles.pusher),
            RealOutput::ArmatureDisplacement => model.preload.armature.place + at(roles.core).approach,
            RealOutput::ArmatureVelocity => at(roles.core).rate,
            RealOutput::ArmatureGap => {
                let link = roles.core.and_then(|index| model.links.get(index));
                link.map_or(0.0, |link| -(link.approach + at(roles.core).approach))
            }
            RealOutput::ArmatureLastRelease => self.event(roles.core, |link| link.last_opening),
            RealOutput::StepMinimumStopForce => self.range(roles.core).least,
            RealOutput::StepMinimumPusherForce => self.range(roles.pusher).least,
            RealOutput::SecondForce => force(roles.second),
            RealOutput::SecondLastOpening => self.event(roles.second, |link| link.last_opening),
            RealOutput::SecondLastClosing => self.event(roles.second, |link| link.last_closing),
            RealOutput::SecondMinimumForce => self.range(roles.second).least,
            RealOutput::SecondMaximumForce => self.range(roles.second).greatest,
            RealOutput::ChatterLongestFalseMake => self.makes(Some(CONTACT)).longest,
            RealOutput::ChatterTotalFalseMake => self.makes(Some(CONTACT)).total,
            RealOutput::SecondLongestFalseMake => self.makes(roles.second).longest,
            RealOutput::SecondTotalFalseMake => self.makes(roles.second).total,
            RealOutput::ChatterLongestInterruption => self.interruptions().longest,
            RealOutput::ChatterTotalInterruption => self.interruptions().total,
            RealOutput::EnergyBalance => state.energy_balance,
            RealOutput::SolverForceError => self.force_error(),
            RealOutput::ContactIndentation => model.preload.indentation + contact().approach,
            RealOutput::TipDisplacement => {
                model.preload.deflection + motion.support().0 + at(roles.fixed).approach - contact().approach
            }
            RealOutput::TipVelocity => motion.support().1 + at(roles.fixed).rate - contact().rate,
            RealOutput::FixedDisplacement => model.preload.fixed_deflection + at(roles.fixed).approach,
            RealOutput::FixedVelocity => at(roles.fixed).rate,
            RealOutput::ContactLastOpening => self.event(Some(CONTACT), |link| link.last_opening),
            RealOutput::ContactLastClosing => self.event(Some(CONTACT), |link| link.last_closing),
            RealOutput::ContactTangentialForce => motion.friction(model).0,
            RealOutput::ContactSlip => motion.friction(model).1.way,
            RealOutput::ContactSlipDistance => motion.friction(model).1.distance,
            RealOutput::FrictionEnergy => motion.friction(model).1.dissipated,
            RealOutput::PreloadForce => model.preload.force,
            RealOutput::PreloadIndentation => model.preload.indentation,
            RealOutput::PreloadContactStiffness => model.preload.contact_stiffness,
            RealOutput::PreloadAxialForce => model.preload.axial_force,
            RealOutput::PreloadFrequency => model.frequency,
        }
    }

    /// Extremes within the last communication step, if requested.
    fn extremes(&self) -> Option<Extremes> {
        let requested = self.model.scene.effects.extremes;
        requested.then(|| self.motion.extremes(&self.model))
    }

    /// Extremes of the force of a link; 0 without it, or if they are not requested.
    fn range(&self, role: Option<usize>) -> Range {
        role.zip(self.extremes()).map_or_else(Range::default, |(index, mut extremes)| *extremes.of(index))
    }

    /// The last instant of an event of a link, s; -1 where it has not been yet, or without the link.
    fn event(&self, role: Option<usize>, event: fn(&LinkState) -> Option<f64>) -> f64 {
        let link = role.and_then(|index| self.motion.state().links.get(index));
        link.and_then(event).unwrap_or(-1.0)
    }

    /// Estimate of the error of the contact force so far, relative as the tolerance is; 1 at most.
    pub fn force_error(&self) -> f64 {
        self.motion.state().force_error.relative()
    }

    /// Rate of a continuous output at the communication point (limit from the left), in its SI unit per second; `None`
    /// for outputs that are not continuous; 0 at the start.
    pub fn rate(&self, output: RealOutput) -> Option<f64> {
        let Self { model, motion, .. } = self;
        let roles = &model.roles;
        // Of force and velocity.
        let rates = |role: Option<usize>| role.map_or((0.0, 0.0), |index| motion.link_rates(model, index));
        let along = || motion.friction_rates(model);
        Some(match output {
            RealOutput::ContactForce => rates(Some(CONTACT)).0,
            RealOutput::ParallelForce => rates(roles.parallel).0,
            RealOutput::SecondForce => rates(roles.second).0,
            RealOutput::PusherForce => rates(roles.pusher).0,
            RealOutput::ContactElasticForce => motion.elastic_force(model).1,
            RealOutput::ArmatureDisplacement => self.real(RealOutput::ArmatureVelocity),
            RealOutput::ArmatureVelocity => rates(roles.core).1,
            RealOutput::ArmatureGap => -self.real(RealOutput::ArmatureVelocity),
            RealOutput::ContactConductance
            | RealOutput::ContactResistance
            | RealOutput::ContactVoltage
            | RealOutput::ContactTemperature
            | RealOutput::SecondConductance
            | RealOutput::SecondResistance => conduction::rate(model, motion, output),
            RealOutput::ContactIndentation => motion.link(model, CONTACT).rate,
            RealOutput::TipDisplacement => self.real(RealOutput::TipVelocity),
            RealOutput::FixedDisplacement => self.real(RealOutput::FixedVelocity),
            RealOutput::TipVelocity => rates(roles.fixed).1 - rates(Some(CONTACT)).1,
            RealOutput::FixedVelocity => rates(roles.fixed).1,
            RealOutput::ContactTangentialForce => along().0,
            RealOutput::ContactSlip => along().1.way,
            RealOutput::ContactSlipDistance => along().1.distance,
            RealOutput::FrictionEnergy => along().1.dissipated,
            // All that the description does not declare as continuous (`tests/derivatives.rs`).
            _ => return None,
        })
    }

    /// Interruptions of the circuit of the first contact up to the communication point; none if they are not counted.
    pub fn interruptions(&self) -> Summary {
        self.monitored(Some(CONTACT), Interruptions::summary)
    }

    /// False makes of the circuit of a contact.
    fn makes(&self, role: Option<usize>) -> Summary {
        self.monitored(role, Interruptions::makes)
    }

    fn monitored(&self, role: Option<usize>, summary: fn(&Interruptions, &Criterion, f64) -> Summary) -> Summary {
        let link = role.and_then(|index| self.model.links.get(index));
        let counted = link.and_then(|link| Some((link.circuit?, link.criterion?)));
        counted.map_or_else(Summary::default, |(circuit, criterion)| {
            let interruptions = self.motion.interruptions(&self.model, circuit);
            summary(&interruptions, &criterion, self.time())
        })
    }

    /// An integer output or calculated parameter; counts saturate at the integer range.
    pub fn integer(&self, output: IntegerOutput) -> i32 {
        let count = |n: u64| i32::try_from(n).unwrap_or(i32::MAX);
        match output {
            IntegerOutput::SolverSteps => count(self.state().steps),
            IntegerOutput::SolverRejectedSteps => count(self.state().rejected_steps),
            IntegerOutput::SolverIterations => count(self.state().iterations),
            IntegerOutput::ChatterCount => count(self.interruptions().count),
            IntegerOutput::ChatterFalseMakes => count(self.makes(Some(CONTACT)).count),
            IntegerOutput::SecondFalseMakes => count(self.makes(self.model.roles.second).count),
            IntegerOutput::SolverModesUsed => count(self.model.modes.len() as u64),
        }
    }

    /// An output or calculated parameter as a number, Booleans as 0 or 1; `None` for inputs and parameters.
    pub fn output(&self, variable: &Variable) -> Option<f64> {
        match variable.group {
            Group::RealOutput(output) => Some(self.real(output)),
            Group::IntegerOutput(output) => Some(f64::from(self.integer(output))),
            Group::BooleanOutput(output) => Some(f64::from(u8::from(self.boolean(output)))),
            _ => None,
        }
    }

    /// A Boolean output.
    pub fn boolean(&self, output: BooleanOutput) -> bool {
        let index = match output {
            BooleanOutput::ContactClosed => Some(CONTACT),
            BooleanOutput::ParallelClosed => self.model.roles.parallel,
            BooleanOutput::SecondClosed => self.model.roles.second,
            BooleanOutput::PusherClosed => self.model.roles.pusher,
        };
        let link = |index| Some((index, self.model.links.get(index)?, self.motion.state().links.get(index)?));
        index.and_then(link).is_some_and(|(index, link, at)| {
            // At the instant of closing there is no force yet.
            let touches = at.closed && link.contact().is_some_and(|law| !law.never_opens());
            touches || self.motion.force(&self.model, index) > 0.0
        })
    }
}
