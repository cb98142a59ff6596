//! Identifies width, thickness, camber radius, rivet mass and damping of the specimen from published results; prints their
//! sensitivities and their differences from the start values of the parameters.
//!
//! `cargo run --release --example identify`

use identify::{Amplitude, Error, PARAMETERS, Published, SOURCES, Specimen, precision, sensitivities};
use relay_contact::scene::Scene;

fn main() -> Result<(), Error> {
    println!("Published (Zhang, Zhang, Meng, Ren, Machines 2025, 13(1), 52)");
    for source in SOURCES {
        println!(
            "  {:28} {:>10} {:5} {}",
            source.name, source.value, source.unit, source.place
        );
    }
    let found = Specimen::identify(&Published::default())?;
    let start = Specimen::of(&Scene::default());
    println!("\nIdentified, and the start value of the parameter");
    for ((parameter, found), start) in PARAMETERS.iter().zip(found.values).zip(start.values) {
        println!(
            "  {:4} {:22} {found:12.6} {:5} start value {start:12.6}, {:+.4} %   from {}",
            parameter.symbol,
            parameter.name,
            parameter.unit,
            100.0 * (start / found - 1.0),
            parameter.from
        );
    }
    let elastic = Published {
        amplitude: Amplitude::Elastic,
        ..Published::default()
    };
    println!("\nIf the published force amplitude is that of the elastic part of the contact force");
    for ((parameter, found), value) in PARAMETERS
        .iter()
        .zip(found.values)
        .zip(Specimen::identify(&elastic)?.values)
    {
        let changed = 100.0 * (value / found - 1.0);
        println!(
            "  {:4} {value:12.6} {:5} {changed:+.2} %",
            parameter.symbol, parameter.unit
        );
    }
    println!("\nChange in % for a published result higher by 1 %, linearised");
    let names = PARAMETERS.map(|parameter| format!("{:>12}", parameter.symbol)).concat();
    println!("  {:28}{names}", "");
    for (source, row) in SOURCES.iter().zip(sensitivities()?) {
        let cells = row.map(|slope| format!("{slope:+12.3}")).concat();
        println!("  {:28}{cells}", source.name);
    }
    println!("\nUncertainty in % due to the rounding of a published result: half a unit in its last digit");
    println!("  {:28}{names}", "");
    for (source, row) in SOURCES.iter().zip(precision()?) {
        let cells = row.map(|percent| format!("{percent:12.4}")).concat();
        println!("  {:28}{cells}", source.name);
    }
    Ok(())
}
