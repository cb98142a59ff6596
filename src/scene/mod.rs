//! What is to be simulated: every parameter with its value, and the effects asked for.
//!
//! The names, ranges and start values are those of `modelDescription.xml`; [`Scene::default`] is the specimen of
//! Zhang, Zhang, Meng, Ren, Machines 2025, 13(1), 52, with the values the paper leaves out identified from its results.

pub mod file;
pub mod input_table;
pub(crate) mod names;
mod parameters;
mod values;

pub use parameters::*;
pub(crate) use values::check_range;
pub use values::choices;
