//! The motion at a communication point, and dense output between integration steps.
//!
//! While inputs continue as before, the integrator runs ahead in steps as long as the error allows. Communication points then lie
//! inside an integration step, and the tip is read from the step's polynomials (dense output). When an input changes, the step is
//! repeated from its start to the communication point, and the communication step that begins there is integrated to its end.

use std::fmt;

use crate::beam::mode::{MAX_MODES, Modal};
use crate::chatter::Interruptions;
use crate::contact::friction::{Phase, Slip};
use crate::excitation::drive::Drive;
use crate::integrator::course::turning_points_between;
use crate::integrator::dense_output::{DenseLink, DenseOutput};
use crate::integrator::events::log::Event;
use crate::integrator::extremes::Extremes;
use crate::integrator::with_contact;
use crate::link::{CONTACT, Link, MAX_LINKS, Ways};
use crate::math::prediction::{value_and_slope, value_at};
use crate::model::Model;
use crate::state::{LinkState, State};
use serde::de::{self, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

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
    /// Base acceleration and velocities of the fixed contacts during it.
    pub(crate) drive: Drive,
    /// State at the start of the current integration step: at the communication point, or before it.
    pub(crate) start: State,
    /// State at the end of the current integration step: at the communication point, or ahead of it.
    pub(crate) end: State,
    /// The links between `start` and `end`.
    pub(crate) dense: DenseOutput,
}

/// Reads a motion part by part into its place on the heap: as a whole it takes much of a small stack.
pub(crate) fn on_heap<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Box<Motion>, D::Error> {
    struct Parts;
    impl<'de> Visitor<'de> for Parts {
        type Value = Box<Motion>;

        fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
            formatter.write_str("a motion")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut parts: A) -> Result<Box<Motion>, A::Error> {
            let mut motion = empty();
            read(&mut parts, &mut motion.time)?;
            read(&mut parts, &mut motion.current)?;
            read(&mut parts, &mut motion.current_rate)?;
            read(&mut parts, &mut motion.size)?;
            read(&mut parts, &mut motion.extremes)?;
            read(&mut parts, &mut motion.drive)?;
            read(&mut parts, &mut motion.start)?;
            read(&mut parts, &mut motion.end)?;
            read(&mut parts, &mut motion.dense)?;
            Ok(motion)
        }
    }
    deserializer.deserialize_tuple(PARTS, Parts)
}

/// Number of fields of [`Motion`], in the order of which they are saved.
const PARTS: usize = 9;

/// Room for a motion.
#[inline(never)]
fn empty() -> Box<Motion> {
    Box::new(Motion::new(State::empty()))
}

/// Reads the next part.
#[inline(never)]
fn read<'de, A: SeqAccess<'de>, T: Deserialize<'de>>(parts: &mut A, part: &mut T) -> Result<(), A::Error> {
    let missing = || de::Error::custom("it ends within a motion");
    *part = parts.next_element()?.ok_or_else(missing)?;
    Ok(())
}

/// A link at a communication point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LinkNow {
    /// Force, N.
    pub force: f64,
    /// Approach minus that of the preload, m.
    pub approach: f64,
    /// Its velocity, m/s.
    pub rate: f64,
}

/// A link, its state at the start of the step around a communication point, and its dense output with the place of that point,
/// where it lies inside.
type Seen<'a> = (&'a Link, &'a LinkState, Option<(&'a DenseLink, f64)>);

