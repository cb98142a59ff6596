//! Ratios of instructions: linear contacts beside the Hertz contact on the same grid, random excitation beside a sine.

use anyhow::Result;

use super::cost::RunScene;

/// Prints them.
pub fn print() -> Result<()> {
    let run_scene = RunScene::build()?;
    for step in ["1e-6", "1e-5", "1e-4", "1e-3"] {
        let count = |changes: &[(&str, &str)]| {
            let always = [("communicationStep", step), ("effects.contactDamping", "true")];
            let changes = always.iter().chain(changes);
            let changes: Vec<_> = changes.map(|(name, value)| ((*name).into(), (*value).into())).collect();
            run_scene.instructions(&changes)
        };
        let hertz = count(&[])?;
        let linearised = count(&[("effects.contactLaw", "Linearised")])? / hertz;
        let bonded = count(&[("effects.contactLaw", "Bonded")])? / hertz;
        let random = count(&[
            ("effects.excitation", "Random"),
            ("excitation.frequency", "20"),
            ("excitation.endFrequency", "2000"),
            ("excitation.spectralDensity", "1"),
        ])? / hertz;
        println!(
            "step {step} s, over the Hertz contact under a sine: linearised {linearised:.2}, bonded {bonded:.2}, random \
             excitation {random:.2}"
        );
    }
    Ok(())
}
