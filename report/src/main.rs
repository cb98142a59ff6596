//! The report, the cost of each effect, and runs of scenes: started by `cargo xtask report`, `effects`, `scene` and others.
//!
//! [`content`]: sections, tables and figures;   [`page`]: the HTML page made of them;   [`markdown`]: the same as Markdown, and
//! pages of `docs/` read;   [`numbers`]: formatting of numbers.   Sections of the report, listed in [`sections`]: [`opening`]:
//! whether the contact opens;   [`accuracy`], [`effects`]: what accuracy and effects cost;   [`importers`]: the component in
//! importers of others;   [`paper`]: comparison with the publication;   [`stability`]: hard cases and the property that each
//! keeps.   [`scene`]: runs of scene files.

mod accuracy;
mod content;
mod effects;
mod importers;
mod markdown;
mod numbers;
mod opening;
mod page;
mod paper;
mod scene;
mod sections;
mod stability;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use content::Arguments;

#[derive(Parser)]
#[command(name = "report", bin_name = "cargo xtask", arg_required_else_help = true)]
struct CommandLine {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Run everything that the report shows and write out/report/index.html
    Report(Arguments),
    /// Measure the cost and influence of each effect; rewrite docs/effects.md
    Effects(effects::Arguments),
    /// Run a scene, write its outputs to out/scenes/NAME.csv and .png, and print a summary
    Scene(scene::Arguments),
    /// Write each scene as a parameter set for SSP tools, out/ssv/NAME.ssv
    Ssv,
    /// Measure time over accuracy, compared with other integrators; rewrite docs/accuracy.csv and the tables of accuracy.md
    Accuracy(accuracy::study::Arguments),
    /// Count the instructions of a communication step, through C and in Rust (needs valgrind)
    Instructions,
    /// Write the reference runs that importers are compared with
    ReferenceRuns,
    /// Print the results of the importers
    Importers,
}

fn main() -> ExitCode {
    let outcome = match CommandLine::parse().task {
        Task::Report(arguments) => sections::run(arguments),
        Task::Effects(arguments) => effects::run(&arguments),
        Task::Scene(arguments) => scene::run(&arguments),
        Task::Ssv => scene::ssv::write(),
        Task::Accuracy(arguments) => accuracy::study::run(&arguments),
        Task::Instructions => effects::instructions(),
        Task::ReferenceRuns => importers::reference::write(),
        Task::Importers => importers::print(),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error:#}");
            ExitCode::FAILURE
        }
    }
}