impl Motion {
    /// Starts from a state.
    pub fn new(state: State) -> Self {
        Self {
            time: state.time,
            current: 0.0,
            current_rate: 0.0,
            size: 0.0,
            extremes: None,
            drive: Drive::resting(state.displacements),
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

    /// Takes over another of this model: what it has of modes and links, as a whole motion takes longer than a step.
    pub(crate) fn copy(&mut self, model: &Model, other: &Self) {
        let (modes, links) = (model.modes.len(), model.links.len());
        self.start.copy(&other.start, modes, links);
        self.end.copy(&other.end, modes, links);
        self.dense.copy(&other.dense, links);
        Self {
            start: _,
            end: _,
            dense: _,
            time: self.time,
            current: self.current,
            current_rate: self.current_rate,
            size: self.size,
            extremes: self.extremes,
            drive: self.drive,
        } = *other;
    }

    /// The last integrated state at or before the communication point.
    pub fn state(&self) -> &State {
        if self.end.time <= self.time { &self.end } else { &self.start }
    }

    /// Whether the values are consistent: finite, with times in order (check of a deserialised state).
    pub fn is_sound(&self) -> bool {
        let Self { time, current, current_rate, size, extremes, drive, start, end, dense } = self;
        let numbers = [*time, *current, *current_rate, *size, drive.jerk, drive.acceleration(start.time), drive.coil];
        let extremes = extremes.iter().flat_map(Extremes::numbers);
        let moving = drive.velocities.into_iter().chain(drive.displacements);
        numbers.into_iter().chain(moving).chain(extremes).all(f64::is_finite)
            && *size >= 0.0
            && dense.is_sound()
            && start.is_sound()
            && end.is_sound()
            && start.time <= *time
            && (start == end && end.time == *time || start.time < end.time && *time <= end.time)
    }

    /// Openings and closings that the integrator has located beyond the communication point: of each link the last ones.
    pub fn events_ahead(&self) -> impl Iterator<Item = Event> {
        let links = self.end.links.iter().enumerate();
        links.flat_map(move |(link, at)| {
            let mut last = [(at.last_opening, false), (at.last_closing, true)];
            if !at.closed {
                last.reverse();
            }
            let ahead = move |(instant, closes): (Option<f64>, bool)| {
                let time = instant.filter(|time| *time > self.time)?;
                Some(Event { time, closes, link })
            };
            last.into_iter().filter_map(ahead)
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

    /// A link at the communication point, with its state at the start of the step around it.
    fn seen<'a>(&'a self, model: &'a Model, index: usize) -> Option<Seen<'a>> {
        let link = model.links.get(index)?;
        let state = self.state().links.get(index)?;
        let dense = self.inside().and_then(|y| Some((self.dense.links.get(index)?, y)));
        Some((link, state, dense))
    }

    /// A link at the communication point; nothing of a model that has no such link.
    pub fn link(&self, model: &Model, index: usize) -> LinkNow {
        let Some((_, state, dense)) = self.seen(model, index) else { return LinkNow::default() };
        let force = self.force(model, index);
        let (approach, rate) = match dense {
            Some((dense, y)) => (value_at(&dense.approach, y), value_at(&dense.rate, y)),
            None => (state.approach, state.rate),
        };
        LinkNow { force, approach, rate }
    }

    /// Its force alone, N.
    pub fn force(&self, model: &Model, index: usize) -> f64 {
        let Some((link, state, dense)) = self.seen(model, index) else { return 0.0 };
        let Some((dense, y)) = dense else { return state.force };
        if !state.closed {
            return 0.0;
        }
        let force = link.force + value_at(&dense.force, y);
        let opens = link.contact().is_some_and(|law| !law.never_opens());
        if opens { force.max(f64::MIN_POSITIVE) } else { force }
    }

    /// Rates of force (N/s) and velocity (m/s2) of a contact at the communication point; at a discontinuity, the limit from the
    /// left.
    pub fn link_rates(&self, model: &Model, index: usize) -> (f64, f64) {
        let Some((link, state, dense)) = self.seen(model, index).filter(|_| self.size > 0.0) else { return (0.0, 0.0) };
        if let Some((dense, y)) = dense {
            let slope = |values| value_and_slope(values, y).1 / self.length();
            let force = if state.closed { slope(&dense.force) } else { 0.0 };
            return (force, slope(&dense.rate));
        }
        let acceleration = self.acceleration(model, link);
        let Some(law) = link.contact().filter(|_| state.closed) else { return (0.0, acceleration) };
        let branch = law.closed_branch(link.approach + state.approach, state.rate);
        (branch.stiffness * state.rate + branch.damping * acceleration, acceleration)
    }

    /// Second derivative of the approach of a link at the end of a step, m/s2.
    fn acceleration(&self, model: &Model, link: &Link) -> f64 {
        let accelerations = self.accelerations(model, self.state());
        let Some(port) = model.ports.get(link.port) else { return 0.0 };
        let pairs = port.shape.iter().zip(&accelerations);
        -link.sense * pairs.map(|(b, acceleration)| b * acceleration).sum::<f64>()
    }

    /// Force of the first contact without what its damping adds (N), and the rate of that (N/s).
    pub fn elastic_force(&self, model: &Model) -> (f64, f64) {
        let (contact, law) = (self.link(model, CONTACT), &model.law);
        if contact.force <= 0.0 && !law.never_opens() {
            return (0.0, 0.0);
        }
        let indentation = model.preload.indentation + contact.approach;
        let stiffness = law.stiffness(indentation);
        (law.closed_branch(indentation, 0.0).force, stiffness * contact.rate)
    }

    /// Friction force (N) and slip at the communication point.
    pub fn friction(&self, model: &Model) -> (f64, Slip) {
        let state = self.state();
        let mut slip = state.slip;
        let Some((link, along, dense)) = model.friction().and_then(|(index, _)| self.seen(model, index)) else {
            return (0.0, slip);
        };
        let Some((dense, y)) = dense else { return (along.force, slip) };
        let (closed, slips) = (state.links[CONTACT].closed, slip.phase != Phase::Stick);
        let at = |values| value_at(values, y);
        if !closed || slips {
            let start = slip.way;
            slip.way = at(&self.dense.slip.slip);
            slip.distance += if closed { (slip.way - start).abs() } else { 0.0 };
        }
        if closed && slips {
            slip.dissipated = at(&self.dense.slip.dissipated).max(slip.dissipated);
        }
        (if closed { link.force + at(&dense.force) } else { 0.0 }, slip)
    }

    /// Their time derivatives at the communication point; at a discontinuity, the limit from the left.
    pub(crate) fn friction_rates(&self, model: &Model) -> (f64, Slip) {
        let state = self.state();
        let none = (0.0, Slip::default());
        let (law, Some((index, friction))) = (&model.law, model.friction()) else { return none };
        let Some((link, along, dense)) = self.seen(model, index).filter(|_| self.size > 0.0) else { return none };
        let contact = &state.links[CONTACT];
        let of_slip = |y: f64| value_and_slope(&self.dense.slip.slip, y).1 / self.length();
        if !contact.closed {
            let slip = dense.map_or(-along.rate, |(_, y)| of_slip(y));
            return (0.0, Slip { way: slip, ..Slip::default() });
        }
        let (force, rate, slip);
        if let Some((dense, y)) = dense {
            let (value, slope) = value_and_slope(&dense.force, y);
            (force, rate) = (link.force + value, slope / self.length());
            slip = if state.slip.phase == Phase::Stick { 0.0 } else { of_slip(y) };
        } else {
            force = along.force;
            let d = model.preload.indentation + contact.approach;
            let stick = friction.trial(law, d, -along.approach - state.slip.way, -along.rate);
            if let Some(sign) = state.slip.phase.sign() {
                rate = sign * friction.coefficient * self.link_rates(model, CONTACT).0;
                slip = if law.damping > 0.0 {
                    (force - stick.force) / (law.damping * stick.stiffness)
                } else {
                    -along.rate + sign * friction.coefficient / friction.ratio / law.exponent * contact.rate
                };
            } else {
                let acceleration = -self.acceleration(model, link);
                rate =
                    stick.by_indentation * contact.rate - stick.stiffness * (-along.rate + law.damping * acceleration);
                slip = 0.0;
            }
        }
        let slip = Slip { way: slip, distance: slip.abs(), dissipated: (force * slip).abs(), ..Slip::default() };
        (rate, slip)
    }

    /// Accelerations of the modes under all loads at the end of a step.
    pub(crate) fn accelerations(&self, model: &Model, state: &State) -> Modal {
        let base = self.drive.acceleration(self.time) + model.generator.acceleration_before(self.time);
        let modes = with_contact::modes(model, state);
        let mut accelerations = match model.axial.as_deref() {
            Some(axial) => axial.loads(&model.modes, &modes),
            None => [0.0; MAX_MODES],
        };
        for (link, at) in model.links.iter().zip(&state.links) {
            let force = link.sense * (at.force - link.force);
            for (acceleration, b) in
                accelerations.iter_mut().zip(model.ports.get(link.port).iter().flat_map(|port| &port.shape))
            {
                *acceleration += b * force;
            }
        }
        for ((acceleration, mode), at) in accelerations.iter_mut().zip(&model.modes).zip(&modes) {
            *acceleration -= mode.participation * base + mode.omega_squared * at.q + mode.damping * at.v;
        }
        accelerations
    }

    /// Extremes at the communication point alone.
    pub(crate) fn extremes_now(&self, model: &Model) -> Extremes {
        let mut forces = [0.0; MAX_LINKS];
        for (index, force) in forces.iter_mut().enumerate().take(model.links.len()) {
            *force = self.force(model, index);
        }
        let second = model.roles.second.and_then(|index| {
            let link = model.links.get(index)?;
            Some(link.approach + self.link(model, index).approach)
        });
        Extremes::at(model, forces, second.unwrap_or_default())
    }

    /// Displacements of the inputs that move bodies, m.
    pub(crate) fn displacements(&self) -> Ways {
        let at = self.state();
        self.drive.moved(at.displacements, self.time - at.time)
    }

    /// Displacement (m) and velocity (m/s) of the fixed contact.
    pub fn support(&self) -> (f64, f64) {
        let ([displacement, ..], [velocity, ..]) = (self.displacements(), self.state().velocities);
        (displacement, velocity)
    }

    /// Extremes of the forces within the last communication step; for scenes with `effects.extremes`.
    pub fn extremes(&self, model: &Model) -> Extremes {
        self.extremes.unwrap_or_else(|| self.extremes_now(model))
    }

    /// Adds those of the dense output between two instants (s); the first may lie before the step, and is included
    /// already.
    pub(crate) fn add_dense(&self, extremes: &mut Extremes, model: &Model, from: f64, to: f64) {
        // Of two contacts that open together the second does in a step of no length.
        if self.length() <= 0.0 {
            return;
        }
        let at = |time: f64| ((time - self.end.time) / self.length()).clamp(-1.0, 0.0);
        let (from, to) = (at(from), at(to));
        let links = model.links.iter().zip(&self.start.links).zip(&self.dense.links);
        for (index, ((link, start), dense)) in links.enumerate() {
            if link.contact().is_none() {
                continue;
            }
            if start.closed {
                extremes.add_course(link, index, (&dense.force, &dense.turns), from, to);
            } else {
                extremes.of(index).add(0.0);
            }
            if model.roles.second == Some(index) {
                let turns = turning_points_between(model.simd, &dense.approach, from, to);
                for y in turns.iter().chain([from, to]) {
                    extremes.approach(link.approach + value_at(&dense.approach, y));
                }
            }
        }
        let course = |index: usize| {
            self.start.links.get(index).filter(|at| at.closed)?;
            let dense = self.dense.links.get(index)?;
            Some((&dense.force, dense.turns))
        };
        extremes.add_pair(model, course, (from, to));
    }

    /// Interruptions of a circuit up to the communication point; none if they are not counted.
    pub fn interruptions(&self, model: &Model, circuit: usize) -> Interruptions {
        let circuits = &self.state().circuits;
        let links = &self.dense.links;
        let passes = |now: f64| links.iter().any(|dense| dense.passages.until(now).next().is_some());
        let Some(now) = self.inside().filter(|now| passes(*now)) else { return circuits.of(circuit) };
        let mut circuits = *circuits;
        let passages = links.each_ref().map(|dense| &dense.passages);
        circuits.pass(&model.links, &passages, (self.end.time, self.length()), now);
        circuits.of(circuit)
    }
}
