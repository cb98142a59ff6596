//! A model with its state and energy, also one built from modes without a beam.

use relay_contact::error::StepError;
use relay_contact::inputs::Inputs;
use relay_contact::reference::{Generator, Law, Mode, Model, Opening, Preload, State};
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::PusherKind;

use crate::scenes::shaken;

/// A model with its state.
#[derive(Debug)]
pub struct Rig {
    /// Modes, contact law and preload.
    pub model: Model,
    /// The state at the time reached.
    pub state: State,
    simulation: Simulation,
}

impl Rig {
    /// The model at rest in its preload.
    pub fn new(model: Model) -> Self {
        let state = model.initial_state(0.0);
        Self::at(model, &state)
    }

    fn at(model: Model, state: &State) -> Self {
        let simulation = Simulation::from_state(model.clone(), state);
        Self { model, state: *state, simulation }
    }

    /// The same with a sine base acceleration from time 0: amplitude (m/s2) and frequency (Hz).
    pub fn shaken(model: Model, amplitude: f64, frequency: f64) -> Self {
        let generator = Generator::new(&shaken(amplitude, frequency));
        Self::new(model.with(|model| model.generator = generator))
    }

    /// Sets the initial modal velocities, in the order of the modes, and the dependent values.
    pub fn launch(&mut self, velocities: &[f64]) {
        let (model, mut state) = (&self.model, self.state);
        for (mode, v) in state.modes.iter_mut().zip(velocities) {
            mode.v = *v;
        }
        model.settle(&mut state);
        *self = Self::at(model.clone(), &state);
    }

    /// Gives the whole spring a velocity, m/s.
    pub fn throw(&mut self, speed: f64) {
        let velocities: Vec<f64> = self.model.modes.iter().map(|mode| speed * mode.participation).collect();
        self.launch(&velocities);
    }

    /// Allows a bonded contact to open from now on.
    pub fn unbond(&mut self) {
        let model = self.model.clone().with(|model| {
            model.law.opening = Opening::Tension;
        });
        *self = Self::at(model, &self.state);
    }

    /// Advances to the instant `time` (s) with the inputs held.
    pub fn run_to(&mut self, inputs: &Inputs, time: f64) -> Result<(), StepError> {
        let start = self.simulation.time();
        self.simulation.step(inputs, start, time - start)?;
        self.state = self.simulation.state_now()?;
        Ok(())
    }

    /// Instants of the last closing and opening, s.
    pub fn touch(&self) -> (f64, f64) {
        let contact = self.state.contact();
        contact.last_closing.zip(contact.last_opening).expect("a touch and a release")
    }

    /// Energy relative to the preload, J: kinetic and strain energy of the modes about the preload, and the contact's
    /// elastic energy above its tangent there, `V(d) - V(d_0) - F_0 (d - d_0)`. Never negative, as V is convex.
    pub fn energy(&self) -> f64 {
        let Self { model, state, .. } = self;
        let modes: f64 = model
            .modes
            .iter()
            .zip(&state.modes)
            .map(|(mode, at)| 0.5 * (at.v * at.v + mode.omega_squared * at.q * at.q))
            .sum();
        let law = model.law;
        let contact = |d: f64| {
            let d = d - law.offset;
            let indented = if law.never_opens() { d.abs() } else { d.max(0.0) };
            law.elastic_force(indented) * indented / (law.exponent + 1.0)
        };
        let Preload { indentation, force, pusher_force, pusher_overlap, .. } = model.preload;
        let deviation = state.contact().approach;
        let bent = modes + contact(indentation + deviation) - contact(indentation) - force * deviation;
        if model.scene.effects.pusher == PusherKind::None {
            return bent;
        }
        // Between the spring and the pusher, prescribed ones of which do not move: what the modes do there.
        let moved: f64 = model.modes.iter().zip(&state.modes).map(|(mode, at)| mode.pusher * at.q).sum();
        let spring = |d: f64| 0.5 * model.scene.pusher.stiffness * d.max(0.0).powi(2);
        bent + spring(pusher_overlap + moved) - spring(pusher_overlap) - pusher_force * moved + self.magnetic()
    }

    /// Displacement of the armature since the preload, m.
    pub fn armature(&self, state: &State) -> f64 {
        let pairs = self.model.modes.iter().zip(&state.modes);
        pairs.map(|(mode, at)| mode.armature * at.q).sum()
    }

    /// Energy of the armature's stops and of its magnet, whose current is held, above their tangents at the preload, J.
    fn magnetic(&self) -> f64 {
        if self.model.scene.effects.pusher != PusherKind::Armature {
            return 0.0;
        }
        let (given, rest) = (&self.model.scene.armature, self.model.preload.armature);
        let potential = |place: f64| {
            let gap = given.core_position - place;
            let overlaps = [-gap, given.rest_position - place];
            let stops: f64 = overlaps.iter().map(|d| 0.5 * given.stop_stiffness * d.max(0.0).powi(2)).sum();
            let reach = given.hold_force * self.state.coil.powi(2) * given.gap_constant;
            let magnet = if gap > 0.0 {
                -reach / (1.0 + gap / given.gap_constant)
            } else {
                reach * (gap / given.gap_constant - 1.0)
            };
            stops + magnet
        };
        let moved = self.armature(&self.state);
        let slope = rest.core_force - rest.rest_force - rest.magnet_force;
        potential(rest.place + moved) - potential(rest.place) - slope * moved
    }
}

/// A model built from modes: contact gap `gap` (m), tolerance relative to `force_scale` (N).
pub fn compose(modes: &[Mode], law: Law, gap: f64, tolerance: f64, force_scale: f64) -> Model {
    let mut scene = Scene::default();
    scene.solver.tolerance = tolerance;
    // A mass carries no current.
    scene.effects.chatter = false;
    Model::new(&scene, 0.0).expect("the specimen").with(|model| {
        model.preload = Preload { indentation: -gap, ..Preload::default() };
        model.modes = modes.to_vec();
        model.law = law;
        model.force_scale = force_scale;
    })
}

/// An undamped mass (kg) on a spring (N/m), with base acceleration.
pub fn oscillator(mass: f64, stiffness: f64) -> Mode {
    Mode {
        omega_squared: stiffness / mass,
        damping: 0.0,
        tip: 1.0 / mass.sqrt(),
        participation: mass.sqrt(),
        ..Mode::default()
    }
}

/// A spring (N/m) that acts only in compression.
pub fn stop(stiffness: f64) -> Law {
    Law { opening: Opening::Tension, ..Law::linear(stiffness, 0.0) }
}

/// Hertzian contact `k d^(3/2)` (N/m^1.5) with the damping time (s).
pub fn hertz(coefficient: f64, damping: f64) -> Law {
    Law::power(coefficient, 1.5, damping)
}
