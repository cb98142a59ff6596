//! Published numbers compared with those of this model.

use anyhow::Result;
use relay_contact::variables::AxialForceKind;

use super::published as paper;
use super::results::{LINEAR, Results, peak};
use super::runs::{self, elastic_force, excitation, linear_force};
use super::table::{Comparison, cells, table};
use crate::content::Block;
use crate::numbers::{number, signed};

/// The introduction.
pub fn introduction() -> Block {
    Block::Text(format!(
        "Source: Y. Zhang, C. Zhang, Y. Meng, W. Ren, *Machines* 2025, 13(1), 52, \
         [doi:10.3390/machines13010052](https://doi.org/10.3390/machines13010052): finite elements and measurements \
         of one relay contact. Values of this model are runs of the library with its start values, made when this \
         page was written.\n\n\
         The unpublished parameters were fitted to the rows marked †, which show the quality of the fit. The resistances with ratio \
         10 at 1000 Hz follow from two of them, static force and force amplitude, by the publication's own power law: they test that \
         law against the measurement, not this model. Nothing was fitted to the other rows.\n\n\
         The published stiffness coefficients beta cannot be used as they are printed (see *Findings*). Here a \
         published damping ratio means damping times of beam and contact of {} µs times the ratio, the printed \
         coefficient divided by 4 π². The mass coefficients alpha are used as printed.\n\n\
         Amplitudes are half the difference between maximum and minimum over a period, after all transients have \
         decayed. Unless stated otherwise, the axial force is that of eq. 9 at the preload.",
        number(1e6 * runs::damping_per_ratio(), 3)
    ))
}

/// Static force, stiffness, frequencies.
pub fn statics(results: &Results) -> Result<Block> {
    let (preload, frequency) = (results.specimen.preload(), results.specimen.frequency());
    let stiffness = (1e-6 * paper::STIFFNESS, 1e-6 * preload.contact_stiffness);
    let without = runs::model(&runs::spring(15.5e-3, 0.2e-3, AxialForceKind::None))?.frequency();
    let mut rows = Comparison::at("section 3.1");
    rows.row("static contact force F_0 †", paper::FORCE, preload.force, 4, "N");
    rows.row("contact stiffness k_j †", stiffness.0, stiffness.1, 4, "N/µm");
    let name = "first frequency, without prestress";
    rows.row(name, paper::WITHOUT_PRESTRESS, without, 1, "Hz");
    rows.then_at("section 3.1, Fig. 4");
    let name = "first frequency, with prestress †";
    rows.row(name, paper::WITH_PRESTRESS, frequency, 1, "Hz");
    rows.then_at("section 3.1, Fig. 5");
    for (length, overtravel, frequency) in paper::SHORT {
        let spring = runs::spring(1e-3 * length, 1e-3 * overtravel, AxialForceKind::FromPreload);
        let name = format!("first frequency, L = {length} mm, s = {overtravel} mm, with prestress");
        rows.row(&name, frequency, runs::model(&spring)?.frequency(), 1, "Hz");
    }
    Ok(rows.table("Static contact and first frequency; prestress is the axial force of eq. 9"))
}

/// The time domain.
pub fn time_domain(results: &Results) -> Result<Block> {
    let run = results.at(paper::BEST, 1000.0)?;
    let displacement = 1e6 * run.displacement;
    let mut rows = Comparison::at("section 3.2, Fig. 6");
    let name = "force amplitude, 1000 Hz, ratio 10 †";
    rows.row(name, paper::FORCE_AMPLITUDE, run.amplitude(), 3, "cN");
    let name = "phase between force and displacement, 1000 Hz, ratio 10";
    rows.difference(name, paper::PHASE, run.phase, 1, "°");
    let name = "displacement amplitude of the contact, 1000 Hz, ratio 10, relative to that of the base";
    let relative = displacement / (1e6 * excitation(1000.0));
    rows.row(name, paper::DISPLACEMENT_RATIO, relative, 3, "");
    rows.then_at("section 3.2, Fig. 7");
    for (ratio, at, published) in paper::PEAKS {
        let runs = results.ratio(ratio)?;
        let (found, highest) = peak(runs.iter().map(|run| (run.frequency, run.amplitude())));
        let name = format!("maximum force amplitude, ratio {ratio}");
        rows.row(&name, published, highest, 2, "cN");
        let name = format!("frequency of the maximum in the grid, ratio {ratio}");
        rows.difference(&name, at, found, 0, "Hz");
    }
    Ok(rows.table("Time domain, 98 m/s² (the grid has steps of 250 Hz)"))
}

