//! A running simulation: model, state, and workspace of the steps.

use crate::chatter::{Criterion, Interruptions, Summary};
use crate::electrical::ElectricalContact;
use crate::error::{SceneError, StepError};
use crate::inputs::Inputs;
use crate::integrator::communication_step;
use crate::integrator::extremes::Range;
use crate::integrator::with_contact;
use crate::integrator::workspace::Workspace;
use crate::link::CONTACT;
use crate::memory;
use crate::model::Model;
use crate::preload::Initial;
use crate::scene::Scene;
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
}

impl Simulation {
    /// The scene at rest in its preload at `start_time`, s. The initial `support.displacement` belongs to the preload.
    ///
    /// # Errors
    /// A [`SceneError`] if the scene cannot be simulated.
    pub fn new(scene: &Scene, inputs: &Inputs, start_time: f64) -> Result<Self, SceneError> {
        let [support, displacement, pusher] = inputs.displacements_after(0.0);
        let initial = Initial {
            displacements: [support, 0.0, pusher],
            coil: inputs.coil_relative_current,
        };
        let model = on_heap(scene, &initial)?;
        let room = model.room(displacement);
        if room.min(room + model.preload.indentation) <= 0.0 {
            return Err(SceneError::NoGap {
                gap: scene.second.gap,
                displacement,
                least: model.preload.indentation.max(0.0),
            });
        }
        let mut motion = Motion::at_rest(&model, start_time);
        if model.second().is_some() {
            for state in [&mut motion.start, &mut motion.end] {
                state.displacements = [0.0, displacement, 0.0];
                for (link, at) in model.links.iter().zip(&mut state.links) {
                    at.approach = link.offset(&state.displacements);
                }
            }
        }
        motion.current = inputs.contact_current;
        let workspace = Workspace::new(&model);
        Ok(Self {
            model,
            motion,
            workspace,
        })
    }

    /// A model with any initial state: for reference runs, or to continue a run with other parameters.
    pub fn from_state(model: Model, state: &State) -> Self {
        let workspace = Workspace::new(&model);
        Self {
            model: Box::new(model),
            motion: Box::new(Motion::new(*state)),
            workspace,
        }
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
        communication_step::step(
            &self.model,
            &mut self.motion,
            &mut self.workspace,
            inputs,
            time,
            step_size,
        )
    }

    /// With the state of another simulation of the same scene, which started with these inputs.
    ///
    /// # Errors
    /// A [`SceneError`] if the scene cannot be simulated.
    pub fn resume(scene: &Scene, initial: &Initial, motion: &Motion) -> Result<Self, SceneError> {
        let model = on_heap(scene, initial)?;
        let workspace = Workspace::new(&model);
        let mut simulation = Self {
            motion: Motion::at_rest(&model, 0.0),
            model,
            workspace,
        };
        simulation.go_on_from(motion);
        Ok(simulation)
    }

