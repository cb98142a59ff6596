//! The contact inside a Rust program's own loop, without FMI: the program has the vibration and the circuit, the library the contact.
//!
//!     cargo run --release --example embed                       # 400 m/s2 over 20 ms, to out/embed.csv
//!     cargo run --release --example embed -- 300 0.1 burst.csv
//!     .venv/bin/python -m relay_contact plot out/embed.csv
//!
//! Vibration: two machines of 900 and 1000 Hz beat, `a(t) = A sin(2 pi 950 t) sin(2 pi 50 t)`. Circuit: 6 V, a load of
//! 60 Ohm and 1 mH, the contact, and across it a quench of 47 Ohm and 220 nF, without which the coil would drive an arc.
//! The library models no arcs: the summary says whether the contact stayed below 12 V and 0.4 A.
//!
//! Steps are 2 us long. One in which the contact opens or closes is taken back and done again in tenths, as the circuit
//! sees the conductance at the ends of steps only. `embed.c` does the same in C and prints the same numbers.
//!
//! In another project: `relay-contact = { path = "..." }`, `indicatif` and `thiserror` under `[dependencies]`.

use std::env;
use std::f64::consts::TAU;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use indicatif::{ProgressBar, ProgressStyle};
use relay_contact::error::{SceneError, StepError};
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{IntegerOutput, RealInput, RealOutput};

const USAGE: &str = "A relay contact, shaken and under current, in a loop of one's own.
usage: embed [ACCELERATION [DURATION [FILE]]]
  ACCELERATION  greatest base acceleration, m/s2 (400)
  DURATION      simulated time, 2e-6 to 10 s (0.02, done in some 0.1 s)
  FILE          table to write, CSV in SI units (out/embed.csv)";

/// Communication step, s.
const STEP: f64 = 2e-6;

