//! The project's tasks: `cargo xtask --help`.

mod bill;
mod commands;
mod documentation;
mod explore;
mod fmu;
mod importers;
mod licences;
mod linked;
mod package;
mod python;
mod reference;
mod release;
mod report;
mod site;
mod test;
mod valgrind;
mod variant;
mod wheel;

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use clap::{Parser, Subcommand};

use self::variant::Variant;

#[derive(Parser)]
#[command(bin_name = "cargo xtask", about = "Tasks of relay-contact", arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Build the component and pack it as dist/RelayContact.fmu
    Fmu {
        /// As dist/RelayContact-plain.fmu, with Reals in place of enumerations, integers and Booleans, for tools that lack those
        #[arg(long)]
        plain: bool,
        /// Carrying this spring file (TOML), which is then the start value of beam.file, as dist/RelayContact-NAME.fmu
        #[arg(long, value_name = "FILE")]
        spring: Option<PathBuf>,
    },
    /// Build the component and the Python package that carries it, dist/relay_contact-VERSION-py3-none-PLATFORM.whl
    Wheel,
    /// Build the page that runs the simulation in a browser, dist/explore.html, and test it
    Explore,
    /// Build the documentation site, out/site/html/index.html
    Docs,
    /// Build the component, run the published 1 kHz case under FMPy, compare and plot
    Demo,
    /// Measure time over accuracy, compared with other integrators; rewrite tables and figures of docs/accuracy.md
    Accuracy {
        /// Few settings, into out/accuracy alone
        #[arg(long)]
        quick: bool,
    },
    /// Measure the cost and influence of each effect; rewrite docs/effects.md
    Effects,
    /// Run everything shown in the report; write out/report/index.html, docs/validation.md and pictures of docs/report
    Report {
        /// Fewer points and runs, all into out/report-quick: to see that everything works
        #[arg(long)]
        quick: bool,
        /// Before, fit the contact to the published numbers anew
        #[arg(long)]
        fit: bool,
    },
    /// Test the component in other importers and print the table of results
    Importers,
    /// Check calls as from importers for memory errors and leaks, under valgrind
    Valgrind,
    /// Count the instructions of a communication step, through C and in Rust (needs valgrind)
    Instructions,
    /// Build the component for all platforms and pack it as dist/release/RelayContact.fmu
    Release(release::Arguments),
    /// Run every check and test
    Test(test::Arguments),
}

fn main() -> ExitCode {
    let outcome = match Arguments::parse().task {
        Task::Fmu { plain, spring } => {
            let built = Variant::new(plain, spring.as_deref()).and_then(|variant| fmu::build_variant(&variant));
            built.map(|path| println!("{}", path.display()))
        }
        Task::Wheel => wheel::run(),
        Task::Explore => explore::run_task(),
        Task::Docs => site::run(),
        Task::Demo => demo(),
        Task::Accuracy { quick } => report::accuracy(quick),
        Task::Effects => report::with_component("effects"),
        Task::Report { quick, fit } => report::run(quick, fit),
        Task::Importers => importers::run(),
        Task::Valgrind => valgrind::run(),
        Task::Instructions => python::prepare().and_then(|()| python::report(&["instructions"])),
        Task::Release(arguments) => release::run(&arguments),
        Task::Test(arguments) => test::run(arguments),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error:#}");
            ExitCode::FAILURE
        }
    }
}

/// The published 1 kHz case in FMPy, including all preparation.
fn demo() -> Result<()> {
    // Python first, so that missing programs are reported before the build.
    python::prepare()?;
    let path = fmu::build()?;
    let mut python = commands::python();
    commands::run(python.args(["examples/python/paper_1khz.py", "--fmu"]).arg(path))
}
