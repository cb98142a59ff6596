//! Each case of the list as a test of its name: `cargo test -p hard-cases --test cases stiffer`.
//!
//! Long ones, a million contact cycles, are left out of the default run:
//! `cargo test --release -p hard-cases --test cases -- --ignored`.

use std::process::ExitCode;

use hard_cases::CASES;
use hard_cases::case::Case;
use libtest_mimic::{Arguments, Failed, Trial, run};

fn main() -> ExitCode {
    let trial = |case: &'static Case| {
        let test = move || match case.keeps_its_properties() {
            Ok(_) => Ok(()),
            Err(error) => Err(Failed::from(format!("{error:#}"))),
        };
        Trial::test(case.name, test).with_ignored_flag(case.long)
    };
    let trials = CASES.iter().copied().flatten().map(trial).collect();
    run(&Arguments::from_args(), trials).exit_code()
}
