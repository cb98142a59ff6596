//! Eigenvectors of the beam with a linear contact, pair by pair of eigenvalues.

use std::ops::Add;

use crate::closed_loop::eigenvalues;
use crate::closed_loop::oscillator::Oscillator;
use crate::closed_loop::problem::{Number, Pair, Problem, Root};

/// Share of one mode in the motion of a pair. A function `f(l)` on a pair is given as `f_0 + f_1 l`, by `[f_0, f_1]`.
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
    /// The oscillator without loads: nu is the product of the zeros, c minus their sum.
    pub oscillator: Oscillator,
    pub components: Vec<Component>,
}

impl Problem {
    /// The eigenvalues and eigenvectors, a pair for each mode; `None` if they cannot be separated.
    pub fn solve(&self) -> Option<Vec<EigenPair>> {
        let solved = |pair: &Pair| match pair {
            Pair::Close(root) => self.close_pair(*root),
            Pair::Apart(slow, fast) => self.pair_apart(slow, fast),
        };
        Some(eigenvalues::pairs(self)?.iter().map(solved).collect())
    }

    fn close_pair(&self, root: Root<Number>) -> EigenPair {
        let (mean, square) = (root.value.mean, root.value.square);
        let linear = |f: Number| [f.mean - mean * f.slope, f.slope];
        let vectors = self.vectors(root);
        // Products of left and right eigenvectors, for both parts of each; q of the left one multiplies v.
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
        let component = |[q, left]: [Number; 2]| Component {
            q: linear(q),
            v: linear(q * root.value),
            x: [x(linear(left)), x(linear(q))],
            x_rate: [x_rate(linear(left)), x_rate(linear(q))],
        };
        EigenPair {
            oscillator: Oscillator {
                omega_squared: mean * mean - square,
                damping: -2.0 * mean,
                force: [1.0, 0.0],
                ..Oscillator::default()
            },
            components: vectors.into_iter().map(component).collect(),
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
        // Both scaled to the same strain energy, as their contact forces may differ by orders of magnitude.
        let product = |a: &[[f64; 2]], b: &[[f64; 2]]| {
            let parts = a.iter().zip(b).zip(&self.modes);
            parts.map(|(([a, _], [b, _]), (omega, _))| omega * a * b).sum::<f64>()
        };
        let s1 = 1.0 / product(&slow, &slow).sqrt();
        let s2 = (1.0 / product(&fast, &fast).sqrt()).copysign(product(&slow, &fast));
        let (n1, n2) = (n1 * s1, n2 * s2);
        let component = |([q1, left1], [q2, left2]): ([f64; 2], [f64; 2])| {
            let ([x1, x2], [y1, y2]) = ([left1 / n1, left2 / n2], [q1 / n1, q2 / n2]);
            Component {
                q: linear(s1 * q1, s2 * q2),
                v: linear(s1 * l1 * q1, s2 * l2 * q2),
                x: [x1 + x2, y1 + y2],
                x_rate: [l1 * x1 + l2 * x2, l1 * y1 + l2 * y2],
            }
        };
        EigenPair {
            oscillator: Oscillator {
                omega_squared: l1 * l2,
                damping: -(l1 + l2),
                apart: Some([(l1, s1), (l2, s2)]),
                force: linear(s1, s2),
                ..Oscillator::default()
            },
            components: slow.into_iter().zip(fast).map(component).collect(),
        }
    }

    /// For each mode, q_i of the eigenvector of unit contact force and the factor of q_i in the left eigenvector.
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
            // If p_i suffers cancellation, it follows from the secular equation instead.
            let all = self.modes.iter().zip(&inverses).enumerate();
            let others = all.filter(|(n, _)| *n != weakest.1);
            let parts = others.map(|(_, ((_, tip), inverse))| *inverse * (tip * tip));
            let sum = parts.fold(one / (contact * self.contact_stiffness), Add::add);
            if let (Some(inverse), Some((_, tip))) = (inverses.get_mut(weakest.1), self.modes.get(weakest.1)) {
                *inverse = sum * (-1.0 / (tip * tip));
            }
        }
        // (l + c_i) q_i + k beta_c T_i (sum T q), with the secular equation for the sum.
        let excess = self.stiffness_damping - self.contact_damping;
        let vectors = self.modes.iter().zip(inverses).map(|(&(omega, tip), inverse)| {
            let q = inverse * tip;
            [q, q * (value + (self.mass_damping + excess * omega)) / contact]
        });
        vectors.collect()
    }
}
