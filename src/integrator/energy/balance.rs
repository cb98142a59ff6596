//! The energy balance (`effects.energy`): the numerical energy error of the integration in time. Energy supplied since
//! initialisation, minus energy stored, minus energy dissipated, J. Positive: the integration has lost energy;
//! negative: it has created energy.
//!
//! Supplied: the work of the base acceleration `a` and of the moving fixed contact (displacement `u`). Stored: kinetic
//! and strain energy of the beam and the elastic energy `V` of the contact. Dissipated: `D_b` in the beam and, in the
//! contact, the work of `F_d`, the force of the law minus its elastic part `V'(d)`. If damping makes the force vanish
//! before the surfaces part, `F_d = -V'(d)`: the energy left in the indentation does no work and is dissipated.
//!
//! A step moves the tip by a force `F_p`, a polynomial, and for that force the motion of the modes is exact. So for
//! the beam, with the preload force `F_0` and `E_b = sum (v_i^2 + omega_i^2 q_i^2) / 2`, both about the preload,
//!
//! ```text
//! change of E_b + D_b = work of a + integral of (F_p - F_0) (u' - d') dt
//! ```
//!
//! holds in each step, whatever `F_p` is. In the balance the works of the base and of the fixed contact, `D_b` and
//! `E_b` cancel. What is left is the contact,
//!
//! ```text
//! balance = integral of (F_p - F_d) d' dt - change of V = integral of (F_p - F) d' dt,
//! ```
//!
//! the work of the difference between the polynomial and the law `F` at the motion. This difference vanishes at the
//! nodes, where a quadrature would not see it. The motion is therefore computed again in two half steps, from the same
//! start under the same `F_p`, with the base acceleration at more instants, and the integral is taken by the Radau
//! quadratures of both, with eight nodes each. The energy at the end of that motion may differ from that of the step
//! taken, by the step's polynomial of the base acceleration, by an impulse it applied, or by a programming error. This
//! difference is included.
//!
//! Friction adds the work that its polynomial `T_p` misses of its law `T`, `-integral of (T_p - T) v' dt`.
//!
//! So the balance measures the integration in time, not the truncation to a number of modes, nor the exact solution of
//! a single mode, which it relies on. A contact at rest and exact linear steps contribute nothing: one does not move,
//! the other has no polynomial and satisfies the law at every instant to rounding.
//!
//! The balance is updated at the ends of integration steps: at a communication point inside a step it is that of the
//! step's start.
//!
//! A force error `e` over a tip path `s` changes the energy by at most `e s`. So compare the balance with the tolerance
//! times the force scale times the path.

use crate::excitation::drive::Drive;
use crate::integrator::collocation::polynomial::LONG_BY_TIME;
use crate::integrator::collocation::step::compute;
use crate::integrator::collocation::trial::{Source, Trial};
use crate::integrator::grid::Target;
use crate::integrator::workspace::{Room, Rooms, Workspace};
use crate::link::{CONTACT, LinkLaw, MAX_LINKS};
use crate::math::nodal::{LONG, Nodal};
use crate::model::Model;
use crate::state::State;

/// Energy relative to the preload at the end of a step about to be accepted, if the step were free of error, J; `None` where
/// that cannot be computed.
pub(crate) fn expected_energy<const S: usize>(
    model: &Model,
    state: &State,
    drive: &Drive,
    workspace: &mut Workspace,
    trial: &Trial<S>,
    target: &Target,
) -> Option<f64>
where
    Workspace: Rooms<S>,
{
    let half = 0.5 * target.length;
    let polynomial = Rooms::<S>::room(workspace).cache.collocation;
    let variable = polynomial.variable;
    let first = workspace.long.cache.collocation;
    // Of a leap only the first half begins where its contact has closed.
    let in_half = [first, &LONG_BY_TIME];
    let in_halves = |values: &Nodal<S>| {
        [(0.0, in_half[0]), (0.5, in_half[1])].map(|(start, half)| {
            half.nodes.map(|node| polynomial.interpolate(values, variable.place(start + 0.5 * node)))
        })
    };
    let halves: [[Nodal<LONG>; 2]; MAX_LINKS] = trial.links.map(|nodes| in_halves(&nodes.forces));
    let mut at: State = *state;
    let mut work = 0.0;
    for (half_step, collocation) in in_half.into_iter().enumerate() {
        let Workspace { long: Room { cache, scratch, .. }, half: motion, .. } = &mut *workspace;
        for (nodes, halves) in motion.links.iter_mut().zip(&halves) {
            nodes.forces = *halves.get(half_step)?;
        }
        cache.collocation = collocation;
        let prepared = cache.prepare(at.time, half, target.recurring, model);
        let computed = compute(model, &at, drive, prepared, Source::Given, motion, scratch);
        work += half * prepared.collocation.mean(&powers(model, state, motion));
        at.modes = motion.modes;
        for (at, nodes) in at.links.iter_mut().zip(&motion.links) {
            (at.approach, at.rate) = (nodes.end.approach, nodes.end.rate);
        }
        cache.collocation = first;
        computed?;
        at.time += half;
        at.displacements = drive.moved(at.displacements, half);
    }
    // Of a closed contact the work; without contact force, all elastic energy that leaves the contact is dissipated.
    let stored = |index: usize| {
        let links = [state, &at].map(|state| state.links.get(index).copied().unwrap_or_default());
        if links[0].closed { links[0].approach } else { links[1].approach }
    };
    Some(model.energy_at(&at.modes, state.coil, stored) + work)
}

