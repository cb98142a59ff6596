//! The simulation in WebAssembly: what the page calls.
//!
//! The page writes the text of a scene file where [`scene_text`] says, calls [`run_scene`] or [`opening_level`], and reads
//! [`results`], or after a failure [`message`]. Pointers only lead out, into buffers that live until the next call.
#![allow(clippy::missing_errors_doc)] // used only by the page

mod curves;
mod level;

use std::sync::{Mutex, MutexGuard, PoisonError};

use relay_contact::many::RunError;

pub use curves::curves;
pub use level::level;

struct Buffers {
    text: Vec<u8>,
    results: Vec<f64>,
    message: String,
}

static BUFFERS: Mutex<Buffers> = Mutex::new(Buffers { text: Vec::new(), results: Vec::new(), message: String::new() });

fn buffers() -> MutexGuard<'static, Buffers> {
    BUFFERS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Keeps the results, or the message; returns the number of results, 0 after a failure.
fn keep(compute: impl FnOnce(&str) -> Result<Vec<f64>, RunError>) -> usize {
    let mut buffers = buffers();
    let outcome = compute(&String::from_utf8_lossy(&buffers.text));
    (buffers.results, buffers.message) = match outcome {
        Ok(results) => (results, String::new()),
        Err(failure) => (Vec::new(), failure.to_string()),
    };
    buffers.results.len()
}

/// Makes room for the text of a scene file, in bytes of UTF-8, and returns its place.
#[unsafe(no_mangle)]
pub extern "C" fn scene_text(length: usize) -> *mut u8 {
    let mut buffers = buffers();
    buffers.text = vec![0; length];
    buffers.text.as_mut_ptr()
}

/// Runs the scene: the numbers of [`curves`].
#[unsafe(no_mangle)]
pub extern "C" fn run_scene() -> usize {
    keep(curves)
}

/// The level of [`level`] at a frequency (Hz), m/s², and that of linear theory.
#[unsafe(no_mangle)]
pub extern "C" fn opening_level(frequency: f64) -> usize {
    keep(|text| Ok(level(text, frequency)?.to_vec()))
}

/// Place of the results of the last call.
#[unsafe(no_mangle)]
pub extern "C" fn results() -> *const f64 {
    buffers().results.as_ptr()
}

/// Place of the message of the last call, if that failed.
#[unsafe(no_mangle)]
pub extern "C" fn message() -> *const u8 {
    buffers().message.as_ptr()
}

/// Length of the message, in bytes of UTF-8.
#[unsafe(no_mangle)]
pub extern "C" fn message_length() -> usize {
    buffers().message.len()
}
