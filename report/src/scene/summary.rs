//! What happened in a run, in a few lines.

use std::fmt;
use std::time::Duration;

use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{IntegerOutput, RealOutput, ResistanceKind};

use crate::numbers::{seconds, significant};

/// Kept up with from step to step.
pub struct Summary {
    scene: Scene,
    openings: u64,
    /// Openings and closings beyond those that the simulation keeps of a step.
    left_out: u64,
    /// Least and greatest contact force, N.
    force: (f64, f64),
    /// Ohm.
    worst_resistance: f64,
    reals: Vec<(RealOutput, f64)>,
    integers: Vec<(IntegerOutput, i32)>,
    /// Spent on the steps.
    taken: Duration,
    /// Simulated, s.
    time: f64,
}

impl Summary {
    /// At the start of a run.
    pub fn new(scene: &Scene, simulation: &Simulation) -> Self {
        let force = simulation.real(RealOutput::ContactForce);
        Self {
            scene: *scene,
            openings: 0,
            left_out: 0,
            force: (force, force),
            worst_resistance: simulation.real(RealOutput::ContactResistance),
            reals: Vec::new(),
            integers: Vec::new(),
            taken: Duration::ZERO,
            time: 0.0,
        }
    }

    /// After a communication step, which took a time.
    pub fn add(&mut self, simulation: &Simulation, taken: Duration) {
        let (events, left_out) = simulation.events();
        self.openings += events.filter(|event| !event.closes).count() as u64;
        self.left_out += left_out;
        let force = simulation.real(RealOutput::ContactForce);
        let (mut least, mut greatest) = (force, force);
        if self.scene.effects.extremes {
            least = simulation.real(RealOutput::StepMinimumForce);
            greatest = simulation.real(RealOutput::StepMaximumForce);
        }
        self.force = (self.force.0.min(least), self.force.1.max(greatest));
        let resistances = [RealOutput::ContactResistance, RealOutput::StepMaximumResistance];
        self.worst_resistance = resistances.iter().fold(self.worst_resistance, |worst, output| {
            worst.max(simulation.real(*output))
        });
        self.taken += taken;
    }

    /// At the end of the run.
    pub fn end(&mut self, simulation: &Simulation) {
        self.time = simulation.time();
        self.reals = RealOutput::ALL
            .iter()
            .map(|output| (*output, simulation.real(*output)))
            .collect();
        let integers = IntegerOutput::ALL.iter();
        self.integers = integers.map(|output| (*output, simulation.integer(*output))).collect();
    }

    fn real(&self, output: RealOutput) -> f64 {
        let found = self.reals.iter().find(|(known, _)| *known == output);
        found.map_or(f64::NAN, |(_, value)| *value)
    }

    fn integer(&self, output: IntegerOutput) -> i32 {
        let found = self.integers.iter().find(|(known, _)| *known == output);
        found.map_or(0, |(_, value)| *value)
    }

    fn opened(&self) -> String {
        let instant = |output| match self.real(output) {
            time if time < 0.0 => "none".to_owned(),
            time => seconds(time),
        };
        let times = match (self.openings, self.left_out) {
            (0, 0) => return "opened: never".to_owned(),
            (1, 0) => "once".to_owned(),
            (openings, 0) => format!("{openings} times"),
            (openings, _) => format!("more than {openings} times"),
        };
        format!(
            "opened: {times}; last opening {}, last closing {}",
            instant(RealOutput::ContactLastOpening),
            instant(RealOutput::ContactLastClosing),
        )
    }

    fn interruptions(&self) -> String {
        if !self.scene.effects.chatter {
            return "interruptions: not counted (effects.chatter)".to_owned();
        }
        let chatter = &self.scene.chatter;
        format!(
            "interruptions (above {} Ohm for at least {}): {}, longest {}, in all {}",
            chatter.resistance_threshold,
            seconds(chatter.minimum_duration),
            self.integer(IntegerOutput::ChatterCount),
            seconds(self.real(RealOutput::ChatterLongestInterruption)),
            seconds(self.real(RealOutput::ChatterTotalInterruption)),
        )
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        let effects = &self.scene.effects;
        let seen = if effects.extremes {
            ""
        } else {
            " at the communication points"
        };
        writeln!(formatter, "{}", self.opened())?;
        writeln!(formatter, "{}", self.interruptions())?;
        writeln!(
            formatter,
            "contact force{seen}: {:.6} to {:.6} N",
            self.force.0, self.force.1
        )?;
        if effects.resistance != ResistanceKind::None {
            writeln!(
                formatter,
                "worst resistance{seen}: {} Ohm",
                significant(self.worst_resistance)
            )?;
        }
        if effects.energy {
            writeln!(
                formatter,
                "energy balance: {:.3e} J",
                self.real(RealOutput::EnergyBalance)
            )?;
        } else {
            writeln!(formatter, "energy balance: not drawn up (effects.energy)")?;
        }
        writeln!(
            formatter,
            "solver: {} steps, {} rejected, {} iterations, {} modes",
            self.integer(IntegerOutput::SolverSteps),
            self.integer(IntegerOutput::SolverRejectedSteps),
            self.integer(IntegerOutput::SolverIterations),
            self.integer(IntegerOutput::SolverModesUsed),
        )?;
        let taken = self.taken.as_secs_f64();
        write!(formatter, "time taken: {} for {}", seconds(taken), seconds(self.time))
    }
}
