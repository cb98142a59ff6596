//! The same equations integrated in another way: total deflections instead of deviations from the preload, polynomials
//! instead of modes, Runge-Kutta steps instead of exact modes.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use relay_contact::reference::{Power, Preload, Section, Spring};
use relay_contact::scene::Scene;

use crate::FUNCTIONS;

/// The equations in the total deflection `w = sum r_a (x/L)^2 P_a(2 x/L - 1)`.
pub struct Reference {
    section: Section,
    hertz: Power,
    pub preload: Preload,
    scene: Scene,
    pub inverse_mass: DMatrix<f64>,
    pub bending: DMatrix<f64>,
    pub geometric: DMatrix<f64>,
    damping: DMatrix<f64>,
    /// Load per base acceleration.
    load: DVector<f64>,
    /// Deflection of the tip at preload, of the continuum, beyond what these few functions make of it, m.
    beyond: f64,
    pub r: DVector<f64>,
    v: DVector<f64>,
    pub time: f64,
}

impl Reference {
    pub fn new(scene: &Scene) -> Self {
        Self::with::<FUNCTIONS>(scene)
    }

    /// With fewer functions.
    pub fn with<const COUNT: usize>(scene: &Scene) -> Self {
        let spring = Spring::new(scene).unwrap();
        let section = spring.section;
        let hertz = Power::hertz(&scene.contact);
        let preload = Preload::new(scene, &spring, &hertz, 0.0).unwrap();
        let Section {
            length,
            bending_stiffness,
            mass_per_length,
            tip_mass,
            ..
        } = section;
        // Shifted Legendre polynomials, of which monomials would lose half the digits.
        let legendre = DMatrix::from_row_slice(
            FUNCTIONS,
            FUNCTIONS,
            &[
                1.0, 0.0, 0.0, 0.0, -1.0, 2.0, 0.0, 0.0, 1.0, -6.0, 6.0, 0.0, -1.0, 12.0, -30.0, 20.0,
            ],
        );
        let legendre = legendre.view((0, 0), (COUNT, COUNT)).into_owned();
        let matrix = |entry: &dyn Fn(f64, f64) -> f64| {
            let monomials = DMatrix::from_fn(COUNT, COUNT, |a, b| entry((a + 2) as f64, (b + 2) as f64));
            &legendre * monomials * legendre.transpose()
        };
        let mass = matrix(&|a, b| mass_per_length * length / (a + b + 1.0) + tip_mass);
        let bending =
            matrix(&|a, b| bending_stiffness / length.powi(3) * a * (a - 1.0) * b * (b - 1.0) / (a + b - 3.0));
        let geometric = matrix(&|a, b| a * b / (length * (a + b - 1.0)));
        let stiffness = &bending - &geometric * preload.axial_force;
        let monomials = DVector::from_fn(COUNT, |a, _| mass_per_length * length / (a + 3) as f64 + tip_mass);
        let load = &legendre * monomials;
        let ones = DVector::from_element(COUNT, 1.0);
        let at_rest = &ones * preload.force - &load * scene.environment.gravity;
        let r = stiffness.clone().lu().solve(&at_rest).unwrap();
        Self {
            section,
            hertz,
            preload,
            beyond: preload.deflection - r.sum(),
            r,
            v: DVector::zeros(COUNT),
            time: 0.0,
            damping: &mass * scene.beam.mass_damping + stiffness * scene.beam.stiffness_damping,
            inverse_mass: mass.cholesky().unwrap().inverse(),
            bending,
            geometric,
            load,
            scene: scene.clone(),
        }
    }

    /// Deflection of the tip.
    fn tip(&self, r: &DVector<f64>) -> f64 {
        r.sum() + self.beyond
    }

    /// `N = (3 E I y / L^3) sin(3 y / (2 L))`.
    pub fn axial_force(&self, y: f64) -> f64 {
        3.0 * self.section.bending_stiffness * y / self.section.length.powi(3) * (1.5 * y / self.section.length).sin()
    }

    fn force_of(&self, r: &DVector<f64>, v: &DVector<f64>) -> f64 {
        let d = self.scene.contact.overtravel - self.tip(r);
        if d <= 0.0 {
            return 0.0;
        }
        let elastic = self.hertz.coefficient * d.powf(1.5);
        (elastic - self.scene.contact.damping * 1.5 * self.hertz.coefficient * d.sqrt() * v.sum()).max(0.0)
    }

    pub fn force(&self) -> f64 {
        self.force_of(&self.r, &self.v)
    }

    fn acceleration(&self, time: f64, r: &DVector<f64>, v: &DVector<f64>) -> DVector<f64> {
        let base = self.scene.excitation.amplitude * (TAU * self.scene.excitation.frequency * time).sin()
            + self.scene.environment.gravity;
        let mut load = -&self.load * base;
        load.add_scalar_mut(self.force_of(r, v));
        load -= &self.bending * r;
        load += &self.geometric * r * self.axial_force(self.tip(r));
        load -= &self.damping * v;
        &self.inverse_mass * load
    }

    /// The classical Runge-Kutta method.
    pub fn run_to(&mut self, until: f64, steps: u32) {
        let h = (until - self.time) / f64::from(steps);
        let start = self.time;
        for k in 0..steps {
            let t = start + h * f64::from(k);
            let (r, v) = (self.r.clone(), self.v.clone());
            let a1 = self.acceleration(t, &r, &v);
            let (r2, v2) = (&r + &v * (h / 2.0), &v + &a1 * (h / 2.0));
            let a2 = self.acceleration(t + h / 2.0, &r2, &v2);
            let (r3, v3) = (&r + &v2 * (h / 2.0), &v + &a2 * (h / 2.0));
            let a3 = self.acceleration(t + h / 2.0, &r3, &v3);
            let (r4, v4) = (&r + &v3 * h, &v + &a3 * h);
            let a4 = self.acceleration(t + h, &r4, &v4);
            self.r = r + (v + (&v2 + &v3) * 2.0 + &v4) * (h / 6.0);
            self.v = &self.v + (a1 + (a2 + a3) * 2.0 + a4) * (h / 6.0);
        }
        self.time = until;
    }
}
