//! What an instance costs: its start, its end and its memory; and how many runs a second many of them are.

use std::fmt::Write as _;
use std::fs;
use std::num::NonZero;
use std::path::Path;
use std::thread::available_parallelism;
use std::time::Instant;

use anyhow::{Context, Result};
use relay_contact::many::run_many;
use relay_contact::scene::file::SceneFile;
use relay_contact::simulation::Simulation;

/// Scenes and tolerances of the instances.
const SCENES: [(&str, &str); 5] = [
    ("paper-1khz", "1e-2"),
    ("paper-1khz", "1e-6"),
    ("chatter-41g", "1e-2"),
    ("chatter-41g", "1e-6"),
    ("tapered-spring", "1e-6"),
];

/// Instances whose memory is measured together.
const TOGETHER: usize = 20;

/// Reads a scene of the project.
fn read(name: &str, tolerance: &str) -> Result<SceneFile> {
    let mut scene = SceneFile::read(&Path::new("scenes").join(name).with_extension("toml"))?;
    scene.set("solver.tolerance", tolerance)?;
    Ok(scene)
}

fn start(scene: &SceneFile) -> Result<Simulation> {
    let inputs = scene.first_inputs()?;
    Ok(Simulation::new(&scene.scene, &inputs, 0.0)?)
}

/// Memory of this process that is in use, kB, without its code; on Linux.
fn in_use() -> Option<f64> {
    let text = fs::read_to_string("/proc/self/smaps_rollup").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("Anonymous:"))?;
    line.split_whitespace().next()?.parse().ok()
}

/// Start (s, the least) of an instance alone and beside another one of the same scene, its end, and its memory (kB) after the start
/// and after the run, as CSV. To be called first: what was freed before would be used again.
pub fn costs(quick: bool) -> Result<String> {
    let (mut memory, mut held) = (Vec::new(), Vec::new());
    for (name, tolerance) in SCENES {
        let scene = read(name, tolerance)?;
        let mut used = vec![in_use()];
        let first = held.len();
        for _ in 0..TOGETHER {
            held.push(start(&scene)?);
        }
        used.push(in_use());
        for simulation in held.iter_mut().skip(first) {
            for (time, size) in scene.steps() {
                simulation.step(&scene.inputs_over(time, size)?, time, size)?;
            }
        }
        used.push(in_use());
        let each = |place: usize| Some((used[place]? - used[0]?) / TOGETHER as f64);
        memory.push([each(1), each(2)].map(|kilobytes| kilobytes.map_or(String::new(), |each| format!("{each:.0}"))));
    }
    drop(held);
    let mut text = "scene,tolerance,first_seconds,later_seconds,end_seconds,started_kb,run_kb\n".to_owned();
    for ((name, tolerance), [started, run]) in SCENES.iter().zip(memory) {
        let scene = read(name, tolerance)?;
        let mut least = [f64::INFINITY; 3];
        let mut time = |place: usize, begun: Instant| least[place] = least[place].min(begun.elapsed().as_secs_f64());
        for _ in 0..if quick { 3 } else { 300 } {
            let begun = Instant::now();
            let first = start(&scene)?;
            time(0, begun);
            let begun = Instant::now();
            let later = start(&scene)?;
            time(1, begun);
            let begun = Instant::now();
            drop(later);
            time(2, begun);
            drop(first);
        }
        let [first, later, end] = least;
        let _ = writeln!(text, "{name},{tolerance},{first:.3e},{later:.3e},{end:.3e},{started},{run}");
    }
    Ok(text)
}

/// Runs a second of many scenes that differ in their frequency, by one worker and by one for each core, the best of some rounds,
/// as CSV.
pub fn rates(quick: bool) -> Result<String> {
    let (scene, count) = (read("chatter-41g", "1e-2")?, if quick { 20 } else { 1000 });
    let mut scenes = Vec::new();
    for n in 0..count {
        let mut scene = scene.clone();
        scene.scene.excitation.frequency = 100.0 + 2900.0 * f64::from(n) / f64::from(count - 1);
        scenes.push(scene);
    }
    let workers = [NonZero::<usize>::MIN, available_parallelism()?];
    let mut best = [0.0_f64; 2];
    for _ in 0..if quick { 1 } else { 10 } {
        for (best, workers) in best.iter_mut().zip(workers) {
            let begun = Instant::now();
            let rows = run_many(&scenes, workers, |_| ());
            *best = best.max(f64::from(count) / begun.elapsed().as_secs_f64());
            let failed = rows.into_iter().find_map(Result::err);
            failed.map_or(Ok(()), Err).context("one of many")?;
        }
    }
    let mut text = "workers,simulations_per_second\n".to_owned();
    for (workers, best) in workers.iter().zip(best) {
        let _ = writeln!(text, "{workers},{best:.1}");
    }
    Ok(text)
}
