//! Axial force that follows the deflection at all times, compression positive, as loads on the modes.
//!
//! With `w = w_0 + sum q_j phi_j`, `w_0` the deflection at preload and `phi_j` the modes under the axial force `N_0`
//! there, the weak form of `rho A w_tt + E I w_xxxx + N w_xx = ...` has the axial force as `-N` times the integral of
//! `w' phi_i'` (the boundary term at the tip is the shear `N w_x` of the condition there). The modes hold its part
//! `-N_0 w'`; what is left is a load on mode i,
//!
//! `L_i = (N(y) - N_0) (g_i + sum_j G_ij q_j)`, `G_ij` the integral of `phi_i' phi_j'`, `g_i` that of `w_0' phi_i'`,
//!
//! where `w_0 = sum q0_j phi_j` with `omega_j^2 q0_j = T_j F_0 - (g_j of the base) g0`, so that `g = G q0`.
//!
//! The tangent of the beam at preload is `diag(omega_i^2) - N'(y_0) g_i T_j`. Its second part has rank one and is not
//! symmetric: the axial force follows the tip alone and acts on the whole beam, so no potential stands behind it, and
//! it does work over a cycle. Such a matrix cannot be part of a Rayleigh damping matrix: `-N' beta g_i T_j` would feed
//! energy in, and has no common modes with the mass. So damping and modes have the stiffness of bending and of the
//! constant `N_0`, which is symmetric and positive below the buckling load; the damping at the tip has
//! `beta N_0 w_xt`. The rest is a load. Relative to the tip stiffness it is of the order of
//! `N_0 L^2 / (E I)`, 7e-4 at the specimen.

use nalgebra::{DMatrix, DVector, Schur};

use crate::beam::mode::{MAX_MODES, Modal, Mode, ModeState};
use crate::beam::section::Section;
use crate::beam::spring::Basis;
use crate::preload::Preload;

/// Of the search for eigenvalues, which takes two or three for each.
const ITERATIONS: usize = 30 * MAX_MODES;

/// The axial force that follows the deflection at all times, as a load on the modes.
#[derive(Clone, Debug)]
pub struct Feedback {
    section: Section,
    /// Deflection of the tip at preload, m.
    deflection: f64,
    /// G_ij, row by row, 1/(kg m).
    pub geometric: Vec<Modal>,
    /// g_i, 1/sqrt(kg).
    pub slopes: Modal,
}

impl Feedback {
    /// For the modes about the preload, under the constant acceleration `gravity` (m/s2).
    pub fn new(section: &Section, preload: &Preload, gravity: f64, basis: &Basis) -> Self {
        let Basis { modes, shapes, space, .. } = basis;
        let slopes: Vec<_> = shapes.iter().map(|shape| space.slopes_of(section.length, shape)).collect();
        let row = |a: &DVector<f64>| std::array::from_fn(|i| slopes.get(i).map_or(0.0, |b| a.dot(b)));
        let geometric: Vec<Modal> = shapes.iter().map(row).collect();
        let at_rest = |mode: &Mode| (mode.tip * preload.force - mode.participation * gravity) / mode.omega_squared;
        let mut slopes = [0.0; MAX_MODES];
        add_rows(&mut slopes, &geometric, modes.iter().map(at_rest));
        Self { section: *section, deflection: preload.deflection, geometric, slopes }
    }

    /// Axial force above that of the preload, N, at a deflection of the tip given as deviation from it (m).
    #[inline(always)]
    pub fn change(&self, y: f64) -> f64 {
        let per_length = 1.5 / self.section.length;
        let sin = (per_length * (self.deflection + y)).sin();
        // Difference of two sines without cancellation.
        let difference = 2.0 * (per_length * (self.deflection + 0.5 * y)).cos() * (0.5 * per_length * y).sin();
        self.section.tip_stiffness() * (y * sin + self.deflection * difference)
    }

    /// Axial force per deflection of the tip, N/m, at the deviation `y` (m) from the preload.
    pub fn slope(&self, y: f64) -> f64 {
        let at = self.deflection + y;
        let (sin, cos) = (1.5 * at / self.section.length).sin_cos();
        self.section.tip_stiffness() * (sin + 1.5 * at / self.section.length * cos)
    }

    /// Loads on the modes in a state.
    pub fn loads(&self, modes: &[Mode], states: &[ModeState]) -> Modal {
        let y: f64 = modes.iter().zip(states).map(|(mode, at)| mode.tip * at.q).sum();
        let mut slopes = self.slopes;
        add_rows(&mut slopes, &self.geometric, states.iter().map(|at| at.q));
        let change = self.change(y);
        slopes.map(|slope| change * slope)
    }

    /// Bound of the change of the modal stiffness by the axial force in a state, relative to the stiffness.
    pub fn strength(&self, modes: &[Mode], states: &[ModeState]) -> f64 {
        let y: f64 = modes.iter().zip(states).map(|(mode, at)| mode.tip * at.q).sum();
        let change = self.change(y);
        // Norms relative to the stiffness; that of the slopes of all modes is bounded by the buckling load.
        let pairs = self.slopes.iter().zip(modes);
        let slopes: f64 = pairs.map(|(g, mode)| g * g / mode.omega_squared).sum();
        let tips: f64 = modes.iter().map(Mode::compliance).sum();
        let geometric = self.geometric.iter().enumerate().zip(modes);
        let own = |i, row: &Modal| row.get(i).copied().unwrap_or_default();
        let trace: f64 = geometric.map(|((i, row), mode)| own(i, row) / mode.omega_squared).sum();
        self.slope(y).abs() * (slopes * tips).sqrt() + change.abs() * trace
    }

    /// Lowest angular frequency (rad/s) of small vibration about the preload, with an elastic support of `stiffness`
    /// (N/m) at the tip: of the tangent `diag(omega_i^2) + (k T_i - N' g_i) T_j`, whose inverse Sherman and Morrison
    /// give.
    pub fn frequency(&self, modes: &[Mode], stiffness: f64) -> Option<f64> {
        let slope = self.slope(0.0);
        let vector = |entry: &dyn Fn(&Mode, f64) -> f64| {
            let entries = modes.iter().zip(&self.slopes).map(|(mode, g)| entry(mode, *g));
            DVector::from_iterator(modes.len(), entries)
        };
        let compliant = vector(&|mode, _| mode.tip / mode.omega_squared);
        let pushed = vector(&|mode, g| (stiffness * mode.tip - slope * g) / mode.omega_squared);
        let tips = vector(&|mode, _| mode.tip);
        let mut inverse = DMatrix::from_diagonal(&vector(&|mode, _| 1.0 / mode.omega_squared));
        inverse.ger(-1.0 / (1.0 + tips.dot(&pushed)), &pushed, &compliant, 1.0);
        // Without a limit the search turned for ever where inertia and many modes spread the frequencies beyond rounding.
        let schur = Schur::try_new(inverse, f64::EPSILON, ITERATIONS)?;
        let largest = schur.complex_eigenvalues().iter().map(|mu| mu.re).fold(0.0, f64::max);
        (largest > 0.0).then(|| 1.0 / largest.sqrt())
    }
}

/// Adds the rows, each times its displacement.
#[inline(always)]
fn add_rows(sums: &mut Modal, rows: &[Modal], displacements: impl Iterator<Item = f64>) {
    for (row, q) in rows.iter().zip(displacements) {
        for (sum, entry) in sums.iter_mut().zip(row) {
            *sum += entry * q;
        }
    }
}
