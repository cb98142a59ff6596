//! The FMI 2.0 functions called through their C signatures: what the package `campaign`, which judges statuses, values and states
//! of every call, does not look at.
//!
//! [`messages`], [`logging`]: what is said, and where;   [`values`], [`steps`], [`course`]: what a call does to the
//! simulation;   [`dependencies`]: of initial unknowns;   [`fmu_state`]: a saved state goes on bit by bit;   [`springs`]: of a file;
//! [`plain`]: all numbers as Reals;   [`importers`]: habits of importers;   `environment`: hosts with another floating-point environment.
#![allow(clippy::undocumented_unsafe_blocks)] // every block calls a C function with what it needs, or, as the test says, without

mod course;
mod dependencies;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod environment;
mod fmu_state;
mod importers;
mod logging;
mod messages;
mod plain;
mod springs;
mod steps;
mod values;
