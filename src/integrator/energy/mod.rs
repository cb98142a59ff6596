//! The energy that steps make or lose.

pub mod balance;
pub mod conservation;
