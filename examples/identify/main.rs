//! How width, thickness, camber radius, rivet mass and damping of the specimen follow from published results, how strongly
//! each depends on each, and how far the start values of the parameters are from them.
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
    println!("\nIdentified, beside the start value of the parameter");
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
    println!("\nThe same, if the published force amplitude is that of the elastic part of the contact force");
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
    let slopes = sensitivities()?;
    println!("\nChange in % where a published result changes by 1 % (small changes)");
    let names = PARAMETERS.map(|parameter| format!("{:>12}", parameter.symbol)).concat();
    println!("  {:28}{names}", "");
    for (source, row) in SOURCES.iter().zip(slopes.iter().copied()) {
        let cells = row.map(|slope| format!("{slope:+12.3}")).concat();
        println!("  {:28}{cells}", source.name);
    }
    println!("\nThe same as derivatives, parameter per published result in their units");
    for (source, row) in SOURCES.iter().zip(&slopes) {
        for ((parameter, slope), value) in PARAMETERS.iter().zip(row).zip(found.values) {
            if slope.abs() > 1e-6 {
                let derivative = slope * value / source.value;
                println!(
                    "  d {} / d {} = {derivative:.4e} {} per {}",
                    parameter.name, source.name, parameter.unit, source.unit
                );
            }
        }
    }
    println!("\nUncertain by, in %, because a published result is rounded to its last digit (half of it, up or down)");
    println!("  {:28}{names}", "");
    for (source, row) in SOURCES.iter().zip(precision()?) {
        let cells = row.map(|percent| format!("{percent:12.4}")).concat();
        println!("  {:28}{cells}", source.name);
    }
    Ok(())
}
