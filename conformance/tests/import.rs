//! The packaged component, loaded and run by the importer of the crate `fmi`.

mod rows;

use fmi::fmi2::import::Fmi2Import;
use fmi::fmi2::instance::{CoSimulation, Common, InstanceCS};
use fmi::traits::FmiImport;

fn import() -> Fmi2Import {
    let path = std::env::var("RELAY_CONTACT_FMU").expect(
        "RELAY_CONTACT_FMU must hold the path of RelayContact.fmu: run `cargo xtask test`, or `cargo xtask fmu` and set it",
    );
    fmi::import::from_path(&path)
        .unwrap_or_else(|error| panic!("{path}: {error}; `cargo xtask fmu` makes the file anew"))
}

/// The value reference the packaged description gives to a name.
fn reference(import: &Fmi2Import, name: &str) -> u32 {
    let variables = &import.model_description().model_variables.variables;
    let variable = variables.iter().find(|variable| variable.name == name);
    variable
        .unwrap_or_else(|| panic!("{name} is not in the description"))
        .value_reference
}

fn instantiate(import: &Fmi2Import) -> InstanceCS {
    import.instantiate_cs("conformance", false, false).expect("an instance")
}

#[test]
fn the_package_belongs_to_this_source() {
    let import = import();
    let packed = std::fs::read_to_string(import.archive_path().join("modelDescription.xml")).expect("a description");
    let guid = format!("guid=\"{}\"", import.model_description().guid);
    // Not by `assert_eq`, which would print both.
    assert!(
        packed.replacen(&guid, "guid=\"\"", 1) == include_str!("../../modelDescription.xml"),
        "RelayContact.fmu is older than the source"
    );
    let instance = instantiate(&import);
    assert_eq!(Common::get_version(&instance), "2.0");
    assert_eq!(instance.get_types_platform(), "default");
}

fn compare(task: &str, rows: &[[f64; 2]], prepare: impl FnOnce(&Fmi2Import, &mut InstanceCS)) {
    let import = import();
    let mut instance = instantiate(&import);
    instance.setup_experiment(None, 0.0, None).expect("the experiment");
    prepare(&import, &mut instance);
    Common::enter_initialization_mode(&mut instance).expect("Initialization Mode");
    Common::exit_initialization_mode(&mut instance).expect("initialised");
    let input = [reference(&import, "base.acceleration")];
    let output = [reference(&import, "contact.force")];
    let version = fmi::built_info::PKG_VERSION;
    rows::compare("fmi (Rust)", version, task, rows, |acceleration, time, length| {
        let mut force = [f64::NAN];
        instance.get_real(&output, &mut force).expect("the force");
        instance.set_real(&input, &[acceleration]).expect("the acceleration");
        instance.do_step(time, length, true).expect("a step");
        force[0]
    });
    Common::terminate(&mut instance).expect("the end");
}

#[test]
fn a_sine_given_at_the_communication_points_gives_the_forces_of_our_own_run() {
    compare("run", &rows::held(), |import, instance| {
        instance
            .set_real(&[reference(import, "solver.tolerance")], &[1e-7])
            .expect("the tolerance");
    });
}

#[test]
fn the_published_run_gives_the_forces_of_our_own() {
    compare("published run", &rows::published(), |import, instance| {
        let choices = ["effects.excitation", "effects.axialForce"].map(|name| reference(import, name));
        instance.set_integer(&choices, &[2, 1]).expect("the choices");
    });
}
