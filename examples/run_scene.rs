//! Runs a scene file, with changes; prints its outputs at the end, and the time taken per simulated millisecond.
//!
//!     cargo run --release --example run_scene -- scenes/paper-1khz.toml excitation.amplitude=400 stop=0.1

use std::env;
use std::error::Error;
use std::hint::black_box;
use std::path::Path;
use std::process;
use std::time::Instant;

use relay_contact::scene::file::SceneFile;
use relay_contact::simulation::Simulation;

fn main() {
    if let Err(error) = run() {
        eprintln!("{error}");
        process::exit(1);
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let mut arguments = env::args().skip(1);
    let path = arguments.next().ok_or("usage: run_scene FILE [NAME=VALUE...]")?;
    let mut scene = SceneFile::read(Path::new(&path))?;
    for change in arguments {
        let (name, value) = change.split_once('=').ok_or_else(|| format!("{change}: must be NAME=VALUE"))?;
        scene.set(name, value)?;
    }

    let start = scene.first_inputs()?;
    let mut contact = Simulation::new(&scene.scene, &start, 0.0)?;
    let mut outputs = vec![0.0; scene.outputs.len()];
    let begun = Instant::now();
    for (time, size) in scene.steps() {
        contact.step(&scene.inputs_over(time, size)?, time, size)?;
        // What is not read is not computed.
        for (value, variable) in outputs.iter_mut().zip(&scene.outputs) {
            *value = contact.output(variable).unwrap_or(f64::NAN);
        }
        black_box(&mut outputs);
    }
    let taken = begun.elapsed();

    println!("{}, at {} s", scene.title, contact.time());
    for (value, variable) in outputs.iter().zip(&scene.outputs) {
        println!("{} = {value} {}", variable.name, variable.unit);
    }
    println!("{} ns per simulated millisecond", 1e6 * taken.as_secs_f64() / scene.stop);
    Ok(())
}
