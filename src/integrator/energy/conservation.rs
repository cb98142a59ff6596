//! The account of the energy where nothing dissipates and no generator runs.
//!
//! The energy about the preload then changes by the work of the base acceleration, which the modal displacements tell
//! exactly, and of the moving contact, which is its velocity times the impulse of the force: the polynomial's, exactly.
//! What else a step makes of it is its error, and is returned by a small impulse on the tip in this step or in later
//! ones, so that nothing adds up over any number of impacts.

use crate::excitation::drive::Drive;
use crate::excitation::generator::Generator;
use crate::integrator::collocation::step::Trial;
use crate::integrator::integration::Integration;
use crate::integrator::workspace::{Room, Workspace};
use crate::model::Model;

/// Share of the tolerance that the contact force may be wrong by to return energy.
const RETURNED: f64 = 0.05;

/// Whether nothing dissipates, and the work done on the motion is known.
pub(crate) fn conserves(model: &Model, drive: &Drive) -> bool {
    let undamped = model.modes.iter().all(|mode| mode.damping == 0.0);
    // An axial force that follows the deflection has no potential.
    undamped
        && model.axial().is_none()
        && model.law.damping() == 0.0
        && model.generator == Generator::None
        && drive.jerk == 0.0
}

impl Integration<'_> {
    /// Energy that the step makes beyond the work done on it, and what rounding may make of it, J. The modes at its end
    /// are those of the last attempt.
    fn surplus<const S: usize>(&mut self, trial: &Trial<S>, length: f64) -> (f64, f64)
    where
        Workspace: Room<S>,
    {
        let Self {
            model, state, drive, ..
        } = self;
        let (cache, end, _) = Room::<S>::parts(self.workspace);
        let start = model.energy(&state.modes, state.indentation);
        let finish = model.energy(end, trial.indentation);
        let moved = model.modes.iter().zip(state.modes.iter().zip(end.iter()));
        let loads = moved.map(|(mode, (start, end))| mode.participation * (end.q - start.q));
        let by_base = -drive.acceleration(state.time) * loads.sum::<f64>();
        let by_support = drive.support_rate * length * cache.collocation().mean(&trial.forces);
        // Displacement and velocity of each mode are rounded, sums of two products and a load; so are the forces on the way.
        let way = (trial.indentation - state.indentation).abs() + (drive.support_rate * length).abs();
        let size = start.max(finish) + (state.force + model.preload.force) * way;
        let rounding = 4.0 * f64::EPSILON * model.modes.len() as f64 * size;
        (finish - start - by_base - by_support, rounding)
    }

    /// Whether the step makes or loses as much energy as a force wrong by more than the tolerance over the way of the
    /// tip would. The error estimate, one number, can be small by chance.
    pub(crate) fn breaks_account<const S: usize>(&mut self, trial: &Trial<S>, length: f64) -> bool
    where
        Workspace: Room<S>,
    {
        if !self.conserves || !self.state.closed {
            return false;
        }
        let (surplus, rounding) = self.surplus(trial, length);
        let rate = self.state.support_rate;
        let fastest = (rate - self.state.indentation_rate)
            .abs()
            .max((rate - trial.rate).abs());
        surplus.abs() > rounding + self.tolerance * length * fastest
    }

    /// Enters a step about to be taken in the account.
    pub(crate) fn enter<const S: usize>(&mut self, trial: &Trial<S>, length: f64)
    where
        Workspace: Room<S>,
    {
        if self.conserves {
            self.state.energy_surplus += self.surplus(trial, length).0;
        }
    }

    /// Returns what was made too much or too little, by an impulse on the tip not larger than that of a small error of
    /// the force over the step just taken. What is left is for later steps.
    pub(crate) fn settle(&mut self, length: f64) {
        if !self.conserves || !self.state.closed || self.state.energy_surplus == 0.0 {
            return;
        }
        let Self { model, state, .. } = self;
        let velocity = state.support_rate - state.indentation_rate;
        let bound = RETURNED * self.tolerance * length;
        let impulse = (-state.energy_surplus / velocity).clamp(-bound, bound);
        if !impulse.is_finite() {
            return;
        }
        for (at, mode) in state.modes.iter_mut().zip(&model.modes) {
            at.v += mode.tip * impulse;
        }
        let gained = model.mobility() * impulse;
        state.indentation_rate -= gained;
        state.energy_surplus += impulse * (velocity + 0.5 * gained);
    }
}
