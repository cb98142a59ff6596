//! Two cases in which the publication's numbers do not follow from its formulas.

use std::f64::consts::{PI, TAU};

use anyhow::Result;
use relay_contact::variables::AxialForceKind;

use super::curves::{FORCE_AMPLITUDE, FREQUENCY, amplitudes, published};
use super::results::Results;
use super::{published as paper, runs};
use crate::content::{Block, Figure, Style};
use crate::numbers::number;

/// The blocks of the section.
pub fn blocks(results: &Results) -> Result<Vec<Block>> {
    let [text, figure] = damping(results);
    Ok(vec![text, figure, axial_force(results)?])
}

/// The published beta as printed.
fn damping(results: &Results) -> [Block; 2] {
    let beta = paper::BETAS[3];
    let amplitudes: Vec<f64> = results.literal.iter().map(runs::Periodic::amplitude).collect();
    let least = amplitudes.iter().fold(f64::INFINITY, |least, a| least.min(*a));
    let greatest = amplitudes
        .iter()
        .fold(f64::NEG_INFINITY, |greatest, a| greatest.max(*a));
    let omega = paper::ALPHA_PER_BETA.sqrt();
    let (_, alpha, _) = paper::EQUIVALENT[0];
    let first = results.specimen.frequency();
    let text = format!(
        "### The published stiffness coefficient cannot be used as printed\n\n\
         The publication damps with C = beta K and prints beta = {beta:.4e} s, which is 2 ζ/ω at 1000 Hz with a \"damping ratio\" \
         ζ of 10 (eq. 15). With that number in SI units there is no resonance: the force amplitude is {} to {} cN from 250 to \
         2000 Hz. The publication shows a resonance, 4.812 cN at 1000 Hz and 5.2 cN near 1250 Hz (Figs. 6 and 7).\n\n\
         Its own relation between the two damping coefficients, alpha = 1610065 beta (eq. 33), should be alpha = beta \
         ω² with ω the first angular frequency (eq. 32). The factor is the square of {}: near the first frequency in \
         Hz ({}), not in rad/s ({}). It was not found from a frequency, though: it is the quotient of the two coefficients that came closest to \
         the measurements, {alpha} 1/s and {beta:.4e} s, {}. If the coefficient refers to frequencies in Hz, it is \
         smaller by a factor of 4 π² in SI units: {} s. With it the resonance appears. Eq. 32 in SI units, of {alpha} 1/s and {} Hz, gives {} µs. \
         Both support the calibration, neither proves it.",
        number(least, 3),
        number(greatest, 3),
        number(omega, 1),
        number(first, 1),
        number(TAU * first, 0),
        number(alpha / beta, 0),
        format_args!("{:.3e}", beta / (4.0 * PI * PI)),
        paper::WITH_PRESTRESS,
        number(1e6 * alpha / (TAU * paper::WITH_PRESTRESS).powi(2), 1),
    );
    [Block::Text(text), Block::Figure(literal_figure(results))]
}

fn literal_figure(results: &Results) -> Figure {
    let mut curves = vec![amplitudes("beta as printed", &results.literal, Style::Dashed, 1)];
    if let Some((_, runs)) = results.curves.iter().find(|(ratio, _)| *ratio == paper::BEST) {
        curves.push(amplitudes("beta / 4 π²", runs, Style::Line, 0));
    }
    let points = [(1000.0, paper::FORCE_AMPLITUDE), (paper::PEAKS[0].1, paper::PEAKS[0].2)];
    curves.extend(published("ratio 10", points, 0));
    Figure {
        id: "finding-beta",
        title: "The published beta as printed, and divided by 4 π²".to_owned(),
        x: FREQUENCY,
        y: FORCE_AMPLITUDE,
        curves,
        caption: "As printed, beam and contact are strongly overdamped: the force is the same at every frequency. The \
             published points lie on a resonance."
            .to_owned(),
    }
}

/// Equation 9.
fn axial_force(results: &Results) -> Result<Block> {
    let model = &results.specimen;
    let without = runs::model(&runs::spring(15.5e-3, 0.2e-3, AxialForceKind::None))?;
    let force = relay_contact::reference::axial_force_from_deflection(&model.section(), model.preload().deflection);
    let buckling = model.section().buckling_load();
    let shift = without.frequency() - model.frequency();
    let published = paper::WITHOUT_PRESTRESS - paper::WITH_PRESTRESS;
    let part = paper::WITH_PRESTRESS / paper::WITHOUT_PRESTRESS;
    let needed = runs::axial_force_for(part * without.frequency())?;
    let text = format!(
        "### Equation 9 does not explain the published effect of prestress\n\n\
         Eq. 9 gives the axial force from the tip's deflection, N = (3 E I y / L³) sin(3 y / (2 L)). For the specimen \
         this is {} mN, which lowers the first frequency by {} Hz. The publication states {} Hz (1397.6 to 1354.5 \
         Hz), {} times as much; this model has the lower one, to which its mass per length is fitted. Lowering the frequency of this spring by the same ratio takes {} N, {} % of the \
         buckling load of the open contact ({} N).\n\n\
         The published shift comes from a three-dimensional model with friction, and its two frequencies also differ \
         in the boundary condition: bonded in all directions with prestress, a single spring without. A flat contact \
         without friction exerts no force along the spring. The component has eq. 9 because the publication does, and leaves it out \
         unless it is asked for (`effects.axialForce`). What \
         friction explains of the publication, and what not, is in `docs/friction.md`.",
        number(1e3 * force, 2),
        number(shift, 3),
        number(published, 1),
        number(published / shift, 0),
        number(needed, 2),
        number(100.0 * needed / buckling, 0),
        number(buckling, 2),
    );
    Ok(Block::Text(text))
}
