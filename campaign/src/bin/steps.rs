//! Makes communication steps, for counting instructions: `steps SCENE INTERFACE COUNT`, the scene `1us` (steps far
//! shorter than those of the integrator), `10us` (about as long) or `shaken` (10 us, and an input that changes every
//! step), the interface `fmi2DoStep` (of the library file beside this program) or `library` (the same steps without C).

use campaign::api::LIBRARY;
use campaign::call::Call;
use campaign::description::DESCRIPTION;
use campaign::importer::Importer;
use relay_contact::fmi2::{fmi2OK, fmi2True};
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ExcitationKind, RealOutput};

const AMPLITUDE: f64 = 98.0;

/// Step size, s, and the acceleration in a step, m/s2.
fn plan(scene: &str) -> (f64, fn(u32) -> f64) {
    match scene {
        "1us" => (1e-6, |_| 0.0),
        "10us" => (1e-5, |_| 0.0),
        "shaken" => (1e-5, |k| f64::from(k % 5)),
        other => panic!("unknown scene {other}"),
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, scene, way, count] = &arguments[..] else {
        panic!("usage: steps SCENE INTERFACE COUNT");
    };
    let count = count.parse().expect("a count of steps");
    let force = match way.as_str() {
        "fmi2DoStep" => through_c(plan(scene), count),
        "library" => alone(plan(scene), count),
        other => panic!("unknown interface {other}"),
    };
    println!("{force}");
}

fn through_c((size, acceleration): (f64, fn(u32) -> f64), count: u32) -> f64 {
    let api = &*LIBRARY;
    let mut importer = Importer::new(api);
    for call in Call::shaken(AMPLITUDE) {
        assert_eq!(importer.make(&call, 0.0).0, fmi2OK);
    }
    let (c, input, output) = (
        importer.component,
        DESCRIPTION.reference("base.acceleration"),
        DESCRIPTION.reference("contact.force"),
    );
    let (mut force, mut value) = (0.0, 0.0);
    // SAFETY: pointers to what is declared here.
    unsafe {
        for k in 0..count {
            let before = std::mem::replace(&mut value, acceleration(k));
            if value != before {
                assert_eq!((api.fmi2SetReal)(c, &raw const input, 1, &raw const value), fmi2OK);
            }
            assert_eq!((api.fmi2DoStep)(c, f64::from(k) * size, size, fmi2True), fmi2OK);
        }
        assert_eq!((api.fmi2GetReal)(c, &raw const output, 1, &raw mut force), fmi2OK);
    }
    force
}

fn alone((size, acceleration): (f64, fn(u32) -> f64), count: u32) -> f64 {
    let mut scene = Scene::default();
    scene.effects.excitation = ExcitationKind::Sine;
    scene.excitation.amplitude = AMPLITUDE;
    let mut inputs = Inputs::default();
    let mut simulation = Simulation::new(&scene, &inputs, 0.0).expect("a scene that fits");
    for k in 0..count {
        inputs.base_acceleration = acceleration(k);
        simulation.step(&inputs, f64::from(k) * size, size).expect("a step");
    }
    simulation.real(RealOutput::ContactForce)
}
