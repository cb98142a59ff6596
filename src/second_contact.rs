//! The second contact of a changeover relay (`effects.secondContact`), as the mirror image of the first.
//!
//! The moving contact lies between the first fixed contact and a second one on the other side of the spring, at the distance
//! `gap` from its surface at the preload. With the displacement `u_2` of the second fixed contact relative to the first, its
//! indentation and the equations of motion are
//!
//! ```text
//! e = -(d - d_0) - gap + u_2,   F_2 = F(e, e') by the law of the first with its own radius and damping time
//! q_i'' + c_i q_i' + omega_i^2 q_i = T_i (F - F_2 - F_0) - g_i a
//! ```
//!
//! The distance of both fixed contacts is `gap - u_2 - d_0`. While it is positive at most one contact is closed, as a contact
//! force needs an overlap. With `q' = -q`, `a' = -a`, `F_0' = -F_0`, `u' = u_2 - u`, `d' - d_0' = u_2 - (d - d_0)` and
//! `d_0' = -gap` the equations of the second contact alone are those of the first. So a model in the view of the second is
//! one like any other ([`Model::views`]), and the state goes over from one view to the other in flight ([`State::mirror`]):
//! all that is done for the first contact is done for the second, with the same code and the same bits.

use crate::beam::axial::Feedback;
use crate::chatter::Criterion;
use crate::contact::law::Law;
use crate::electrical::ElectricalContact;
use crate::model::Model;
use crate::preload::Preload;
use crate::state::State;

impl Model {
    /// With a second contact of this law.
    pub(crate) fn with_second(mut self, law: Law) -> Self {
        self.hardest = self.law.hardest(&law);
        self.second = None;
        let mut second = Box::new(self.clone());
        second.law = law;
        second.preload = Preload {
            force: -self.preload.force,
            indentation: -self.scene.second.gap,
            contact_stiffness: 0.0,
            deflection: -self.preload.deflection,
            ..self.preload
        };
        second.electrical = ElectricalContact::new(&self.scene, &law);
        second.criterion = (second.electrical.as_ref()).and_then(|contact| Criterion::new(&self.scene, contact));
        second.axial = self.axial().map(Feedback::mirrored).map(Box::new);
        second.mirrored = true;
        self.second = Some(second);
        self
    }

    /// The view that a state is of, and that of the other contact, where there are two.
    pub(crate) fn views(&self, state: &State) -> (&Self, Option<&Self>) {
        match self.second.as_deref() {
            Some(second) if state.mirrored => (second, Some(self)),
            second => (self, second),
        }
    }

    /// Distance of both fixed contacts with the second displaced by so much (m); infinite where there is one.
    pub(crate) fn room(&self, displacement: f64) -> f64 {
        if self.second.is_some() {
            self.scene.second.gap - displacement - self.preload.indentation
        } else {
            f64::INFINITY
        }
    }
}
