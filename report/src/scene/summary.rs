//! Summary of a run in a few lines.

use std::time::Duration;

use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{IntegerOutput, RealOutput, ResistanceKind};

use crate::numbers::{seconds, significant};

/// Collected step by step.
pub struct Summary {
    scene: Scene,
    openings: u64,
    /// Openings and closings of a step beyond those that the simulation records.
    left_out: u64,
    /// Least and greatest contact force, N.
    force: (f64, f64),
    /// Ohm.
    worst_resistance: f64,
    /// Spent on the steps.
    taken: Duration,
}

impl Summary {
    /// At the start of a run.
    pub fn new(scene: &Scene, simulation: &Simulation) -> Self {
        let force = simulation.real(RealOutput::ContactForce);
        Self {
            scene: scene.clone(),
            openings: 0,
            left_out: 0,
            force: (force, force),
            worst_resistance: simulation.real(RealOutput::ContactResistance),
            taken: Duration::ZERO,
        }
    }

    /// After a communication step, which took a time.
    pub fn add(&mut self, simulation: &Simulation, taken: Duration) {
        let (events, left_out) = simulation.events();
        self.openings += events.filter(|event| !(event.closes || event.second)).count() as u64;
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

    fn opened(&self, simulation: &Simulation) -> String {
        let instant = |output| match simulation.real(output) {
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

    fn interruptions(&self, simulation: &Simulation) -> String {
        if !self.scene.effects.chatter {
            return "interruptions: not counted (effects.chatter)".to_owned();
        }
        let chatter = &self.scene.chatter;
        format!(
            "interruptions (above {} Ohm for at least {}): {}, longest {}, in all {}",
            chatter.resistance_threshold,
            seconds(chatter.minimum_duration),
            simulation.integer(IntegerOutput::ChatterCount),
            seconds(simulation.real(RealOutput::ChatterLongestInterruption)),
            seconds(simulation.real(RealOutput::ChatterTotalInterruption)),
        )
    }

    /// At the end of the run.
    pub fn text(&self, simulation: &Simulation) -> String {
        let effects = &self.scene.effects;
        let seen = if effects.extremes {
            ""
        } else {
            " at the communication points"
        };
        let (least, greatest) = self.force;
        let mut lines = vec![
            self.opened(simulation),
            self.interruptions(simulation),
            format!("contact force{seen}: {least:.6} to {greatest:.6} N"),
        ];
        if effects.resistance != ResistanceKind::None {
            lines.push(format!(
                "worst resistance{seen}: {} Ohm",
                significant(self.worst_resistance)
            ));
        }
        lines.push(if effects.energy {
            format!("energy balance: {:.3e} J", simulation.real(RealOutput::EnergyBalance))
        } else {
            "energy balance: not computed (effects.energy)".to_owned()
        });
        let [steps, rejected, iterations, modes] = [
            IntegerOutput::SolverSteps,
            IntegerOutput::SolverRejectedSteps,
            IntegerOutput::SolverIterations,
            IntegerOutput::SolverModesUsed,
        ]
        .map(|output| simulation.integer(output));
        lines.push(format!(
            "solver: {steps} steps, {rejected} rejected, {iterations} iterations, {modes} modes"
        ));
        let taken = seconds(self.taken.as_secs_f64());
        lines.push(format!("time taken: {taken} for {}", seconds(simulation.time())));
        lines.join("\n")
    }
}
