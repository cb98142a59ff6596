//! A scene over time.

use relay_contact::many::RunError;
use relay_contact::scene::file::SceneFile;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{IntegerOutput, RealOutput};

/// What the page shows at a communication point; the extremes are those since the point before.
const COLUMNS: [RealOutput; 4] = [
    RealOutput::ContactForce,
    RealOutput::StepMinimumForce,
    RealOutput::StepMaximumForce,
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

/// Runs a scene file, given as text. Gives the number of interruptions, of communication points and of events, then the
/// summary, then for each communication point its time (s) and columns, and for each event its instant (s) and 1 for an opening,
/// 0 for a closing.
pub fn curves(text: &str) -> Result<Vec<f64>, RunError> {
    let file: SceneFile = text.parse()?;
    let start = file.first_inputs()?;
    let mut contact = Simulation::new(&file.scene, &start, 0.0)?;
    let (mut rows, mut events) = (Vec::new(), Vec::new());
    let mut record = |contact: &Simulation| {
        rows.push([contact.time()].into_iter().chain(COLUMNS.map(|output| contact.real(output))));
        let own = contact.events().0.filter(|event| event.link == 0);
        events.extend(own.map(|event| [event.time, f64::from(u8::from(!event.closes))]));
    };
    record(&contact);
    for (time, size) in file.steps() {
        contact.step(&file.inputs_over(time, size)?, time, size)?;
        record(&contact);
    }
    let interruptions = f64::from(contact.integer(IntegerOutput::ChatterCount));
    let mut numbers = vec![interruptions, rows.len() as f64, events.len() as f64];
    numbers.extend(SUMMARY.map(|output| contact.real(output)));
    numbers.extend(rows.into_iter().flatten());
    numbers.extend(events.into_iter().flatten());
    Ok(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "stop = 0.004\ncommunicationStep = 1e-5\noutputs = [\"contact.force\"]\n[parameters]\n\
                         effects.excitation = \"Sine\"\nexcitation.frequency = 1000\nexcitation.amplitude = 400\n";

    #[test]
    fn the_numbers_are_laid_out_as_the_page_reads_them() -> Result<(), RunError> {
        let numbers = curves(SCENE)?;
        let [count, rows, events] = [numbers[0], numbers[1], numbers[2]];
        // It is open at the end.
        assert_eq!((rows, count, events), (401.0, 4.0, 7.0));
        let after = 8 + 5 * 401;
        assert_eq!(numbers.len(), after + 2 * 7);
        assert_eq!(numbers[after - 5], 0.004);
        // Open for as long as the interruptions say, but for the time with little force before and after.
        let mut open = 0.004;
        for (event, opens) in numbers[after..].chunks(2).zip([1.0, 0.0].into_iter().cycle()) {
            assert_eq!(event[1], opens);
            open += (1.0 - 2.0 * opens) * event[0];
        }
        assert!(open > 0.0 && open <= numbers[6] && numbers[6] < 1.1 * open, "{open} {}", numbers[6]);
        Ok(())
    }

    #[test]
    fn a_value_out_of_range_is_refused_by_its_name() {
        let failure = curves(&SCENE.replace("400", "-1e99")).map_err(|failure| failure.to_string());
        assert!(failure.is_err_and(|text| text.contains("excitation.amplitude")));
    }
}
