//! What accuracy costs: the component beside general integrators on the same equations, with the same error measure.
//!
//! ```text
//! scenes      what is simulated
//! problem     the modal equations of a scene, as a general integrator wants them
//! integrator  what all of them do: forces on a grid, instants of opening and closing, time and work spent
//! component, cvode, diffsol, generalised_alpha    the integrators
//! radau       the reference, with its own error
//! plan        what is measured
//! study       runs them against the reference, interleaved;   table    what came of it
//! machine     where it ran
//! ```

pub mod component;
pub mod cvode;
pub mod diffsol;
pub mod generalised_alpha;
pub mod integrator;
pub mod machine;
pub mod plan;
pub mod problem;
pub mod radau;
pub mod scenes;
pub mod study;
pub mod table;
