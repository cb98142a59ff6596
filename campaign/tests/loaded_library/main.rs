//! The component as in an importer: a loaded library, called through its C functions.
#![allow(clippy::undocumented_unsafe_blocks)] // every block calls a C function with valid arguments, or with wrong ones on purpose

mod every_call;
mod hostile_states;
mod instances;
mod random_calls;
