//! A scene with prescribed base acceleration and motion of the fixed contact, and the properties that hold in every scene.
//! Every number is finite, the contact force is never tensile (except bonded), no energy is generated, the work is
//! bounded, and the force does not depend on the communication step.

use anyhow::{Context, Result, bail};
use relay_contact::inputs::Inputs;
use relay_contact::reference::{MAX_MODES, Mode, Model};
use relay_contact::scene::Scene;

use crate::case::{Check, closest};
use testing::rig::Rig;
use testing::scenes::largest_difference;
use testing::worst;

/// Tip displacement per impulse of the auxiliary mode that measures the impulse of the contact force; its mass is so
/// large that it hardly moves.
const METER: f64 = 1e-9;

/// A time interval with prescribed motion.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    /// Duration, s.
    pub duration: f64,
    /// Base acceleration, held, m/s2.
    pub acceleration: f64,
    /// Displacement of the fixed contact at the end, reached linearly, m.
    pub support: f64,
}

impl Segment {
    /// The base is accelerated (m/s2) for a time (s).
    pub fn accelerated(duration: f64, acceleration: f64) -> Self {
        Self { duration, acceleration, support: 0.0 }
    }

    /// The fixed contact moves to a displacement (m) within a time (s).
    pub fn moved(duration: f64, support: f64) -> Self {
        Self { duration, acceleration: 0.0, support }
    }
}

/// A scene with prescribed motion.
#[derive(Clone, Debug)]
pub struct Ride {
    /// The scene.
    pub scene: Scene,
    /// Velocity of the whole spring at the start, m/s; negative toward the fixed contact.
    pub speed: f64,
    /// The intervals, in order.
    pub segments: Vec<Segment>,
    /// Limit of integration steps, accepted and rejected.
    pub steps: u64,
}

/// The result.
pub struct Outcome {
    /// Force at the end of each segment, N.
    pub(crate) forces: Vec<f64>,
    /// Largest contact force at communication points, a bonded one pulling too, N.
    largest: f64,
    /// Largest excess of the energy over that supplied, J.
    made: f64,
    /// Initial energy, including that of the preload, plus the magnitude of all work, J.
    throughput: f64,
    /// Path of the indentation and of the fixed contact, m.
    path: f64,
    pub(crate) rig: Rig,
}

impl Ride {
    /// A scene that starts at rest.
    pub(crate) fn new(scene: Scene, segments: impl Into<Vec<Segment>>) -> Self {
        Self { scene, speed: 0.0, segments: segments.into(), steps: 100_000 }
    }

    /// The scene with a square wave of base acceleration, which jumps at communication points and opens the contact of the
    /// specimen.
    pub(crate) fn shaken(scene: Scene) -> Self {
        let wave = [500.0, -500.0, 500.0, -500.0, 0.0];
        Self::new(scene, wave.map(|acceleration| Segment::accelerated(3e-4, acceleration)))
    }

    /// Simulates it with each segment in `parts` communication steps.
    /// A number that is not finite, a tensile contact force at a communication point, and more steps than allowed are errors.
    pub fn run(&self, parts: u32) -> Result<Outcome> {
        let mut model = Model::new(&self.scene, 0.0)?;
        // Room for the mode that meters the work of the support.
        if model.modes.len() == MAX_MODES {
            let mut scene = self.scene.clone();
            scene.solver.modes = i32::try_from(MAX_MODES)? - 1;
            model = Model::new(&scene, 0.0)?;
        }
        let massless = Mode { omega_squared: 0.0, damping: 0.0, tip: METER, participation: 0.0, ..Mode::default() };
        model = model.with(|model| model.modes.insert(0, massless));
        let mut rig = Rig::new(model);
        if self.speed != 0.0 {
            rig.throw(self.speed);
        }
        let (mut work, mut lowest, mut support, mut time) = (0.0, rig.energy(), 0.0, 0.0);
        let mut outcome = Outcome {
            forces: Vec::new(),
            largest: 0.0,
            made: 0.0,
            throughput: lowest + rig.model.preload.force * rig.model.preload.indentation.max(0.0),
            path: 0.0,
            rig,
        };
        for segment in &self.segments {
            let size = segment.duration / f64::from(parts);
            let rate = (segment.support - support) / segment.duration;
            for part in 1..=parts {
                let rig = &mut outcome.rig;
                let (base_before, meter_before, before) = (base_work(rig), meter(rig), rig.state);
                let inputs = Inputs {
                    base_acceleration: segment.acceleration,
                    support_displacement: if part == parts {
                        segment.support
                    } else {
                        support + rate * size * f64::from(part)
                    },
                    ..Inputs::default()
                };
                rig.run_to(&inputs, time + size * f64::from(part))
                    .with_context(|| format!("after {} integration steps", before.steps))?;
                self.inspect(rig)?;
                outcome.largest = outcome.largest.max(rig.state.contact().force.abs());
                let base = segment.acceleration * (base_work(rig) - base_before);
                let held = rate * (meter(rig) - meter_before);
                work += base + held;
                outcome.throughput += base.abs() + held.abs();
                let fastest = before.contact().rate.abs().max(rig.state.contact().rate.abs());
                let way = (rig.state.contact().approach - before.contact().approach).abs().max(fastest * size);
                outcome.path += way + (rate * size).abs();
                let balance = rig.energy() - work;
                outcome.made = outcome.made.max(balance - lowest);
                lowest = lowest.min(balance);
            }
            time += segment.duration;
            support = segment.support;
            outcome.forces.push(outcome.rig.state.contact().force);
        }
        Ok(outcome)
    }