/// Power of what the forces of a motion miss of the dissipative parts of their laws, W.
fn powers(model: &Model, state: &State, motion: &Trial<LONG>) -> Nodal<LONG> {
    let mut powers = [0.0; LONG];
    for ((link, at), nodes) in model.links.iter().zip(&state.links).zip(&motion.links) {
        let moved = nodes.approaches.iter().zip(&nodes.rates).zip(&nodes.forces);
        for (k, (power, ((d, rate), force))) in powers.iter_mut().zip(moved).enumerate() {
            *power += match &link.law {
                LinkLaw::Contact(_) if at.closed => {
                    (force - (link.force_at(*d, *rate) - link.force_at(*d, 0.0))) * rate
                }
                LinkLaw::Friction(friction) => {
                    let contact = model.links.get(CONTACT).zip(motion.links.get(CONTACT));
                    let (Some((contact, across)), true) = (contact, state.links[CONTACT].closed) else { continue };
                    let (Some(across), Some(across_rate)) = (across.approaches.get(k), across.rates.get(k)) else {
                        continue;
                    };
                    let expected = if let Some(sign) = state.slip.phase.sign() {
                        sign * friction.coefficient * contact.force_at(*across, *across_rate)
                    } else {
                        let across = contact.approach + across;
                        friction.trial(&model.law, across, -d - state.slip.way, -rate).force
                    };
                    (link.force + force - expected) * rate
                }
                LinkLaw::Contact(_) | LinkLaw::Magnet(_) | LinkLaw::Gauge => 0.0,
            };
        }
    }
    powers
}

#[cfg(test)]
mod tests {
    use nalgebra::SVector;

    use super::*;
    use crate::inputs::Inputs;
    use crate::integrator::collocation::polynomial::{Collocation, SHORT_BY_TIME};
    use crate::integrator::communication_step::advance;
    use crate::integrator::grid::Grid;
    use crate::integrator::recorder::Recorder;
    use crate::integrator::stepper::Stepper;
    use crate::link::INPUTS;
    use crate::math::nodal::SHORT;
    use crate::scene::Scene;
    use crate::variables::ExcitationKind;

    const MODES: usize = 6;
    type Along = SVector<f64, { 2 * MODES + 2 }>;

    /// The specimen in motion: shaken by the generator and by an input that grows, with the fixed contact moving.
    fn moving() -> (Model, State, Drive) {
        let mut scene = Scene::default();
        scene.effects.excitation = ExcitationKind::Sine;
        scene.effects.energy = true;
        scene.excitation.amplitude = 300.0;
        scene.excitation.phase = 0.3;
        scene.solver.modes = i32::try_from(MODES).unwrap();
        let model = Model::new(&scene, 0.0).unwrap();
        let mut state = model.initial_state(0.0);
        let inputs = Inputs { base_acceleration: 20.0, base_acceleration_rate: 1e5, ..Inputs::default() };
        let ways = ([0.0; INPUTS], [-2e-8, 0.0, 0.0]);
        let drive = Drive::default().next(&inputs, (0.0, 1e-3), ways, [0.0; INPUTS]).unwrap();
        let mut workspace = Workspace::new(&model);
        advance(&model, &mut state, &mut workspace, drive, Grid::over(0.0, 4e-4), false, None).unwrap();
        state.energy_balance = 0.0;
        (model, state, drive)
    }

    /// What a modified step of `length` (s) adds to the balance, J.
    fn balance<const S: usize>(
        model: &Model,
        state: &mut State,
        drive: Drive,
        length: f64,
        change: impl FnOnce(&mut Trial<S>),
    ) -> (f64, Trial<S>)
    where
        Workspace: Rooms<S>,
    {
        let mut workspace = Workspace::new(model);
        let grid = Grid::over(state.time, length);
        let mut stepper = Stepper::new(model, state, &mut workspace, drive, grid, Recorder::default());
        let target = stepper.grid.target(length, stepper.state.time, None);
        let mut trial: Box<Trial<S>> = bytemuck::zeroed_box();
        stepper.compute(&mut trial, &target).unwrap();
        change(&mut trial);
        assert!(stepper.commit(&trial, &target, true).unwrap());
        (state.energy_balance, *trial)
    }

