//! The scenes compared, with the effects that are on by default. All start from rest.

use relay_contact::error::SceneError;
use relay_contact::scene::Scene;
use relay_contact::variables::ContactLawKind;
use testing::scenes::shaken;

use crate::problem::Problem;

/// Number of modes of the references that represent the continuum.
pub const MANY_MODES: i32 = 64;

/// Scenes in which the component is compared with other integrators.
pub const COMPARED: [&str; 4] = ["paper", "chatter", "chatter 3 %", "closing bounce"];

/// The published case: 98 m/s2 at 1000 Hz, 50 ms; the contact stays closed.
pub fn paper() -> Result<Problem, SceneError> {
    Problem::new("paper", &shaken(98.0, 1000.0), 0.0, 0.05, 500)
}

/// 400 m/s2: the contact opens in every period; first 5 ms. The first mode of the spring has this share of critical damping;
/// the specimen has 34 %.
pub fn chatter(name: &'static str, damping: f64) -> Result<Problem, SceneError> {
    let mut scene = shaken(400.0, 1000.0);
    scene.beam.stiffness_damping *= damping / 0.34;
    Problem::new(name, &scene, 0.0, 0.005, 250)
}

/// The contact is open by 20 um at the start, and the fixed contact approaches at 60 mm/s: it closes and bounces.
/// Contact damping is 1 us; with that of the specimen it would not bounce. 5 ms.
pub fn closing_bounce() -> Result<Problem, SceneError> {
    let mut scene = Scene::default();
    scene.contact.overtravel = -20e-6;
    scene.contact.damping = 1e-6;
    Problem::new("closing bounce", &scene, 0.06, 0.005, 250)
}

/// The published case with the contact linearised and bonded, so that everything is linear.
pub fn linear() -> Result<Problem, SceneError> {
    let mut scene = shaken(98.0, 1000.0);
    scene.effects.contact_law = ContactLawKind::Bonded;
    Problem::new("linear", &scene, 0.0, 0.05, 500)
}

/// All of them.
pub fn all() -> Result<Vec<Problem>, SceneError> {
    Ok(vec![
        paper()?,
        linear()?,
        chatter("chatter", 0.34)?,
        chatter("chatter 3 %", 0.03)?,
        chatter("chatter 0.3 %", 0.003)?,
        closing_bounce()?,
    ])
}
