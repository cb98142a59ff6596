//! The results shown by all sections, computed once.

use anyhow::{Context, Result};
use rayon::prelude::*;
use relay_contact::reference::Model;

use super::published::{ALPHAS, BETAS, EQUIVALENT, FREQUENCIES, RATIOS};
use super::runs::{self, Periodic};

/// Damping ratios drawn over frequency; with smaller ones the contact opens near the resonance.
pub const DRAWN: [f64; 4] = [5.0, 10.0, 20.0, 30.0];

/// Frequencies of linear responses: least and step, Hz.
pub const LINEAR: (u32, u32) = (250, 5);

/// The runs.
pub struct Results {
    /// The published excitation grid: ratio after ratio, frequency after frequency.
    grid: Vec<Periodic>,
    /// Over the frequencies of the curves, for each of [`DRAWN`].
    pub curves: Vec<(f64, Vec<Periodic>)>,
    /// Over the grid, with the published stiffness coefficient of ratio 10 as printed.
    pub literal: Vec<Periodic>,
    /// The specimen.
    pub specimen: Model,
    /// Models of the frequency domain, by mass coefficient, 1/s.
    mass_damped: Vec<(f64, Model)>,
}

impl Results {
    /// Runs everything; `quick` makes the curves coarser but does not change the tables.
    pub fn compute(quick: bool) -> Result<Self> {
        let step = if quick { 125 } else { 25 };
        let frequencies: Vec<f64> = (250..=2000).step_by(step).map(f64::from).collect();
        let grid = pairs(&RATIOS, &FREQUENCIES);
        let curves = pairs(&DRAWN, &frequencies);
        let literal = BETAS[3];
        let mut points: Vec<_> = grid
            .iter()
            .chain(&curves)
            .map(|(ratio, f)| (runs::specimen(*ratio), *f))
            .collect();
        points.extend(FREQUENCIES.map(|f| (runs::with_damping(literal), f)));
        let mut done = points
            .par_iter()
            .map(|(scene, frequency)| runs::periodic(scene, *frequency))
            .collect::<Result<Vec<_>>>()?
            .into_iter();
        let grid: Vec<_> = done.by_ref().take(grid.len()).collect();
        let curves = DRAWN
            .map(|ratio| (ratio, done.by_ref().take(frequencies.len()).collect()))
            .to_vec();
        let literal = done.collect();
        let alphas = ALPHAS.into_iter().chain(EQUIVALENT.map(|(_, alpha, _)| alpha));
        Ok(Self {
            grid,
            curves,
            literal,
            specimen: runs::model(&runs::specimen(10.0))?,
            mass_damped: alphas
                .map(|alpha| Ok((alpha, runs::model(&runs::with_mass_damping(alpha))?)))
                .collect::<Result<_>>()?,
        })
    }

    /// The runs of a published ratio over the published frequencies.
    pub fn ratio(&self, ratio: f64) -> Result<&[Periodic]> {
        let index = RATIOS
            .iter()
            .position(|known| *known == ratio)
            .context("no such ratio")?;
        let count = FREQUENCIES.len();
        self.grid
            .get(index * count..(index + 1) * count)
            .context("grid not run")
    }

    /// The run of a published ratio at a published frequency.
    pub fn at(&self, ratio: f64, frequency: f64) -> Result<&Periodic> {
        let found = self.ratio(ratio)?.iter().find(|run| run.frequency == frequency);
        found.context("no such frequency")
    }

    /// The model of the frequency domain with a mass coefficient, 1/s.
    pub fn alpha(&self, alpha: f64) -> Result<&Model> {
        let found = self.mass_damped.iter().find(|(known, _)| *known == alpha);
        found.map(|(_, model)| model).context("no such mass coefficient")
    }

    /// Force amplitude (cN) of the linear response with a mass coefficient (1/s) over frequency (Hz).
    pub fn linear(&self, alpha: f64) -> Result<Vec<(f64, f64)>> {
        let model = self.alpha(alpha)?;
        Ok(over_frequency(|frequency| runs::linear_force(model, frequency)))
    }
}

/// A linear response over frequency, in steps that show its peak where it is stated.
pub fn over_frequency(value: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let frequencies = (LINEAR.0..=2000).step_by(LINEAR.1 as usize).map(f64::from);
    frequencies.map(|frequency| (frequency, value(frequency))).collect()
}

fn pairs(ratios: &[f64], frequencies: &[f64]) -> Vec<(f64, f64)> {
    let of = |ratio: &f64| {
        let ratio = *ratio;
        frequencies.iter().map(move |frequency| (ratio, *frequency))
    };
    ratios.iter().flat_map(of).collect()
}

/// Frequency (Hz) and value of the highest of some points.
pub fn peak(points: impl Iterator<Item = (f64, f64)>) -> (f64, f64) {
    points.fold((f64::NAN, f64::NEG_INFINITY), |best, point| {
        if point.1 > best.1 { point } else { best }
    })
}
