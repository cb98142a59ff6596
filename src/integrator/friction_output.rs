//! Friction at a communication point, and its time derivatives.

use crate::friction::Phase;
use crate::integrator::dense_output::DenseFriction;
use crate::integrator::motion::Motion;
use crate::math::prediction::value_and_slope;
use crate::model::Model;

/// Friction at a communication point, or its time derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrictionNow {
    /// Friction force, N.
    pub force: f64,
    /// Slip, m.
    pub slip: f64,
    /// Distance slipped so far, m.
    pub distance: f64,
    /// Energy dissipated by slip so far, J.
    pub dissipated: f64,
}

impl Motion {
    /// Friction at the communication point.
    pub fn friction(&self) -> FrictionNow {
        let start = self.state().tangential;
        let Some(y) = self.inside() else {
            return FrictionNow {
                force: start.force,
                slip: start.slip,
                distance: start.distance,
                dissipated: start.dissipated,
            };
        };
        let force = &self.end.tangential.course;
        let DenseFriction { slip, dissipated } = &self.dense.friction;
        let at = |values| value_and_slope(values, y).0;
        let (closed, slips) = (self.start.closed, start.phase != Phase::Stick);
        let now = if closed && !slips { start.slip } else { at(slip) };
        FrictionNow {
            force: if closed { at(force) } else { 0.0 },
            slip: now,
            distance: start.distance + if closed { (now - start.slip).abs() } else { 0.0 },
            dissipated: if closed && slips {
                at(dissipated).max(start.dissipated)
            } else {
                start.dissipated
            },
        }
    }

    /// Its time derivatives at the communication point; at a discontinuity, the limit from the left.
    pub(crate) fn friction_rates(&self, model: &Model) -> FrictionNow {
        let state = self.state();
        let mut rates = FrictionNow::default();
        let (Some(friction), Some(law)) = (model.friction(), model.law.power()) else {
            return rates;
        };
        let start = state.tangential;
        if self.size == 0.0 {
            return rates;
        }
        if !state.closed {
            rates.slip = match self.inside() {
                Some(y) => value_and_slope(&self.dense.friction.slip, y).1 / self.length(),
                None => start.rate,
            };
            return rates;
        }
        let force;
        if let Some(y) = self.inside() {
            let slope = |values| value_and_slope(values, y).1 / self.length();
            force = value_and_slope(&self.end.tangential.course, y).0;
            rates.force = slope(&self.end.tangential.course);
            if start.phase != Phase::Stick {
                rates.slip = slope(&self.dense.friction.slip);
            }
        } else {
            force = start.force;
            let d = model.preload.indentation + state.indentation;
            let stick = friction.trial(law, d, start.deflection(), start.rate);
            if let Some(sign) = start.phase.sign() {
                let normal = self.tip_rates(model).forces[0];
                rates.force = sign * friction.coefficient * normal;
                rates.slip = if law.damping > 0.0 {
                    (force - stick.force) / (law.damping * stick.stiffness)
                } else {
                    start.rate + sign * friction.coefficient / friction.ratio / law.exponent * state.indentation_rate
                };
            } else {
                let accelerations = self.accelerations(model, state);
                let modes = friction.levers.iter().zip(&accelerations).take(model.modes.len());
                let acceleration: f64 = modes.map(|(lever, acceleration)| lever * acceleration).sum();
                rates.force = stick.by_indentation * state.indentation_rate
                    - stick.stiffness * (start.rate + law.damping * acceleration);
            }
        }
        rates.distance = rates.slip.abs();
        rates.dissipated = (force * rates.slip).abs();
        rates
    }
}
