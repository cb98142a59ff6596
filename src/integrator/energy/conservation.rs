//! Energy conservation in scenes without damping and without generator.
//!
//! The energy relative to the preload then changes only by the work of the base acceleration, known exactly from the
//! modal displacements, and of the moving fixed contact: its velocity times the impulse of the force, known exactly
//! from the polynomial. Any other change is an error of the step. It is corrected by a small impulse on the tip in this
//! step or in later ones, so that errors do not accumulate over any number of impacts.

use crate::excitation::drive::Drive;
use crate::excitation::generator::Generator;
use crate::integrator::collocation::step::Trial;
use crate::integrator::constants::RETURNED;
use crate::integrator::integration::Integration;
use crate::integrator::workspace::{Room, Workspace};
use crate::model::Model;

/// Whether there is no dissipation and the work of the drive is known exactly.
pub(crate) fn conserves(model: &Model, drive: &Drive) -> bool {
    let undamped = model.modes.iter().all(|mode| mode.damping == 0.0);
    // An axial force that follows the deflection has no potential.
    undamped
        && model.axial().is_none()
        && model.friction().is_none()
        && model.law.damping() == 0.0
        && model.generator == Generator::None
        && drive.jerk == 0.0
}

impl Integration<'_> {
    /// Energy error of the step (gain beyond the work done), and its rounding, J. The modes at its end are those of the
    /// last [`Integration::attempt`].
    fn surplus<const S: usize>(&mut self, trial: &Trial<S>, length: f64) -> (f64, f64)
    where
        Workspace: Room<S>,
    {
        let Self {
            model, state, drive, ..
        } = self;
        let (cache, end, _) = Room::<S>::parts(self.workspace);
        let start = model.energy(&state.modes, state.indentation);
        let finish = model.energy(&end.modes, trial.indentation);
        let moved = model.modes.iter().zip(state.modes.iter().zip(end.modes.iter()));
        let loads = moved.map(|(mode, (start, end))| mode.participation * (end.q - start.q));
        let by_base = -drive.acceleration(state.time) * loads.sum::<f64>();
        let by_support = drive.support_rate * length * cache.collocation().mean(&trial.forces);
        // Rounding of displacement and velocity of each mode, sums of two products and a load, and of the forces.
        let way = (trial.indentation - state.indentation).abs() + (drive.support_rate * length).abs();
        let size = start.abs().max(finish.abs()) + (state.force + model.preload.force.abs()) * way;
        let rounding = 4.0 * f64::EPSILON * model.modes.len() as f64 * size;
        (finish - start - by_base - by_support, rounding)
    }

    /// Whether the energy error of the step exceeds that of a force error of one tolerance along the path of the tip.
    /// The error estimate, a single number, can be small by chance.
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

    /// Adds the energy error of a step about to be accepted.
    pub(crate) fn enter<const S: usize>(&mut self, trial: &Trial<S>, length: f64)
    where
        Workspace: Room<S>,
    {
        if self.conserves {
            self.state.energy_surplus += self.surplus(trial, length).0;
        }
    }

    /// Corrects the accumulated energy error by an impulse on the tip, limited to that of a small force error over the
    /// step just taken. The remainder is left to later steps.
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
