//! The secular equation of the beam with a linear contact, whose zeros are the eigenvalues of the two together.
//!
//! A force `F` on the tip moves the modes of the cantilever as `q_i = T_i F / p_i(l)`, `p_i = l^2 + c_i l + omega_i^2`,
//! and the contact force is `F = -k (1 + beta_c l) sum T_i q_i`. Both hold at the zeros of
//!
//! `1 + k (1 + beta_c l) sum T_i^2 / p_i(l)`
//!
//! (G. H. Golub, SIAM Review 15 (1973) 318, for a change of rank one; here of stiffness and damping together). The
//! zeros are twice as many as modes, and form pairs: complex conjugates, or two real ones. With `c_i = alpha + beta
//! omega_i^2`, `p_i = l (l + alpha) + omega_i^2 h` with `h = 1 + beta l`. Many slow zeros cluster at `l = -1 / beta`,
//! where only `h` separates them, so `h` is computed along with `l` and not from it.

use std::ops::{Add, Div, Mul};

#[derive(Clone, Debug)]
pub struct Problem {
    /// omega_i^2 and T_i of the modes of the cantilever, frequency ascending.
    pub modes: Vec<(f64, f64)>,
    /// alpha, 1/s.
    pub mass_damping: f64,
    /// beta, s.
    pub stiffness_damping: f64,
    /// k, N/m.
    pub contact_stiffness: f64,
    /// beta_c, s.
    pub contact_damping: f64,
}

/// A zero `l` of the secular equation, with quantities that would lose digits if computed from `l`.
#[derive(Clone, Copy, Debug)]
pub struct Root<T> {
    /// l, 1/s.
    pub value: T,
    /// h = 1 + beta l.
    pub beam: T,
    /// 1 + beta_c l.
    pub contact: T,
}

#[derive(Clone, Copy, Debug)]
pub enum Pair {
    /// Complex conjugates, equal, or real and close to each other.
    Close(Root<Number>),
    /// Real and distinct, the slow one first.
    Apart(Root<f64>, Root<f64>),
}

/// Values of a function at the two zeros `m +- w` of a pair, `mean +- slope w`: real whether the zeros are real, equal
/// or complex, and smooth from one to the other.
#[derive(Clone, Copy, Debug)]
pub struct Number {
    /// Mean of the two values.
    pub mean: f64,
    /// Divided difference of the two values.
    pub slope: f64,
    /// w^2.
    pub(crate) square: f64,
}

impl Number {
    /// From mean, divided difference and `w^2`.
    pub fn new(mean: f64, slope: f64, square: f64) -> Self {
        Self { mean, slope, square }
    }

    /// The same value at one real zero.
    pub(crate) fn real(value: f64) -> Self {
        Self::new(value, 0.0, 0.0)
    }

    pub(crate) fn size(self) -> f64 {
        self.mean.abs() + self.slope.abs() * self.square.abs().sqrt()
    }
}

impl Add for Number {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.mean + other.mean, self.slope + other.slope, self.square)
    }
}

impl Add<f64> for Number {
    type Output = Self;
    fn add(self, other: f64) -> Self {
        Self::new(self.mean + other, self.slope, self.square)
    }
}

impl Mul for Number {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::new(
            self.mean * other.mean + self.square * self.slope * other.slope,
            self.mean * other.slope + self.slope * other.mean,
            self.square,
        )
    }
}

impl Mul<f64> for Number {
    type Output = Self;
    fn mul(self, other: f64) -> Self {
        Self::new(self.mean * other, self.slope * other, self.square)
    }
}

impl Div for Number {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let product = other.mean * other.mean - other.square * other.slope * other.slope;
        self * Self::new(other.mean / product, -other.slope / product, self.square)
    }
}
