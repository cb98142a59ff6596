//! The library from C, and in a loop of one's own. [`program`]: compiles a C program;   [`life_cycle`]: a full life;
//! [`embed`]: the examples that do without FMI, in Rust and in C.

#![allow(clippy::unwrap_used)]

mod embed;
mod life_cycle;
mod program;