    /// Checks at every communication point.
    fn inspect(&self, Rig { model, state, .. }: &Rig) -> Result<()> {
        let numbers =
            [state.time, state.contact().approach, state.contact().rate, state.contact().force, state.displacements[0]];
        let modal = state.modes.iter().flat_map(|mode| [mode.q, mode.v]);
        if numbers.into_iter().chain(modal).any(|x| !x.is_finite()) {
            bail!("not finite at {} s: {numbers:?}", state.time);
        }
        if state.contact().force < 0.0 && !model.law.never_opens() {
            bail!("tensile contact force at {} s: {:e} N", state.time, state.contact().force);
        }
        if state.steps + state.rejected_steps > self.steps {
            bail!("more than {} integration steps until {} s", self.steps, state.time);
        }
        Ok(())
    }

    /// The outcome with 64 communication steps in each segment, and the properties that hold in every scene, also with
    /// 1 and 7.
    pub(crate) fn checked(&self) -> Result<(Outcome, Vec<Check>)> {
        self.compared(Outcome::same_force)
    }

    /// The same with another comparison of the forces.
    fn compared(&self, same: fn(&Outcome, &Outcome) -> Check) -> Result<(Outcome, Vec<Check>)> {
        let fine = self.run(64)?;
        let mut checks = vec![Ok(vec![fine.energy()])];
        for parts in [1, 7] {
            let coarse = self.run(parts)?;
            checks.push(Ok(vec![coarse.energy(), same(&fine, &coarse)]));
        }
        Ok((fine, closest(checks)?))
    }

    /// The properties that hold in every scene.
    pub(crate) fn checks(&self) -> Result<Vec<Check>> {
        Ok(self.checked()?.1)
    }

    /// The same for forces far above the force scale: the tolerance is relative to the largest so far.
    pub(crate) fn checks_of_large_forces(&self) -> Result<Vec<Check>> {
        Ok(self.compared(Outcome::same_force_as_promised)?.1)
    }
}

impl Outcome {
    /// Allowed error of the contact force, N.
    fn force_error(&self) -> f64 {
        self.rig.model.force_scale * self.tolerance()
    }

    /// No energy is generated. A force error of the tolerance generates at most that force times the path of the tip;
    /// rounding adds the last of thirteen digits of the energy transferred.
    pub fn energy(&self) -> Check {
        let allowed = self.force_error() * self.path + 1e-13 * self.throughput;
        Check::energy("no energy is generated", self.made, allowed)
    }

    /// The forces at the ends of the segments agree with those of another simulation.
    pub fn same_force(&self, other: &Self) -> Check {
        self.agrees(other, self.rig.model.force_scale)
    }

    /// The same to what is promised of every scene: the tolerance is relative to the largest force so far.
    pub fn same_force_as_promised(&self, other: &Self) -> Check {
        let largest = self.largest.max(other.largest);
        self.agrees(other, self.rig.model.force_scale.max(largest))
    }

    /// The forces agree to the tolerance, relative to a force (N).
    fn agrees(&self, other: &Self, scale: f64) -> Check {
        let difference = largest_difference(&self.forces, &other.forces);
        let property = "the force is independent of the communication step";
        Check::two_runs(property, difference, self.tolerance() * scale)
    }

    fn tolerance(&self) -> f64 {
        self.rig.model.scene.solver.effective_tolerance()
    }
}

/// The specimen with a change.
pub(crate) fn changed(change: impl FnOnce(&mut Scene)) -> Scene {
    let mut scene = Scene::default();
    change(&mut scene);
    scene
}

/// Without damping and inputs: the energy of a thrown spring, read every microsecond.
pub(crate) fn conserved(mut rig: Rig, microseconds: u32) -> Result<Vec<Check>> {
    let (start, mut before) = (rig.energy(), rig.state);
    let (mut off, mut path) = (0.0, 0.0);
    for point in 1..=microseconds {
        rig.run_to(&Inputs::default(), f64::from(point) * 1e-6)?;
        path += (rig.state.contact().approach - before.contact().approach).abs();
        path += (rig.armature(&rig.state) - rig.armature(&before)).abs();
        off = worst(off, (rig.energy() - start).abs());
        before = rig.state;
    }
    // Rounding: the last of thirteen digits.
    let allowed = rig.model.scene.solver.effective_tolerance() * rig.model.force_scale * path + 1e-13 * start;
    Ok(vec![Check::energy("the energy supplied is conserved", off, allowed)])
}

/// Impulse of the contact force in excess of the preload force since the start, N s.
fn meter(rig: &Rig) -> f64 {
    rig.model.modes.first().filter(|mode| mode.tip == METER).map_or(0.0, |_| rig.state.modes[0].v / METER)
}

/// Work of a base acceleration of 1 m/s2 since the preload, J.
fn base_work(rig: &Rig) -> f64 {
    let pairs = rig.model.modes.iter().zip(&rig.state.modes);
    -pairs.map(|(mode, at)| mode.participation * at.q).sum::<f64>()
}
