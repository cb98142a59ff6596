//! Modes of the cantilever with its rivet by Galerkin's method in a polynomial space.
//!
//! The basis on `xi = 2 x / L - 1` are the second antiderivatives of the orthonormal Legendre polynomials that vanish
//! with their slope at the clamp. Then the bending stiffness is the unit matrix, only the first two functions move the
//! tip, and the space holds the cubic a static tip load makes. So the static compliance at the tip is exact with
//! any number of modes of two or more, and the contact force converges exponentially with their number.

use nalgebra::{DMatrix, DVector};

use crate::beam::mode::Mode;
use crate::beam::section::Section;

/// The polynomial space and its matrices, without dimensions.
#[derive(Clone, Debug)]
pub struct Space {
    /// Integral of products of the functions over xi.
    mass: DMatrix<f64>,
    /// Integral of products of their slopes over xi.
    pub(crate) geometric: DMatrix<f64>,
    /// Integral of each function over xi.
    pub(crate) load: DVector<f64>,
    /// What each function does, with rotations by xi.
    pub(crate) at: Places,
}

/// What functions do at the places of a spring that are asked for: deflection (m) and rotation at the tip, deflection at the
/// pusher and at a parallel contact (m).
#[derive(Clone, Debug)]
pub(crate) struct Places {
    pub(crate) tip: DVector<f64>,
    pub(crate) slope: DVector<f64>,
    pub(crate) pusher: DVector<f64>,
    pub(crate) parallel: DVector<f64>,
}

impl Space {
    /// The space spanned by `count` functions.
    pub fn new(count: usize) -> Self {
        // By columns of factors of the Legendre polynomials P_row; the curvatures are orthonormal polynomials.
        let curvature = |row, k| if row == k { (k as f64 + 0.5).sqrt() } else { 0.0 };
        let slopes = antiderivatives(&DMatrix::from_fn(count + 2, count, curvature));
        let values = antiderivatives(&slopes);
        let products = |functions: &DMatrix<f64>| {
            let mut found = DMatrix::zeros(count, count);
            for (row, factors) in functions.row_iter().map(|row| row.transpose()).enumerate() {
                // The integral of P_row squared is 1 / (row + 1/2).
                found.ger(1.0 / (row as f64 + 0.5), &factors, &factors, 1.0);
            }
            found
        };
        // At the tip each polynomial is 1; all but the first integrate to nothing.
        let (tip, slope) = (values.row_sum_tr(), slopes.row_sum_tr());
        Self {
            load: values.row(0).transpose() * 2.0,
            mass: products(&values),
            geometric: products(&slopes),
            at: Places { slope, pusher: DVector::zeros(count), parallel: tip.clone(), tip },
        }
    }

    /// The space of other functions, orthonormal in strain energy, in units of the section, which carries no rivet: products
    /// of the functions over the mass (kg), of their slopes over the length (m), the mass each moves (kg), and what each does at
    /// the places asked for.
    pub(super) fn with(
        section: &Section,
        mass: DMatrix<f64>,
        slopes: DMatrix<f64>,
        load: DVector<f64>,
        places: Places,
    ) -> Self {
        let (half_mass, half_stiffness) = section.halves();
        let root = half_stiffness.sqrt();
        Self {
            mass: mass * (half_stiffness / half_mass),
            geometric: slopes * (half_stiffness * section.length / 2.0),
            load: load * (root / half_mass),
            at: Places {
                tip: places.tip * root,
                slope: places.slope * (root * section.length / 2.0),
                pusher: places.pusher * root,
                parallel: places.parallel * root,
            },
        }
    }

    /// The factors of [`Space::with`]'s functions in the shape under unit force at the tip and an axial compression (N);
    /// `None` at or above the buckling load.
    pub(super) fn deflections(&self, section: &Section, axial_force: f64) -> Option<DVector<f64>> {
        let (_, half_stiffness) = section.halves();
        let rigidity = self.rigidity(section, axial_force, 0.0);
        Some(rigidity.cholesky()?.solve(&self.at.tip) / half_stiffness.sqrt())
    }

