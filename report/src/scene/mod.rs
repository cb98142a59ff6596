//! Runs scene files in Rust.

pub mod ssv;
mod summary;

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use commands::root;
use indicatif::{ProgressBar, ProgressStyle};
pub use relay_contact::scene::file::SceneFile;
use relay_contact::simulation::Simulation;
use relay_contact::variables::ExcitationKind;

use self::summary::Summary;

/// Which scene, and what to change in it.
#[derive(clap::Args)]
pub struct Arguments {
    /// Name of a file in scenes/, or path of a scene file
    #[arg(value_name = "NAME|FILE")]
    scene: String,
    /// Change a parameter, an input, stop, communicationStep or outputs: beam.length=0.02, effects.excitation=Sine
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    changes: Vec<(String, String)>,
}

fn assignment(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE")?;
    Ok((name.trim().to_owned(), value.trim().to_owned()))
}

/// Runs the scene, writes `out/scenes/<name>.csv` and `.png`, and prints a summary. Changes become part of the name.
pub fn run(arguments: &Arguments) -> Result<()> {
    let path = find(&arguments.scene)?;
    let mut file = SceneFile::read(&path)?;
    let name = path.file_stem().context("a scene file needs a name")?.to_string_lossy();
    let (mut names, mut titles) = (vec![name.into_owned()], vec![file.title.clone()]);
    for (variable, value) in &arguments.changes {
        file.set(variable, value)?;
        names.push(format!("{variable}={value}"));
        titles.push(format!("{variable} = {value}"));
    }
    let folder = root().join("out/scenes");
    fs::create_dir_all(&folder)?;
    let table = folder.join(format!("{}.csv", names.join(",")));
    let title = titles.join(", ");
    println!("{title}");
    let summary = simulate(&file, &table)?;
    println!("{summary}\n{}", table.display());
    let mut plot = commands::python();
    plot.args(["-m", "relay_contact", "plot", "--title", &title])
        .arg(&table);
    if file.scene.effects.excitation == ExcitationKind::LogSweep {
        let excitation = &file.scene.excitation;
        let sweep = [
            excitation.frequency,
            excitation.end_frequency,
            excitation.start_time,
            excitation.duration,
        ];
        plot.arg("--sweep").args(sweep.map(|value| value.to_string()));
    }
    commands::run(&mut plot)
}

/// Every file in `scenes/`, by name.
pub fn all() -> Result<Vec<(String, SceneFile)>> {
    let scenes = names()?.into_iter().map(|name| {
        let file = read(&name)?;
        Ok((name, file))
    });
    scenes.collect()
}

/// A file of `scenes/` by name, or one by its path.
pub fn read(scene: &str) -> Result<SceneFile> {
    Ok(SceneFile::read(&find(scene)?)?)
}

fn names() -> Result<Vec<String>> {
    let folder = root().join("scenes");
    let mut names = Vec::new();
    for entry in fs::read_dir(&folder).with_context(|| format!("cannot read {}", folder.display()))? {
        let path = entry?.path();
        if let (Some("toml"), Some(name)) = (path.extension().and_then(|text| text.to_str()), path.file_stem()) {
            names.push(name.to_string_lossy().into_owned());
        }
    }
    names.sort();
    Ok(names)
}

fn find(scene: &str) -> Result<PathBuf> {
    let file = Path::new(scene);
    if file.is_file() {
        return Ok(file.to_owned());
    }
    let named = root().join("scenes").join(format!("{scene}.toml"));
    if named.is_file() {
        return Ok(named);
    }
    bail!(
        "{scene}: no such scene and no such file; scenes are {}",
        names()?.join(", ")
    );
}

