//! A scene driven through segments of base acceleration and support displacement, and the properties kept on the way.

use crate::common::Rig;
use relay_contact::inputs::Inputs;
use relay_contact::model::{MAX_MODES, Mode, Model};
use relay_contact::scene::Scene;

/// Tip displacement per impulse of the mode that measures the impulse of the contact force: too heavy to move.
const METER: f64 = 1e-9;

/// What happens over a stretch of time.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    /// s.
    pub duration: f64,
    /// Base acceleration, held, m/s2.
    pub acceleration: f64,
    /// Displacement of the fixed contact at the end, reached linearly, m.
    pub support: f64,
}

/// A scene and what is done to it.
#[derive(Clone, Debug)]
pub struct Ride {
    pub scene: Scene,
    /// Velocity of the whole spring at the start, m/s; negative toward the fixed contact.
    pub speed: f64,
    pub segments: Vec<Segment>,
    /// Integration steps, taken and repeated, that are enough.
    pub steps: u64,
}

/// What came out.
#[derive(Debug)]
pub struct Outcome {
    /// Force at the end of each segment, N.
    pub forces: Vec<f64>,
    /// Longest rise of the energy over what was put in, J.
    made: f64,
    /// Energy at the start, also that of the preload, and all work, taken positive, J.
    throughput: f64,
    /// Way of the indentation and of the fixed contact, m.
    path: f64,
    pub rig: Rig,
}

impl Ride {
    /// The scene with a square wave of base acceleration, which opens the specimen's contact.
    pub fn shaken(scene: Scene) -> Self {
        let segment = |acceleration| Segment {
            duration: 3e-4,
            acceleration,
            support: 0.0,
        };
        Self {
            scene,
            speed: 0.0,
            segments: [500.0, -500.0, 500.0, -500.0, 0.0].map(segment).to_vec(),
            steps: 100_000,
        }
    }

    /// Drives the scene with each segment in `parts` communication steps; numbers, signs and bounds are checked at each.
    pub fn run(&self, parts: u32) -> Result<Outcome, String> {
        let mut model = Model::new(&self.scene, 0.0).map_err(|error| error.to_string())?;
        let metered = model.modes.len() < MAX_MODES;
        if metered {
            let meter = Mode {
                omega_squared: 0.0,
                damping: 0.0,
                tip: METER,
                participation: 0.0,
            };
            model.modes.insert(0, meter);
        }
        let pulls = model.law.never_opens();
        let mut rig = Rig::new(model);
        if self.speed != 0.0 {
            let velocities: Vec<f64> = rig
                .model
                .modes
                .iter()
                .map(|mode| self.speed * mode.participation)
                .collect();
            rig.launch(&velocities);
        }
        let (mut work, mut lowest, mut support, mut time) = (0.0, rig.energy(), 0.0, 0.0);
        let mut outcome = Outcome {
            forces: Vec::new(),
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
                let before = (
                    base_work(rig),
                    meter(rig),
                    rig.state.indentation,
                    rig.state.indentation_rate,
                );
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
                    .map_err(|error| format!("{error}, {} steps", rig.state.steps))?;
                let state = &rig.state;
                let numbers = [
                    state.time,
                    state.indentation,
                    state.indentation_rate,
                    state.force,
                    state.support,
                ];
                let modal = state.modes.iter().flat_map(|mode| [mode.q, mode.v]);
                if numbers.into_iter().chain(modal).any(|x| !x.is_finite()) {
                    return Err(format!("not finite at {} s: {numbers:?}", state.time));
                }
                if state.force < 0.0 && !pulls {
                    return Err(format!("tension at {} s: {:e} N", state.time, state.force));
                }
                if state.steps + state.rejected_steps > self.steps {
                    return Err(format!("more than {} steps until {} s", self.steps, state.time));
                }
                let base = segment.acceleration * (base_work(rig) - before.0);
                let held = rate * (meter(rig) - before.1);
                work += base + held;
                outcome.throughput += base.abs() + held.abs();
                let fastest = before.3.abs().max(rig.state.indentation_rate.abs());
                let way = (rig.state.indentation - before.2).abs().max(fastest * size);
                outcome.path += way + (rate * size).abs();
                let balance = rig.energy() - work;
                outcome.made = outcome.made.max(balance - lowest);
                lowest = lowest.min(balance);
            }
            time += segment.duration;
            support = segment.support;
            outcome.forces.push(outcome.rig.state.force);
        }
        if !metered && self.segments.iter().any(|segment| segment.support != 0.0) {
            return Err("the work of the support cannot be measured with this many modes".to_owned());
        }
        Ok(outcome)
    }

    /// All properties, with a segment in one communication step, in seven and in sixty-four.
    pub fn keeps_its_properties(&self) -> Outcome {
        let fine = self.run(64).unwrap();
        for parts in [1, 7] {
            let coarse = self.run(parts).unwrap();
            assert!(
                coarse.balances(&self.scene),
                "{parts} parts: {}",
                coarse.account(&self.scene)
            );
            fine.agrees(&coarse, &self.scene)
                .map_err(|error| format!("{parts} parts, {error}"))
                .unwrap();
        }
        assert!(fine.balances(&self.scene), "64 parts: {}", fine.account(&self.scene));
        fine
    }
}

impl Outcome {
    /// Error allowed in the contact force, N.
    fn error(&self, scene: &Scene) -> f64 {
        self.rig.model.force_scale * scene.solver.effective_tolerance()
    }

    /// A contact force wrong by the tolerance makes at most that force times the way of the tip in energy; rounding, the
    /// last of thirteen digits of what goes through.
    fn allowed(&self, scene: &Scene) -> f64 {
        self.error(scene) * self.path + 1e-13 * self.throughput
    }

    /// Whether no energy was made.
    pub fn balances(&self, scene: &Scene) -> bool {
        self.made <= self.allowed(scene)
    }

    /// Whether the forces at the ends of the segments are those of another run. Two runs with an error below the tolerance
    /// each differ by less than twice that.
    pub fn agrees(&self, other: &Self, scene: &Scene) -> Result<(), String> {
        let error = self.error(scene);
        for (segment, (a, b)) in self.forces.iter().zip(&other.forces).enumerate() {
            if (a - b).abs() > 2.0 * error {
                let ratio = (a - b).abs() / error;
                return Err(format!(
                    "segment {segment}: {a} against {b} N, {ratio:.1e} times the tolerance"
                ));
            }
        }
        Ok(())
    }

    /// The energy made, in words.
    pub fn account(&self, scene: &Scene) -> String {
        format!(
            "{:e} J made, {:.1e} times what is allowed, {:.1e} of the throughput",
            self.made,
            self.made / self.allowed(scene),
            self.made / self.throughput
        )
    }
}

/// Impulse of the contact force above the preload force since the start, N s.
fn meter(rig: &Rig) -> f64 {
    rig.model
        .modes
        .first()
        .filter(|mode| mode.tip == METER)
        .map_or(0.0, |_| rig.state.modes[0].v / METER)
}

/// Work of one metre per second squared of base acceleration from the preload to here, J.
fn base_work(rig: &Rig) -> f64 {
    let pairs = rig.model.modes.iter().zip(&rig.state.modes);
    -pairs.map(|(mode, at)| mode.participation * at.q).sum::<f64>()
}
