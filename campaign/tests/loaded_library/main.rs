//! The component as an importer meets it: a library file, loaded, and called through its C functions.
#![allow(clippy::undocumented_unsafe_blocks)] // every block calls a C function with what it needs, or, as the test says, without

mod every_call;
mod hostile_states;
mod instances;
mod random_calls;
