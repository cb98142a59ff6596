//! Each case of the list as a test of its name: `cargo test -p hard-cases --test cases stiffer`.
//! Long cases, a million contact cycles, are not part of the default run:
//! `cargo test --release -p hard-cases --test cases -- --ignored`.
//!
//! A run of all cases leaves their properties in `out/hard-cases.json`, for the report.

use std::process::ExitCode;
use std::sync::{LazyLock, Mutex};
use std::{fs, path::Path};

use hard_cases::case::{Case, Check};
use hard_cases::{CASES, LONG_CASES};
use libtest_mimic::{Arguments, Failed, Trial, run};
use serde_json::{Value, json};

/// What was measured, in the order of the list.
static MEASURED: LazyLock<Mutex<Vec<Value>>> = LazyLock::new(|| Mutex::new(vec![Value::Null; cases().count()]));

fn cases() -> impl Iterator<Item = &'static Case> {
    CASES.iter().copied().flatten()
}

fn trial(case: &'static Case) -> Trial {
    Trial::test(case.name, || match case.keeps_its_properties() {
        Ok(checks) => {
            if let Some(place) = cases().position(|known| known.name == case.name) {
                MEASURED.lock().unwrap()[place] = described(case, &checks);
            }
            Ok(())
        }
        Err(error) => Err(Failed::from(format!("{error:#}"))),
    })
}

fn described(case: &Case, checks: &[Check]) -> Value {
    let check = |check: &Check| {
        json!({
            "property": check.property,
            "measured": check.amount(check.measured),
            "allowed": check.amount(check.allowed),
            "reason": check.reason,
            // Infinite where the property holds exactly: null.
            "margin": check.margin(),
        })
    };
    let checks: Vec<_> = checks.iter().map(check).collect();
    json!({ "name": case.name, "difficulty": case.difficulty, "checks": checks })
}

fn main() -> ExitCode {
    let long = LONG_CASES.iter().map(|case| trial(case).with_ignored_flag(true));
    let conclusion = run(&Arguments::from_args(), cases().map(trial).chain(long).collect());
    let measured = MEASURED.lock().unwrap();
    if measured.iter().all(|case| !case.is_null()) {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../out");
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("hard-cases.json"), json!(*measured).to_string()).unwrap();
    }
    conclusion.exit_code()
}
