//! The component beside general integrators, as the tables of `docs/accuracy.md`: `cargo bench --package benches --bench peers`.

use anyhow::Result;
use benches::{plan, scenes, study, table};

fn main() -> Result<()> {
    let mut cases = Vec::new();
    for problem in scenes::all()? {
        cases.extend(plan::peers(&problem, false)?);
    }
    print!("{}", table::report(&study::run(&cases, 5)));
    Ok(())
}
