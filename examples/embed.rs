//! The contact inside a Rust program's own loop, without FMI: the program has the vibration, the library the contact.
//!
//!     cargo run --release --example embed                       # 400 m/s2 over 20 ms, to out/embed.csv
//!     cargo run --release --example embed -- 300 0.1 burst.csv  # m/s2, s, table
//!     .venv/bin/python -m relay_contact plot out/embed.csv
//!
//! Two machines of 900 and 1000 Hz beat, `a(t) = A sin(2 pi 950 t) sin(2 pi 50 t)`. Steps are 2 us long. One in which the
//! contact opens or closes is taken back and done again in tenths, as a program has to that couples it to something else at
//! the ends of steps. `embed.c` does the same in C and prints the same numbers.
//!
//! In another project: `relay-contact = { path = "..." }` under `[dependencies]`.

use std::env;
use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process;

use relay_contact::error::StepError;
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{IntegerOutput, RealInput, RealOutput};

/// Communication step, s.
const STEP: f64 = 2e-6;

/// Base acceleration, m/s2.
fn vibration(amplitude: f64, time: f64) -> f64 {
    amplitude * (TAU * 950.0 * time).sin() * (TAU * 50.0 * time).sin()
}

/// A step, over which the acceleration changes linearly.
fn advance(contact: &mut Simulation, amplitude: f64, time: f64, size: f64) -> Result<(), Box<dyn Error>> {
    let (now, then) = (vibration(amplitude, time), vibration(amplitude, time + size));
    let mut inputs = Inputs::default();
    // Refused with the variable's name and its range where it is not allowed.
    inputs.set_real(RealInput::BaseAcceleration, now)?;
    inputs.set_rate(RealInput::BaseAcceleration, (then - now) / size)?;
    // After an error the contact stands where the step began.
    contact.step(&inputs, time, size).map_err(|error: StepError| error.into())
}

/// Instants of the last opening and closing, s.
fn switches(contact: &Simulation) -> [f64; 2] {
    [RealOutput::ContactLastOpening, RealOutput::ContactLastClosing].map(|output| contact.real(output))
}

fn main() {
    if let Err(error) = run() {
        eprintln!("{error}");
        process::exit(1);
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<_> = env::args().skip(1).collect();
    let parsed = |text: &String| text.parse::<f64>().map_err(|_| format!("{text}: not a number"));
    let number = |at: usize, default| arguments.get(at).map_or(Ok(default), parsed);
    let (amplitude, duration) = (number(0, 400.0)?, number(1, 0.02)?);
    if !duration.is_finite() || duration <= 0.0 {
        return Err(format!("{duration} s: not allowed, allowed is a positive number").into());
    }
    let path = arguments.get(2).map_or("out/embed.csv", String::as_str);

    // The start values are those of the published specimen. `Simulation::new` checks all fields.
    let mut scene = Scene::default();
    scene.contact.overtravel = 0.19e-3;
    scene.chatter.minimum_duration = 5e-6;
    scene.effects.extremes = false; // not read here
    let mut contact = Simulation::new(&scene, &Inputs::default(), 0.0)?;

    let mut table = "time,base.acceleration,contact.force,contact.resistance\n".to_owned();
    let (mut repeated, mut n) = (0, 0.0);
    while (n + 0.5) * STEP < duration {
        let time = n * STEP;
        // A copy of all that moves, without allocation. It can be kept as long as wanted, and serialised by serde.
        let saved = *contact.motion();
        let before = switches(&contact);
        advance(&mut contact, amplitude, time, STEP)?;
        if switches(&contact) != before {
            contact.go_on_from(&saved);
            for k in 0..10 {
                advance(&mut contact, amplitude, time + f64::from(k) * (0.1 * STEP), 0.1 * STEP)?;
            }
            repeated += 1;
        }
        n += 1.0;
        let [force, resistance] =
            [RealOutput::ContactForce, RealOutput::ContactResistance].map(|output| contact.real(output));
        let time = n * STEP;
        writeln!(table, "{time},{},{force},{resistance}", vibration(amplitude, time))?;
    }
    fs::create_dir_all(Path::new(path).parent().unwrap_or(Path::new("")))?;
    fs::write(path, table)?;
    println!("interruptions of 5 us or more: {}", contact.integer(IntegerOutput::ChatterCount));
    let longest = contact.real(RealOutput::ChatterLongestInterruption);
    println!("longest interruption: {:.3} us", 1e6 * longest);
    println!("steps done again: {repeated}");
    println!("{path}");
    Ok(())
}
