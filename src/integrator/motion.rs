//! The motion at a communication point, and dense output between integration steps.
//!
//! Long communication steps are integrated exactly to their ends. With short ones (a circuit simulator's) or ones of
//! ever new sizes, and inputs that continue as before, the integrator runs ahead in steps as long as the error allows.
//! The communication points then lie inside an integration step, and the tip is read from the step's polynomials (dense
//! output). When an input changes, the step is repeated from its start to the communication point and integration
//! restarts there.

use crate::beam::mode::{MAX_MODES, Modal};
use crate::chatter::Interruptions;
use crate::excitation::drive::Drive;
use crate::integrator::course::turning_points_between;
use crate::integrator::dense_output::{DenseFriction, DenseOutput};
use crate::integrator::events::log::Event;
use crate::integrator::extremes::Extremes;
use crate::integrator::with_contact;
use crate::math::prediction::value_and_slope;
use crate::model::Model;
use crate::state::State;
use serde::{Deserialize, Serialize};

/// All that changes in a simulation: the motion around a communication point. Plain numbers, so saving it is a copy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Motion {
    /// The communication point, s.
    pub time: f64,
    /// Current through the contact, A, and its rate over the last communication step, A/s.
    pub current: f64,
    /// See [`Motion::current`].
    pub current_rate: f64,
    /// Length of the last communication step, s.
    pub(crate) size: f64,
    /// Extremes of the contact force in it, N; `None` before it, or if none are requested.
    pub(crate) extremes: Option<Extremes>,
    /// Base acceleration and velocity of the fixed contact during it.
    pub(crate) drive: Drive,
    /// State at the start of the current integration step: at the communication point, or before it.
    pub(crate) start: State,
    /// State at the end of the current integration step: at the communication point, or ahead of it.
    pub(crate) end: State,
    /// The tip between `start` and `end`.
    pub(crate) dense: DenseOutput,
}

/// The tip at a communication point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tip {
    /// Forces of both contacts, N.
    pub forces: [f64; 2],
    /// Indentation minus preload indentation, m.
    pub indentation: f64,
    /// Its velocity, m/s.
    pub rate: f64,
}

/// Time derivatives of the tip at a communication point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TipRates {
    /// Rates of the forces of both contacts, N/s.
    pub forces: [f64; 2],
    /// Second derivative of the indentation, m/s2.
    pub acceleration: f64,
}

impl Motion {
    /// Starts from a state.
    pub fn new(state: State) -> Self {
        Self {
            time: state.time,
            current: 0.0,
            current_rate: 0.0,
            size: 0.0,
            extremes: None,
            drive: Drive::default(),
            start: state,
            end: state,
            dense: DenseOutput::default(),
        }
    }

    /// At rest in the preload.
    #[inline(never)]
    pub(crate) fn at_rest(model: &Model, time: f64) -> Box<Self> {
        Box::new(Self::new(model.initial_state(time)))
    }

    /// The last integrated state at or before the communication point.
    pub fn state(&self) -> &State {
        if self.end.time <= self.time {
            &self.end
        } else {
            &self.start
        }
    }

    /// Whether the values are consistent: finite, with times in order (check of a deserialised state).
    pub fn is_sound(&self) -> bool {
        let Self {
            time,
            current,
            current_rate,
            size,
            extremes,
            drive,
            start,
            end,
            dense,
        } = self;
        let DenseOutput {
            force,
            indentation,
            rate,
            turns,
            passages,
            friction,
        } = dense;
        let DenseFriction { slip, dissipated } = friction;
        let polynomials = [force, indentation, rate, slip, dissipated].into_iter().flatten();
        let numbers = [
            *time,
            *current,
            *current_rate,
            *size,
            drive.jerk,
            drive.support_rate,
            drive.second_rate,
        ];
        let extremes = extremes.iter().flat_map(Extremes::numbers);
        let driven = drive.acceleration(start.time);
        numbers
            .iter()
            .copied()
            .chain(extremes)
            .chain(polynomials.copied())
            .all(f64::is_finite)
            && driven.is_finite()
            && *size >= 0.0
            && turns.is_sound()
            && passages.is_sound()
            && start.is_sound()
            && end.is_sound()
            && start.time <= *time
            && (start == end && end.time == *time || start.time < end.time && *time <= end.time)
    }

