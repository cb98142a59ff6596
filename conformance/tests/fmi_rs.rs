//! The packaged component, loaded and run by the importer of the crate `fmi-rs`, another one than `fmi`.

mod rows;

use std::sync::Arc;

use fmi_rs::fmi2::builder::FMU2Builder;
use fmi_rs::fmi2::types::{fmi2Status, fmi2True};
use fmi_rs::fmi2::{CS, FMU2};

fn builder() -> FMU2Builder {
    let path = std::env::var("RELAY_CONTACT_FMU").expect("RELAY_CONTACT_FMU: run `cargo xtask importers`");
    // Reads and validates the description.
    FMU2Builder::new(&path).expect("a component")
}

fn reference(builder: &FMU2Builder, name: &str) -> u32 {
    let mut variables = builder.model_description.modelVariables.iter();
    let variable = variables.find(|variable| variable.name == name).expect("the variable");
    variable.valueReference
}

fn ok(status: fmi2Status) {
    assert_eq!(status, fmi2Status::Ok);
}

fn compare(task: &str, rows: &[[f64; 2]], prepare: impl FnOnce(&FMU2Builder, &Arc<FMU2<CS>>)) {
    let builder = builder();
    let instance = builder.instantiate_cs("conformance").expect("an instance");
    ok(instance.setupExperiment(None, 0.0, None));
    prepare(&builder, &instance);
    ok(instance.enterInitializationMode());
    ok(instance.exitInitializationMode());
    let input = [reference(&builder, "base.acceleration")];
    let output = [reference(&builder, "contact.force")];
    // The crate does not tell its version: that of the lock file.
    let lock = include_str!("../../Cargo.lock");
    let (_, after) = lock.split_once("name = \"fmi-rs\"\nversion = \"").expect("locked");
    let version = after.split('"').next().expect("a version");
    rows::compare("fmi-rs (Rust)", version, task, rows, |acceleration, time, length| {
        let mut force = [f64::NAN];
        ok(instance.getReal(&output, &mut force));
        ok(instance.setReal(&input, &[acceleration]));
        ok(instance.doStep(time, length, fmi2True));
        force[0]
    });
    ok(instance.terminate());
}

#[test]
fn a_sine_given_at_the_communication_points_gives_the_forces_of_our_own_run() {
    compare("run", &rows::held(), |builder, instance| {
        ok(instance.setReal(&[reference(builder, "solver.tolerance")], &[1e-7]));
    });
}

#[test]
fn the_published_run_gives_the_forces_of_our_own() {
    compare("published run", &rows::published(), |builder, instance| {
        let choices = ["effects.excitation", "effects.axialForce"].map(|name| reference(builder, name));
        ok(instance.setInteger(&choices, &[2, 1]));
    });
}
