//! Hard cases: what makes each hard, the properties that it must keep, and with which margin it keeps them.

use anyhow::{Result, bail};
use hard_cases::CASES;
use hard_cases::case::{Case, Check};

use crate::content::{Arguments, Block, Section, Table};
use rayon::prelude::*;

/// The section; an error if a property is violated.
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
        "{count} properties in {} scenes that are hard for integrators, measured in this run; if one is violated, no report is written. \
         Margin: allowed value divided by the measured one. Where results are compared between communication steps, three lengths of \
         step are simulated; in each of them the contact force at communication points is never tensile (except for bonded contacts), \
         all numbers are finite and the work is bounded. An energy balance *in = stored + dissipated* is that of the component itself \
         (`tests/energy_balance.rs` checks it independently), others are computed independently of it. `cargo test -p hard-cases` runs \
         the same cases and random scenes; for wrong calls see `docs/robustness.md`.",
        kept.len(),
    );
    let columns = [
        "case",
        "what makes it hard",
        "property kept",
        "measured",
        "allowed",
        "reason",
        "margin",
    ];
    let table = Table {
        caption: "Tolerance 1e-6 of the preload force unless stated otherwise.".to_owned(),
        columns: columns.map(str::to_owned).to_vec(),
        rows: kept.iter().flat_map(|(case, checks)| rows(case, checks)).collect(),
    };
    Ok(vec![Section {
        id: "stability",
        title: "Hard cases",
        lead: format!(
            "{count} properties are kept in {} scenes that are hard for integrators; the smallest margin is {least:.1}.",
            kept.len()
        ),
        blocks: vec![Block::Text(text), Block::Table(table)],
    }])
}

/// Name and difficulty are in the first row only.
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