    /// The opening or closing that the integrator has located beyond the communication point.
    pub fn event_ahead(&self) -> Option<Event> {
        let ahead = self.end.time > self.time && self.end.closed != self.start.closed;
        ahead.then_some(Event {
            time: self.end.time,
            closes: self.end.closed,
            second: self.end.mirrored,
        })
    }

    /// Where the communication point lies inside an integration step: relative to its end, in step lengths, -1 to 0.
    pub(crate) fn inside(&self) -> Option<f64> {
        let from_end = self.time - self.end.time;
        (from_end < 0.0).then(|| from_end / self.length())
    }

    /// Length of the step of [`Motion::dense`], s.
    pub(crate) fn length(&self) -> f64 {
        self.end.time - self.start.time
    }

    /// The tip at the communication point.
    pub fn tip(&self, model: &Model) -> Tip {
        let state = self.state();
        if state.mirrored {
            return self.mirrored_tip(model, state);
        }
        let (force, indentation, rate) = self.seen(model, state);
        Tip {
            forces: [force, 0.0],
            indentation,
            rate,
        }
    }

    /// [`Motion::tip`] from the view of the second contact.
    #[cold]
    fn mirrored_tip(&self, model: &Model, state: &State) -> Tip {
        let (force, indentation, rate) = self.seen(model.views(state).0, state);
        Tip {
            forces: [0.0, force],
            indentation: state.second_support - indentation,
            rate: self.drive.second_rate - rate,
        }
    }

    /// Force of the first contact without what its damping adds (N), and the rate of that (N/s).
    pub fn elastic_force(&self, model: &Model) -> (f64, f64) {
        let (tip, law) = (self.tip(model), &model.law);
        if tip.forces[0] <= 0.0 && !law.never_opens() {
            return (0.0, 0.0);
        }
        let indentation = model.preload.indentation + tip.indentation;
        let stiffness = law.stiffness(indentation);
        (law.closed_branch(indentation, 0.0).force, stiffness * tip.rate)
    }

    /// Force, indentation and its velocity in the view of this state.
    #[inline(always)]
    fn seen(&self, model: &Model, state: &State) -> (f64, f64, f64) {
        let Some(y) = self.inside() else {
            return (state.force, state.indentation, state.indentation_rate);
        };
        let at = |values| value_and_slope(values, y).0;
        let force = model.preload.force + at(&self.dense.force);
        let force = match state.closed {
            true if model.law.never_opens() => force,
            true => force.max(f64::MIN_POSITIVE),
            false => 0.0,
        };
        (force, at(&self.dense.indentation), at(&self.dense.rate))
    }

    /// Accelerations of the modes under all loads at the end of a step.
    pub(crate) fn accelerations(&self, model: &Model, state: &State) -> Modal {
        let base = self.drive.acceleration(self.time) + model.generator.acceleration_before(self.time);
        let base = if state.mirrored { -base } else { base };
        let force = state.force - model.preload.force;
        let modes = with_contact::modes(model, state);
        let axial = match (model.axial(), model.friction()) {
            (Some(axial), _) => axial.loads(&model.modes, &modes),
            (None, Some(friction)) => {
                let along = state.tangential.force - friction.preload;
                friction.levers.map(|lever| lever * along)
            }
            (None, None) => [0.0; MAX_MODES],
        };
        let mut accelerations = axial;
        for ((acceleration, mode), at) in accelerations.iter_mut().zip(&model.modes).zip(&modes) {
            let load = mode.tip * force - mode.participation * base + *acceleration;
            *acceleration = load - mode.omega_squared * at.q - mode.damping * at.v;
        }
        accelerations
    }

    /// Extremes at the communication point alone.
    pub(crate) fn extremes_now(&self, model: &Model) -> Extremes {
        let tip = self.tip(model);
        let second = self.state().second_support - tip.indentation - model.scene.second.gap;
        Extremes::at(tip.forces, second)
    }

