//! Finite elements of the cantilever: quintic Hermite polynomials, whose unknowns at each node are displacement, slope and
//! curvature, so that errors of frequencies fall with the eighth power of the element's length.
//!
//! Of `rho A w_tt + E I w_xxxx + N w_xx = F - (rho A + rivet) a` with `w = w_x = 0` at the clamp: the weak form has the mass,
//! the bending stiffness, the integral of the slopes times `-N`, and the integral of the shape functions as load of a base
//! acceleration. The unknowns are `w`, `h w_x` and `h^2 w_xx` with the element's length `h`: all are displacements.

use nalgebra::{DMatrix, DVector, Dyn, linalg::Cholesky};
use relay_contact::scene::Scene;

/// How far from the diagonal the matrices have entries.
pub const BAND: usize = 5;

/// Shape functions of an element from 0 to 1, coefficients of powers ascending.
const SHAPES: [[f64; 6]; 6] = [
    [1.0, 0.0, 0.0, -10.0, 15.0, -6.0],
    [0.0, 1.0, 0.0, -6.0, 8.0, -3.0],
    [0.0, 0.0, 0.5, -1.5, 1.5, -0.5],
    [0.0, 0.0, 0.0, 10.0, -15.0, 6.0],
    [0.0, 0.0, 0.0, -4.0, 7.0, -3.0],
    [0.0, 0.0, 0.0, 0.5, -1.0, 0.5],
];

/// The unknowns that the clamp holds: displacement and slope of the first node.
const HELD: usize = 2;

/// The matrices of a cantilever.
#[derive(Clone, Debug)]
pub struct Cantilever {
    /// E I, N m2.
    pub bending_stiffness: f64,
    /// L, m.
    pub length: f64,
    /// Of beam and rivet, kg.
    pub mass: DMatrix<f64>,
    /// N/m.
    pub bending: DMatrix<f64>,
    /// Integral of products of slopes, 1/m: taken off the bending stiffness times the axial compression.
    pub geometric: DMatrix<f64>,
    /// Load per base acceleration, kg.
    pub load: DVector<f64>,
    /// Which unknown is the displacement of the tip.
    pub tip: usize,
}

impl Cantilever {
    /// The spring of a scene in a number of elements.
    pub fn new(scene: &Scene, elements: usize) -> Self {
        let beam = &scene.beam;
        let bending_stiffness = beam.youngs_modulus * beam.width * beam.thickness.powi(3) / 12.0;
        let mass_per_length = beam.density * beam.width * beam.thickness;
        let h = beam.length / elements as f64;
        let slopes = SHAPES.map(derivative);
        let curvatures = slopes.map(derivative);
        let nodes = 3 * (elements + 1);
        let assembled = |shapes: &[[f64; 6]; 6], factor: f64| {
            let mut matrix = DMatrix::zeros(nodes, nodes);
            for first in (0..3 * elements).step_by(3) {
                for (i, a) in shapes.iter().enumerate() {
                    for (j, b) in shapes.iter().enumerate() {
                        matrix[(first + i, first + j)] += factor * integral(a, b);
                    }
                }
            }
            matrix.view((HELD, HELD), (nodes - HELD, nodes - HELD)).into_owned()
        };
        let mut mass = assembled(&SHAPES, mass_per_length * h);
        let one = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let mut load = DVector::zeros(nodes);
        for first in (0..3 * elements).step_by(3) {
            for (i, shape) in SHAPES.iter().enumerate() {
                load[first + i] += mass_per_length * h * integral(shape, &one);
            }
        }
        let mut load = load.rows(HELD, nodes - HELD).into_owned();
        let tip = 3 * elements - HELD;
        mass[(tip, tip)] += scene.tip.mass;
        mass[(tip + 1, tip + 1)] += scene.tip.rotary_inertia / h.powi(2);
        load[tip] += scene.tip.mass;
        Self {
            bending_stiffness,
            length: beam.length,
            mass,
            bending: assembled(&curvatures, bending_stiffness / h.powi(3)),
            geometric: assembled(&slopes, 1.0 / h),
            load,
            tip,
        }
    }

    /// Tip stiffness 3 E I / L^3 without axial force, N/m.
    pub fn tip_stiffness(&self) -> f64 {
        3.0 * self.bending_stiffness / self.length.powi(3)
    }

