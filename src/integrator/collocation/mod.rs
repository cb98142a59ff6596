//! One step, in which the forces of the links are polynomials through Radau nodes.

pub mod axial_force;
pub mod cache;
pub mod coefficients;
pub(crate) mod elimination;
pub mod error;
pub mod fading_load;
mod modal_end;
pub mod modal_response;
pub mod newton;
pub mod part;
pub mod polynomial;
pub mod shapes;
pub(crate) mod side_by_side;
pub mod slip;
pub mod step;
mod store;
pub mod superposition;
pub mod trial;
