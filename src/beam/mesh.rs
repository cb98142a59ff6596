//! Bending of a spring of segments by integration along it.
//!
//! On each piece moment, slope and deflection are known at Gauss nodes. A load makes a moment by two integrations from the
//! free end, the moment over `E I` the deflection by two from the clamp: no system of equations, and exact but for the
//! polynomials on a piece.

use nalgebra::{DMatrix, DVector, DVectorView, DVectorViewMut, Dyn, LU};

use crate::beam::pieces::Pieces;
use crate::math::legendre;

pub struct Mesh<'a> {
    pub spring: &'a Pieces,
    stretches: Vec<Stretch>,
    rule: Rule,
}

/// A piece with its nodes.
struct Stretch {
    /// Half its length, m.
    half: f64,
    /// 1 / (E I) at the nodes, 1/(N m2).
    flexibility: Vec<f64>,
    /// rho A at the nodes, kg/m.
    mass_per_length: Vec<f64>,
}

/// Moments along a spring, N m.
#[derive(Clone, Debug)]
pub struct Moments {
    clamp: f64,
    /// At the nodes of all stretches.
    nodes: Vec<f64>,
}

/// A bent spring.
#[derive(Clone, Debug)]
pub struct Bend {
    moments: Moments,
    /// Slope (1) and deflection (m) at the nodes of all stretches.
    pub slope: Vec<f64>,
    pub deflection: Vec<f64>,
    /// Deflection (m) and slope (1) at the ends of the stretches.
    pub ends: Vec<(f64, f64)>,
}

impl Bend {
    /// Deflection (m) and slope (1) at the end of so many stretches.
    pub fn at_end(&self, stretches: usize) -> (f64, f64) {
        let last = stretches.checked_sub(1).and_then(|last| self.ends.get(last));
        last.copied().unwrap_or_default()
    }
}

impl<'a> Mesh<'a> {
    /// With enough nodes for `count` functions.
    pub fn new(spring: &'a Pieces, count: usize) -> Self {
        let rule = Rule::new(spring.nodes(count));
        let stretches = spring.parts.iter().map(|piece| {
            let sections = rule.nodes.iter().map(|x| piece.section(f64::midpoint(*x, 1.0)));
            let (flexibility, mass_per_length) = sections.map(|(stiffness, mass)| (1.0 / stiffness, mass)).unzip();
            Stretch { half: 0.5 * piece.length, flexibility, mass_per_length }
        });
        Self { stretches: stretches.collect(), spring, rule }
    }

    /// The spring under these moments, from the clamp on.
    pub fn bent(&self, moments: Moments) -> Bend {
        let (count, clamp) = (moments.nodes.len(), moments.clamp);
        let mut bend = Bend {
            moments,
            slope: Vec::with_capacity(count),
            deflection: Vec::with_capacity(count),
            ends: Vec::with_capacity(self.stretches.len()),
        };
        let (mut deflection, mut slope) = (0.0, self.spring.clamp_flexibility * clamp);
        for (stretch, moments) in self.stretches.iter().zip(bend.moments.nodes.chunks_exact(self.rule.len())) {
            let (slopes, end) = self.along(stretch, moments, (deflection, slope));
            bend.deflection.extend(self.rule.integrals(&slopes).iter().map(|sum| deflection + stretch.half * sum));
            bend.slope.extend(slopes);
            bend.ends.push(end);
            (deflection, slope) = end;
        }
        bend
    }

    /// Slopes at the nodes of a stretch under moments there (N m); and deflection (m) and slope at its end, from those at its start.
    fn along(&self, stretch: &Stretch, moments: &[f64], (deflection, slope): (f64, f64)) -> (Vec<f64>, (f64, f64)) {
        let half = stretch.half;
        let curvature: Vec<f64> = moments.iter().zip(&stretch.flexibility).map(|(m, f)| m * f).collect();
        let slopes: Vec<f64> = self.rule.integrals(&curvature).iter().map(|sum| slope + half * sum).collect();
        let end = (deflection + half * self.rule.integral(&slopes), slope + half * self.rule.integral(&curvature));
        (slopes, end)
    }

