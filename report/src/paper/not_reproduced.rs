//! What the model does not reproduce, by how much, and why.

use anyhow::Result;
use relay_contact::variables::AxialForceKind;

use super::results::{Results, peak};
use super::runs::{self, linear_force};
use super::{displacement, elastic, published as paper};
use crate::content::Block;
use crate::numbers::{number, significant};

/// The blocks of the section.
pub fn blocks(results: &Results) -> Result<Vec<Block>> {
    let mut blocks = vec![Block::Text(short_springs(results)?)];
    blocks.extend(displacement::blocks(results)?);
    blocks.push(Block::Text(weak_damping(results)?));
    blocks.extend(elastic::blocks(results)?);
    blocks.push(Block::Text(objections(results)));
    Ok(blocks)
}

fn short_springs(results: &Results) -> Result<String> {
    let frequency = |length: f64, overtravel: f64| -> Result<f64> {
        let spring = runs::spring(1e-3 * length, 1e-3 * overtravel, AxialForceKind::FromPreload);
        Ok(runs::model(&spring)?.frequency())
    };
    let scaled = |length: f64| number(results.specimen.frequency() * (15.5 / length).powi(2), 0);
    let change = frequency(11.5, 0.5)? - frequency(11.5, 0.45)?;
    let published = paper::SHORT[1].2 - paper::SHORT[0].2;
    let ratio = results.specimen.preload().contact_stiffness / results.specimen.section().tip_stiffness();
    Ok(format!(
        "The shift of the first frequency by prestress: see *Findings*, eq. 9.\n\n\
         ### The frequencies of the shorter springs\n\n\
         The frequencies of a uniform beam are proportional to 1/L²: from 15.5 mm, {} Hz at 11.5 mm and {} Hz at 7.5 mm. The published \
         ones follow no single power of the length, being higher at 11.5 mm and lower at 7.5 mm. What a uniform \
         beam on a rigid clamp lacks, shear, a longer rivet, a compliant support, each lowers a frequency, the more the shorter the spring: \
         it may explain 7.5 mm, and cannot explain 11.5 mm.\n\n\
         The dependence on overtravel is not reproduced either. Published, L = 11.5 mm: {} Hz from 0.45 to 0.5 mm of \
         overtravel. This model: {} Hz. The contact is {} times as stiff as the spring at its tip, so it acts as a \
         rigid support at any overtravel, and the axial force of eq. 9 is negligible.",
        scaled(11.5),
        scaled(7.5),
        number(published, 1),
        significant(change),
        number(ratio, 0),
    ))
}

fn weak_damping(results: &Results) -> Result<String> {
    let force = results.specimen.preload().force;
    let mut highest = Vec::new();
    for ratio in [0.1, 1.0, 5.0] {
        let model = runs::model(&runs::specimen(ratio))?;
        let (_, linear) = peak(paper::FREQUENCIES.into_iter().map(|f| (f, linear_force(&model, f))));
        highest.push(number(linear / force, 0));
    }
    Ok(format!(
        "### Weak damping\n\n\
         With ratios of 0.1 and 1 the linear force amplitude reaches {} and {} % of the static force within the grid (with 5: {} %): the contact opens, \
         and each closing is an impact. The force is then neither sinusoidal nor necessarily periodic, and the impact forces are far \
         above the static force. The publication gives an amplitude for every point of its grid. The amplitudes of \
         this model depend there on the damping of the contact and of the highest modes, which no published result \
         determines; they are therefore not compared.",
        highest[0], highest[1], highest[2],
    ))
}

fn objections(results: &Results) -> String {
    format!(
        "### Amplitudes in the frequency domain\n\n\
         With mass damping only, the maximum force amplitudes are below the published ones. Mass and stiffness were fitted in the time \
         domain; nothing was fitted here.\n\n\
         ### Known objections\n\n\
         The indentation at rest is {} nm, far below the published roughness of 12.84 µm: the Hertz law represents \
         the whole interface, and its radius is a fit. The damping ratio of the first mode is {}, which a metal \
         spring alone does not have: it is a fit too. If the contact opens, the impact force of re-closing is \
         determined by the contact damping.",
        number(1e9 * results.specimen.preload().indentation, 1),
        number(
            std::f64::consts::PI * results.specimen.frequency() * results.specimen.scene().beam.stiffness_damping,
            2
        ),
    )
}
