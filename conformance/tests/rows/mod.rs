//! The runs that importers are to reproduce, and the rows of the table of what they did.

use std::path::Path;

/// Columns of a table that `cargo xtask importers` wrote.
pub fn table<const N: usize>(path: &str, names: [&str; N]) -> Vec<[f64; N]> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../out/conformance")
        .join(path);
    let text =
        std::fs::read_to_string(path).expect("our own runs: `cargo xtask importers` writes them and runs this test");
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

/// Acceleration and force at each communication point of the run with the acceleration held over each step, whose
/// `solver.tolerance` is 1e-7.
pub fn held() -> Vec<[f64; 2]> {
    let rows = table("reference.csv", ["base.acceleration", "run"]);
    assert_eq!(rows.len(), 501);
    rows
}

/// The same of the published run, which has the choices `Sine` (2) of `effects.excitation` and `FromPreload` (1) of
/// `effects.axialForce`.
pub fn published() -> Vec<[f64; 2]> {
    let forces = table("scenes/paper-1khz.csv", ["contact.force"]);
    assert_eq!(forces.len(), 2001);
    forces.iter().map(|[force]| [0.0, *force]).collect()
}

/// Compares the contact force with that of the rows, and writes the row of the table of results. `advance` returns the
/// force, and does a step from a time (s) of a length (s) with an acceleration (m/s²).
pub fn compare(
    importer: &str,
    version: &str,
    task: &str,
    rows: &[[f64; 2]],
    mut advance: impl FnMut(f64, f64, f64) -> f64,
) {
    const STEP: f64 = 1e-5;

    let mut difference = 0.0_f64;
    for (n, [acceleration, expected]) in (0_u32..).zip(rows) {
        let [time, end] = [n, n + 1].map(|n| f64::from(n) * STEP);
        let force = advance(*acceleration, time, end - time);
        difference = difference.max((force - expected).abs());
    }
    // The same library, given the same numbers, gives the same numbers.
    assert_eq!(difference, 0.0);
    let row = serde_json::json!({
        "importer": importer, "version": version, "task": task, "result": "passed", "difference": difference,
    });
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../out/conformance");
    std::fs::write(folder.join(format!("{importer}, {task}.json")), row.to_string()).expect("a row of the table");
}
