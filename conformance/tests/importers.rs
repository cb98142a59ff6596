//! The packaged component, loaded and run by two importers in Rust: the crates `fmi` and `fmi-rs`.

use std::path::PathBuf;

use fmi::fmi2::import::Fmi2Import;
use fmi::fmi2::instance::{CoSimulation, Common};
use fmi::traits::FmiImport;
use fmi_rs::fmi2::builder::FMU2Builder;
use fmi_rs::fmi2::types::{fmi2Status, fmi2True};

/// A run to reproduce.
struct Run {
    task: &'static str,
    /// Parameters other than at the start.
    reals: &'static [(&'static str, f64)],
    choices: &'static [(&'static str, i32)],
    /// Acceleration and contact force at each communication point.
    rows: Vec<[f64; 2]>,
}

/// That with the acceleration held over each step, and the published one, with a sine and an axial force from the preload.
fn runs() -> [Run; 2] {
    let [held, published] =
        [("reference.csv", ["base.acceleration", "run"]), ("scenes/paper-1khz.csv", ["time", "contact.force"])]
            .map(|(path, names)| table(path, names));
    assert_eq!([held.len(), published.len()], [501, 2001]);
    [
        Run { task: "run", reals: &[("solver.tolerance", 1e-7)], choices: &[], rows: held },
        Run {
            task: "published run",
            reals: &[],
            choices: &[("effects.excitation", 2), ("effects.axialForce", 1)],
            rows: published.into_iter().map(|[_, force]| [0.0, force]).collect(),
        },
    ]
}

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../out/conformance")
}

/// Columns of a table that `cargo xtask importers` wrote.
fn table<const N: usize>(path: &str, names: [&str; N]) -> Vec<[f64; N]> {
    let text = std::fs::read_to_string(folder().join(path))
        .expect("our own runs: `cargo xtask importers` writes them and runs this test");
    let mut lines = text.lines();
    let header: Vec<_> = lines.next().expect("names").split(',').collect();
    let columns = names.map(|name| header.iter().position(|column| *column == name).expect("a column"));
    lines
        .map(|line| {
            let cells: Vec<_> = line.split(',').collect();
            columns.map(|column| cells[column].parse().expect("a number"))
        })
        .collect()
}

impl Run {
    /// Compares the contact force with that of the rows, and writes the row of the table of results. `advance` returns the
    /// force, and does a step from a time (s) of a length (s) with an acceleration (m/s²).
    fn compare(&self, importer: &str, version: &str, mut advance: impl FnMut(f64, f64, f64) -> f64) {
        const STEP: f64 = 1e-5;

        let task = self.task;
        for (n, [acceleration, expected]) in (0_u32..).zip(&self.rows) {
            let [time, end] = [n, n + 1].map(|n| f64::from(n) * STEP);
            // The same library, given the same numbers, gives the same numbers.
            assert_eq!(advance(*acceleration, time, end - time), *expected, "at {end} s");
        }
        let row = serde_json::json!({
            "importer": importer, "version": version, "task": task, "result": "passed", "difference": 0.0,
        });
        let path = folder().join(format!("{importer}, {task}.json"));
        std::fs::write(path, row.to_string()).expect("a row of the table");
    }
}

fn path() -> String {
    std::env::var("RELAY_CONTACT_FMU").expect("RELAY_CONTACT_FMU, the component: run `cargo xtask importers`")
}

fn import() -> Fmi2Import {
    let path = path();
    fmi::import::from_path(&path)
        .unwrap_or_else(|error| panic!("{path}: {error}; `cargo xtask fmu` makes the file anew"))
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
    let instance = import.instantiate_cs("conformance", false, false).expect("an instance");
    assert_eq!(Common::get_version(&instance), "2.0");
    assert_eq!(instance.get_types_platform(), "default");
}

#[test]
fn fmi_gives_the_forces_of_our_own_runs() {
    let import = import();
    let variables = &import.model_description().model_variables.variables;
    let reference = |name: &str| {
        let variable = variables.iter().find(|variable| variable.name == name);
        variable.expect("the variable").value_reference
    };
    let (input, output) = (reference("base.acceleration"), reference("contact.force"));
    for run in runs() {
        let mut instance = import.instantiate_cs("conformance", false, false).expect("an instance");
        instance.setup_experiment(None, 0.0, None).expect("the experiment");
        for (name, value) in run.reals {
            instance.set_real(&[reference(name)], &[*value]).expect(name);
        }
        for (name, choice) in run.choices {
            instance.set_integer(&[reference(name)], &[*choice]).expect(name);
        }
        Common::enter_initialization_mode(&mut instance).expect("Initialization Mode");
        Common::exit_initialization_mode(&mut instance).expect("initialised");
        let version = fmi::built_info::PKG_VERSION;
        run.compare("fmi (Rust)", version, |acceleration, time, length| {
            let mut force = [f64::NAN];
            instance.get_real(&[output], &mut force).expect("the force");
            instance.set_real(&[input], &[acceleration]).expect("the acceleration");
            instance.do_step(time, length, true).expect("a step");
            force[0]
        });
        Common::terminate(&mut instance).expect("the end");
    }
}

#[test]
fn fmi_rs_gives_the_forces_of_our_own_runs() {
    // Reads and validates the description.
    let builder = FMU2Builder::new(&path()).expect("a component");
    let variables = &builder.model_description.modelVariables;
    let reference = |name: &str| {
        let variable = variables.iter().find(|variable| variable.name == name);
        variable.expect("the variable").valueReference
    };
    let (input, output) = (reference("base.acceleration"), reference("contact.force"));
    let ok = |status| assert_eq!(status, fmi2Status::Ok);
    // The crate does not tell its version: that of the lock file.
    let lock = include_str!("../../Cargo.lock");
    let (_, after) = lock.split_once("name = \"fmi-rs\"\nversion = \"").expect("locked");
    let version = after.split('"').next().expect("a version");
    for run in runs() {
        let instance = builder.instantiate_cs("conformance").expect("an instance");
        ok(instance.setupExperiment(None, 0.0, None));
        for (name, value) in run.reals {
            ok(instance.setReal(&[reference(name)], &[*value]));
        }
        for (name, choice) in run.choices {
            ok(instance.setInteger(&[reference(name)], &[*choice]));
        }
        ok(instance.enterInitializationMode());
        ok(instance.exitInitializationMode());
        run.compare("fmi-rs (Rust)", version, |acceleration, time, length| {
            let mut force = [f64::NAN];
            ok(instance.getReal(&[output], &mut force));
            ok(instance.setReal(&[input], &[acceleration]));
            ok(instance.doStep(time, length, fmi2True));
            force[0]
        });
        ok(instance.terminate());
    }
}
