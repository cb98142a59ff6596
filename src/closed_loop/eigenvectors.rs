//! Eigenvalues and eigenvectors of the beam with a linear contact, from the secular equation.
//!
//! A force `F` on the tip moves the modes of the cantilever as `q_i = T_i F / p_i(l)`, `p_i = l^2 + c_i l + omega_i^2`,
//! and the contact answers with `F = -k (1 + beta_c l) sum T_i q_i`. Both hold at the zeros of
//!
//! `1 + k (1 + beta_c l) sum T_i^2 / p_i(l)`
//!
//! (G. H. Golub, SIAM Review 15 (1973) 318, for a change of rank one; here of stiffness and damping together). The
//! zeros are twice as many as modes, and taken in pairs: complex conjugates, or two real ones. With `c_i = alpha + beta
//! omega_i^2`, `p_i = l (l + alpha) + omega_i^2 h` with `h = 1 + beta l`. Many slow zeros crowd at `l = -1 / beta`,
//! where only `h` tells them apart, so `h` is found along with `l` and not formed from it.

use std::ops::{Add, Div, Mul, Sub};

use crate::closed_loop::eigenvalues;
use crate::math::roots;

/// The beam and its contact.
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

/// A zero `l` of the secular equation, with what would lose digits if it were formed from `l`.
#[derive(Clone, Copy, Debug)]
pub struct Root<T> {
    /// l, 1/s.
    pub value: T,
    /// h = 1 + beta l.
    pub beam: T,
    /// 1 + beta_c l.
    pub contact: T,
}

/// Two zeros that belong together.
#[derive(Clone, Copy, Debug)]
pub enum Pair {
    /// Complex conjugates, equal, or real and close to each other.
    Close(Root<Number>),
    /// Real and apart, the slow one first.
    Apart(Root<f64>, Root<f64>),
}

/// Values of a function at the two zeros `m +- w` of a pair, `mean +- slope w`: real whether the zeros are real, equal
/// or complex, and smooth from one to the other.
#[derive(Clone, Copy, Debug)]
pub struct Number {
    /// Mean of the two values.
    pub mean: f64,
    /// Their difference divided by that of the zeros.
    pub slope: f64,
    /// w^2.
    square: f64,
}

impl Number {
    /// From its parts.
    pub fn new(mean: f64, slope: f64, square: f64) -> Self {
        Self { mean, slope, square }
    }

    /// The same value at one real zero.
    fn real(value: f64) -> Self {
        Self::new(value, 0.0, 0.0)
    }

