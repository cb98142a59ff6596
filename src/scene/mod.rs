//! What is simulated: the values of all parameters, and the enabled effects.
//!
//! The names, ranges and start values are those of `modelDescription.xml`; [`Scene::default`] is the specimen of
//! Zhang, Zhang, Meng, Ren, Machines 2025, 13(1), 52, with unpublished values identified from published results.

mod combinations;
mod document;
pub mod file;
pub mod input_table;
pub(crate) mod names;
mod parameters;
pub mod spring;
pub(crate) mod spring_file;
mod values;

pub use parameters::*;
pub(crate) use values::{check_range, refused};
