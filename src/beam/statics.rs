//! Static compliance of the cantilever at its tip, under axial compression.

use std::sync::LazyLock;

use nalgebra::DVectorView;

use crate::beam::galerkin::Space;
use crate::beam::section::Section;

/// Size of the space: the static shapes under an axial force are entire functions, which 20 polynomials represent to rounding up to a
/// tension of a hundred buckling loads.
pub(super) const FEW: usize = 20;

/// The same up to ten thousand; at a hundred thousand to 2e-10.
const MANY: usize = 64;

/// Size of the space for statics under an axial compression (N).
pub(super) fn size(section: &Section, axial_force: f64) -> usize {
    if section.is_taut(axial_force) { MANY } else { FEW }
}

/// Tip deflection per load, as a function of the axial force.
///
/// With the geometric stiffness diagonalised once, each compliance is the sum `b_i c_i / (1 - nu sigma_i)` over its
/// modes, `nu = N L^2 / (4 E I)`.
#[derive(Clone, Debug)]
pub struct Statics {
    /// The uniform section; for another spring that which deflects and turns as much at its contact under a force there.
    pub section: Section,
    terms: Vec<Term>,
}

/// Deflection at a place of the spring per load.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AtPlace {
    /// Per force there, m/N.
    pub(crate) own: f64,
    /// Per force at the tip, m/N.
    pub(crate) across: f64,
    /// Per moment at the tip, 1/N.
    pub(crate) turning: f64,
    /// Per force of a pusher, m/N.
    pub(crate) pushed: f64,
    /// Per constant base acceleration, m per m/s2.
    pub(crate) sag: f64,
}

/// One of the modes of the geometric stiffness.
#[derive(Clone, Copy, Debug, Default)]
struct Term {
    sigma: f64,
    tip: f64,
    slope: f64,
    load: f64,
    pusher: f64,
    parallel: f64,
}

impl Term {
    fn of(space: Space) -> Vec<Self> {
        let eigen = space.geometric.symmetric_eigen();
        let shapes = eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter());
        let term = |(&sigma, shape): (&f64, DVectorView<f64>)| Self {
            sigma,
            tip: shape.dot(&space.at.tip),
            slope: shape.dot(&space.at.slope),
            load: shape.dot(&space.load),
            pusher: shape.dot(&space.at.pusher),
            parallel: shape.dot(&space.at.parallel),
        };
        shapes.map(term).collect()
    }
}

/// Those of a uniform spring.
fn uniform<const N: usize>() -> [Term; N] {
    let mut terms = Term::of(Space::new(N)).into_iter();
    std::array::from_fn(|_| terms.next().unwrap_or_default())
}

impl Statics {
    /// For the section, under axial compressions like one that is prescribed (N), if any.
    pub fn new(section: &Section, prescribed: f64) -> Self {
        // The same numbers for every section: found once in a process, and nothing that would have to be freed.
        static OF_FEW: LazyLock<[Term; FEW]> = LazyLock::new(uniform);
        static OF_MANY: LazyLock<[Term; MANY]> = LazyLock::new(uniform);
        let terms = if section.is_taut(prescribed) { OF_MANY.to_vec() } else { OF_FEW.to_vec() };
        Self { section: *section, terms }
    }

    /// For a space in units of the section.
    pub(super) fn of(section: &Section, space: Space) -> Self {
        Self { section: *section, terms: Term::of(space) }
    }

    /// Axial compression at which the cantilever without contact buckles, N; infinite for a spring given by its modes.
    pub fn buckling_load(&self) -> f64 {
        let largest = self.terms.iter().map(|term| term.sigma).fold(0.0, f64::max);
        4.0 * self.section.bending_stiffness / (self.section.length.powi(2) * largest)
    }

    /// Tip deflection per tip force, m/N; without axial force L^3 / (3 E I).
    pub fn tip_compliance(&self, axial_force: f64) -> f64 {
        self.sum(axial_force, |term| term.tip * term.tip)
    }

    /// Tip deflection per moment at the tip, 1/N; without axial force L^2 / (2 E I).
    pub fn moment_compliance(&self, axial_force: f64) -> f64 {
        self.sum(axial_force, |term| term.tip * term.slope) * (2.0 / self.section.length)
    }

    /// Tip deflection per constant base acceleration, m per m/s2, negative: the spring lags behind the frame.
    pub fn gravity_compliance(&self, axial_force: f64) -> f64 {
        self.under_gravity(axial_force, |term| term.tip)
    }

    /// Of the deflection at the pusher.
    pub(crate) fn at_pusher(&self, axial_force: f64) -> AtPlace {
        self.at(axial_force, |term| term.pusher)
    }

    /// Of the deflection at a parallel contact.
    pub(super) fn at_parallel(&self, axial_force: f64) -> AtPlace {
        self.at(axial_force, |term| term.parallel)
    }

    fn at(&self, axial_force: f64, place: impl Fn(&Term) -> f64) -> AtPlace {
        AtPlace {
            own: self.sum(axial_force, |term| place(term) * place(term)),
            across: self.sum(axial_force, |term| place(term) * term.tip),
            turning: self.sum(axial_force, |term| place(term) * term.slope) * (2.0 / self.section.length),
            pushed: self.sum(axial_force, |term| place(term) * term.pusher),
            sag: self.under_gravity(axial_force, place),
        }
    }

    fn under_gravity(&self, axial_force: f64, place: impl Fn(&Term) -> f64) -> f64 {
        let (half_mass, _) = self.section.halves();
        let tip_mass = self.section.tip_mass;
        -self.sum(axial_force, |term| place(term) * (half_mass * term.load + tip_mass * term.tip))
    }

    fn sum(&self, axial_force: f64, product: impl Fn(&Term) -> f64) -> f64 {
        let (length, bending_stiffness) = (self.section.length, self.section.bending_stiffness);
        let compression = axial_force * length * length / (4.0 * bending_stiffness);
        let terms = self.terms.iter();
        let parts = terms.map(|term| product(term) / (1.0 - compression * term.sigma));
        parts.sum::<f64>() * length.powi(3) / (8.0 * bending_stiffness)
    }
}

/// Axial force that a tip deflection `y` (m) causes, N: `N = (3 E I y / L^3) sin(3 y / (2 L))`.
///
/// Machines 2025, 13(1), 52, eq. (9). At the specimen it is 3 mN and shifts the first frequency by 0.025 Hz; it does
/// not explain the shift of 43 Hz published there.
pub fn axial_force_from_deflection(section: &Section, y: f64) -> f64 {
    section.tip_stiffness() * y * (1.5 * y / section.length).sin()
}