/// What ends the program early, by what is left then.
#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error("{0}\n{USAGE}")]
    Usage(String),
    #[error("a value the contact does not take: {0}")]
    Refused(#[from] SceneError),
    #[error("{0}; the contact still stands where that step began")]
    Stopped(#[from] StepError),
    #[error("{0}: cannot be written: {1}")]
    Table(String, io::Error),
}

/// Source, V.
const SOURCE: f64 = 6.0;
/// Load, Ohm.
const LOAD: f64 = 60.0;
/// Of the load, H.
const INDUCTANCE: f64 = 1e-3;
/// Conductance of the quench, S.
const QUENCH: f64 = 1.0 / 47.0;
/// Of the quench, F.
const CAPACITANCE: f64 = 220e-9;

/// The circuit at one instant.
#[derive(Clone, Copy)]
struct Circuit {
    /// Through the load, A.
    current: f64,
    /// Of the capacitor, V.
    capacitor: f64,
    /// Of the contact, S.
    conductance: f64,
    /// Greatest voltage across the contact and current through it so far, V and A.
    greatest: (f64, f64),
}

impl Circuit {
    /// At rest.
    fn new(conductance: f64) -> Self {
        let current = SOURCE / (LOAD + 1.0 / conductance);
        Self {
            current,
            capacitor: current / conductance,
            conductance,
            greatest: (0.0, 0.0),
        }
    }

    /// Across the contact, V: the load's current goes through contact and quench.
    fn voltage(&self) -> f64 {
        (self.current + QUENCH * self.capacitor) / (self.conductance + QUENCH)
    }

    /// Advances by `size` seconds, to the end of which the contact has another conductance, by the trapezoidal rule.
    fn advance(&mut self, conductance: f64, size: f64) {
        let (half, voltage) = (0.5 * size, self.voltage());
        // What is known: the start, half the step with its slopes, and the source over the other half.
        let i = self.current + half * (2.0 * SOURCE - LOAD * self.current - voltage) / INDUCTANCE;
        let u = self.capacitor + half * QUENCH * (voltage - self.capacitor) / CAPACITANCE;
        // Two linear equations for the end, where voltage = share * (current + QUENCH * capacitor).
        let share = 1.0 / (conductance + QUENCH);
        let (a, b) = (
            1.0 + half * (LOAD + share) / INDUCTANCE,
            half * share * QUENCH / INDUCTANCE,
        );
        let d = 1.0 + half * QUENCH * (1.0 - share * QUENCH) / CAPACITANCE;
        let c = -half * share * QUENCH / CAPACITANCE;
        let determinant = a * d - b * c;
        self.current = (d * i - b * u) / determinant;
        self.capacitor = (a * u - c * i) / determinant;
        self.conductance = conductance;
        let voltage = self.voltage();
        self.greatest = (self.greatest.0.max(voltage), self.greatest.1.max(conductance * voltage));
    }
}

/// Base acceleration, m/s2.
fn vibration(amplitude: f64, time: f64) -> f64 {
    amplitude * (TAU * 950.0 * time).sin() * (TAU * 50.0 * time).sin()
}

/// A step of contact and circuit. The acceleration changes linearly over it.
fn advance(
    contact: &mut Simulation,
    circuit: &mut Circuit,
    amplitude: f64,
    time: f64,
    size: f64,
) -> Result<(), Failure> {
    let (now, then) = (vibration(amplitude, time), vibration(amplitude, time + size));
    let mut inputs = Inputs::default();
    inputs.set_real(RealInput::BaseAcceleration, now)?;
    inputs.set_rate(RealInput::BaseAcceleration, (then - now) / size)?;
    contact.step(&inputs, time, size)?;
    circuit.advance(contact.real(RealOutput::ContactConductance), size);
    Ok(())
}

/// Instants of the last opening and closing, s.
fn switches(contact: &Simulation) -> [f64; 2] {
    [RealOutput::ContactLastOpening, RealOutput::ContactLastClosing].map(|output| contact.real(output))
}

fn run(amplitude: f64, count: u32) -> Result<Vec<[f64; 6]>, Failure> {
    // The start values are those of the published specimen. `Simulation::new` checks all fields.
    let mut scene = Scene::default();
    scene.contact.overtravel = 0.19e-3;
    scene.chatter.minimum_duration = 5e-6;
    scene.effects.extremes = false; // not read here
    let mut contact = Simulation::new(&scene, &Inputs::default(), 0.0)?;
    let mut circuit = Circuit::new(contact.real(RealOutput::ContactConductance));

    let style = ProgressStyle::with_template("{bar:40} {percent}% {eta} left").unwrap_or(ProgressStyle::default_bar());
    let progress = ProgressBar::new(u64::from(count)).with_style(style);
    let mut rows = Vec::with_capacity(count as usize);
    let mut repeated = 0;
    let begun = Instant::now();
    for n in progress.wrap_iter(0..count) {
        let time = f64::from(n) * STEP;
        // A copy of all that moves, without allocation. It can be kept as long as wanted, and serialised by serde.
        let saved = (*contact.motion(), circuit);
        let before = switches(&contact);
        advance(&mut contact, &mut circuit, amplitude, time, STEP)?;
        if switches(&contact) != before {
            contact.go_on_from(&saved.0);
            circuit = saved.1;
            let part = 0.1 * STEP;
            for k in 0..10 {
                advance(&mut contact, &mut circuit, amplitude, time + f64::from(k) * part, part)?;
            }
            repeated += 1;
        }
        let [force, resistance] =
            [RealOutput::ContactForce, RealOutput::ContactResistance].map(|output| contact.real(output));
        let time = f64::from(n + 1) * STEP;
        rows.push([
            time,
            vibration(amplitude, time),
            force,
            resistance,
            circuit.voltage(),
            circuit.current,
        ]);
    }
    let nanoseconds = 1e9 * begun.elapsed().as_secs_f64() / f64::from(count);
    progress.finish_and_clear();

    let interruptions = contact.integer(IntegerOutput::ChatterCount);
    println!("interruptions of 5 us or more: {interruptions}");
    let longest = contact.real(RealOutput::ChatterLongestInterruption);
    println!("longest interruption: {:.3} us", 1e6 * longest);
    println!("steps done again: {repeated}");
    let (voltage, current) = circuit.greatest;
    println!("greatest voltage and current of the contact: {voltage:.3} V, {current:.4} A");
    if voltage >= 12.0 || current >= 0.4 {
        println!("beyond 12 V and 0.4 A the contact would arc: the results do not hold");
    }
    println!("{nanoseconds:.0} ns per step");
    Ok(rows)
}

fn write(path: &Path, rows: &[[f64; 6]]) -> io::Result<()> {
    fs::create_dir_all(path.parent().unwrap_or(Path::new("")))?;
    let mut file = BufWriter::new(File::create(path)?);
    writeln!(
        file,
        "time,base.acceleration,contact.force,contact.resistance,contact.voltage,load.current [A]"
    )?;
    for row in rows {
        writeln!(file, "{}", row.map(|value| value.to_string()).join(","))?;
    }
    file.flush()
}

fn job() -> Result<(), Failure> {
    let arguments: Vec<_> = env::args().skip(1).collect();
    if arguments.iter().any(|text| text == "--help") {
        println!("{USAGE}");
        return Ok(());
    }
    let number = |at: usize, name, default| {
        let wrong = |text| Failure::Usage(format!("{name} = {text}: expected a number"));
        arguments
            .get(at)
            .map_or(Ok(default), |text| text.parse().map_err(|_| wrong(text)))
    };
    let (amplitude, duration) = (number(0, "ACCELERATION", 400.0)?, number(1, "DURATION", 0.02)?);
    if !(STEP..=10.0).contains(&duration) {
        let wrong = format!("DURATION = {duration} s: allowed is 2e-6 to 10 s");
        return Err(Failure::Usage(wrong));
    }
    if arguments.len() > 3 {
        let wrong = format!("{} arguments: allowed are three", arguments.len());
        return Err(Failure::Usage(wrong));
    }
    let path = arguments.get(2).map_or("out/embed.csv", String::as_str);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 5 million")]
    let rows = run(amplitude, (duration / STEP).round() as u32)?;
    write(Path::new(path), &rows).map_err(|error| Failure::Table(path.to_owned(), error))?;
    println!("{path}");
    Ok(())
}

fn main() -> ExitCode {
    let Err(failure) = job() else {
        return ExitCode::SUCCESS;
    };
    eprintln!("{failure}");
    // The kinds can be matched, with what they hold: `Refused(SceneError::OutOfRange { name, allowed, .. })`.
    ExitCode::from(match failure {
        Failure::Usage(_) => 2,
        Failure::Refused(_) | Failure::Stopped(_) | Failure::Table(..) => 1,
    })
}
