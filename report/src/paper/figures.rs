//! The publication's figures of frequencies, time histories and resistance.

use anyhow::{Context, Result};
use relay_contact::reference::{ElectricalContact, Law, Power};
use relay_contact::scene::Scene;
use relay_contact::variables::{AxialForceKind, ResistanceKind};

use super::curves::published;
use super::published as paper;
use super::resistance::resistance_deviations;
use super::results::Results;
use super::runs::{self, Periodic, linear_force, resistance};
use crate::content::{Axis, Curve, Figure, Style};
use crate::numbers::number;

/// Fig. 5: first frequency over overtravel.
pub fn frequencies(quick: bool) -> Result<Figure> {
    let count = if quick { 10 } else { 46 };
    let overtravels = (0..count).map(|k| 0.05 + 0.45 * f64::from(k) / f64::from(count - 1));
    let mut curves = Vec::new();
    for (colour, length) in paper::LENGTHS.into_iter().enumerate() {
        let points = overtravels.clone().map(|overtravel| {
            let scene = runs::spring(1e-3 * length, 1e-3 * overtravel, AxialForceKind::FromPreload);
            Ok((overtravel, runs::model(&scene)?.frequency()))
        });
        let points: Vec<_> = points.collect::<Result<_>>()?;
        curves.push(Curve::new(&format!("L = {length} mm"), points, Style::Line, colour));
        let specimen = (15.5, 0.2, paper::WITH_PRESTRESS);
        let points = paper::SHORT
            .into_iter()
            .chain([specimen])
            .filter(|point| point.0 == length);
        let name = format!("{length} mm, with prestress");
        curves.extend(published(&name, points.map(|point| (point.1, point.2)), colour));
    }
    let points = [(0.2, paper::WITHOUT_PRESTRESS)];
    curves.extend(published("15.5 mm, without prestress", points, 3));
    Ok(Figure {
        id: "paper-fig5",
        title: "First frequency over overtravel (Fig. 5)".to_owned(),
        x: Axis::linear("overtravel", "mm"),
        y: Axis::linear("first frequency", "Hz"),
        curves,
        caption: "This model: exact characteristic equation with the contact as a spring and the axial force of eq. 9; without it the \
                  curves are the same to a line's width. Overtravel has almost no influence. Published: values from the text."
            .to_owned(),
    })
}

/// Times and values of some periods, ms.
fn repeated(run: &Periodic, periods: u32, value: impl Fn(&(f64, f64, f64)) -> f64) -> Vec<(f64, f64)> {
    let mut points = Vec::new();
    for period in 0..periods {
        let start = f64::from(period) / run.frequency;
        points.extend(
            run.course
                .iter()
                .step_by(10)
                .map(|point| (1e3 * (start + point.0), value(point))),
        );
    }
    points
}

/// The points at which a time history is greatest and least, at which published values are drawn.
fn turning(points: &[(f64, f64)]) -> Option<[f64; 2]> {
    let greatest = points.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let least = points.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some([greatest.0, least.0])
}

/// Fig. 6: force and displacement over time at 1000 Hz.
pub fn courses(results: &Results) -> Result<[Figure; 2]> {
    let run = results.at(paper::BEST, 1000.0)?;
    let rest = 100.0 * results.specimen.preload().force;
    let force = repeated(run, 3, |point| 100.0 * point.1);
    let [top, bottom] = turning(&force).context("empty course")?;
    let amplitude = [
        (top, rest + paper::FORCE_AMPLITUDE),
        (bottom, rest - paper::FORCE_AMPLITUDE),
    ];
    let mut curves = vec![Curve::new("this model", force, Style::Line, 0)];
    curves.extend(published("amplitude, to which the rivet is fitted", amplitude, 0));
    let force = Figure {
        id: "paper-fig6-force",
        title: "Contact force at 1000 Hz, 98 m/s² (Fig. 6)".to_owned(),
        x: Axis::linear("time", "ms"),
        y: Axis::linear("contact force", "cN"),
        curves,
        caption: "Three periods after the transients have decayed, damping ratio 10. Published is only the amplitude, to \
                  which the rivet is fitted: the points coincide by construction. They are drawn about the static force, at the times of the \
                  extremes of this model."
            .to_owned(),
    };
    let displacement = repeated(run, 3, |point| 1e6 * point.2);
    let [top, bottom] = turning(&displacement).context("empty course")?;
    let amplitude = [(top, paper::DISPLACEMENT), (bottom, -paper::DISPLACEMENT)];
    let mut curves = vec![Curve::new("this model, contact and base", displacement, Style::Line, 0)];
    curves.extend(published("amplitude", amplitude, 0));
    let displacement = Figure {
        id: "paper-fig6-displacement",
        title: "Displacement of the contact at 1000 Hz, 98 m/s² (Fig. 6)".to_owned(),
        x: Axis::linear("time", "ms"),
        y: Axis::linear("displacement", "µm"),
        curves,
        caption: "Base included. The contact of this model moves with the base within nanometres, so both are one curve. Which \
                  point has the published amplitude is not published: see *What the published contact is*."
            .to_owned(),
    };
    Ok([force, displacement])
}

