//! Modes of the cantilever with its rivet by Galerkin's method in a polynomial space.
//!
//! The basis on `xi = 2 x / L - 1` are the second antiderivatives of the orthonormal Legendre polynomials that vanish
//! with their slope at the clamp. Then the bending stiffness is the unit matrix, only the first two functions move the
//! tip, and the space holds the cubic a static tip load makes. So the static compliance at the tip is exact with
//! any number of modes of two or more, and the contact force converges exponentially with their number.

use nalgebra::{DMatrix, DVector};

use crate::beam::section::Section;
use crate::math::legendre;

/// The polynomial space and its matrices, without dimensions.
#[derive(Clone, Debug)]
pub struct Space {
    /// Integral of products of the functions over xi.
    mass: DMatrix<f64>,
    /// Integral of products of their slopes over xi.
    pub(crate) geometric: DMatrix<f64>,
    /// Integral of each function over xi.
    pub(crate) load: DVector<f64>,
    /// Value of each function at the tip.
    pub(crate) tip: DVector<f64>,
    /// Slope with respect to xi of each function at the tip.
    pub(crate) tip_slope: DVector<f64>,
    /// Value of each function at the pusher.
    pub(crate) pusher: DVector<f64>,
    /// Value of each function at a parallel contact.
    pub(crate) parallel: DVector<f64>,
}

/// What functions do at the places of a spring that are asked for: deflection (m) and rotation at the tip, deflection at the
/// pusher and at a parallel contact (m).
pub(super) struct Places {
    pub(super) tip: DVector<f64>,
    pub(super) slope: DVector<f64>,
    pub(super) pusher: DVector<f64>,
    pub(super) parallel: DVector<f64>,
}

/// One mode, normalised to a modal mass of 1 kg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// Square of the angular frequency, 1/s2.
    pub omega_squared: f64,
    /// Displacement of the tip, 1/sqrt(kg).
    pub tip: f64,
    /// Modal force per base acceleration, sqrt(kg).
    pub participation: f64,
    /// Rotation at the tip, 1/(m sqrt(kg)).
    pub rotation: f64,
    /// Displacement at the pusher, 1/sqrt(kg).
    pub pusher: f64,
}

impl Space {
    /// The space spanned by `count` functions.
    pub fn new(count: usize) -> Self {
        let functions = |x: f64| functions(x, count);
        let mut space = Self {
            mass: DMatrix::zeros(count, count),
            geometric: DMatrix::zeros(count, count),
            load: DVector::zeros(count),
            tip: functions(1.0).0,
            parallel: functions(1.0).0,
            tip_slope: functions(1.0).1,
            pusher: DVector::zeros(count),
        };
        // Degree 2 (count + 1) is integrated exactly.
        for (x, weight) in legendre::gauss(count + 2) {
            let (value, slope) = functions(x);
            space.mass.ger(weight, &value, &value, 1.0);
            space.geometric.ger(weight, &slope, &slope, 1.0);
            space.load.axpy(weight, &value, 1.0);
        }
        space
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
        let half_mass = section.mass_per_length * section.length / 2.0;
        let half_stiffness = 8.0 * section.bending_stiffness / section.length.powi(3);
        Self {
            mass: mass * (half_stiffness / half_mass),
            geometric: slopes * (half_stiffness * section.length / 2.0),
            load: load * (half_stiffness.sqrt() / half_mass),
            tip_slope: places.slope * (half_stiffness.sqrt() * section.length / 2.0),
            tip: places.tip * half_stiffness.sqrt(),
            pusher: places.pusher * half_stiffness.sqrt(),
            parallel: places.parallel * half_stiffness.sqrt(),
        }
    }

    /// The factors of [`Space::with`]'s functions in the shape under unit force at the tip and an axial compression (N);
    /// `None` at or above the buckling load.
    pub(super) fn deflections(&self, section: &Section, axial_force: f64) -> Option<DVector<f64>> {
        let half_stiffness = 8.0 * section.bending_stiffness / section.length.powi(3);
        let rigidity = self.rigidity(section, axial_force, 0.0);
        Some(rigidity.cholesky()?.solve(&self.tip) / half_stiffness.sqrt())
    }

