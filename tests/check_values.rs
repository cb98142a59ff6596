//! Published check values of the specimen at rest: two independent implementations agree on every digit given. Its frequency and what
//! an axial force does to both: `tests/python/test_effects_mechanics.py`.

use relay_contact::scene::Scene;
use relay_contact::variables::{AxialForceKind, RealOutput};
use testing::near;
use testing::scenes::at_rest;

#[test]
fn static_force_indentation_and_stiffness() {
    let mut scene = Scene::default();
    scene.effects.axial_force = AxialForceKind::None;
    for (output, published, last_digit) in [
        (RealOutput::PreloadForce, 0.152_026_1, 1e-7),
        (RealOutput::PreloadIndentation, 64.418e-9, 1e-12),
        (RealOutput::PreloadContactStiffness, 3.539_968e6, 1.0),
    ] {
        // All digits given, the last one rounded.
        near(format_args!("{output:?}"), at_rest(&scene, output), published, 0.5001 * last_digit);
    }
}
