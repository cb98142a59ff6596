//! Axial force of the spring, compression positive.

use crate::beam::section::Section;

/// Axial force that a tip deflection `y` (m) causes, N: `N = (3 E I y / L^3) sin(3 y / (2 L))`.
///
/// Machines 2025, 13(1), 52, eq. (9). At the specimen it is 3 mN and shifts the first frequency by 0.025 Hz; it does
/// not explain the shift of 43 Hz published there.
pub fn from_deflection(section: &Section, y: f64) -> f64 {
    section.tip_stiffness() * y * (1.5 * y / section.length).sin()
}