    /// Ways (m) of the fixed contacts to these displacements (m): of the first, and of the second relative to it.
    pub(crate) fn ways(&self, support: f64, second: f64) -> [f64; 2] {
        let state = self.state();
        let second_way = second - state.second_support;
        // None where nothing moves, also by rounding.
        let way = if state.mirrored {
            second_way - (second - support - state.support)
        } else {
            support - state.support
        };
        [way, second_way]
    }

    /// Displacement (m) and velocity (m/s) of the fixed contact.
    pub fn support(&self) -> (f64, f64) {
        let state = self.state();
        if state.mirrored {
            let (displacement, rate) = (state.second_support, self.drive.second_rate);
            (displacement - state.support, rate - state.support_rate)
        } else {
            (state.support, state.support_rate)
        }
    }

    /// Extremes of the forces within the last communication step; for scenes with `effects.extremes`.
    pub fn extremes(&self, model: &Model) -> Extremes {
        self.extremes.unwrap_or_else(|| self.extremes_now(model))
    }

    /// Adds those of the dense output between two instants (s); the first may lie before the step, and is included
    /// already.
    pub(crate) fn add_dense(&self, extremes: &mut Extremes, model: &Model, from: f64, to: f64) {
        let at = |time: f64| ((time - self.end.time) / self.length()).clamp(-1.0, 0.0);
        let (view, other) = model.views(&self.start);
        let (from, to) = (at(from), at(to));
        if self.start.closed {
            extremes.add_course(view, (&self.dense.force, &self.dense.turns), from, to);
        } else {
            extremes.of(view.mirrored).add(0.0);
        }
        if other.is_some() {
            let (second, gap) = (self.start.second_support, model.scene.second.gap);
            let polynomial = &self.dense.indentation;
            let turns = turning_points_between(polynomial, from, to);
            for y in turns.iter().chain([from, to]) {
                let indentation = value_and_slope(polynomial, y).0;
                let seen = if self.start.mirrored {
                    indentation
                } else {
                    second - indentation
                };
                extremes.approach(seen - gap);
            }
        }
    }

    /// Interruptions of the second contact, or of the first, up to the communication point; none if they are not counted.
    pub fn interruptions(&self, model: &Model, second: bool) -> Interruptions {
        let state = self.state();
        let mut interruptions = state.record(second).interruptions;
        if let Some(now) = self.inside()
            && let Some(criterion) = &model.views(state).0.criterion
            && second == state.mirrored
        {
            for place in self.dense.passages.until(now) {
                interruptions.turn(criterion, self.end.time + place * self.length());
            }
        }
        interruptions
    }

    /// Time derivatives of the tip at the communication point; at a discontinuity, the limit from the left.
    pub fn tip_rates(&self, model: &Model) -> TipRates {
        let state = self.state();
        if self.size == 0.0 {
            return TipRates::default();
        }
        let (model, _) = model.views(state);
        let of_both = |force: f64, acceleration: f64| {
            if state.mirrored {
                TipRates {
                    forces: [0.0, force],
                    acceleration: -acceleration,
                }
            } else {
                TipRates {
                    forces: [force, 0.0],
                    acceleration,
                }
            }
        };
        if let Some(y) = self.inside() {
            let slope = |values| value_and_slope(values, y).1 / self.length();
            let force = if state.closed { slope(&self.dense.force) } else { 0.0 };
            return of_both(force, slope(&self.dense.rate));
        }
        let accelerations = self.accelerations(model, state);
        let modes = model.modes.iter().zip(&accelerations);
        let acceleration = modes.fold(0.0, |sum, (mode, acceleration)| sum - mode.tip * acceleration);
        let rate = state.indentation_rate;
        let law = model
            .law
            .closed_branch(model.preload.indentation + state.indentation, rate);
        let force = if state.closed {
            law.stiffness * rate + law.damping * acceleration
        } else {
            0.0
        };
        of_both(force, acceleration)
    }
}