/// The whole excitation grid.
pub fn grid(results: &Results) -> Result<Block> {
    let mut rows = Vec::new();
    for frequency in paper::FREQUENCIES {
        let mut cells = vec![format!("{frequency} Hz")];
        for ratio in paper::RATIOS {
            let run = results.at(ratio, frequency)?;
            cells.push(if run.opens || !run.repeats {
                "opens".to_owned()
            } else {
                number(run.amplitude(), 3)
            });
        }
        rows.push(cells);
    }
    let ratios = paper::RATIOS.map(|ratio| format!("ratio {ratio}"));
    let columns: Vec<_> = ["frequency".to_owned()].into_iter().chain(ratios).collect();
    Ok(table(
        "Force amplitude of this model in cN over the published excitation grid; the published figure gives numbers \
         only for the peaks above",
        &columns,
        rows,
    ))
}

/// The frequency domain.
pub fn frequency_domain(results: &Results) -> Result<Block> {
    let mut rows = Comparison::at("section 3.2, Fig. 9");
    for (alpha, at, published) in paper::FREQUENCY_DOMAIN_PEAKS {
        let (found, highest) = peak(results.linear(alpha)?.into_iter());
        let name = format!("maximum force amplitude, alpha = {alpha} 1/s");
        rows.row(&name, published, highest, 2, "cN");
        let name = format!("frequency of the maximum, alpha = {alpha} 1/s");
        rows.difference(&name, at, found, 0, "Hz");
    }
    Ok(rows.table(&format!(
        "Frequency domain, 98 m/s², mass damping only, in steps of {} Hz",
        LINEAR.1
    )))
}

/// Frequency domain compared with time domain.
pub fn domains(results: &Results) -> Result<Block> {
    let mut rows = Vec::new();
    for (ratio, alpha, published) in paper::EQUIVALENT {
        let (model, damped) = (results.alpha(alpha)?, runs::model(&runs::specimen(ratio))?);
        let mut scene = runs::specimen(ratio);
        scene.contact.damping = 0.0;
        let beam = runs::model(&scene)?;
        let whole = |f: f64| Ok::<_, anyhow::Error>(results.at(ratio, f)?.amplitude());
        let beam = |f: f64| Ok(linear_force(&beam, f));
        let elastic = |f: f64| Ok(elastic_force(&damped, f));
        let worst = |time: &dyn Fn(f64) -> Result<f64>, highest: f64| {
            let grid = paper::FREQUENCIES.into_iter().filter(|f| *f <= highest);
            grid.map(|f| Ok((linear_force(model, f) / time(f)? - 1.0).abs()))
                .try_fold(0.0_f64, |worst, deviation: Result<f64>| {
                    Ok::<_, anyhow::Error>(worst.max(deviation?))
                })
        };
        let cell = |value: f64| format!("{} %", number(100.0 * value, 1));
        rows.push(cells(&[
            &format!("alpha = {alpha} 1/s and ratio {ratio}"),
            published.unwrap_or("not stated"),
            &cell(worst(&whole, 2000.0)?),
            &cell(worst(&beam, 2000.0)?),
            &cell(worst(&elastic, 2000.0)?),
            &cell(worst(&elastic, 1500.0)?),
        ]));
    }
    let columns = [
        "damping",
        "published (section 4.2, Fig. 19)",
        "this model",
        "this model, without contact damping",
        "this model, elastic part",
        "elastic part, up to 1500 Hz",
    ];
    Ok(table(
        "Largest deviation of the force amplitude between frequency and time domain over the grid, 250 to 2000 Hz; \
         the elastic part is the contact force without what the damping of the contact carries of it",
        &columns,
        rows,
    ))
}

/// Displacement amplitudes over the damping ratio.
pub fn displacements(results: &Results) -> Result<Block> {
    let mut rows = Comparison::at("Table 4");
    for (ratio, published) in paper::RATIOS.into_iter().zip(paper::DISPLACEMENTS) {
        let value = 1e6 * results.at(ratio, 1000.0)?.displacement;
        let name = format!("displacement amplitude, 1000 Hz, ratio {ratio}");
        rows.row(&name, published, value, 3, "µm");
    }
    rows.then_at("section 4.2, Fig. 14");
    let value = 1e6 * results.at(paper::BEST, 1000.0)?.displacement;
    let name = "measured amplitude, compared with ratio 10";
    rows.row(name, paper::MEASURED_DISPLACEMENT, value, 3, "µm");
    rows.then_at("section 3.2, Fig. 8");
    for (ratio, published) in paper::DISPLACEMENT_DEVIATIONS {
        let value = 100.0 * (results.at(ratio, 1250.0)?.displacement / excitation(1250.0) - 1.0);
        let name = format!("displacement amplitude in excess of the base, 1250 Hz, ratio {ratio}");
        let texts = [format!("{published} %"), format!("{} %", number(value, 2))];
        rows.texts(&name, texts, &format!("{} points", signed(value - published, 1)));
    }
    Ok(rows.table("Displacement of the contact, base included, 98 m/s²"))
}