    /// The moments of a force per length at the nodes (N/m), and a force (N) and a moment (N m) at the end of each stretch: from the
    /// free end on.
    fn under(&self, density: &[f64], ends: impl DoubleEndedIterator<Item = (f64, f64)> + ExactSizeIterator) -> Moments {
        let (mut shear, mut moment) = (0.0, 0.0);
        let mut parts = Vec::with_capacity(self.stretches.len());
        let loads = density.chunks_exact(self.rule.len()).zip(ends);
        for (stretch, (density, (force, couple))) in self.stretches.iter().zip(loads).rev() {
            shear += force;
            moment += couple;
            let (half, rule) = (stretch.half, &self.rule);
            // What the load beyond each node makes there, and beyond the start.
            let summed = |values: &[f64], beyond: f64| -> (Vec<f64>, f64) {
                let whole = rule.integral(values);
                let at_nodes = rule.integrals(values);
                (at_nodes.iter().map(|sum| beyond + half * (whole - sum)).collect(), beyond + half * whole)
            };
            let (shears, moments);
            (shears, shear) = summed(density, shear);
            (moments, moment) = summed(&shears, moment);
            parts.push(moments);
        }
        parts.reverse();
        Moments { clamp: moment, nodes: parts.concat() }
    }

    /// Of unit force at the end of so many stretches.
    pub fn pushed(&self, stretches: usize) -> Moments {
        self.loaded(stretches, (1.0, 0.0))
    }

    /// Of unit moment there.
    pub fn turned(&self, stretches: usize) -> Moments {
        self.loaded(stretches, (0.0, 1.0))
    }

    /// Of a force (N) and a moment (N m) there.
    fn loaded(&self, stretches: usize, load: (f64, f64)) -> Moments {
        let ends = (0..self.stretches.len()).map(|at| if at + 1 == stretches { load } else { (0.0, 0.0) });
        self.under(&vec![0.0; self.stretches.len() * self.rule.len()], ends)
    }

    /// Of the inertia of unit acceleration, and of unit angular acceleration about the clamp.
    pub fn shaken(&self) -> [Moments; 2] {
        let (mut start, mut places, mut ends) = (0.0, Vec::new(), Vec::new());
        for stretch in &self.stretches {
            places.extend(self.rule.nodes.iter().map(|x| start + stretch.half * (x + 1.0)));
            start += 2.0 * stretch.half;
            ends.push((start, 1.0));
        }
        let moved = self.accelerated(&vec![1.0; places.len()], &vec![(1.0, 0.0); ends.len()]);
        [moved, self.accelerated(&places, &ends)]
    }

    /// Of the inertia of an acceleration of this shape.
    pub fn swung(&self, shape: &Bend) -> Moments {
        self.accelerated(&shape.deflection, &shape.ends)
    }

    /// Of the inertia of these accelerations of the nodes (m/s2), and of the ends with angular ones (1/s2).
    fn accelerated(&self, nodes: &[f64], ends: &[(f64, f64)]) -> Moments {
        let masses = self.stretches.iter().flat_map(|stretch| &stretch.mass_per_length);
        let density: Vec<_> = masses.zip(nodes).map(|(m, a)| m * a).collect();
        let ends = self.spring.parts.iter().zip(ends);
        self.under(&density, ends.map(|(at, (a, turn))| (at.mass * a, at.inertia * turn)))
    }

    /// Of unit axial compression between clamp and contact in this shape.
    pub fn compressed(&self, shape: &Bend) -> Moments {
        let (at_contact, _) = shape.at_end(self.spring.before_contact);
        let nodes = self.spring.before_contact * self.rule.len();
        let moments = shape.deflection.iter().enumerate();
        let moments = moments.map(|(n, deflection)| if n < nodes { at_contact - deflection } else { 0.0 });
        Moments { clamp: at_contact, nodes: moments.collect() }
    }