    /// Stiffness under the axial compression (N) with an elastic support of `stiffness` (N/m) at the tip.
    fn rigidity(&self, section: &Section, axial_force: f64, stiffness: f64) -> DMatrix<f64> {
        let half_stiffness = 8.0 * section.bending_stiffness / section.length.powi(3);
        let count = self.tip.len();
        let compression = axial_force * section.length * section.length / (4.0 * section.bending_stiffness);
        let mut rigidity = DMatrix::identity(count, count) - &self.geometric * compression;
        rigidity.ger(stiffness / half_stiffness, &self.tip, &self.tip, 1.0);
        rigidity
    }

    /// The modes of the section under the axial compression (N) with an elastic support of `stiffness` (N/m) at the
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
        let Section {
            length,
            bending_stiffness,
            mass_per_length,
            tip_mass,
            tip_inertia,
        } = *section;
        let half_mass = mass_per_length * length / 2.0;
        let half_stiffness = 8.0 * bending_stiffness / length.powi(3);
        let mut mass = self.mass.clone();
        mass.ger(tip_mass / half_mass, &self.tip, &self.tip, 1.0);
        let inertia = 4.0 * tip_inertia / (length * length * half_mass);
        mass.ger(inertia, &self.tip_slope, &self.tip_slope, 1.0);
        let factor = self.rigidity(section, axial_force, stiffness).cholesky()?;
        // Eigenvalues mu of R^-1 M R^-T are 1/omega^2: the low modes, which matter most, have full relative accuracy.
        let half = factor.l_dirty().solve_lower_triangular(&mass)?;
        let reduced = factor.l_dirty().solve_lower_triangular(&half.transpose())?;
        let eigen = ((&reduced + reduced.transpose()) * 0.5).symmetric_eigen();
        let shapes = factor.l_dirty().tr_solve_lower_triangular(&eigen.eigenvectors)?;
        let largest = eigen.eigenvalues.max();
        let mut modes: Vec<_> = eigen
            .eigenvalues
            .iter()
            .zip(shapes.column_iter())
            .map(|(&mu, shape)| {
                // Rounding leaves only the order of magnitude of the highest of many modes.
                let mu = mu.max(f64::EPSILON * largest);
                let normalisation = 1.0 / (mu * half_mass).sqrt();
                let tip = shape.dot(&self.tip) * normalisation;
                let mode = Mode {
                    omega_squared: half_stiffness / (half_mass * mu),
                    tip,
                    participation: half_mass * shape.dot(&self.load) * normalisation + tip_mass * tip,
                    rotation: 2.0 / length * shape.dot(&self.tip_slope) * normalisation,
                    pusher: shape.dot(&self.pusher) * normalisation,
                };
                (mode, shape * normalisation)
            })
            .collect();
        modes.sort_unstable_by(|(a, _), (b, _)| a.omega_squared.total_cmp(&b.omega_squared));
        Some(modes)
    }

    /// Integral over the length (m) of the product of the slopes of two shapes.
    pub fn slope_product(&self, length: f64, a: &DVector<f64>, b: &DVector<f64>) -> f64 {
        2.0 / length * a.dot(&(&self.geometric * b))
    }
}

/// Values and slopes of the basis functions at `xi`.
fn functions(x: f64, count: usize) -> (DVector<f64>, DVector<f64>) {
    let p = legendre::polynomials(x, count + 2);
    // Antiderivative of P_k that vanishes at -1; the recursion of the Legendre polynomials gives it in closed form.
    let first = |k: usize| match k.checked_sub(1).and_then(|below| p.get(below)) {
        None => x + 1.0,
        Some(below) => (p.get(k + 1).copied().unwrap_or_default() - below) / (2 * k + 1) as f64,
    };
    let scale = |k: usize| (k as f64 + 0.5).sqrt();
    let value = |k: usize| match k {
        0 => (x + 1.0).powi(2) / 2.0,
        1 => (x.powi(3) - 3.0 * x - 2.0) / 6.0,
        k => (first(k + 1) - first(k - 1)) / (2 * k + 1) as f64,
    };
    (
        DVector::from_fn(count, |k, _| scale(k) * value(k)),
        DVector::from_fn(count, |k, _| scale(k) * first(k)),
    )
}
