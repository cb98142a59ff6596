//! Each case of the list as a test of its name: `cargo test -p hard-cases --test cases stiffer`.
//! Long cases, a million contact cycles, are not part of the default run:
//! `cargo test --release -p hard-cases --test cases -- --ignored`.

use std::process::ExitCode;

use hard_cases::case::Case;
use hard_cases::{CASES, LONG_CASES};
use libtest_mimic::{Arguments, Failed, Trial, run};

fn trial(case: &'static Case) -> Trial {
    Trial::test(case.name, || match case.keeps_its_properties() {
        Ok(_) => Ok(()),
        Err(error) => Err(Failed::from(format!("{error:#}"))),
    })
}

fn main() -> ExitCode {
    let long = LONG_CASES.iter().map(|case| trial(case).with_ignored_flag(true));
    let trials = CASES.iter().copied().flatten().map(trial).chain(long).collect();
    run(&Arguments::from_args(), trials).exit_code()
}
