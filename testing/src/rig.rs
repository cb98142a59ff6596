//! A model under way, also one put together from modes without a beam, with its energy.

use relay_contact::beam::mode::Mode;
use relay_contact::contact::hertz::Hertz;
use relay_contact::contact::law::Law;
use relay_contact::contact::linear::Linear;
use relay_contact::error::StepError;
use relay_contact::excitation::generator::Generator;
use relay_contact::inputs::Inputs;
use relay_contact::integrator::communication_step;
use relay_contact::integrator::motion::Motion;
use relay_contact::integrator::workspace::Workspace;
use relay_contact::model::Model;
use relay_contact::preload::Preload;
use relay_contact::scene::Scene;
use relay_contact::state::State;

use crate::scenes::shaken;
// For those who need both.
pub use crate::scenes::undamped;

/// A model with its state.
pub struct Rig {
    /// Modes, contact law and preload.
    pub model: Model,
    /// The whole motion at the instant reached.
    pub state: State,
    course: Motion,
    workspace: Workspace,
}

impl std::fmt::Debug for Rig {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{:?}", self.state)
    }
}

impl Rig {
    /// The model at rest in its preload.
    pub fn new(model: Model) -> Self {
        let state = model.initial_state(0.0);
        Self {
            state,
            course: Motion::new(state),
            workspace: Workspace::new(&model),
            model,
        }
    }

    /// The same with a sine at the base from the instant 0 on: amplitude (m/s2) and frequency (Hz).
    pub fn shaken(model: Model, amplitude: f64, frequency: f64) -> Self {
        let generator = Generator::new(&shaken(amplitude, frequency)).expect("a sine");
        Self::new(Model { generator, ..model })
    }

    /// Sets the modal velocities at the start, in the order of the modes, and what follows from them.
    pub fn launch(&mut self, velocities: &[f64]) {
        let Self { model, state, .. } = self;
        state.indentation_rate = 0.0;
        for ((mode, v), constants) in state.modes.iter_mut().zip(velocities).zip(&model.modes) {
            mode.v = *v;
            state.indentation_rate -= constants.tip * v;
        }
        let d = model.preload.indentation + state.indentation;
        state.force = model.law.force(d, state.indentation_rate);
        state.closed = model.engagement(state.indentation, state.indentation_rate) > 0.0;
        self.course = Motion::new(*state);
    }

    /// Lets a bonded contact open from here on.
    pub fn unbond(&mut self) {
        if let Law::Linear(linear) = &mut self.model.law {
            linear.bonded = false;
        }
    }

    /// Advances to the instant `time` (s) with the inputs held.
    ///
    /// # Errors
    /// A [`StepError`] where the motion cannot be integrated.
    pub fn run_to(&mut self, inputs: &Inputs, time: f64) -> Result<(), StepError> {
        let Self {
            model,
            state,
            course,
            workspace,
        } = self;
        let start = course.time;
        communication_step::step(model, course, workspace, inputs, start, time - start)?;
        *state = communication_step::state(model, course, workspace)?;
        Ok(())
    }

    /// Energy above that of the preload, J: kinetic and strain energy of the modes about the preload, and the contact's
    /// elastic energy above its tangent there, `V(d) - V(d_0) - F_0 (d - d_0)`. Never negative, as V is convex.
    pub fn energy(&self) -> f64 {
        let Self { model, state, .. } = self;
        let modes: f64 = model
            .modes
            .iter()
            .zip(&state.modes)
            .map(|(mode, at)| 0.5 * (at.v * at.v + mode.omega_squared * at.q * at.q))
            .sum();
        let contact = |d: f64| match model.law {
            Law::Hertz(hertz) => 0.4 * hertz.elastic_force(d) * d.max(0.0),
            Law::Linear(Linear {
                stiffness,
                offset,
                bonded,
                ..
            }) => {
                let overlap = if bonded { d - offset } else { (d - offset).max(0.0) };
                0.5 * stiffness * overlap * overlap
            }
        };
        let Preload { indentation, force, .. } = model.preload;
        modes + contact(indentation + state.indentation) - contact(indentation) - force * state.indentation
    }
}

/// A model put together from modes: `gap` (m) in front of the contact, tolerance relative to `force_scale` (N).
pub fn compose(modes: &[Mode], law: Law, gap: f64, tolerance: f64, force_scale: f64) -> Model {
    let mut scene = Scene::default();
    scene.solver.tolerance = tolerance;
    // Of a mass there is no current.
    scene.effects.chatter = false;
    let model = Model::new(&scene, 0.0).expect("the specimen");
    Model {
        preload: Preload {
            force: 0.0,
            indentation: -gap,
            contact_stiffness: 0.0,
            deflection: 0.0,
            axial_force: 0.0,
        },
        modes: modes.to_vec(),
        law,
        force_scale,
        ..model
    }
}

/// A mass (kg) on a spring (N/m), without damping. A base acceleration acts on it as on any mass.
pub fn oscillator(mass: f64, stiffness: f64) -> Mode {
    Mode {
        omega_squared: stiffness / mass,
        damping: 0.0,
        tip: 1.0 / mass.sqrt(),
        participation: mass.sqrt(),
    }
}

/// A spring (N/m) that only pushes.
pub fn stop(stiffness: f64) -> Law {
    Law::Linear(Linear {
        stiffness,
        damping: 0.0,
        offset: 0.0,
        bonded: false,
    })
}

/// Hertzian contact `k d^(3/2)` (N/m^1.5) with the damping time (s).
pub fn hertz(coefficient: f64, damping: f64) -> Law {
    Law::Hertz(Hertz { coefficient, damping })
}
