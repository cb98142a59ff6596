//! Hard cases, run now: what makes each hard, the properties it has to keep, and by how much it does.

use anyhow::{Result, bail};
use hard_cases::CASES;
use hard_cases::case::{Case, Check};

use crate::content::{Arguments, Block, Section, Table};
use rayon::prelude::*;

/// The section; an error where a property is not kept.
pub fn sections(_: Arguments) -> Result<Vec<Section>> {
    let cases: Vec<&Case> = CASES.iter().copied().flatten().collect();
    let checks: Vec<_> = cases.par_iter().map(|case| case.keeps_its_properties()).collect();
    let mut broken = Vec::new();
    let mut kept = Vec::new();
    for (case, checks) in cases.iter().zip(checks) {
        match checks {
            Ok(checks) => kept.push((*case, checks)),
            Err(error) => broken.push(format!("{error:#}")),
        }
    }
    if !broken.is_empty() {
        bail!("hard cases:\n{}", broken.join("\n"));
    }
    let margins = kept.iter().flat_map(|(_, checks)| checks).map(Check::margin);
    let (count, least) = margins.fold((0, f64::INFINITY), |(count, least), margin| {
        (count + 1, least.min(margin))
    });
    let text = format!(
        "{count} properties in {} scenes that break integrators, measured in this run; the report is not written where one is \
         not kept. Margin: how many times smaller the measured value is than what is allowed. Where the force is compared between \
         communication steps, three numbers of them are simulated, and in each the contact never pulls at a communication point \
         (bonded contacts excepted), every number stays finite, and the work is bounded. Balances of energy are the component's own where they are *in = stored + dissipated* \
         (`tests/energy_balance.rs` checks them from outside), else computed outside of it. `cargo test -p hard-cases` runs the \
         same cases and random scenes, `docs/robustness.md` tells what wrong calls do.",
        kept.len(),
    );
    let columns = [
        "case",
        "what makes it hard",
        "property kept",
        "measured",
        "allowed",
        "because",
        "margin",
    ];
    let table = Table {
        caption: "Tolerance 1e-6 of the preload force where nothing else is said.".to_owned(),
        columns: columns.map(str::to_owned).to_vec(),
        rows: kept.iter().flat_map(|(case, checks)| rows(case, checks)).collect(),
    };
    Ok(vec![Section {
        id: "stability",
        title: "Hard cases",
        lead: format!(
            "{count} properties are kept in {} scenes that break integrators, the closest with a margin of {least:.1} times.",
            kept.len()
        ),
        blocks: vec![Block::Text(text), Block::Table(table)],
    }])
}

/// The case is named in the first row only.
fn rows(case: &Case, checks: &[Check]) -> Vec<Vec<String>> {
    let row = |(index, check): (usize, &Check)| {
        let name = if index == 0 {
            [case.name, case.difficulty]
        } else {
            [""; 2]
        };
        let margin = match check.margin() {
            f64::INFINITY => "exact".to_owned(),
            margin => format!("{margin:.1e}"),
        };
        let [measured, allowed] = [check.measured, check.allowed].map(|value| check.amount(value));
        let [name, difficulty] = name.map(str::to_owned);
        let (property, reason) = (check.property.to_owned(), check.reason.to_owned());
        vec![name, difficulty, property, measured, allowed, reason, margin]
    };
    checks.iter().enumerate().map(row).collect()
}
