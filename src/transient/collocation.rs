//! The polynomial in time that stands for contact force and base acceleration within a step.

use crate::math::legendre;

/// Gauss nodes in a step.
pub const NODES: usize = 4;

/// A value at each node.
pub type Nodal = [f64; NODES];

/// A polynomial through the nodes and the end of a step, by its coefficients about the end: it predicts the next step.
pub type Prediction = [f64; NODES + 1];

/// Number of load shapes: one for each node, two for the error estimate.
pub const SHAPES: usize = NODES + 2;

/// Nodes on [0, 1], and the shapes as polynomials in `x = t / h`.
#[derive(Clone, Debug)]
pub struct Collocation {
    /// Nodes, ascending.
    pub nodes: Nodal,
    /// Coefficients of `x^m / m!`, m = 0, 1, ..., of: the Lagrange polynomials of the nodes, then `P(2x - 1)` and
    /// `(2x - 1) P(2x - 1)`, where `P` is the Legendre polynomial that vanishes at the nodes.
    pub shapes: [[f64; SHAPES]; SHAPES],
    /// Lagrange polynomials at the start and the end of the step.
    pub at_start: Nodal,
    /// See [`Collocation::at_start`].
    pub at_end: Nodal,
    /// Row by row the coefficients of y^0, y^1, ..., `y = x - 1`, of the polynomial that is 1 at one of the nodes or (the
    /// last row) at the end of the step, and 0 at the others.
    prediction: [Prediction; NODES + 1],
}

impl Collocation {
    /// The nodes and shapes.
    pub fn new() -> Self {
        let mut nodes = [0.0; NODES];
        for (node, (x, _)) in nodes.iter_mut().zip(legendre::gauss(NODES)) {
            *node = f64::midpoint(1.0, x);
        }
        let mut shapes = [[0.0; SHAPES]; SHAPES];
        for (shape, &own) in shapes.iter_mut().zip(&nodes) {
            let others = nodes.iter().filter(|&&node| node != own);
            let scale: f64 = others.clone().map(|node| own - node).product();
            *shape = others.fold(constant(1.0 / scale), |shape, &node| times(shape, 1.0, -node));
        }
        // P(2x - 1) is the product of its linear factors, 1 at x = 1.
        let scale: f64 = nodes.iter().map(|node| 1.0 - node).product();
        let legendre = nodes
            .iter()
            .fold(constant(1.0 / scale), |shape, &node| times(shape, 1.0, -node));
        for (shape, value) in shapes
            .iter_mut()
            .skip(NODES)
            .zip([legendre, times(legendre, 2.0, -1.0)])
        {
            *shape = value;
        }
        let mut at_start = [0.0; NODES];
        let mut at_end = [0.0; NODES];
        for ((start, end), shape) in at_start.iter_mut().zip(&mut at_end).zip(&shapes) {
            *start = shape.first().copied().unwrap_or_default();
            *end = shape.iter().sum();
        }
        for shape in &mut shapes {
            let mut factorial = 1.0;
            for (m, coefficient) in shape.iter_mut().enumerate() {
                *coefficient *= factorial;
                factorial *= (m + 1) as f64;
            }
        }
        let prediction = prediction_basis(&nodes);
        Self {
            nodes,
            shapes,
            at_start,
            at_end,
            prediction,
        }
    }

    /// The nodal polynomial through `values`, at `x` (in steps).
    pub fn interpolate(&self, values: &Nodal, x: f64) -> f64 {
        let mut sum = 0.0;
        for (value, &own) in values.iter().zip(&self.nodes) {
            let others = self.nodes.iter().filter(|&&node| node != own);
            sum += value * others.map(|node| (x - node) / (own - node)).product::<f64>();
        }
        sum
    }

    /// The polynomial through the values at the nodes and at the end.
    pub fn prediction(&self, values: &Nodal, end: f64) -> Prediction {
        let mut sum = [0.0; NODES + 1];
        for (value, row) in values.iter().chain([&end]).zip(&self.prediction) {
            for (sum, coefficient) in sum.iter_mut().zip(row) {
                *sum += value * coefficient;
            }
        }
        sum
    }

    /// Values of the prediction at the nodes of a step `ratio` times as long as the one it is from.
    pub fn predict(&self, prediction: &Prediction, ratio: f64) -> Nodal {
        self.nodes.map(|node| {
            let y = node * ratio;
            prediction
                .iter()
                .rev()
                .fold(0.0, |sum, coefficient| sum * y + coefficient)
        })
    }
}

/// The Lagrange polynomials of the nodes and the end, about the end.
fn prediction_basis(nodes: &Nodal) -> [Prediction; NODES + 1] {
    let mut points = [0.0; NODES + 1];
    for (point, node) in points.iter_mut().zip(nodes) {
        *point = node - 1.0;
    }
    points.map(|own| {
        let mut row = [0.0; NODES + 1];
        if let Some(first) = row.first_mut() {
            *first = 1.0;
        }
        for &point in points.iter().filter(|&&point| point != own) {
            // Times (y - point) / (own - point).
            let mut below = 0.0;
            for coefficient in &mut row {
                let value = (below - point * *coefficient) / (own - point);
                below = *coefficient;
                *coefficient = value;
            }
        }
        row
    })
}

impl Default for Collocation {
    fn default() -> Self {
        Self::new()
    }
}

fn constant(value: f64) -> [f64; SHAPES] {
    let mut shape = [0.0; SHAPES];
    if let Some(first) = shape.first_mut() {
        *first = value;
    }
    shape
}

/// The polynomial times `a x + b`.
fn times(shape: [f64; SHAPES], a: f64, b: f64) -> [f64; SHAPES] {
    let mut below = 0.0;
    shape.map(|coefficient| {
        let value = b * coefficient + a * below;
        below = coefficient;
        value
    })
}

/// Scalar product of two sets of nodal values.
pub fn dot(a: &Nodal, b: &Nodal) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
