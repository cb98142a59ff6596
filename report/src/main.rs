//! The report, the cost of each effect, runs of scenes: what `cargo xtask report`, `effects`, `scene` and others start.
//!
//! [`content`]: sections, tables, figures;   [`page`]: the HTML page made of them, [`markdown`]: the same as Markdown;
//! [`numbers`]: numbers in words.   Sections of the report:   [`opening`]: whether the contact opens;   [`paper`]: the published
//! results beside ours;   [`accuracy`], [`effects`]: what accuracy and effects cost;   [`stability`]: hard cases and the property
//! each keeps;   [`importers`]: other people's importers.   [`documentation`]: the page inside the component;   [`scene`]:
//! runs of scene files.

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
    /// Run what the report shows and write out/report/index.html
    Report(Arguments),
    /// Measure what each effect costs and changes; rewrite docs/effects.md
    Effects(effects::Arguments),
    /// Run a scene, write what it looks at to out/scenes/NAME.csv and .png, and tell what happened
    Scene(scene::Arguments),
    /// Write each scene as a parameter set for SSP tools, out/ssv/NAME.ssv
    Ssv,
    /// Measure what accuracy costs, beside other integrators; rewrite docs/accuracy.csv, its figures and its tables
    Accuracy(accuracy::study::Arguments),
    /// Count the instructions of a communication step, through C and in the library alone (needs valgrind)
    Instructions,
    /// Write the runs that importers are compared with
    ReferenceRuns,
    /// Print the table of what the importers did
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
