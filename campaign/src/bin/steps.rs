//! Makes communication steps, for counting instructions: `steps SCENE INTERFACE COUNT`, the scene `1us` (steps far
//! shorter than those of the integrator), `10us` (about as long), or with an input that changes every step `shaken`
//! (10 us), `sampled` (1 us, a slow sine) or `random` (the same in random lengths, 0.5 to 2 us), the interface `fmi2DoStep`
//! (of the library file beside this program) or `library` (the same steps without C).

use campaign::api::LIBRARY;
use campaign::call::{Call, Fault};
use campaign::description::DESCRIPTION;
use campaign::importer::Importer;
use relay_contact::fmi2::{fmi2OK, fmi2True};
use relay_contact::inputs::Inputs;
use relay_contact::simulation::Simulation;
use relay_contact::variables::RealOutput;
use testing::scenes::shaken;

const AMPLITUDE: f64 = 98.0;

/// Length of each of so many steps, s, and the acceleration in it, m/s2.
fn plan(scene: &str, count: u32) -> Vec<(f64, f64)> {
    let held = |_: u32| 0.0;
    let jumping = |k: u32| f64::from(k % 5);
    let sampled = |k: u32| 0.5 * AMPLITUDE * (1e-3 * f64::from(k)).sin();
    let (sizes, acceleration): (_, fn(u32) -> f64) = match scene {
        "1us" => ([1e-6; 2], held),
        "10us" => ([1e-5; 2], held),
        "shaken" => ([1e-5; 2], jumping),
        "sampled" => ([1e-6; 2], sampled),
        "random" => ([0.5e-6, 2e-6], sampled),
        other => panic!("unknown scene {other}"),
    };
    let [shortest, longest] = sizes;
    // The golden ratio's fractional parts fill an interval evenly.
    let part = |k: u32| (f64::from(k) * 0.618_033_988_749_894_9).fract();
    let step = |k| (shortest + part(k) * (longest - shortest), acceleration(k));
    (0..count).map(step).collect()
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, scene, way, count] = &arguments[..] else {
        panic!("usage: steps SCENE INTERFACE COUNT");
    };
    let plan = plan(scene, count.parse().expect("a count of steps"));
    let force = match way.as_str() {
        "fmi2DoStep" => through_c(&plan),
        "library" => alone(&plan),
        other => panic!("unknown interface {other}"),
    };
    println!("{force}");
}

fn through_c(plan: &[(f64, f64)]) -> f64 {
    let api = &*LIBRARY;
    let mut importer = Importer::new(api);
    for call in Call::shaken(AMPLITUDE) {
        assert_eq!(importer.make(&call, Fault::None, 0.0).0, fmi2OK);
    }
    let (c, input, output) =
        (importer.component, DESCRIPTION.reference("base.acceleration"), DESCRIPTION.reference("contact.force"));
    let (mut force, mut time, mut value) = (0.0, 0.0, 0.0);
    // SAFETY: pointers to what is declared here.
    unsafe {
        for (size, acceleration) in plan {
            let before = std::mem::replace(&mut value, *acceleration);
            if value != before {
                assert_eq!((api.fmi2SetReal)(c, &raw const input, 1, &raw const value), fmi2OK);
            }
            assert_eq!((api.fmi2DoStep)(c, time, *size, fmi2True), fmi2OK);
            time += size;
        }
        assert_eq!((api.fmi2GetReal)(c, &raw const output, 1, &raw mut force), fmi2OK);
    }
    force
}

fn alone(plan: &[(f64, f64)]) -> f64 {
    let mut inputs = Inputs::default();
    let mut simulation = Simulation::new(&shaken(AMPLITUDE, 1000.0), &inputs, 0.0).expect("a scene that fits");
    for (size, acceleration) in plan {
        inputs.base_acceleration = *acceleration;
        simulation.step(&inputs, simulation.time(), *size).expect("a step");
    }
    simulation.real(RealOutput::ContactForce)
}
