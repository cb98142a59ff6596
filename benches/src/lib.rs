//! Cost of accuracy: the component compared with general integrators on the same equations, with the same error measure.
//!
//! ```text
//! scenes      what is simulated
//! problem     the modal equations of a scene, in the form general integrators need
//! integrator  their interface: forces on a grid, times of opening and closing, time and work spent
//! component, cvode, diffsol, newmark    the integrators
//! radau       the reference, with its own error estimate
//! plan        what is measured
//! study       runs them against the reference, interleaved;   table    the results
//! c_program   compiles and asks those in C;   machine   processor and versions;   page   writes into docs/
//! independent random relays against finite elements that share nothing with the component
//! ```

pub mod c_program;
pub mod component;
pub mod cvode;
pub mod diffsol;
pub mod independent;
pub mod integrator;
pub mod machine;
pub mod newmark;
pub mod page;
pub mod plan;
pub mod problem;
pub mod radau;
pub mod scenes;
pub mod study;
pub mod table;
