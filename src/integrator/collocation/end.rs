//! What a trial leaves for the step that is taken.

use bytemuck::Zeroable;

use crate::beam::mode::{MAX_MODES, ModeStates};
use crate::integrator::collocation::tangential::TangentialNodes;
use crate::math::nodal::Nodal;

/// A value at each node for each mode.
pub(crate) type NodalModes<const S: usize> = [Nodal<S>; MAX_MODES];

/// What a trial leaves for the step that is taken.
#[derive(Clone, Debug, Zeroable)]
pub struct End<const S: usize> {
    /// The modes at its end.
    pub modes: ModeStates,
    /// Loads of an axial force that follows the deflection, at its nodes.
    pub loads: NodalModes<S>,
    /// The modes at its nodes, while such loads are sought.
    pub(super) motion: NodalModes<S>,
    /// The loads of that motion.
    pub(super) next: NodalModes<S>,
    /// Friction at its nodes.
    pub tangential: TangentialNodes<S>,
}
