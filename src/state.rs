//! The state: all numbers that change during a simulation, of fixed size, so that saving it is a copy.

use serde::{Deserialize, Serialize};
use serde_big_array::BigArray;

use crate::beam::mode::{MAX_MODES, ModeState, ModeStates};
use crate::circuits::Circuits;
use crate::contact::friction::Slip;
use crate::force_error::ForceError;
use crate::integrator::step_length::StepLengths;
use crate::link::{CONTACT, INPUTS, MAX_LINKS, Ways};
use crate::math::prediction::Prediction;

/// The state at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Time, s.
    pub time: f64,
    /// The modes of the cantilever.
    #[serde(with = "BigArray")]
    pub modes: ModeStates,
    /// Whether, after exact steps, [`State::modes`] are instead those of beam and linear contact together
    /// (`closed_loop`).
    pub with_contact: bool,
    /// Displacements of the inputs since the preload, m.
    pub displacements: Ways,
    /// Their velocities over the last communication step, m/s.
    pub velocities: Ways,
    /// Current of the coil, relative.
    pub coil: f64,
    /// The links, in the order of the model.
    pub links: [LinkState; MAX_LINKS],
    /// Interruptions so far.
    pub circuits: Circuits,
    /// Slip of the first contact.
    pub slip: Slip,
    /// The last instant at which a force left zero or jumped, or at which slip began or ended, s: just after it, forces vary
    /// as a root of time.
    pub last_kink: f64,
    /// Whether that was a contact closing.
    pub kink_is_closing: bool,
    /// Step lengths.
    pub lengths: StepLengths,
    /// Energy error of the steps so far that is not yet corrected, J, in scenes without damping.
    pub energy_surplus: f64,
    /// Energy supplied less stored less dissipated since initialisation, J, if requested.
    pub energy_balance: f64,
    /// What is known of the error of the contact force so far.
    pub force_error: ForceError,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps, repeated with a shorter step size.
    pub rejected_steps: u64,
    /// Newton iterations.
    pub iterations: u64,
}

/// What changes of a link.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LinkState {
    /// Approach less that of the preload, m; of a contact its indentation.
    pub approach: f64,
    /// Its velocity, m/s.
    pub rate: f64,
    /// Force, N.
    pub force: f64,
    /// Force over the last step as deviation from that of the preload, N; that of the next is guessed from it.
    pub course: Prediction,
    /// Whether the contact force is positive.
    pub closed: bool,
    /// Time at which the force last reached zero, s; `None`: not yet.
    pub last_opening: Option<f64>,
    /// Time at which the force last left zero, s; `None`: not yet.
    pub last_closing: Option<f64>,
}

impl LinkState {
    fn is_sound(&self, time: f64) -> bool {
        let Self { approach, rate, force, course, closed: _, last_opening, last_closing } = self;
        let mut numbers = [approach, rate, force].into_iter().chain(course);
        let mut events = [last_opening, last_closing].into_iter().flatten();
        numbers.all(|number| number.is_finite()) && events.all(|event| is_past(*event, time))
    }
}

impl State {
    /// Room for a state.
    pub(crate) fn empty() -> Self {
        Self {
            time: 0.0,
            modes: [ModeState::default(); MAX_MODES],
            with_contact: false,
            displacements: [0.0; INPUTS],
            velocities: [0.0; INPUTS],
            coil: 0.0,
            links: [LinkState::default(); MAX_LINKS],
            circuits: Circuits::default(),
            slip: Slip::default(),
            last_kink: 0.0,
            kink_is_closing: false,
            lengths: StepLengths::new(0.0),
            energy_surplus: 0.0,
            energy_balance: 0.0,
            force_error: ForceError::default(),
            steps: 0,
            rejected_steps: 0,
            iterations: 0,
        }
    }

    /// Takes over another state of a model with so many modes and links.
    pub(crate) fn copy(&mut self, other: &Self, modes: usize, links: usize) {
        copy_first(&mut self.modes, &other.modes, modes);
        copy_first(&mut self.links, &other.links, links);
        Self {
            modes: _,
            links: _,
            time: self.time,
            with_contact: self.with_contact,
            displacements: self.displacements,
            velocities: self.velocities,
            coil: self.coil,
            circuits: self.circuits,
            slip: self.slip,
            last_kink: self.last_kink,
            kink_is_closing: self.kink_is_closing,
            lengths: self.lengths,
            energy_surplus: self.energy_surplus,
            energy_balance: self.energy_balance,
            force_error: self.force_error,
            steps: self.steps,
            rejected_steps: self.rejected_steps,
            iterations: self.iterations,
        } = *other;
    }

    pub(crate) fn touches_now(&self) -> bool {
        self.kink_is_closing && self.last_kink == self.time
    }

    /// The first contact.
    pub fn contact(&self) -> &LinkState {
        &self.links[CONTACT]
    }

    /// Whether a simulation can reach these numbers.
    pub fn is_sound(&self) -> bool {
        let Self {
            time,
            modes,
            with_contact: _,
            displacements,
            velocities,
            coil,
            links,
            circuits,
            slip,
            last_kink,
            kink_is_closing: _,
            lengths,
            energy_surplus,
            energy_balance,
            force_error,
            steps: _,
            rejected_steps: _,
            iterations: _,
        } = self;
        let numbers = [time, coil, energy_surplus, energy_balance].into_iter();
        let mut numbers = numbers.chain(displacements).chain(velocities);
        numbers.all(|number| number.is_finite())
            && modes.iter().all(|mode| mode.q.is_finite() && mode.v.is_finite())
            && links.iter().all(|link| link.is_sound(*time))
            && circuits.is_sound(*time)
            && force_error.is_sound()
            && slip.is_sound(*time)
            && lengths.is_sound()
            && is_past(*last_kink, *time)
    }

    /// Whether a contact has opened or closed.
    pub(crate) fn has_switched(&self) -> bool {
        let switched = |link: &LinkState| link.last_opening.is_some() || link.last_closing.is_some();
        self.links.iter().any(switched)
    }

    /// The last closing of a contact, s.
    pub(crate) fn last_closing(&self) -> Option<f64> {
        let closings = self.links.iter().filter_map(|link| link.last_closing);
        closings.max_by(f64::total_cmp)
    }

    /// Whether a contact is closed.
    #[inline(always)]
    pub(crate) fn is_closed(&self) -> bool {
        self.links.iter().any(|link| link.closed)
    }
}

/// Copies the first values of a list into another, as a whole.
pub(crate) fn copy_first<T: Copy>(to: &mut [T], from: &[T], count: usize) {
    if let (Some(to), Some(from)) = (to.get_mut(..count), from.get(..count)) {
        to.copy_from_slice(from);
    }
}

/// Whether an event (s) may have been at an instant (s).
pub(crate) fn is_past(event: f64, time: f64) -> bool {
    event.is_finite() && event <= time
}
