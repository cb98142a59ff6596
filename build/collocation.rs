//! The polynomials of a step with so many nodes, as Rust: computed once and for all.

use std::fmt::Write as _;

use crate::math::series::{NEGLIGIBLE, TERMS};
use crate::math::{legendre, roots};

/// Points of the quadrature for repeated integrals. Exact for all that are large. Pinned: ÷ 5,
/// `responses_agree_with_quadrature_in_every_regime`.
const POINTS: usize = 20;

/// Terms of the polynomial through the start and the nodes of a long step.
const MOST: usize = 9;

/// All that are used.
pub fn all() -> String {
    let mut code = String::new();
    for (name, size, count, by_root) in
        [("SHORT_BY_TIME", "SHORT", 4, false), ("LONG_BY_TIME", "LONG", 8, false), ("LONG_BY_ROOT", "LONG", 8, true)]
    {
        let _ = write!(
            code,
            "/// Those of steps with {count} nodes.\n#[expect(clippy::unreadable_literal, reason = \"nobody reads them\")]\n\
             pub static {name}: Collocation<{size}> = {};\n",
            collocation(count, by_root)
        );
    }
    code
}

/// `Collocation` of a step with so many Radau IIA nodes.
fn collocation(count: usize, by_root: bool) -> String {
    let nodes: Vec<_> = radau(count).iter().map(|x| f64::midpoint(1.0, *x)).collect();
    let at_start = derivatives(&nodes, 0.0);
    let at_start: Vec<_> = at_start.iter().take(count).map(|shape| shape[0]).collect();
    let leading = nodes.iter().map(|own| {
        let others = nodes.iter().filter(|node| *node != own);
        others.map(|node| 1.0 / (own - node)).product::<f64>()
    });
    let without = |first: usize| {
        let fewer = lagrange(&nodes[first..]);
        let values = [0.0].into_iter().cycle().take(first);
        values.chain(fewer.iter().map(|shape| shape[0])).collect::<Vec<_>>()
    };
    let places = nodes.iter().map(|node| 2.0 * (node - 1.0) + 1.0);
    let places: Vec<_> = [-1.0].into_iter().chain(places).collect();
    let with_start = lagrange(&places);
    let integrals = integrals(&nodes, by_root);
    let shapes = shapes(&nodes, by_root, &integrals);
    let impulses = integrals[0].error.iter().map(|impulse| impulse.abs());
    let impulse = impulses.fold(0.0, f64::max);
    let quadrature = 0.5 * count as f64 * factorial(count - 1).powi(2) / factorial(2 * count - 1);
    format!(
        "Collocation {{ nodes: {:?}, variable: {}, places: {nodes:?}, shapes: {shapes}, at_start: {at_start:?}, \
         at_start_of_fewer: {:?}, weights: {:?}, leading: {:?}, quadrature: {quadrature:?}, impulse: {impulse:?}, \
         start: &{:?}, beside_start: &{:?}, nodal: &{:?} }}",
        times(&nodes, by_root),
        variable(by_root),
        [without(1), without(2), without(3)],
        integrals[0].end(),
        leading.collect::<Vec<_>>(),
        with_start[0],
        &with_start[1..],
        lagrange(&places[1..]),
    )
}

/// Nodes of the Radau quadrature with `count` points on [-1, 1] that include 1, ascending: the roots of
/// P_count - P_(count-1).
fn radau(count: usize) -> Vec<f64> {
    let difference = |x: f64| match legendre::polynomials(x, count + 1).as_slice() {
        [.., below, top] => top - below,
        _ => 0.0,
    };
    // Its roots other than 1 interlace with those of P_count: one lies between any two neighbouring Gauss nodes.
    let gauss: Vec<f64> = legendre::gauss(count).map(|(x, _)| x).collect();
    let between = gauss.windows(2).filter_map(|pair| match pair {
        [a, b] => roots::bracketed(difference, *a, *b),
        _ => None,
    });
    between.chain([1.0]).collect()
}

/// `Shapes` with these repeated integrals.
fn shapes(nodes: &[f64], by_root: bool, integrals: &[Table]) -> String {
    let times = times(nodes, by_root);
    let mut power = vec![1.0; nodes.len()];
    let powers = (0..=TERMS).map(|n| {
        let next = power.iter().zip(&times).map(|(power, x)| power * (x / (n + 1) as f64));
        let next = next.collect();
        std::mem::replace(&mut power, next)
    });
    let negligible = (1..TERMS).map(|n| (NEGLIGIBLE * factorial(n)).powf(1.0 / n as f64));
    let at_nodes: Vec<_> = nodes.iter().map(|x| derivatives(nodes, *x)).collect();
    let table = |m| Table::of(nodes.len(), |i, shape| at_nodes[i][shape][m]);
    let derivatives_at_nodes: Vec<_> = (0..=nodes.len()).map(table).collect();
    let start = derivatives(nodes, 0.0);
    let rows = (0..=nodes.len()).map(|m| {
        let mut nodal: Vec<_> = start.iter().map(|shape| shape[m]).collect();
        let error = nodal.pop().unwrap_or_default();
        Row { nodal, error }
    });
    let rows: Vec<_> = rows.collect();
    let ends = |tables: &[Table]| tables.iter().map(Table::end).collect::<Vec<_>>();
    format!(
        "Shapes {{ variable: {}, powers: {:?}, negligible: {:?}, integrals: {integrals:?}, end_integrals: {:?}, \
         derivatives: &{derivatives_at_nodes:?}, end_derivatives: &{:?}, start_derivatives: &{rows:?} }}",
        variable(by_root),
        powers.collect::<Vec<_>>(),
        negligible.collect::<Vec<_>>(),
        ends(integrals),
        ends(&derivatives_at_nodes),
    )
}