/// Runs the scene from 0 to its stop, writes its outputs at each communication point as a row of `table`, and summarises.
pub fn simulate(file: &SceneFile, table: &Path) -> Result<String> {
    let mut rows = BufWriter::new(File::create(table).with_context(|| format!("cannot write {}", table.display()))?);
    write!(rows, "time")?;
    for output in &file.outputs {
        write!(rows, ",{}", output.name)?;
    }
    writeln!(rows)?;
    let simulation = start(file)?;
    write_row(&mut rows, file, &simulation, 0.0)?;

    let mut summary = Summary::new(&file.scene, &simulation);
    let progress = ProgressBar::new(1000).with_style(ProgressStyle::with_template("{bar:40} {percent}% {eta} left")?);
    let simulation = each_step(file, |simulation, step| {
        summary.add(simulation, step.taken);
        write_row(&mut rows, file, simulation, step.end)?;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 0 and 1000"
        )]
        progress.set_position((1000.0 * step.end / file.stop) as u64);
        Ok(())
    })?;
    progress.finish_and_clear();
    rows.flush()?;
    Ok(summary.text(&simulation))
}

/// A communication step that was made.
pub struct Step {
    /// s.
    pub end: f64,
    /// Computing time.
    pub taken: Duration,
}

/// Runs the scene from 0 to its stop and calls `after` each communication step; returns the simulation at its end.
pub fn each_step(file: &SceneFile, mut after: impl FnMut(&Simulation, &Step) -> Result<()>) -> Result<Simulation> {
    let mut simulation = start(file)?;
    for (time, size) in file.steps() {
        let inputs = file.inputs_over(time, size)?;
        let begun = Instant::now();
        simulation.step(&inputs, time, size)?;
        let taken = begun.elapsed();
        let end = time + size;
        after(&simulation, &Step { end, taken })?;
    }
    Ok(simulation)
}

/// The scene in its preload.
fn start(file: &SceneFile) -> Result<Simulation> {
    let inputs = file.inputs_over(0.0, file.communication_step)?;
    Ok(Simulation::new(&file.scene, &inputs, 0.0)?)
}

fn write_row(rows: &mut impl Write, file: &SceneFile, simulation: &Simulation, time: f64) -> Result<()> {
    write!(rows, "{time}")?;
    for output in &file.outputs {
        let value = simulation.output(output);
        write!(
            rows,
            ",{}",
            value.with_context(|| format!("{}: not an output", output.name))?
        )?;
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
    fn the_summary_tells_how_often_the_contact_opened_and_when() -> Result<()> {
        let mut file = read("chatter-41g")?;
        file.set("stop", "0.0015")?;
        let table = std::env::temp_dir().join(format!("relay-contact-summary-{}.csv", std::process::id()));
        let summary = simulate(&file, &table)?;
        fs::remove_file(&table)?;
        // Found by two other methods, converged in modes and time: 708.827593 us and 1089.427605 us.
        let expected = "opened: once; last opening 708.828 us, last closing 1.0894 ms\n";
        assert!(summary.starts_with(expected), "{summary}");
        assert!(summary.contains("\nworst resistance: 1.000e9 Ohm\n"), "{summary}");
        assert!(summary.ends_with(" for 1.5000 ms"), "{summary}");
        Ok(())
    }

    #[test]
    fn an_unknown_scene_is_told_with_those_there_are() {
        let message = find("paper-2khz").map_or_else(|error| error.to_string(), |_| String::new());
        assert!(
            message.contains("paper-2khz") && message.contains("opening, paper-1khz, paper-elastic"),
            "{message}"
        );
    }

    #[test]
    fn every_scene_of_the_project_runs() -> Result<()> {
        let scenes = all()?;
        assert!(scenes.len() >= 10);
        let table = std::env::temp_dir().join(format!("relay-contact-scenes-{}.csv", std::process::id()));
        for (name, mut file) in scenes {
            file.stop = file.stop.min(100.0 * file.communication_step);
            simulate(&file, &table).with_context(|| name.clone())?;
            let written = fs::read_to_string(&table)?;
            fs::remove_file(&table)?;
            let rows: Vec<Vec<f64>> = written
                .lines()
                .skip(1)
                .map(|row| row.split(',').map(str::parse).collect::<Result<_, _>>())
                .collect::<Result<_, _>>()
                .with_context(|| name.clone())?;
            assert_eq!(rows.len(), 101, "{name}");
            assert!(rows.iter().flatten().all(|value| value.is_finite()), "{name}");
            assert!(rows.iter().all(|row| row.len() == 1 + file.outputs.len()), "{name}");
        }
        Ok(())
    }
}
