//! Hard cases, run now: what makes each hard, the property it has to keep, and by how much it does.
//!
//! [`energy`]: none is made, and blows give back what they should;   [`instants`]: openings and closings do not depend on the
//! communication step, and none is missed;   [`balance`]: forces that are known from statics or in closed form.
//!
//! Allowed is what theory leaves: a contact force wrong by the tolerance makes at most that force times the way of the tip in
//! energy, and two runs within the tolerance differ by at most twice that.

mod balance;
mod energy;
mod instants;

use std::fmt::Write;

use anyhow::{Result, bail};
use testing::rig as common;

use super::Arguments;
use super::content::{Block, Section, Table};
use crate::threads;

/// A property and what became of it.
#[derive(Debug)]
struct Check {
    case: &'static str,
    /// What makes it hard.
    hard: String,
    property: &'static str,
    /// What was measured, at most what is allowed where the property is kept.
    measured: f64,
    allowed: f64,
    unit: &'static str,
}

impl Check {
    /// False also for what is not a number.
    fn is_kept(&self) -> bool {
        self.measured <= self.allowed
    }

    /// How many times less than what is allowed was measured; infinite where the property is kept exactly.
    fn margin(&self) -> f64 {
        if self.measured == 0.0 {
            f64::INFINITY
        } else {
            self.allowed / self.measured
        }
    }

    fn row(&self) -> Vec<String> {
        let amount = |value: f64| match (value, self.unit) {
            (0.0, unit) => format!("0 {unit}"),
            (value, unit) => format!("{value:.1e} {unit}"),
        };
        vec![
            self.case.to_owned(),
            self.hard.clone(),
            self.property.to_owned(),
            amount(self.measured).trim_end().to_owned(),
            amount(self.allowed).trim_end().to_owned(),
            match self.margin() {
                f64::INFINITY => "exact".to_owned(),
                margin => format!("{margin:.1e}"),
            },
        ]
    }
}

type Case = fn(quick: bool) -> Result<Vec<Check>>;

const CASES: &[&[Case]] = &[energy::CASES, instants::CASES, balance::CASES];

/// The section; an error where a property is not kept.
pub fn sections(arguments: Arguments) -> Result<Vec<Section>> {
    let checks = run(arguments.quick)?;
    let least = checks.iter().map(Check::margin).fold(f64::INFINITY, f64::min);
    let text = format!(
        "{} properties of physics in scenes that break integrators, measured in this run; the report is not written where one is \
         not kept. Margin: how many times smaller the measured value is than what theory allows at the tolerance asked. \
         Balances of energy are the component's own where they are *in = stored + dissipated* (`tests/energy_balance.rs` checks them \
         from outside), else reckoned outside of it. `cargo test --test hard_cases` has more cases, `docs/robustness.md` \
         what wrong calls do.",
        checks.len(),
    );
    let columns = [
        "case",
        "what makes it hard",
        "property kept",
        "measured",
        "allowed",
        "margin",
    ];
    let table = Table {
        caption: "Tolerance 1e-6 of the preload force where nothing else is said.".to_owned(),
        columns: columns.map(str::to_owned).to_vec(),
        rows: rows(&checks),
    };
    Ok(vec![Section {
        id: "stability",
        title: "Hard cases",
        lead: format!(
            "{} properties of physics are kept in scenes that break integrators, the closest with a margin of {least:.0} times.",
            checks.len()
        ),
        blocks: vec![Block::Text(text), Block::Table(table)],
    }])
}

/// What is said once of a case is not repeated.
fn rows(checks: &[Check]) -> Vec<Vec<String>> {
    let mut last = "";
    let row = |check: &Check| {
        let mut row = check.row();
        if check.case == last {
            row.iter_mut().take(2).for_each(String::clear);
        }
        last = check.case;
        row
    };
    checks.iter().map(row).collect()
}

fn run(quick: bool) -> Result<Vec<Check>> {
    let cases: Vec<Case> = CASES.iter().flat_map(|cases| cases.iter().copied()).collect();
    let checks: Vec<Check> = threads::map(&cases, |case| case(quick))?
        .into_iter()
        .flatten()
        .collect();
    let mut broken = String::new();
    for check in checks.iter().filter(|check| !check.is_kept()) {
        let _ = write!(broken, "\n{}", check.row().join(" | "));
    }
    if !broken.is_empty() {
        bail!("hard cases: not kept{broken}");
    }
    Ok(checks)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_property_is_kept() -> Result<()> {
        let checks = run(true)?;
        for check in &checks {
            println!("{}", check.row().join(" | "));
        }
        assert!(checks.len() >= 15, "{}", checks.len());
        Ok(())
    }

    #[test]
    fn what_is_no_number_or_too_much_is_not_kept() {
        let check = |measured| Check {
            case: "",
            hard: String::new(),
            property: "",
            measured,
            allowed: 1e-9,
            unit: "s",
        };
        assert!(check(0.0).is_kept() && check(1e-9).is_kept());
        assert!(!check(1.1e-9).is_kept() && !check(f64::NAN).is_kept());
    }
}