/// A value at every node for every load shape.
#[derive(Debug)]
struct Table {
    nodal: Vec<Vec<f64>>,
    error: Vec<f64>,
}

/// A value for every load shape at one instant.
#[derive(Debug)]
#[expect(dead_code, reason = "they are printed")]
struct Row {
    nodal: Vec<f64>,
    error: f64,
}

impl Table {
    /// From the values by node and shape.
    fn of(count: usize, value: impl Fn(usize, usize) -> f64) -> Self {
        let column = |shape: usize| (0..count).map(|i| value(i, shape)).collect::<Vec<_>>();
        Self { nodal: (0..count).map(column).collect(), error: column(count) }
    }

    /// The Lagrange polynomials at the last node.
    fn end(&self) -> Vec<f64> {
        self.nodal.iter().map(|column| column[column.len() - 1]).collect()
    }
}

/// `n`-fold integrals by Cauchy's formula, the integral of `(x - s)^(n-1) / (n-1)!` times the shape, by Gauss
/// quadrature.
fn integrals(nodes: &[f64], by_root: bool) -> Vec<Table> {
    let points: Vec<_> = legendre::gauss(POINTS).collect();
    // By node and order, of each shape, and of its magnitude.
    let by_node: Vec<_> = nodes
        .iter()
        .map(|&x| {
            let mut sums = vec![[[0.0; MOST]; 2]; TERMS];
            for (point, weight) in &points {
                let s = x * f64::midpoint(1.0, *point);
                let slope = if by_root { 2.0 * s } else { 1.0 };
                let ends = times(&[x, s], by_root);
                let mut kernel = 0.5 * weight * x * slope;
                let values = shape_values(nodes, s);
                for (n, [sums, sizes]) in sums.iter_mut().enumerate() {
                    for ((sum, size), value) in sums.iter_mut().zip(sizes).zip(&values) {
                        *sum = kernel.mul_add(*value, *sum);
                        *size = kernel.mul_add(value.abs(), *size);
                    }
                    kernel *= (ends[0] - ends[1]) / (n + 1) as f64;
                }
            }
            sums
        })
        .collect();
    let table = |n: usize| {
        Table::of(nodes.len(), |i, shape| {
            let [sums, sizes] = &by_node[i][n];
            // What is mere rounding is zero.
            let is_rounding = sums[shape].abs() <= 16.0 * f64::EPSILON * sizes[shape];
            if is_rounding { 0.0 } else { sums[shape] }
        })
    };
    (0..TERMS).map(table).collect()
}

fn shape_values(nodes: &[f64], s: f64) -> Vec<f64> {
    let lagrange = nodes.iter().map(|own| {
        let others = nodes.iter().filter(|node| *node != own);
        others.map(|node| (s - node) / (own - node)).product()
    });
    let vanishing = nodes.iter().map(|node| 1.0 - s / node).product();
    lagrange.chain([vanishing]).collect()
}

/// The derivatives of all shapes (m = 0, 1, ...) at a place, from their Taylor coefficients about it.
fn derivatives(nodes: &[f64], at: f64) -> Vec<[f64; MOST]> {
    let from_there: Vec<_> = nodes.iter().map(|node| node - at).collect();
    let without = |shape, node: &f64| multiplied(shape, -1.0 / node, (node - at) / node);
    let vanishing = nodes.iter().fold(one(), without);
    let mut shapes = lagrange(&from_there);
    shapes.push(vanishing);
    for shape in &mut shapes {
        for (m, coefficient) in shape.iter_mut().enumerate() {
            *coefficient *= factorial(m);
        }
    }
    shapes
}

/// Coefficients of the Lagrange polynomials of the points.
fn lagrange(points: &[f64]) -> Vec<[f64; MOST]> {
    let polynomial = |own: &f64| {
        let others = points.iter().filter(|point| *point != own);
        let times = |shape, point: &f64| multiplied(shape, 1.0 / (own - point), -point / (own - point));
        others.fold(one(), times)
    };
    points.iter().map(polynomial).collect()
}

fn one() -> [f64; MOST] {
    let mut shape = [0.0; MOST];
    shape[0] = 1.0;
    shape
}

/// The polynomial times `a x + b`.
fn multiplied(shape: [f64; MOST], a: f64, b: f64) -> [f64; MOST] {
    let mut below = 0.0;
    shape.map(|coefficient| {
        let value = b * coefficient + a * below;
        below = coefficient;
        value
    })
}

fn factorial(n: usize) -> f64 {
    (1..=n).fold(1.0, |product, k| product * k as f64)
}

/// The parts of the step at places in it, 0 to 1.
fn times(places: &[f64], by_root: bool) -> Vec<f64> {
    let time = |place: &f64| if by_root { place * place } else { *place };
    places.iter().map(time).collect()
}

fn variable(by_root: bool) -> &'static str {
    if by_root { "Variable::Root" } else { "Variable::Time" }
}