    /// Stiffness under an axial compression (N).
    pub fn stiffness(&self, axial_force: f64) -> DMatrix<f64> {
        &self.bending - axial_force * &self.geometric
    }

    /// The same, to solve with; none above the buckling load.
    pub fn solver(&self, axial_force: f64) -> Option<Cholesky<f64, Dyn>> {
        self.stiffness(axial_force).cholesky()
    }

    /// Deflections under a force of 1 N at the tip, and under a base acceleration of 1 m/s2.
    pub fn compliances(&self, solver: &Cholesky<f64, Dyn>) -> (DVector<f64>, DVector<f64>) {
        let mut force = DVector::zeros(self.load.len());
        force[self.tip] = 1.0;
        (solver.solve(&force), solver.solve(&-&self.load))
    }

    /// Lowest angular frequency without contact and axial force, rad/s: by inverse iteration.
    pub fn lowest_frequency(&self) -> Option<f64> {
        let solver = self.solver(0.0)?;
        let (mut shape, _) = self.compliances(&solver);
        // The second frequency is six times higher, so each iteration gains three digits of the eigenvalue.
        for _ in 0..10 {
            shape = solver.solve(&(&self.mass * shape)).normalize();
        }
        let energy = |matrix: &DMatrix<f64>| shape.dot(&(matrix * &shape));
        Some((energy(&self.bending) / energy(&self.mass)).sqrt())
    }
}

fn derivative(shape: [f64; 6]) -> [f64; 6] {
    let [_, b, c, d, e, f] = shape;
    [b, 2.0 * c, 3.0 * d, 4.0 * e, 5.0 * f, 0.0]
}

/// Of a product from 0 to 1.
fn integral(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    let terms = a
        .iter()
        .enumerate()
        .flat_map(|(i, a)| b.iter().enumerate().map(move |(j, b)| a * b / (i + j + 1) as f64));
    terms.sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bare() -> Scene {
        let mut scene = Scene::default();
        scene.tip.mass = 0.0;
        scene
    }

    /// cos x cosh x = -1. Errors are below 5e-8 times the eighth power of the wave's angle in an element; rounding is that of
    /// the largest eigenvalue, which is 1e8 times the first.
    #[test]
    fn frequencies_are_those_of_the_cantilever() {
        let scene = bare();
        let cantilever = Cantilever::new(&scene, 8);
        let root = cantilever.mass.clone().cholesky().unwrap().l().try_inverse().unwrap();
        let mut found: Vec<f64> = (&root * &cantilever.bending * root.transpose())
            .symmetric_eigenvalues()
            .iter()
            .copied()
            .collect();
        found.sort_by(f64::total_cmp);
        let mass = scene.beam.density * scene.beam.width * scene.beam.thickness;
        let unit = cantilever.bending_stiffness / (mass * scene.beam.length.powi(4));
        for (found, wave) in found
            .iter()
            .zip([1.875_104_068_711_961, 4.694_091_132_974_175, 7.854_757_438_237_613])
        {
            let exact = unit * f64::powi(wave, 4);
            let (error, allowed) = ((found / exact - 1.0).abs(), 5e-8 * f64::powi(wave / 8.0, 8) + 3e-9);
            assert!(error < allowed, "{wave}: {error}");
        }
        let lowest = cantilever.lowest_frequency().unwrap();
        assert!((lowest.powi(2) / found[0] - 1.0).abs() < 1e-9);
    }

    /// The compliance of a cantilever under compression N is `(tan(l L) / l - L) / N`, `l^2 = N / (E I)`, also under tension.
    #[test]
    fn compression_softens_as_it_does_exactly() {
        let scene = bare();
        let cantilever = Cantilever::new(&scene, 8);
        let length = scene.beam.length;
        for share in [0.5, -0.3] {
            let axial_force = share * cantilever.bending_stiffness * (std::f64::consts::FRAC_PI_2 / length).powi(2);
            let wave = (f64::abs(axial_force) / cantilever.bending_stiffness).sqrt();
            let bent = if share > 0.0 {
                (wave * length).tan()
            } else {
                (wave * length).tanh()
            };
            let exact = (bent / wave - length) / axial_force;
            let (deflection, _) = cantilever.compliances(&cantilever.solver(axial_force).unwrap());
            let found = deflection[cantilever.tip];
            assert!((found / exact - 1.0).abs() < 1e-10, "{share}: {}", found / exact - 1.0);
        }
    }
}