    /// What an axial compression (N) between clamp and contact adds to loads, of a tension as much as rounding allows; `None` if the spring
    /// buckles under it.
    pub fn compression(&self, force: f64) -> Option<Compression<'_>> {
        let count = self.rule.len();
        let mut twice = self.rule.partial.clone();
        for mut column in twice.column_iter_mut() {
            let sums = self.rule.integrals(column.as_slice());
            column.copy_from(&sums);
        }
        let equations = self.stretches.iter().take(self.spring.before_contact).map(|stretch| {
            let mut matrix = &twice * (force * stretch.half * stretch.half);
            for (mut column, flexibility) in matrix.column_iter_mut().zip(&stretch.flexibility) {
                column *= *flexibility;
            }
            (matrix + DMatrix::identity(count, count)).lu()
        });
        let mut compression =
            Compression { mesh: self, force, equations: equations.collect(), moved: self.none(), rest: 1.0 };
        let (moved, deflection) = compression.moments(self.none(), 1.0);
        (compression.moved, compression.rest) = (moved, 1.0 - deflection);
        // With tension it is 1 or more, but for rounding.
        if force < 0.0 && !(0.5..STEEPEST).contains(&compression.rest) {
            return self.compression(0.5 * force);
        }
        (compression.rest > 0.0).then_some(compression)
    }

    /// Factors of the products of deflections in the kinetic energy, and of slopes in the work of an axial compression:
    /// at the nodes, then masses and rotary inertias at the ends.
    pub fn inertia(&self) -> (Vec<f64>, Vec<f64>, Vec<(f64, f64)>) {
        let count = self.stretches.len() * self.rule.len();
        let (mut masses, mut lengths) = (Vec::with_capacity(count), Vec::with_capacity(count));
        for (n, stretch) in self.stretches.iter().enumerate() {
            let axial = if n < self.spring.before_contact { stretch.half } else { 0.0 };
            lengths.extend(self.rule.weights.iter().map(|weight| weight * axial));
            let nodes = self.rule.weights.iter().zip(&stretch.mass_per_length);
            masses.extend(nodes.map(|(weight, mass)| weight * stretch.half * mass));
        }
        let ends = self.spring.parts.iter().map(|piece| (piece.mass, piece.inertia));
        (masses, lengths, ends.collect())
    }

    /// How far moments turn the clamp, and the part of a stretch that each node stands for, 1.
    fn turns(&self, moments: &Moments) -> (f64, Vec<f64>) {
        let parts = self.stretches.iter().flat_map(|stretch| {
            let nodes = self.rule.weights.iter().zip(&stretch.flexibility);
            nodes.map(|(weight, flexibility)| stretch.half * weight * flexibility)
        });
        let turns = parts.zip(&moments.nodes).map(|(part, moment)| part * moment);
        (self.spring.clamp_flexibility * moments.clamp, turns.collect())
    }

    /// The shape under moments without its parts along others, which are orthonormal in strain energy, itself of unit energy; `None`
    /// if nothing is left.
    pub fn orthonormal(&self, mut moments: Moments, others: &[Bend]) -> Option<Bend> {
        let size = moments.work(&self.turns(&moments)).sqrt();
        // Twice is enough.
        for _ in 0..2 {
            let turns = self.turns(&moments);
            for other in others {
                moments.add(-other.moments.work(&turns), &other.moments);
            }
        }
        let rest = moments.work(&self.turns(&moments)).sqrt();
        (rest > DEPENDENT * size).then(|| {
            moments.clamp /= rest;
            moments.nodes.iter_mut().for_each(|moment| *moment /= rest);
            self.bent(moments)
        })
    }

    /// The moments of the sum of shapes, each times a factor.
    pub fn sum<'b>(&self, parts: impl Iterator<Item = (f64, &'b Bend)>) -> Moments {
        let mut moments = self.none();
        for (factor, shape) in parts {
            moments.add(factor, &shape.moments);
        }
        moments
    }

    /// No moments.
    fn none(&self) -> Moments {
        Moments { clamp: 0.0, nodes: vec![0.0; self.stretches.len() * self.rule.len()] }
    }
}

impl Moments {
    /// Work on what turns so far, J.
    fn work(&self, (clamp, nodes): &(f64, Vec<f64>)) -> f64 {
        self.clamp * clamp + dot(&self.nodes, nodes)
    }

    /// Adds a multiple of others.
    fn add(&mut self, factor: f64, others: &Self) {
        self.clamp += factor * others.clamp;
        for (own, other) in self.nodes.iter_mut().zip(&others.nodes) {
            *own += factor * other;
        }
    }
}