    /// The state: together with the scene and the initial displacement of the fixed contact, all that has to be saved.
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
        self.workspace.events.forget_after(f64::NEG_INFINITY);
        if let Some(event) = motion.event_ahead() {
            self.workspace.events.record(event);
        }
    }

    /// Openings and closings within the last communication step, at most a thousand, and the number of others. None
    /// after a state was set.
    pub fn events(&self) -> (impl Iterator<Item = &Event>, u64) {
        let events = &self.workspace.events;
        (events.until(self.motion.time), events.left_out)
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
        let (state, contact) = (motion.state(), || motion.link(model, CONTACT));
        let force = || contact().force;
        let core = || model.core().map(|index| motion.link(model, index));
        let fixed = || {
            model
                .fixed()
                .map_or_else(LinkNow::default, |index| motion.link(model, index))
        };
        let second = model.second();
        let second_force = || second.map_or(0.0, |index| motion.link(model, index).force);
        let electrical = |index: usize| model.links.get(index).and_then(|link| link.electrical);
        let conductance = || electrical(CONTACT).map(|electrical| electrical.conductance(force()));
        let second_conductance = || {
            let electrical = second.and_then(electrical);
            electrical.map(|electrical| electrical.conductance(second_force()))
        };
        let extremes = || model.scene.effects.extremes.then(|| motion.extremes(model));
        let range = |index: usize| extremes().map_or_else(Range::default, |mut extremes| *extremes.of(index));
        let of_second = || second.map_or_else(Range::default, range);
        let second_event =
            |event: fn(&LinkState) -> Option<f64>| or_not_yet(second.and_then(|index| event(state.links.get(index)?)));
        match output {
            RealOutput::ContactForce => force(),
            RealOutput::ContactElasticForce => motion.elastic_force(model).0,
            RealOutput::ContactConductance => conductance().unwrap_or_default(),
            RealOutput::ContactResistance => conductance().map_or(0.0, |conductance| 1.0 / conductance),
            RealOutput::ContactVoltage => conductance().map_or(0.0, |conductance| {
                let highest = model.scene.contact.open_voltage;
                (motion.current / conductance).clamp(-highest, highest)
            }),
            RealOutput::ContactTemperature => match electrical(CONTACT).filter(|_| model.scene.effects.heating) {
                Some(electrical) => electrical.temperature(&model.scene, force(), motion.current),
                None => model.scene.environment.temperature,
            },
            RealOutput::StepMinimumForce => range(CONTACT).least,
            RealOutput::StepMaximumForce => range(CONTACT).greatest,
            RealOutput::StepMaximumResistance => match electrical(CONTACT).filter(|_| model.scene.effects.extremes) {
                Some(electrical) => 1.0 / electrical.conductance(range(CONTACT).least),
                None => 0.0,
            },
            RealOutput::StepMinimumGap => extremes()
                .filter(|_| second.is_some())
                .map_or(0.0, |extremes| -extremes.nearest),
            RealOutput::PusherForce => model.pusher().map_or(0.0, |index| motion.link(model, index).force),
            RealOutput::ArmatureDisplacement => core().map_or(0.0, |at| model.preload.armature.place + at.approach),
            RealOutput::ArmatureVelocity => core().map_or(0.0, |at| at.rate),
            RealOutput::ArmatureGap => model.core().zip(core()).map_or(0.0, |(index, at)| {
                let overlap = model.links.get(index).map_or(0.0, |link| link.approach);
                -(overlap + at.approach)
            }),
            RealOutput::ArmatureLastRelease => {
                or_not_yet(model.core().and_then(|index| state.links.get(index)?.last_opening))
            }
            RealOutput::StepMinimumStopForce => model.core().map_or(0.0, |index| range(index).least),
            RealOutput::StepMinimumPusherForce => model.pusher().map_or(0.0, |index| range(index).least),
            RealOutput::SecondForce => second_force(),
            RealOutput::SecondConductance => second_conductance().unwrap_or_default(),
            RealOutput::SecondResistance => second_conductance().map_or(0.0, |conductance| 1.0 / conductance),
            RealOutput::SecondLastOpening => second_event(|link| link.last_opening),
            RealOutput::SecondLastClosing => second_event(|link| link.last_closing),
            RealOutput::SecondMinimumForce => of_second().least,
            RealOutput::SecondMaximumForce => of_second().greatest,
            RealOutput::ChatterLongestFalseMake => self.makes(CONTACT).longest,
            RealOutput::ChatterTotalFalseMake => self.makes(CONTACT).total,
            RealOutput::SecondLongestFalseMake => self.makes_of_second().longest,
            RealOutput::SecondTotalFalseMake => self.makes_of_second().total,
            RealOutput::ChatterLongestInterruption => self.interruptions().longest,
            RealOutput::ChatterTotalInterruption => self.interruptions().total,
            RealOutput::EnergyBalance => state.energy_balance,
            RealOutput::SolverForceError => self.force_error(),
            RealOutput::ContactIndentation => model.preload.indentation + contact().approach,
            RealOutput::TipDisplacement => {
                model.preload.deflection + motion.support().0 + fixed().approach - contact().approach
            }
            RealOutput::TipVelocity => motion.support().1 + fixed().rate - contact().rate,
            RealOutput::FixedDisplacement => model.preload.fixed_deflection + fixed().approach,
            RealOutput::FixedVelocity => fixed().rate,
            RealOutput::ContactLastOpening => or_not_yet(state.links[CONTACT].last_opening),
            RealOutput::ContactLastClosing => or_not_yet(state.links[CONTACT].last_closing),
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

    /// Estimate of the error of the contact force so far, relative as the tolerance is; 1 at most.
    pub fn force_error(&self) -> f64 {
        self.motion.state().force_error.relative()
    }

    /// Rate of a continuous output at the communication point (limit from the left), in its SI unit per second; `None`
    /// for outputs that are not continuous; 0 at the start.
    pub fn rate(&self, output: RealOutput) -> Option<f64> {
        let Self { model, motion, .. } = self;
        let rates = || motion.link_rates(model, CONTACT);
        let along = || motion.friction_rates(model);
        let fixed_acceleration = || model.fixed().map_or(0.0, |index| motion.link_rates(model, index).1);
        let electrical = |index: usize| model.links.get(index).and_then(|link| link.electrical);
        // Conductance and its rate.
        let conducting_at = |electrical: Option<ElectricalContact>, force, rate| {
            electrical.map(|electrical| {
                (
                    electrical.conductance(force),
                    electrical.conductance_slope(force) * rate,
                )
            })
        };
        let force = || motion.link(model, CONTACT).force;
        let conducting = || conducting_at(electrical(CONTACT), force(), rates().0);
        let force_rate = |index| motion.link_rates(model, index).0;
        let second_conducting = || {
            let index = model.second()?;
            conducting_at(electrical(index), motion.link(model, index).force, force_rate(index))
        };
        Some(match output {
            RealOutput::SecondForce => model.second().map_or(0.0, force_rate),
            RealOutput::PusherForce => model.pusher().map_or(0.0, force_rate),
            RealOutput::ArmatureDisplacement => self.real(RealOutput::ArmatureVelocity),
            RealOutput::ArmatureVelocity => model.core().map_or(0.0, |index| motion.link_rates(model, index).1),
            RealOutput::ArmatureGap => -self.real(RealOutput::ArmatureVelocity),
            RealOutput::SecondConductance => second_conducting().map_or(0.0, |(_, rate)| rate),
            RealOutput::SecondResistance => {
                second_conducting().map_or(0.0, |(conductance, rate)| -rate / conductance.powi(2))
            }
            RealOutput::ContactForce => rates().0,
            RealOutput::ContactElasticForce => motion.elastic_force(model).1,
            RealOutput::ContactConductance => conducting().map_or(0.0, |(_, rate)| rate),
            RealOutput::ContactResistance => {
                conducting().map_or(0.0, |(conductance, rate)| -rate / conductance.powi(2))
            }
            RealOutput::ContactVoltage => conducting().map_or(0.0, |(conductance, rate)| {
                let voltage = motion.current / conductance;
                if voltage.abs() >= model.scene.contact.open_voltage {
                    return 0.0;
                }
                (motion.current_rate - voltage * rate) / conductance
            }),
            RealOutput::ContactTemperature => match electrical(CONTACT).filter(|_| model.scene.effects.heating) {
                Some(electrical) => {
                    let force = force();
                    let (by_force, by_current) = electrical.temperature_slopes(&model.scene, force, motion.current);
                    by_force * rates().0 + by_current * motion.current.signum() * motion.current_rate
                }
                None => 0.0,
            },
            RealOutput::ContactIndentation => motion.link(model, CONTACT).rate,
            RealOutput::TipDisplacement => self.real(RealOutput::TipVelocity),
            RealOutput::FixedDisplacement => self.real(RealOutput::FixedVelocity),
            RealOutput::TipVelocity => fixed_acceleration() - rates().1,
            RealOutput::FixedVelocity => fixed_acceleration(),
            RealOutput::ContactTangentialForce => along().0,
            RealOutput::ContactSlip => along().1.way,
            RealOutput::ContactSlipDistance => along().1.distance,
            RealOutput::FrictionEnergy => along().1.dissipated,
            RealOutput::ContactLastOpening
            | RealOutput::ContactLastClosing
            | RealOutput::StepMinimumForce
            | RealOutput::StepMaximumForce
            | RealOutput::StepMaximumResistance
            | RealOutput::StepMinimumGap
            | RealOutput::StepMinimumPusherForce
            | RealOutput::StepMinimumStopForce
            | RealOutput::ArmatureLastRelease
            | RealOutput::SecondLastOpening
            | RealOutput::SecondLastClosing
            | RealOutput::SecondMinimumForce
            | RealOutput::SecondMaximumForce
            | RealOutput::ChatterLongestFalseMake
            | RealOutput::ChatterTotalFalseMake
            | RealOutput::SecondLongestFalseMake
            | RealOutput::SecondTotalFalseMake
            | RealOutput::ChatterLongestInterruption
            | RealOutput::ChatterTotalInterruption
            | RealOutput::EnergyBalance
            | RealOutput::SolverForceError
            | RealOutput::PreloadForce
            | RealOutput::PreloadIndentation
            | RealOutput::PreloadContactStiffness
            | RealOutput::PreloadAxialForce
            | RealOutput::PreloadFrequency => return None,
        })
    }

    /// Interruptions of the first contact up to the communication point; none if they are not counted.
    pub fn interruptions(&self) -> Summary {
        self.monitored(CONTACT, Interruptions::summary)
    }

    /// False makes of the second contact up to the communication point; none if they are not counted.
    fn makes_of_second(&self) -> Summary {
        self.model
            .second()
            .map_or_else(Summary::default, |index| self.makes(index))
    }

    /// False makes of a contact.
    fn makes(&self, index: usize) -> Summary {
        self.monitored(index, Interruptions::makes)
    }

    fn monitored(&self, index: usize, summary: fn(&Interruptions, &Criterion, f64) -> Summary) -> Summary {
        let counted = self.model.links.get(index).and_then(|link| link.criterion);
        counted.map_or_else(Summary::default, |criterion| {
            summary(&self.motion.interruptions(&self.model, index), &criterion, self.time())
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
            IntegerOutput::ChatterFalseMakes => count(self.makes(CONTACT).count),
            IntegerOutput::SecondFalseMakes => count(self.makes_of_second().count),
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
            BooleanOutput::SecondClosed => self.model.second(),
            BooleanOutput::PusherClosed => self.model.pusher(),
        };
        index.is_some_and(|index| {
            let closed = self.motion.state().links.get(index).is_some_and(|link| link.closed);
            // At the instant of closing there is no force yet.
            self.motion.link(&self.model, index).force > 0.0 || closed && !self.model.law().never_opens()
        })
    }
}

/// The model of a scene, made out of line, as it is large; refused where there is no memory to simulate it.
#[inline(never)]
fn on_heap(scene: &Scene, initial: &Initial) -> Result<Box<Model>, SceneError> {
    let model = Model::starting(scene, initial)?;
    let needed = Workspace::size(&model);
    if memory::has(needed) {
        Ok(Box::new(model))
    } else {
        Err(SceneError::Memory(needed))
    }
}
/// The instant of an event (s) as outputs have it: -1 for one that has not been yet.
fn or_not_yet(event: Option<f64>) -> f64 {
    event.unwrap_or(-1.0)
}
