//! The packaged component, loaded and run by the importer of the crate `fmi`.

use std::path::Path;

use fmi::fmi2::Fmi2Error;
use fmi::fmi2::import::Fmi2Import;
use fmi::fmi2::instance::{CoSimulation, Common, InstanceCS};
use fmi::traits::FmiImport;
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ExcitationKind, GUID, RealOutput};

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
    assert_eq!(
        import.model_description().guid,
        GUID,
        "RelayContact.fmu is older than the source"
    );
    let instance = instantiate(&import);
    assert_eq!(Common::get_version(&instance), "2.0");
    assert_eq!(instance.get_types_platform(), "default");
}

#[test]
fn the_sine_run_gives_the_bits_of_the_simulation_in_rust() {
    const STEP: f64 = 1e-5;
    const TOLERANCE: f64 = 1e-6;

    let import = import();
    let mut instance = instantiate(&import);
    instance
        .setup_experiment(Some(TOLERANCE), 0.0, Some(0.01))
        .expect("the experiment");
    instance
        .set_integer(
            &[reference(&import, "effects.excitation")],
            &[ExcitationKind::Sine as i32],
        )
        .expect("the excitation");
    Common::enter_initialization_mode(&mut instance).expect("Initialization Mode");
    Common::exit_initialization_mode(&mut instance).expect("initialised");

    let mut scene = Scene::default();
    scene.effects.excitation = ExcitationKind::Sine;
    scene.solver.tolerance = TOLERANCE;
    let inputs = Inputs::default();
    let mut simulation = Simulation::new(&scene, &inputs, 0.0).expect("the specimen");

    let force = [reference(&import, "contact.force")];
    let (mut smallest, mut largest) = (f64::INFINITY, 0.0_f64);
    for n in 0..1000 {
        let time = f64::from(n) * STEP;
        instance.do_step(time, STEP, true).expect("a step");
        simulation.step(&inputs, time, STEP).expect("a step");
        let mut value = [f64::NAN];
        instance.get_real(&force, &mut value).expect("the force");
        let expected = simulation.real(RealOutput::ContactForce);
        assert_eq!(
            value[0].to_bits(),
            expected.to_bits(),
            "{} N and {expected} N after {time} s",
            value[0]
        );
        (smallest, largest) = (smallest.min(value[0]), largest.max(value[0]));
    }
    assert!(
        largest > smallest,
        "the excitation moves nothing: {smallest} N to {largest} N"
    );
    Common::terminate(&mut instance).expect("the end");
}

#[test]
fn a_sine_given_at_the_communication_points_gives_the_forces_of_our_own_run() {
    const STEP: f64 = 1e-5;
    const TOLERANCE: f64 = 1e-7;

    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../out/conformance");
    let table = std::fs::read_to_string(folder.join("reference.csv"))
        .expect("our own runs: `cargo xtask importers` writes them and runs this test");
    let mut lines = table.lines();
    let header: Vec<_> = lines.next().expect("names").split(',').collect();
    let place = |name| header.iter().position(|column| *column == name).expect("a column");
    let columns = [place("base.acceleration"), place("run")];
    let mut rows = lines.map(|line| {
        let cells: Vec<_> = line.split(',').collect();
        columns.map(|column| cells[column].parse::<f64>().expect("a number"))
    });

    let import = import();
    let mut instance = instantiate(&import);
    instance.setup_experiment(None, 0.0, None).expect("the experiment");
    instance
        .set_real(&[reference(&import, "solver.tolerance")], &[TOLERANCE])
        .expect("the tolerance");
    Common::enter_initialization_mode(&mut instance).expect("Initialization Mode");
    Common::exit_initialization_mode(&mut instance).expect("initialised");
    let input = [reference(&import, "base.acceleration")];
    let output = [reference(&import, "contact.force")];
    let force = |instance: &mut InstanceCS| {
        let mut value = [f64::NAN];
        instance.get_real(&output, &mut value).expect("the force");
        value[0]
    };

    let [mut held, first] = rows.next().expect("the start");
    let mut difference = (force(&mut instance) - first).abs();
    let mut steps = 0;
    for (n, [next, expected]) in (0_u32..).zip(rows) {
        instance.set_real(&input, &[held]).expect("the acceleration");
        instance.do_step(f64::from(n) * STEP, STEP, true).expect("a step");
        difference = difference.max((force(&mut instance) - expected).abs());
        (held, steps) = (next, steps + 1);
    }
    assert_eq!(steps, 500);
    // The same library, handed the same numbers, gives the same numbers.
    assert_eq!(difference, 0.0);
    let row = serde_json::json!({
        "importer": "fmi (Rust)", "version": fmi::built_info::PKG_VERSION, "task": "run",
        "result": "passed", "difference": difference,
    });
    std::fs::write(folder.join("fmi, run.json"), row.to_string()).expect("a row of the table");
}

#[test]
fn refusals_arrive_as_the_status_of_the_standard() {
    let import = import();
    let mut instance = instantiate(&import);
    let length = [reference(&import, "beam.length")];
    let refused = instance.set_real(&length, &[-1.0]);
    assert!(matches!(refused, Err(Fmi2Error::Discard)), "{refused:?}");
    instance.set_real(&length, &[0.015]).expect("the instance goes on");
    let refused = instance.do_step(0.0, 1e-5, true);
    assert!(matches!(refused, Err(Fmi2Error::Error)), "{refused:?}");
    Common::reset(&mut instance).expect("a reset");
    instance.set_real(&length, &[0.015]).expect("after the reset");
}
