//! The contact force over the frequency of the base vibration, and the vibration at which the contact opens: linear
//! response, nonlinear stepped sweep up and down, opening threshold.
//!
//! `cargo run --example frequency_response` writes `out/frequency-response.csv`, and draws it as
//! `out/frequency-response.png` with the Python environment that `cargo xtask demo` makes.

use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use indicatif::{ProgressBar, ProgressStyle};
use relay_contact::inputs::Inputs;
use relay_contact::reference::{self, Model, State};
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ExcitationKind, RealOutput};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Base accelerations of the response curves, m/s2: 10 g, close to the lowest threshold, and beyond it.
const ACCELERATIONS: [f64; 3] = [98.0, 250.0, 400.0];
/// Of the curves, Hz.
const LOWEST: f64 = 50.0;
/// See [`LOWEST`].
const HIGHEST: f64 = 3000.0;
/// From point to point of the stepped sweep, Hz.
const STEP: f64 = 25.0;
/// Frequencies at which the nonlinear threshold is sought, Hz.
const THRESHOLDS: u32 = 20;

/// A motion counts as periodic when the extremes of the force change by less than this part of the preload from one
/// period to the next: far below what the picture shows.
const PERIODIC: f64 = 1e-6;
/// Periods after which it has to be.
const PATIENCE: u32 = 100;

/// The specimen shaken with a sine, from the instant `start` (s).
fn shaken(acceleration: f64, frequency: f64, start: f64) -> Scene {
    let mut scene = Scene::default();
    scene.effects.excitation = ExcitationKind::Sine;
    scene.excitation.amplitude = acceleration;
    scene.excitation.frequency = frequency;
    scene.excitation.start_time = start;
    scene
}

/// Extremes of the contact force over a period, and the motion at its end.
struct Period {
    least: f64,
    most: f64,
    /// Whether the contact opens in it.
    opens: bool,
    end: State,
}

impl Period {
    fn amplitude(&self) -> f64 {
        0.5 * (self.most - self.least)
    }
}

/// The periodic motion that the vibration leads to from another motion, or from rest. The sine starts with that motion:
/// the acceleration does not jump, as the other one has ended with a whole period.
fn settle(acceleration: f64, frequency: f64, from: Option<&State>) -> Result<Period> {
    let start = from.map_or(0.0, |state| state.time);
    let model = Model::new(&shaken(acceleration, frequency, start), 0.0)?;
    let preload = model.preload().force;
    let state = from.copied().unwrap_or(model.initial_state(0.0));
    let mut contact = Simulation::from_state(model, &state);
    let (mut least, mut most) = (f64::NAN, f64::NAN);
    for period in 0..PATIENCE {
        let last = (least, most);
        let (time, until) = (contact.time(), start + f64::from(period + 1) / frequency);
        contact.step(&Inputs::default(), time, until - time)?;
        (least, most) = (
            contact.real(RealOutput::StepMinimumForce),
            contact.real(RealOutput::StepMaximumForce),
        );
        let changed = (least - last.0).abs().max((most - last.1).abs());
        if changed < PERIODIC * preload {
            let end = contact.state_now()?;
            let opens = end.contact().last_opening > Some(end.time - 1.0 / frequency);
            return Ok(Period {
                least,
                most,
                opens,
                end,
            });
        }
    }
    Err(format!("{acceleration} m/s2 at {frequency} Hz: not periodic after {PATIENCE} periods").into())
}

/// Least acceleration whose periodic motion opens the contact, within 1e-4 of it, m/s2. The acceleration is approached from
/// below, each motion beginning with the one before.
fn threshold(frequency: f64, linear: f64) -> Result<f64> {
    let (mut low, mut high) = (0.0, f64::INFINITY);
    let mut trial = 0.5 * linear;
    let mut closed = None;
    while high - low > 1e-4 * low || low == 0.0 {
        let period = settle(trial, frequency, closed.as_ref())?;
        if period.opens {
            high = trial;
        } else {
            (low, closed) = (trial, Some(period.end));
        }
        trial = if high.is_finite() {
            f64::midpoint(low, high)
        } else {
            1.2 * low
        };
    }
    Ok(f64::midpoint(low, high))
}

/// Points from the lowest to the highest frequency at equal distances, Hz.
fn frequencies(count: u32) -> impl DoubleEndedIterator<Item = f64> {
    (0..=count).map(move |k| LOWEST + (HIGHEST - LOWEST) * f64::from(k) / f64::from(count))
}

/// The table: curve, acceleration (m/s2), frequency (Hz), amplitude of the force (N).
fn table() -> Result<String> {
    let mut rows = String::from("curve,acceleration,frequency,force_amplitude\n");
    let model = Model::new(&Scene::default(), 0.0)?;
    for frequency in frequencies(590) {
        let force = reference::response(&model, TAU * frequency).force.norm();
        for acceleration in ACCELERATIONS {
            writeln!(rows, "linear,{acceleration},{frequency},{}", acceleration * force)?;
        }
        let opening = reference::opening_threshold(&model, TAU * frequency);
        writeln!(rows, "linear threshold,{opening},{frequency},{}", model.preload().force)?;
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 59
    let points = ((HIGHEST - LOWEST) / STEP).round() as u32;
    let sweeps = 2 * (points + 1) * u32::try_from(ACCELERATIONS.len())?;
    let style = ProgressStyle::with_template("{msg:20} {bar:40} {percent}% {eta} left")?;
    let progress = ProgressBar::new(u64::from(sweeps + THRESHOLDS + 1)).with_style(style);
    progress.set_message("stepped sweeps");
    for acceleration in ACCELERATIONS {
        let mut from = None;
        let up = frequencies(points).map(|frequency| ("up", frequency));
        let down = frequencies(points).rev().map(|frequency| ("down", frequency));
        for (curve, frequency) in up.chain(down) {
            let period = settle(acceleration, frequency, from.as_ref())?;
            writeln!(rows, "{curve},{acceleration},{frequency},{}", period.amplitude())?;
            from = Some(period.end);
            progress.inc(1);
        }
    }
    progress.set_message("opening thresholds");
    for frequency in frequencies(THRESHOLDS) {
        let linear = reference::opening_threshold(&model, TAU * frequency);
        writeln!(rows, "threshold,{},{frequency},", threshold(frequency, linear)?)?;
        progress.inc(1);
    }
    progress.finish_and_clear();
    Ok(rows)
}

/// The interpreter of the Python environment, if there is one.
fn python(root: &Path) -> Option<PathBuf> {
    let interpreter = root.join(if cfg!(windows) {
        ".venv/Scripts/python.exe"
    } else {
        ".venv/bin/python"
    });
    interpreter.is_file().then_some(interpreter)
}

fn main() -> Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = root.join("out");
    fs::create_dir_all(&folder)?;
    let csv = folder.join("frequency-response.csv");
    fs::write(&csv, table()?)?;
    println!("{}", csv.display());
    let Some(python) = python(root) else {
        return Err("no picture: there is no .venv with matplotlib; `cargo xtask demo` makes it".into());
    };
    let script = root.join("examples/python/frequency_response.py");
    let status = Command::new(python).arg(script).arg(&folder).status()?;
    if !status.success() {
        return Err(format!("examples/python/frequency_response.py failed: {status}").into());
    }
    Ok(())
}
