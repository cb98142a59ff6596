//! Where an integrator breaks: extreme scenes and motions, each with the properties that have to hold in all of them.
//!
//! No number is lost (NaN, infinity), the contact never pulls, energy is never made, the work is bounded, and the result does not
//! depend on the communication step. See [`ride`] for what these mean in numbers.
//!
//! Long forms, left out of the default run:
//! - `PROPTEST_CASES=100000 cargo test --release --test hard_cases campaign` draws that many scenes
//!   (`PROPTEST_RNG_SEED=...` draws others; `-- --include-ignored` asks for all properties).
//! - `cargo test --release --test hard_cases endurance -- --ignored` takes a million contact cycles and ten million
//!   steps.

#![allow(clippy::unwrap_used)]

mod campaign;
mod contact;
mod endurance;
mod excitation;
mod ride;
mod solver;
mod spring;

use testing::rig as common;