    /// Stiffness under the axial compression (N) with an elastic support of `stiffness` (N/m) at the tip.
    fn rigidity(&self, section: &Section, axial_force: f64, stiffness: f64) -> DMatrix<f64> {
        let (_, half_stiffness) = section.halves();
        let count = self.at.tip.len();
        let compression = axial_force * section.length * section.length / (4.0 * section.bending_stiffness);
        let mut rigidity = DMatrix::identity(count, count) - &self.geometric * compression;
        rigidity.ger(stiffness / half_stiffness, &self.at.tip, &self.at.tip, 1.0);
        rigidity
    }

    /// The modes without damping of the section under the axial compression (N) with an elastic support of `stiffness` (N/m) at the
    /// tip, frequency ascending; `None` at or above the buckling load.
    pub fn modes(&self, section: &Section, axial_force: f64, stiffness: f64) -> Option<Vec<Mode>> {
        let modes = self.modes_with_shapes(section, axial_force, stiffness)?;
        Some(modes.into_iter().map(|(mode, _)| mode).collect())
    }

    /// [`Space::modes`], each with its shape: coefficients of the basis functions, 1/sqrt(kg).
    pub fn modes_with_shapes(
        &self,
        section: &Section,
        axial_force: f64,
        stiffness: f64,
    ) -> Option<Vec<(Mode, DVector<f64>)>> {
        let (length, tip_mass) = (section.length, section.tip_mass);
        let (half_mass, half_stiffness) = section.halves();
        let at = &self.at;
        let mut mass = self.mass.clone();
        mass.ger(tip_mass / half_mass, &at.tip, &at.tip, 1.0);
        let inertia = 4.0 * section.tip_inertia / (length * length * half_mass);
        mass.ger(inertia, &at.slope, &at.slope, 1.0);
        let factor = self.rigidity(section, axial_force, stiffness).cholesky()?;
        // Eigenvalues mu of R^-1 M R^-T are 1/omega^2: the low modes, which matter most, have full relative accuracy.
        let half = factor.l_dirty().solve_lower_triangular(&mass)?;
        let reduced = factor.l_dirty().solve_lower_triangular(&half.transpose())?;
        let eigen = ((&reduced + reduced.transpose()) * 0.5).symmetric_eigen();
        let shapes = factor.l_dirty().tr_solve_lower_triangular(&eigen.eigenvectors)?;
        let largest = eigen.eigenvalues.max();
        let modes = eigen.eigenvalues.iter().zip(shapes.column_iter()).map(|(&mu, shape)| {
            // Rounding leaves only the order of magnitude of the highest of many modes.
            let mu = mu.max(f64::EPSILON * largest);
            let normalisation = 1.0 / (mu * half_mass).sqrt();
            let tip = shape.dot(&at.tip) * normalisation;
            let mode = Mode {
                omega_squared: half_stiffness / (half_mass * mu),
                tip,
                participation: half_mass * shape.dot(&self.load) * normalisation + tip_mass * tip,
                rotation: 2.0 / length * shape.dot(&at.slope) * normalisation,
                pusher: shape.dot(&at.pusher) * normalisation,
                parallel: shape.dot(&at.parallel) * normalisation,
                ..Mode::default()
            };
            (mode, shape * normalisation)
        });
        let mut modes: Vec<_> = modes.collect();
        modes.sort_unstable_by(|(a, _), (b, _)| a.omega_squared.total_cmp(&b.omega_squared));
        Some(modes)
    }

    /// The vector whose product with another shape is the integral over the length (m) of the product of both slopes.
    pub fn slopes_of(&self, length: f64, shape: &DVector<f64>) -> DVector<f64> {
        &self.geometric * shape * (2.0 / length)
    }
}

/// The antiderivatives that vanish at -1 of functions, which are columns of factors of the Legendre polynomials: that of P_k is
/// `(P_(k+1) - P_(k-1)) / (2 k + 1)`, with `P_(-1) = -P_0`.
fn antiderivatives(functions: &DMatrix<f64>) -> DMatrix<f64> {
    let of = |row: usize, k: usize| functions.get((row, k)).map_or(0.0, |factor: &f64| *factor);
    DMatrix::from_fn(functions.nrows(), functions.ncols(), |row, k| {
        let below = row.saturating_sub(1);
        of(below, k) / (2 * below + 1) as f64 - of(row + 1, k) / (2 * row + 3) as f64
    })
}
