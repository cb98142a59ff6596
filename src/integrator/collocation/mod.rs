//! One step, in which the contact force is a polynomial through Radau nodes.

pub mod axial_force;
pub mod coefficients;
pub(crate) mod elimination;
pub mod end;
pub mod error;
pub mod friction;
pub mod modal_response;
pub mod newton;
pub mod part;
pub mod polynomial;
pub mod shapes;
pub(crate) mod side_by_side;
pub mod step;
pub mod superposition;
pub mod tangential;
pub mod trial;
