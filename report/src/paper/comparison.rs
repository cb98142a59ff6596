//! Published numbers compared with those of this model.

use anyhow::Result;
use relay_contact::variables::AxialForceKind;

use super::published as paper;
use super::results::{Results, peak};
use super::runs::{self, elastic_force, excitation, linear_force};
use super::table::{cells, comparison, difference, row, table};
use crate::content::Block;
use crate::numbers::{number, signed};

const FIT: &str = " †";

/// The introduction.
pub fn introduction() -> Block {
    Block::Text(format!(
        "Source: Y. Zhang, C. Zhang, Y. Meng, W. Ren, *Machines* 2025, 13(1), 52, \
         [doi:10.3390/machines13010052](https://doi.org/10.3390/machines13010052): finite elements and measurements \
         of one relay contact. Values of this model are runs of the library with its start values, made when this \
         page was written.\n\n\
         The unpublished parameters were fitted to the rows marked †: these show the quality of the fit. All other \
         rows are predictions.\n\n\
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
    let model = &results.specimen;
    let without = runs::model(&runs::spring(15.5e-3, 0.2e-3, AxialForceKind::None))?;
    let mut rows = vec![
        row(
            &format!("static contact force F_0{FIT}"),
            paper::FORCE,
            model.preload().force,
            4,
            "N",
            "section 3.1",
        ),
        row(
            &format!("contact stiffness k_j{FIT}"),
            1e-6 * paper::STIFFNESS,
            1e-6 * model.preload().contact_stiffness,
            4,
            "N/µm",
            "section 3.1",
        ),
        row(
            &format!("first frequency, with prestress{FIT}"),
            paper::WITH_PRESTRESS,
            model.frequency(),
            1,
            "Hz",
            "section 3.1, Fig. 4",
        ),
        row(
            "first frequency, without prestress",
            paper::WITHOUT_PRESTRESS,
            without.frequency(),
            1,
            "Hz",
            "section 3.1",
        ),
    ];
    for (length, overtravel, frequency) in paper::SHORT {
        let ours = runs::model(&runs::spring(
            1e-3 * length,
            1e-3 * overtravel,
            AxialForceKind::FromPreload,
        ))?;
        rows.push(row(
            &format!("first frequency, L = {length} mm, s = {overtravel} mm, with prestress"),
            frequency,
            ours.frequency(),
            1,
            "Hz",
            "section 3.1, Fig. 5",
        ));
    }
    Ok(comparison(
        "Static contact and first frequency; prestress is the axial force of eq. 9",
        rows,
    ))
}

/// The time domain.
pub fn time_domain(results: &Results) -> Result<Block> {
    let run = results.at(paper::BEST, 1000.0)?;
    let base = 1e6 * excitation(1000.0);
    let displacement = 1e6 * run.displacement;
    let mut rows = vec![
        row(
            &format!("force amplitude, 1000 Hz, ratio 10{FIT}"),
            paper::FORCE_AMPLITUDE,
            run.amplitude(),
            3,
            "cN",
            "section 3.2, Fig. 6",
        ),
        row(
            "displacement amplitude of the contact, 1000 Hz, ratio 10",
            paper::DISPLACEMENT,
            displacement,
            3,
            "µm",
            "section 3.2, Fig. 6",
        ),
        row(
            "ratio of that amplitude to the base amplitude",
            paper::DISPLACEMENT_RATIO,
            displacement / base,
            3,
            "",
            "section 3.2",
        ),
        difference(
            "phase between force and displacement, 1000 Hz, ratio 10",
            paper::PHASE,
            run.phase,
            1,
            "°",
            "section 3.2, Fig. 6",
        ),
    ];
    for (ratio, at, published) in paper::PEAKS {
        let runs = results.ratio(ratio)?;
        let (found, highest) = peak(runs.iter().map(|run| (run.frequency, run.amplitude())));
        let name = format!("ratio {ratio}");
        rows.push(row(
            &format!("maximum force amplitude, {name}"),
            published,
            highest,
            2,
            "cN",
            "section 3.2, Fig. 7",
        ));
        rows.push(difference(
            &format!("frequency of the maximum in the grid, {name}"),
            at,
            found,
            0,
            "Hz",
            "section 3.2, Fig. 7",
        ));
    }
    Ok(comparison("Time domain, 98 m/s² (the grid has steps of 250 Hz)", rows))
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
    let columns: Vec<_> = ["frequency"]
        .into_iter()
        .chain(ratios.iter().map(String::as_str))
        .collect();
    Ok(table(
        "Force amplitude of this model in cN over the published excitation grid; the published figure gives numbers \
         only for the peaks above",
        &columns,
        rows,
    ))
}

/// The frequency domain.
pub fn frequency_domain(results: &Results) -> Result<Block> {
    let mut rows = Vec::new();
    for (alpha, at, published) in paper::FREQUENCY_DOMAIN_PEAKS {
        let model = results.alpha(alpha)?;
        let (found, highest) = peak((250..=2000).map(|f| (f64::from(f), linear_force(model, f64::from(f)))));
        let name = format!("alpha = {alpha} 1/s");
        let place = "section 3.2, Fig. 9";
        rows.push(row(
            &format!("maximum force amplitude, {name}"),
            published,
            highest,
            2,
            "cN",
            place,
        ));
        rows.push(difference(
            &format!("frequency of the maximum, {name}"),
            at,
            found,
            0,
            "Hz",
            place,
        ));
    }
    Ok(comparison("Frequency domain, 98 m/s², mass damping only", rows))
}

/// Frequency domain compared with time domain.
pub fn domains(results: &Results) -> Result<Block> {
    let mut rows = Vec::new();
    for (ratio, alpha) in paper::EQUIVALENT {
        let (model, damped) = (results.alpha(alpha)?, runs::model(&runs::specimen(ratio))?);
        let whole = |f: f64| Ok::<_, anyhow::Error>(results.at(ratio, f)?.amplitude());
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
            &format!("within {} %", paper::EQUIVALENT_DEVIATION),
            &cell(worst(&whole, 2000.0)?),
            &cell(worst(&elastic, 2000.0)?),
            &cell(worst(&elastic, 1500.0)?),
            "section 4.2, Fig. 19",
        ]));
    }
    Ok(table(
        "Largest deviation of the force amplitude between frequency and time domain over the grid, 250 to 2000 Hz; \
         the elastic part is the contact force without the contribution of contact damping",
        &[
            "damping",
            "published",
            "this model",
            "this model, elastic part",
            "elastic part, up to 1500 Hz",
            "location in the publication",
        ],
        rows,
    ))
}

