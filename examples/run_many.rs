//! Runs a scene file with many values of a parameter, on all cores; prints the outputs at the end.
//!
//!     cargo run --release --example run_many -- scenes/chatter-41g.toml excitation.frequency 100 3000 1000 solver.tolerance=1e-2

use std::env;
use std::error::Error;
use std::path::Path;
use std::thread;

use relay_contact::many::run_many;
use relay_contact::scene::file::SceneFile;

fn main() -> Result<(), Box<dyn Error>> {
    let usage = "usage: run_many FILE PARAMETER FIRST LAST COUNT [NAME=VALUE...]";
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [path, parameter, first, last, count, changes @ ..] = arguments.as_slice() else {
        return Err(usage.into());
    };
    let mut scene = SceneFile::read(Path::new(path))?;
    for change in changes {
        let (name, value) = change.split_once('=').ok_or(usage)?;
        scene.set(name, value)?;
    }
    let (first, last, count): (f64, f64, u32) = (first.parse()?, last.parse()?, count.parse()?);
    let value = |n: u32| first + (last - first) * f64::from(n) / f64::from(count.saturating_sub(1).max(1));
    let scenes = (0..count).map(|n| {
        let mut scene = scene.clone();
        scene.set(parameter, &value(n).to_string()).map(|()| scene)
    });
    let scenes = scenes.collect::<Result<Vec<_>, _>>()?;

    let rows = run_many(&scenes, thread::available_parallelism()?, |_| ());
    let names: Vec<_> = scene.outputs.iter().map(|variable| variable.name).collect();
    println!("{parameter},{},error", names.join(","));
    for (n, row) in (0..count).zip(rows) {
        match row {
            Ok(row) => println!(
                "{},{},",
                value(n),
                row.iter().map(f64::to_string).collect::<Vec<_>>().join(",")
            ),
            Err(error) => println!("{},{}{error:?}", value(n), ",".repeat(names.len())),
        }
    }
    Ok(())
}