    fn size(self) -> f64 {
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

impl Sub for Number {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + other * -1.0
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

/// One mode's part of the motion of a pair. A function `f(l)` on a pair is given as `f_0 + f_1 l`, by `[f_0, f_1]`.
#[derive(Clone, Copy, Debug)]
pub struct Component {
    /// q_i per displacement x of the oscillator, and per velocity.
    pub q: [f64; 2],
    /// v_i per x, and per x'.
    pub v: [f64; 2],
    /// x per q_i, and per v_i.
    pub x: [f64; 2],
    /// x' per q_i, and per v_i.
    pub x_rate: [f64; 2],
}

/// A pair as a damped oscillator `x'' + c x' + nu x = 0` with its eigenvectors.
#[derive(Clone, Debug)]
pub struct EigenPair {
    /// nu, the product of the zeros, 1/s2.
    pub omega_squared: f64,
    /// c, minus their sum, 1/s.
    pub damping: f64,
    /// The zeros where they are real and apart, 1/s, each with its part of `force`.
    pub apart: Option<[(f64, f64); 2]>,
    /// Contact force per x and per x'.
    pub force: [f64; 2],
    /// Mode by mode.
    pub components: Vec<Component>,
}

/// Half the distance of two real zeros over their mean, up to which they are treated as close.
const CLOSE: f64 = 1e-1;

impl Problem {
    /// The eigenvalues and eigenvectors, a pair for each mode; `None` where they cannot be told apart.
    pub fn solve(&self) -> Option<Vec<EigenPair>> {
        let undamped = self.undamped()?;
        let pairs = if self.contact_damping == self.stiffness_damping {
            undamped.iter().map(|(nu, _)| self.damped_pair(*nu)).collect()
        } else {
            eigenvalues::pairs(self, &undamped)?
        };
        Some(pairs.iter().map(|pair| self.eigen_pair(pair)).collect())
    }

    /// The zeros without damping, each `-l^2` with the square of its mode's tip displacement (modal mass 1 kg).
    ///
    /// They interlace with the omega_i^2. Each is sought as distance from the nearest of these, which keeps all digits
    /// of it.
    fn undamped(&self) -> Option<Vec<(f64, f64)>> {
        let softness = 1.0 / self.contact_stiffness;
        let total: f64 = self.modes.iter().map(|(_, tip)| tip * tip).sum();
        let rest = |pole: f64, distance: f64| {
            let others = self.modes.iter().filter(|(omega, _)| *omega != pole);
            others
                .map(|(omega, tip)| tip * tip / ((omega - pole) - distance))
                .sum::<f64>()
                + softness
        };
        let mut found = Vec::with_capacity(self.modes.len());
        for (n, &(low, tip)) in self.modes.iter().enumerate() {
            let next = self.modes.get(n + 1);
            let gap = next.map_or(self.contact_stiffness * total, |(high, _)| 0.5 * (high - low));
            let left = |distance: f64| distance * rest(low, distance) - tip * tip;
            let (pole, pole_tip, distance) = match next {
                Some(&(high, tip)) if left(gap) < 0.0 => {
                    let right = |distance: f64| distance * rest(high, distance) - tip * tip;
                    (high, tip, roots::bracketed(right, -gap, 0.0)?)
                }
                _ => (low, tip, roots::bracketed(left, 0.0, gap * (1.0 + 1e-9))?),
            };
            // A mode of unit contact force has q_i = T_i / (omega_i^2 - nu), its tip moves by 1 / k.
            let mass: f64 = self
                .modes
                .iter()
                .map(|(omega, tip)| {
                    let p = if *omega == pole {
                        -distance
                    } else {
                        (omega - pole) - distance
                    };
                    (tip / p).powi(2)
                })
                .sum();
            if pole_tip == 0.0 || !mass.is_finite() {
                return None;
            }
            found.push((pole + distance, softness * softness / mass));
        }
        Some(found)
    }

    /// The pair of a mode whose damping is the beam's.
    fn damped_pair(&self, nu: f64) -> Pair {
        let mean = -0.5 * (self.mass_damping + self.stiffness_damping * nu);
        let square = mean * mean - nu;
        let w = square.max(0.0).sqrt();
        if w > CLOSE * mean.abs() {
            let fast = mean - w;
            let slow = nu / fast;
            // l (l + alpha) + nu h = 0.
            let root = |value: f64| {
                let beam = -value * (value + self.mass_damping) / nu;
                Root {
                    value,
                    beam,
                    contact: beam,
                }
            };
            Pair::Apart(root(slow), root(fast))
        } else {
            let value = Number::new(mean, 1.0, square);
            let beam = value * self.stiffness_damping + 1.0;
            Pair::Close(Root {
                value,
                beam,
                contact: beam,
            })
        }
    }

    fn eigen_pair(&self, pair: &Pair) -> EigenPair {
        match pair {
            Pair::Close(root) => self.close_pair(*root),
            Pair::Apart(slow, fast) => self.pair_apart(slow, fast),
        }
    }

    fn close_pair(&self, root: Root<Number>) -> EigenPair {
        let (mean, square) = (root.value.mean, root.value.square);
        let linear = |f: Number| [f.mean - mean * f.slope, f.slope];
        let vectors = self.vectors(root);
        // Products of the left vectors (of which q is what multiplies v) with the right ones, for either part of both.
        let (mut a, mut b, mut c, mut d) = (0.0, 0.0, 0.0, 0.0);
        for [q, left] in &vectors {
            let ([q0, q1], [v0, v1], [l0, l1]) = (linear(*q), linear(*q * root.value), linear(*left));
            a += l0 * q0 + q0 * v0;
            b += l0 * q1 + q0 * v1;
            c += l1 * q0 + q1 * v0;
            d += l1 * q1 + q1 * v1;
        }
        let determinant = a * d - b * c;
        let x = |[f0, f1]: [f64; 2]| (d * f0 - b * f1) / determinant;
        let x_rate = |[f0, f1]: [f64; 2]| (a * f1 - c * f0) / determinant;
        EigenPair {
            omega_squared: mean * mean - square,
            damping: -2.0 * mean,
            apart: None,
            force: [1.0, 0.0],
            components: vectors
                .into_iter()
                .map(|[q, left]| Component {
                    q: linear(q),
                    v: linear(q * root.value),
                    x: [x(linear(left)), x(linear(q))],
                    x_rate: [x_rate(linear(left)), x_rate(linear(q))],
                })
                .collect(),
        }
    }

    fn pair_apart(&self, slow: &Root<f64>, fast: &Root<f64>) -> EigenPair {
        let (l1, l2) = (slow.value, fast.value);
        let linear = |f1: f64, f2: f64| [(l1 * f2 - l2 * f1) / (l1 - l2), (f1 - f2) / (l1 - l2)];
        let at = |root: &Root<f64>| {
            let vectors = self.vectors(Root {
                value: Number::real(root.value),
                beam: Number::real(root.beam),
                contact: Number::real(root.contact),
            });
            let vectors: Vec<[f64; 2]> = vectors.iter().map(|[q, left]| [q.mean, left.mean]).collect();
            // Left times right vector.
            let product: f64 = vectors.iter().map(|[q, left]| q * (left + root.value * q)).sum();
            (vectors, product)
        };
        let ((slow, n1), (fast, n2)) = (at(slow), at(fast));
        // Both with the same strain energy: the force of one may be far larger.
        let product = |a: &[[f64; 2]], b: &[[f64; 2]]| {
            let parts = a.iter().zip(b).zip(&self.modes);
            parts.map(|(([a, _], [b, _]), (omega, _))| omega * a * b).sum::<f64>()
        };
        let s1 = 1.0 / product(&slow, &slow).sqrt();
        let s2 = (1.0 / product(&fast, &fast).sqrt()).copysign(product(&slow, &fast));
        let (n1, n2) = (n1 * s1, n2 * s2);
        EigenPair {
            omega_squared: l1 * l2,
            damping: -(l1 + l2),
            apart: Some([(l1, s1), (l2, s2)]),
            force: linear(s1, s2),
            components: slow
                .into_iter()
                .zip(fast)
                .map(|([q1, left1], [q2, left2])| {
                    let ([x1, x2], [y1, y2]) = ([left1 / n1, left2 / n2], [q1 / n1, q2 / n2]);
                    Component {
                        q: linear(s1 * q1, s2 * q2),
                        v: linear(s1 * l1 * q1, s2 * l2 * q2),
                        x: [x1 + x2, y1 + y2],
                        x_rate: [l1 * x1 + l2 * x2, l1 * y1 + l2 * y2],
                    }
                })
                .collect(),
        }
    }

    /// Mode by mode q_i of the eigenvector of unit contact force, and what multiplies q_i in the left eigenvector.
    fn vectors(&self, root: Root<Number>) -> Vec<[Number; 2]> {
        let Root { value, beam, contact } = root;
        let own = value * (value + self.mass_damping);
        let one = Number::new(1.0, 0.0, value.square);
        let mut inverses: Vec<Number> = Vec::with_capacity(self.modes.len());
        let mut weakest = (0.1, 0);
        for (n, &(omega, _)) in self.modes.iter().enumerate() {
            let p = own + beam * omega;
            let digits = p.size() / (own.size() + omega * beam.size());
            if digits < weakest.0 {
                weakest = (digits, n);
            }
            inverses.push(one / p);
        }
        if weakest.0 < 0.1 {
            // Where a p_i is the small difference of large terms, the secular equation itself gives it.
            let others = self
                .modes
                .iter()
                .zip(&inverses)
                .enumerate()
                .filter(|(n, _)| *n != weakest.1);
            let sum = others.fold(
                one / (contact * self.contact_stiffness),
                |sum, (_, ((_, tip), inverse))| sum + *inverse * (tip * tip),
            );
            if let (Some(inverse), Some((_, tip))) = (inverses.get_mut(weakest.1), self.modes.get(weakest.1)) {
                *inverse = sum * (-1.0 / (tip * tip));
            }
        }
        // (l + c_i) q_i + k beta_c T_i (sum T q), with the secular equation for the sum.
        let excess = self.stiffness_damping - self.contact_damping;
        self.modes
            .iter()
            .zip(inverses)
            .map(|(&(omega, tip), inverse)| {
                let q = inverse * tip;
                [q, q * (value + (self.mass_damping + excess * omega)) / contact]
            })
            .collect()
    }
}