/// Displacement amplitudes over the damping ratio.
pub fn displacements(results: &Results) -> Result<Block> {
    let mut rows = Vec::new();
    for (ratio, published) in paper::RATIOS.into_iter().zip(paper::DISPLACEMENTS) {
        let ours = 1e6 * results.at(ratio, 1000.0)?.displacement;
        let name = format!("displacement amplitude, 1000 Hz, ratio {ratio}");
        rows.push(row(&name, published, ours, 3, "µm", "Table 4"));
    }
    let ours = 1e6 * results.at(paper::BEST, 1000.0)?.displacement;
    rows.push(row(
        "measured amplitude, compared with ratio 10",
        paper::MEASURED_DISPLACEMENT,
        ours,
        3,
        "µm",
        "section 4.2, Fig. 14",
    ));
    for (ratio, published) in paper::DISPLACEMENT_DEVIATIONS {
        let ours = 100.0 * (results.at(ratio, 1250.0)?.displacement / excitation(1250.0) - 1.0);
        rows.push(cells(&[
            &format!("displacement amplitude in excess of the base, 1250 Hz, ratio {ratio}"),
            &format!("{published} %"),
            &format!("{} %", number(ours, 2)),
            &format!("{} points", signed(ours - published, 1)),
            "section 3.2, Fig. 8",
        ]));
    }
    Ok(comparison("Displacement of the contact, base included, 98 m/s²", rows))
}