    /// The same from all works, energies and losses, integrated along the motion under the force of the step by the
    /// classical Runge-Kutta method, J.
    #[expect(clippy::indexing_slicing, reason = "as many entries as the modes need")]
    fn summed<const S: usize>(
        model: &Model,
        start: &State,
        end: &State,
        drive: Drive,
        length: f64,
        (trial, collocation): (&Trial<S>, &Collocation<S>),
    ) -> f64 {
        const STEPS: u32 = 20_000;
        // Displacement and velocity of each mode, energy supplied, energy dissipated.
        let rates = |t: f64, y: &Along| {
            let force = collocation.interpolate(&trial.links[CONTACT].forces, t / length);
            let base = drive.acceleration(start.time + t) + model.generator.phasor(start.time + t).0;
            let (mut d, mut rate) = (start.displacements[0] + drive.velocities[0] * t, drive.velocities[0]);
            let mut slope = Along::zeros();
            for (i, mode) in model.modes.iter().enumerate() {
                let (q, v) = (y[2 * i], y[2 * i + 1]);
                slope[2 * i] = v;
                slope[2 * i + 1] =
                    mode.tip * force - mode.participation * base - mode.damping * v - mode.omega_squared * q;
                d -= mode.tip * q;
                rate -= mode.tip * v;
                slope[2 * MODES] -= base * mode.participation * v;
                slope[2 * MODES + 1] += mode.damping * v * v;
            }
            let d = model.preload.indentation + d;
            slope[2 * MODES] += (model.preload.force + force) * drive.velocities[0];
            slope[2 * MODES + 1] += (model.law.force(d, rate) - model.law.force(d, 0.0)) * rate;
            slope
        };
        let mut y = Along::zeros();
        for (i, at) in start.modes.iter().take(MODES).enumerate() {
            (y[2 * i], y[2 * i + 1]) = (at.q, at.v);
        }
        let h = length / f64::from(STEPS);
        for k in 0..STEPS {
            let t = f64::from(k) * h;
            let a = rates(t, &y);
            let b = rates(t + 0.5 * h, &(y + a * (0.5 * h)));
            let c = rates(t + 0.5 * h, &(y + b * (0.5 * h)));
            let d = rates(t + h, &(y + c * h));
            y += (a + (b + c) * 2.0 + d) * (h / 6.0);
        }
        let stored = |state: &State| model.energy(state) + model.preload.force * state.displacements[0];
        y[2 * MODES] - y[2 * MODES + 1] - (stored(end) - stored(start))
    }

    #[test]
    fn a_step_is_balanced_as_the_sum_of_its_works_and_losses_is() {
        // Four nodes, and steps far longer than the error allows, so that there is an energy error.
        for length in [6e-5, 1.2e-4, 2.4e-4] {
            let (model, start, drive) = moving();
            let mut end = start;
            let (entered, trial) = balance::<SHORT>(&model, &mut end, drive, length, |_| ());
            let sum = summed(&model, &start, &end, drive, length, (&trial, &SHORT_BY_TIME));
            // The defect at the start excites oscillations of about a microsecond, which the nodes of the half steps do
            // not resolve.
            assert!((entered - sum).abs() < 0.1 * sum.abs(), "{length} s: entered {entered:e} J, summed {sum:e} J");
        }
    }

    #[test]
    fn a_wrong_force_shows_in_the_balance() {
        let (model, start, drive) = moving();
        let mut end = start;
        let wrong = 1e-6;
        let (entered, trial) = balance::<LONG>(&model, &mut end, drive, 6e-5, |trial| {
            trial.links[CONTACT].forces = trial.links[CONTACT].forces.map(|force| force + wrong);
        });
        let sum = summed(&model, &start, &end, drive, 6e-5, (&trial, &LONG_BY_TIME));
        assert!((entered - sum).abs() < 1e-3 * sum.abs(), "entered {entered:e} J, summed {sum:e} J");
        // More than the work of the wrong force itself: the changed motion meets other forces of the law.
        let worth = wrong * (end.links[CONTACT].approach - start.links[CONTACT].approach).abs();
        assert!(entered.abs() > worth, "entered {entered:e} J, worth {worth:e} J");
    }

    #[test]
    fn a_wrong_motion_shows_in_the_balance() {
        let (model, start, drive) = moving();
        let mut end = start;
        let mut made = 0.0;
        let (entered, _) = balance::<LONG>(&model, &mut end, drive, 6e-5, |trial| {
            let first = trial.modes.first_mut().unwrap();
            let expected = first.v;
            first.v *= 1.0 + 1e-6;
            made = 0.5 * (first.v * first.v - expected * expected);
        });
        assert!((entered + made).abs() < 1e-3 * made, "entered {entered:e} J, made {made:e} J");
    }
}
