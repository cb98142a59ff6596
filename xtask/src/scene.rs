//! Runs a scene file in Rust.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use indicatif::{ProgressBar, ProgressStyle};
use relay_contact::scene_file::SceneFile;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{Group, IntegerOutput, RealOutput};

use crate::commands::root;

/// Which scene, and what to change in it.
#[derive(clap::Args)]
pub struct Arguments {
    /// Name of a file in scenes/, or path of a scene file
    #[arg(value_name = "NAME|FILE")]
    scene: String,
    /// Change a parameter, an input, stop or communicationStep: beam.length=0.02, effects.excitation=Sine
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    changes: Vec<(String, String)>,
}

fn assignment(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("wanted is NAME=VALUE")?;
    Ok((name.trim().to_owned(), value.trim().to_owned()))
}

/// Runs the scene, writes `out/scenes/<name>.csv` and prints a summary.
pub fn run(arguments: &Arguments) -> Result<()> {
    let path = find(&arguments.scene)?;
    let text = fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let mut file: SceneFile = text.parse().with_context(|| path.display().to_string())?;
    for (name, value) in &arguments.changes {
        file.set(name, value)?;
    }
    let name = path.file_stem().context("a scene file needs a name")?;
    let folder = root().join("out/scenes");
    fs::create_dir_all(&folder)?;
    let table = folder.join(name).with_extension("csv");
    println!("{}", file.title);
    let summary = simulate(&file, &table)?;
    println!("{summary}\n{}", table.display());
    Ok(())
}

fn find(scene: &str) -> Result<PathBuf> {
    let file = Path::new(scene);
    if file.is_file() {
        return Ok(file.to_owned());
    }
    let folder = root().join("scenes");
    let named = folder.join(format!("{scene}.toml"));
    if named.is_file() {
        return Ok(named);
    }
    let files = fs::read_dir(&folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut names: Vec<_> = files
        .filter_map(|entry| Some(entry.ok()?.path().file_stem()?.to_string_lossy().into_owned()))
        .collect();
    names.sort();
    bail!(
        "{scene}: no such scene and no such file; scenes are {}",
        names.join(", ")
    );
}

/// Runs the scene from 0 to its stop and tells what happened.
fn simulate(file: &SceneFile, table: &Path) -> Result<String> {
    let mut simulation = Simulation::new(&file.scene, &file.inputs, 0.0)?;
    let mut rows = BufWriter::new(File::create(table).with_context(|| format!("cannot write {}", table.display()))?);
    write!(rows, "time")?;
    for output in &file.outputs {
        write!(rows, ",{}", output.name)?;
    }
    writeln!(rows)?;
    write_row(&mut rows, file, &simulation, 0.0)?;

    let (mut least, mut most) = (
        simulation.real(RealOutput::ContactForce),
        simulation.real(RealOutput::ContactForce),
    );
    let progress = ProgressBar::new(1000).with_style(ProgressStyle::with_template("{bar:40} {percent}% {eta} left")?);
    let mut time = 0.0;
    let mut step = 0.0;
    // A remainder of rounding alone is no step.
    while file.stop - time > 1e-9 * file.communication_step {
        step += 1.0;
        let next = (step * file.communication_step).min(file.stop);
        simulation.step(&file.inputs, time, next - time)?;
        time = next;
        write_row(&mut rows, file, &simulation, time)?;
        let force = simulation.real(RealOutput::ContactForce);
        (least, most) = (force.min(least), force.max(most));
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // between 0 and 1000
        progress.set_position((1000.0 * time / file.stop) as u64);
    }
    progress.finish_and_clear();
    rows.flush()?;

    let instant = |output| match simulation.real(output) {
        time if time < 0.0 => "none".to_owned(),
        time => format!("{:.3} us", 1e6 * time),
    };
    Ok(format!(
        "contact force at the communication points: {least:.6} to {most:.6} N\n\
         last opening: {}, last closing: {}\n\
         integration steps: {}, rejected: {}",
        instant(RealOutput::ContactLastOpening),
        instant(RealOutput::ContactLastClosing),
        simulation.integer(IntegerOutput::SolverSteps),
        simulation.integer(IntegerOutput::SolverRejectedSteps),
    ))
}

fn write_row(rows: &mut impl Write, file: &SceneFile, simulation: &Simulation, time: f64) -> Result<()> {
    write!(rows, "{time}")?;
    for output in &file.outputs {
        match output.group {
            Group::RealOutput(output) => write!(rows, ",{}", simulation.real(output))?,
            Group::IntegerOutput(output) => write!(rows, ",{}", simulation.integer(output))?,
            Group::BooleanOutput(output) => write!(rows, ",{}", simulation.boolean(output))?,
            _ => bail!("{}: not an output", output.name),
        }
    }
    writeln!(rows)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_writes_a_row_for_every_communication_point() -> Result<()> {
        let text = "stop = 0.0025\ncommunicationStep = 1e-3\noutputs = [\"contact.force\", \"contact.closed\"]";
        let table = std::env::temp_dir().join(format!("relay-contact-scene-{}.csv", std::process::id()));
        simulate(&text.parse()?, &table)?;
        let written = fs::read_to_string(&table)?;
        fs::remove_file(&table)?;
        let rows: Vec<_> = written.lines().map(|row| row.split(',').collect::<Vec<_>>()).collect();
        let times: Vec<_> = rows.iter().filter_map(|row| row.first().copied()).collect();
        assert_eq!(times, ["time", "0", "0.001", "0.002", "0.0025"]);
        assert_eq!(rows.first(), Some(&vec!["time", "contact.force", "contact.closed"]));
        assert!(rows.iter().all(|row| row.len() == 3));
        Ok(())
    }

    #[test]
    fn an_unknown_scene_is_told_with_those_there_are() {
        let message = find("paper-2khz").map_or_else(|error| error.to_string(), |_| String::new());
        assert!(
            message.contains("paper-2khz") && message.contains("at-rest, paper-1khz"),
            "{message}"
        );
    }
}
