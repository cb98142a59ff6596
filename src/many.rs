//! Many scenes at once, on all cores of a machine.

use std::num::NonZero;
use std::sync::Mutex;
use std::thread;

use crate::error::{SceneError, StepError, caught};
use crate::scene::file::SceneFile;
use crate::shared::open;
use crate::simulation::{Kept, Simulation};

/// Why one of many scenes has no results; the others have theirs.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RunError {
    /// A scene that cannot be simulated, or an input that leaves its range.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A communication step that could not be integrated.
    #[error(transparent)]
    Step(#[from] StepError),
    /// An error of this library.
    #[error("internal error: {0}")]
    Panic(String),
}

/// Runs scenes from their begin to their stop; returns for each, in their order, its outputs at the stop (SI units; a choice by its
/// number, true as 1), or why it has none. The bits are those of the scene alone, whatever the number of workers.
///
/// `progress` is called after each scene with the number of those that are done.
///
/// ```
/// use std::num::NonZero;
///
/// use relay_contact::many::run_many;
/// use relay_contact::scene::file::SceneFile;
///
/// let scene = |amplitude: f64| -> Result<SceneFile, relay_contact::error::SceneError> {
///     let text = "stop = 2e-3\ncommunicationStep = 2e-3\noutputs = [\"step.minimumForce\"]\n[parameters.effects]\nexcitation = \"Sine\"";
///     let mut scene: SceneFile = text.parse()?;
///     scene.set("excitation.amplitude", &amplitude.to_string())?;
///     Ok(scene)
/// };
/// let scenes = [scene(50.0)?, scene(400.0)?];
/// let rows = run_many(&scenes, NonZero::<usize>::MIN, |done| println!("{done} of 2"));
/// assert!(rows[0].clone()?[0] > 0.0);
/// assert_eq!(rows[1].clone()?, [0.0]); // opened
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn run_many(
    scenes: &[SceneFile],
    workers: NonZero<usize>,
    progress: impl FnMut(usize) + Send,
) -> Vec<Result<Vec<f64>, RunError>> {
    // Else computed anew for each scene that is alone at a time.
    let _kept = Kept::default();
    side_by_side(scenes, workers, run, progress)
}

/// Runs a scene; returns its outputs at the stop.
fn run(scene: &SceneFile) -> Result<Vec<f64>, RunError> {
    let start = scene.first_inputs()?;
    let mut simulation = Simulation::new(&scene.scene, &start, 0.0)?;
    for (time, size) in scene.steps() {
        simulation.step(&scene.inputs_over(time, size)?, time, size)?;
    }
    let outputs = scene.outputs.iter().map(|variable| simulation.output(variable));
    Ok(outputs.map(|value| value.unwrap_or(f64::NAN)).collect())
}

/// Does the same with each item on so many threads, of which this one is the first: where the system gives no others (WebAssembly
/// has none) it does all. A panic is an error of its item.
fn side_by_side<T: Sync, R: Send>(
    items: &[T],
    workers: NonZero<usize>,
    work: impl Fn(&T) -> Result<R, RunError> + Sync,
    progress: impl FnMut(usize) + Send,
) -> Vec<Result<R, RunError>> {
    let mut rows: Vec<_> = items.iter().map(|_| Err(RunError::Panic("not run".to_owned()))).collect();
    let (left, told) = (Mutex::new(items.iter().zip(&mut rows)), Mutex::new((0, progress)));
    // Each worker takes the next item once it has done one, as some take much longer than others.
    let next = || open(&left).next();
    let worker = || {
        while let Some((item, row)) = next() {
            *row = caught(|| work(item)).unwrap_or_else(|panic| Err(RunError::Panic(panic)));
            let mut told = open(&told);
            told.0 += 1;
            let count = told.0;
            told.1(count);
        }
    };
    thread::scope(|scope| {
        for _ in 1..workers.get().min(items.len()) {
            if thread::Builder::new().spawn_scoped(scope, worker).is_err() {
                break;
            }
        }
        worker();
    });
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_an_error_of_its_item_alone() {
        let odd = |item: &u32| {
            assert!(item.is_multiple_of(2), "odd: {item}");
            Ok(*item)
        };
        for workers in [1, 2, 7] {
            let mut counts = Vec::new();
            let rows = side_by_side(&[0, 1, 2, 3], NonZero::new(workers).unwrap(), odd, |count| {
                counts.push(count);
            });
            let wrong = |item: u32| Err(RunError::Panic(format!("odd: {item}")));
            assert_eq!(rows, [Ok(0), wrong(1), Ok(2), wrong(3)]);
            assert_eq!(counts, [1, 2, 3, 4]);
        }
    }
}