/// Fig. 11: resistance over force.
pub fn laws() -> Result<Figure> {
    let law = |kind| {
        let mut scene = Scene::default();
        scene.effects.resistance = kind;
        let path =
            ElectricalContact::new(&scene, &Law::Power(Power::hertz(&scene.contact))).context("no resistance")?;
        Ok::<_, anyhow::Error>((0..=60).map(move |k| {
            let force = 0.01 * 100f64.powf(f64::from(k) / 60.0);
            (force, 1e3 / path.conductance(force))
        }))
    };
    let (coefficient, exponent) = paper::RESISTANCE;
    let points = [0.02, 0.05, 0.1, 0.152, 0.2, 0.5, 1.0].map(|force: f64| (force, coefficient * force.powf(-exponent)));
    let mut curves = vec![
        Curve::new("power law", law(ResistanceKind::PowerLaw)?, Style::Line, 0),
        Curve::new("Holm", law(ResistanceKind::Holm)?, Style::Dashed, 1),
    ];
    curves.extend(published("eq. 29, which the power law is", points, 0));
    Ok(Figure {
        id: "paper-fig11",
        title: "Contact resistance over contact force (Fig. 11)".to_owned(),
        x: Axis::logarithmic("contact force", "N"),
        y: Axis::logarithmic("contact resistance", "mΩ"),
        curves,
        caption: "The component's power law is the published fit, so they coincide by construction. Holm's law, with the hardness the publication \
                  measured and the resistivity of AgSnO2, is that of a single clean spot."
            .to_owned(),
    })
}

/// Fig. 16: resistance over time at 1000 Hz.
pub fn resistance_course(results: &Results) -> Result<Figure> {
    let run = results.at(paper::BEST, 1000.0)?;
    let (low, high) = paper::MEASURED_RESISTANCE;
    let band = |value: f64| [(0.0, value), (10.0, value)];
    let course = repeated(run, 10, |point| resistance(point.1));
    Ok(Figure {
        id: "paper-fig16",
        title: "Contact resistance at 1000 Hz, 98 m/s² (Fig. 16)".to_owned(),
        x: Axis::linear("time", "ms"),
        y: Axis::linear("contact resistance", "mΩ"),
        curves: vec![
            Curve::new("this model", course, Style::Line, 0),
            Curve::new("measured, maximum", band(high), Style::Dashed, 1),
            Curve::new("measured, minimum", band(low), Style::Dashed, 2),
        ],
        caption: format!(
            "Ten periods. Measured: {low} to {high} mΩ; this model: {} to {} mΩ. The publication's own simulation \
             deviates by {} % from the measured minimum.",
            number(resistance(run.greatest), 1),
            number(resistance(run.least), 1),
            paper::RESISTANCE_DEVIATIONS[0].1
        ),
    })
}

/// Table 6 and Fig. 18: deviations of the resistance from the measured values at 1000 Hz.
pub fn deviations(results: &Results) -> Result<[Figure; 2]> {
    let mut found = [Vec::new(), Vec::new()];
    for (ratio, _, _) in paper::RESISTANCE_DEVIATIONS {
        let run = results.at(ratio, 1000.0)?;
        let (least, greatest) = resistance_deviations(run.least, run.greatest);
        found[0].push((ratio, least.abs()));
        found[1].push((ratio, greatest.abs()));
    }
    let [least, greatest] = found;
    let furthest = greatest.iter().fold(0.0_f64, |most, point| most.max(point.1));
    let nearest = least.iter().fold(f64::INFINITY, |least, point| least.min(point.1));
    let published_least = paper::RESISTANCE_DEVIATIONS.map(|(ratio, least, _)| (ratio, least));
    let published_greatest = paper::RESISTANCE_DEVIATIONS.map(|(ratio, _, greatest)| (ratio, greatest));
    let mut curves = vec![
        Curve::new("this model, maximum", greatest, Style::LineAndMarkers, 0),
        Curve::new("this model, minimum", least, Style::LineAndMarkers, 1),
    ];
    curves.extend(published("maximum", published_greatest, 0));
    curves.extend(published("minimum", published_least, 1));
    let time = Figure {
        id: "paper-table6",
        title: "Deviation of the resistance from the measurement, time domain, 1000 Hz (Table 6)".to_owned(),
        x: Axis::linear("damping ratio", ""),
        y: Axis::linear("magnitude of the deviation", "%"),
        curves,
        caption: format!(
            "Absolute values, as the publication gives no signs. The publication's Fig. 17 is another: it is over frequency, of which the \
             measured values are not published. This model deviates by at most {} % from the \
             measured maximum, and is at least {} % above the measured minimum.",
            number(furthest, 1),
            number(nearest, 1)
        ),
    };
    let mut points = Vec::new();
    let high = paper::MEASURED_RESISTANCE.1;
    let force = results.specimen.preload().force;
    for step in 0..=40 {
        let alpha = 3000.0 + 100.0 * f64::from(step);
        let model = runs::model(&runs::with_mass_damping(alpha))?;
        let greatest = resistance(force - linear_force(&model, 1000.0) / 100.0);
        points.push((alpha, 100.0 * (greatest / high - 1.0).abs()));
    }
    let best = points
        .iter()
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(f64::NAN, |point| point.0);
    let mut curves = vec![Curve::new("this model", points, Style::Line, 0)];
    curves.extend(published("5125 1/s", [(5125.0, paper::FREQUENCY_DOMAIN_DEVIATION)], 0));
    let frequency = Figure {
        id: "paper-fig18",
        title: "Deviation of the maximum resistance from the measurement, frequency domain, 1000 Hz (Fig. 18)"
            .to_owned(),
        x: Axis::linear("mass coefficient", "1/s"),
        y: Axis::linear("magnitude of the deviation", "%"),
        curves,
        caption: format!(
            "Measured values at other frequencies are not published. The deviation of this model is smallest at {} \
             1/s; over its frequencies, the publication finds 5125 1/s best.",
            number(best, 0)
        ),
    };
    Ok([time, frequency])
}