/// A constant axial compression between clamp and contact. With the deflection `w_c` of the contact it adds `N (w_c - w)` to the moment of
/// loads: an initial value problem from the clamp on, linear in `w_c`.
pub struct Compression<'a> {
    mesh: &'a Mesh<'a>,
    /// N.
    force: f64,
    /// For the moments at the nodes of each stretch up to the contact.
    equations: Vec<LU<f64, Dyn, Dyn>>,
    /// Moments per deflection of the contact, N.
    moved: Moments,
    /// What they leave of that deflection, 1: 0 at the buckling load; with tension it grows as the hyperbolic cosine.
    rest: f64,
}

impl Compression<'_> {
    /// The moments of loads and the compression, from those of the loads alone.
    pub fn added(&self, moments: Moments) -> Moments {
        let (mut moments, deflection) = self.moments(moments, 0.0);
        moments.add(deflection / self.rest.max(LEAST_REST), &self.moved);
        moments
    }

    /// The moments in place of those of the loads, were the contact deflected so far (m); and the deflection that it has under them.
    fn moments(&self, mut moments: Moments, at_contact: f64) -> (Moments, f64) {
        let Mesh { spring, stretches, rule } = self.mesh;
        moments.clamp += self.force * at_contact;
        let mut start = (0.0, spring.clamp_flexibility * moments.clamp);
        let parts = stretches.iter().zip(&self.equations).zip(moments.nodes.chunks_exact_mut(rule.len()));
        for ((stretch, equations), moments) in parts {
            let (deflection, slope) = start;
            for (moment, x) in moments.iter_mut().zip(&rule.nodes) {
                *moment += self.force * (at_contact - deflection - stretch.half * (x + 1.0) * slope);
            }
            equations.solve_mut(&mut DVectorViewMut::from_slice(moments, rule.len()));
            (_, start) = self.mesh.along(stretch, moments, start);
        }
        (moments, start.0)
    }
}

/// Largest factor by which a tension may make rounding grow along the spring, 1. Chosen: half of the digits; a tension of some hundred
/// buckling loads.
const STEEPEST: f64 = 1e8;

/// Least [`Compression::rest`] that counts, 1: nearer to the buckling load all shapes would be that of buckling to rounding, and too few
/// functions be left of them.
const LEAST_REST: f64 = 1e-2;

/// Share of a shape that must be left of it beside others for it to be another one.
const DEPENDENT: f64 = 1e-9;

/// Gauss quadrature on [-1, 1], also from -1 to each node.
struct Rule {
    nodes: Vec<f64>,
    weights: Vec<f64>,
    /// By rows of nodes: the integral to it of what is 1 at one node and 0 at the others.
    partial: DMatrix<f64>,
}

impl Rule {
    fn new(count: usize) -> Self {
        let (nodes, weights): (Vec<f64>, Vec<f64>) = legendre::gauss(count).unzip();
        let values: Vec<_> = nodes.iter().map(|x| legendre::polynomials(*x, count + 1)).collect();
        let value = |node: usize, k: usize| values.get(node).and_then(|at| at.get(k)).copied().unwrap_or_default();
        // Integral of P_k from -1 on, (P_(k+1) - P_(k-1)) / (2 k + 1), with P_-1 = -1; times k + 1/2.
        let below = |node: usize, k: usize| k.checked_sub(1).map_or(-1.0, |below| value(node, below));
        let integrals = DMatrix::from_fn(count, count, |node, k| 0.5 * (value(node, k + 1) - below(node, k)));
        let mut partial = DMatrix::zeros(count, count);
        for ((n, weight), mut column) in weights.iter().enumerate().zip(partial.column_iter_mut()) {
            column.gemv(*weight, &integrals, &DVector::from_fn(count, |k, _| value(n, k)), 0.0);
        }
        Self { nodes, weights, partial }
    }

    fn len(&self) -> usize {
        self.nodes.len()
    }

    fn integral(&self, values: &[f64]) -> f64 {
        dot(&self.weights, values)
    }

    /// From -1 to each node.
    fn integrals(&self, values: &[f64]) -> DVector<f64> {
        &self.partial * DVectorView::from_slice(values, self.len())
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    DVectorView::from_slice(a, a.len()).dot(&DVectorView::from_slice(b, b.len()))
}
