//! A scene over time.

use relay_contact::many::RunError;
use relay_contact::scene::file::SceneFile;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{IntegerOutput, RealOutput};

/// What the page shows at a communication point; the extremes are those since the point before.
const COLUMNS: [RealOutput; 5] = [
    RealOutput::ContactForce,
    RealOutput::StepMinimumForce,
    RealOutput::StepMaximumForce,
    RealOutput::ContactResistance,
    RealOutput::StepMaximumResistance,
];

/// What the page shows of the whole run.
const SUMMARY: [RealOutput; 5] = [
    RealOutput::PreloadForce,
    RealOutput::PreloadFrequency,
    RealOutput::ChatterLongestInterruption,
    RealOutput::ChatterTotalInterruption,
    RealOutput::SolverForceError,
];

/// A run.
pub struct Curves {
    /// Time (s), then the outputs of each column, at each communication point.
    rows: Vec<[f64; 1 + COLUMNS.len()]>,
    /// Instants of openings (1) and closings (0), s.
    events: Vec<(f64, f64)>,
    summary: [f64; SUMMARY.len()],
    interruptions: i32,
}

impl Curves {
    /// Interruptions, rows, events, the summary, all rows, all events.
    pub fn numbers(&self) -> Vec<f64> {
        let counts = [
            f64::from(self.interruptions),
            self.rows.len() as f64,
            self.events.len() as f64,
        ];
        let events = self.events.iter().flat_map(|(time, opens)| [*time, *opens]);
        let head = counts.into_iter().chain(self.summary);
        head.chain(self.rows.iter().flatten().copied()).chain(events).collect()
    }

    fn record(&mut self, contact: &Simulation) {
        let mut row = [contact.time(); 1 + COLUMNS.len()];
        for (value, output) in row.iter_mut().skip(1).zip(COLUMNS) {
            *value = contact.real(output);
        }
        self.rows.push(row);
        let events = contact.events().0.filter(|event| event.link == 0);
        self.events
            .extend(events.map(|event| (event.time, f64::from(u8::from(!event.closes)))));
    }
}

/// Runs a scene file, given as text.
pub fn curves(text: &str) -> Result<Curves, RunError> {
    let file: SceneFile = text.parse()?;
    let start = file.inputs_over(0.0, file.communication_step)?;
    let mut contact = Simulation::new(&file.scene, &start, 0.0)?;
    let mut curves = Curves {
        rows: Vec::new(),
        events: Vec::new(),
        summary: [0.0; SUMMARY.len()],
        interruptions: 0,
    };
    curves.record(&contact);
    for (time, size) in file.steps() {
        contact.step(&file.inputs_over(time, size)?, time, size)?;
        curves.record(&contact);
    }
    curves.summary = SUMMARY.map(|output| contact.real(output));
    curves.interruptions = contact.integer(IntegerOutput::ChatterCount);
    Ok(curves)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "stop = 0.004\ncommunicationStep = 1e-5\noutputs = [\"contact.force\"]\n[parameters]\n\
                         effects.excitation = \"Sine\"\nexcitation.frequency = 1000\nexcitation.amplitude = 400\n";

    #[test]
    fn the_numbers_are_laid_out_as_the_page_reads_them() -> Result<(), RunError> {
        let curves = curves(SCENE)?;
        let numbers = curves.numbers();
        let [count, rows, events] = [numbers[0], numbers[1], numbers[2]];
        // It is open at the end.
        assert_eq!((rows, count, events), (401.0, 4.0, 7.0));
        let after = 8 + 6 * curves.rows.len();
        assert_eq!(numbers.len(), after + 2 * curves.events.len());
        assert_eq!(numbers[after - 6], 0.004);
        // Open for as long as the interruptions say, but for the time with little force before and after.
        let closings = curves.events.iter().skip(1).step_by(2).chain([&(0.004, 0.0)]);
        let openings = curves.events.iter().step_by(2);
        let open: f64 = openings
            .zip(closings)
            .map(|(opening, closing)| closing.0 - opening.0)
            .sum();
        assert!(curves.events.iter().step_by(2).all(|event| event.1 == 1.0));
        assert!(
            open > 0.0 && open <= numbers[6] && numbers[6] < 1.1 * open,
            "{open} {}",
            numbers[6]
        );
        Ok(())
    }

    #[test]
    fn a_value_out_of_range_is_refused_by_its_name() {
        let failure = curves(&SCENE.replace("400", "-1e99"))
            .map(|_| ())
            .map_err(|failure| failure.to_string());
        assert!(
            failure
                .as_ref()
                .is_err_and(|text| text.contains("excitation.amplitude")),
            "{failure:?}"
        );
    }
}
