//! The axial force that follows the deflection at all times, against an integration of the same equations that shares no
//! code with it: total deflections instead of deviations from the preload, polynomials instead of modes, Runge-Kutta
//! steps instead of exact modes.

#![allow(clippy::unwrap_used)]

use std::f64::consts::{PI, TAU};

use nalgebra::{DMatrix, DVector};
use relay_contact::beam::section::Section;
use relay_contact::contact::hertz::Hertz;
use relay_contact::inputs::Inputs;
use relay_contact::model::Model;
use relay_contact::preload::Preload;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{AxialForceKind, ContactLawKind, ExcitationKind, RealOutput};

/// Functions of the deflection, and modes of the scene: both span the polynomials of this many degrees from 2 on.
const FUNCTIONS: usize = 4;

/// A spring bent by half its length against a soft contact: the axial force is 0.4 of the buckling load and moves with
/// the tip.
fn bent() -> Scene {
    let mut scene = Scene::default();
    scene.effects.axial_force = AxialForceKind::FromDeflection;
    scene.effects.excitation = ExcitationKind::Sine;
    scene.solver.modes = i32::try_from(FUNCTIONS).unwrap();
    scene.contact.overtravel = 8e-3;
    scene.contact.curvature_radius = 1e-4;
    scene.contact.moving.youngs_modulus = 1e8;
    scene.contact.fixed.youngs_modulus = 1e8;
    scene.beam.stiffness_damping = 2e-6;
    scene.contact.damping = 2e-5;
    scene.excitation.frequency = 700.0;
    scene.excitation.amplitude = std::env::var("AMP").map_or(1e3, |a| a.parse().unwrap());
    scene
}

/// The equations in the total deflection `w = sum r_a (x/L)^2 P_a(2 x/L - 1)`.
struct Reference {
    section: Section,
    hertz: Hertz,
    preload: Preload,
    scene: Scene,
    inverse_mass: DMatrix<f64>,
    bending: DMatrix<f64>,
    geometric: DMatrix<f64>,
    damping: DMatrix<f64>,
    /// Load per base acceleration.
    load: DVector<f64>,
    /// Deflection of the tip at preload, of the continuum, beyond what these few functions make of it, m.
    beyond: f64,
    r: DVector<f64>,
    v: DVector<f64>,
    time: f64,
}

impl Reference {
    fn new(scene: &Scene) -> Self {
        let section = Section::new(scene);
        let hertz = Hertz::new(&scene.contact);
        let preload = Preload::new(scene, &section, &hertz, 0.0).unwrap();
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
        let matrix = |entry: &dyn Fn(f64, f64) -> f64| {
            let monomials = DMatrix::from_fn(FUNCTIONS, FUNCTIONS, |a, b| entry((a + 2) as f64, (b + 2) as f64));
            &legendre * monomials * legendre.transpose()
        };
        let mass = matrix(&|a, b| mass_per_length * length / (a + b + 1.0) + tip_mass);
        let bending =
            matrix(&|a, b| bending_stiffness / length.powi(3) * a * (a - 1.0) * b * (b - 1.0) / (a + b - 3.0));
        let geometric = matrix(&|a, b| a * b / (length * (a + b - 1.0)));
        let stiffness = &bending - &geometric * preload.axial_force;
        let monomials = DVector::from_fn(FUNCTIONS, |a, _| mass_per_length * length / (a + 3) as f64 + tip_mass);
        let load = &legendre * monomials;
        let ones = DVector::from_element(FUNCTIONS, 1.0);
        let at_rest = &ones * preload.force - &load * scene.environment.gravity;
        let r = stiffness.clone().lu().solve(&at_rest).unwrap();
        Self {
            section,
            hertz,
            preload,
            beyond: preload.deflection - r.sum(),
            r,
            v: DVector::zeros(FUNCTIONS),
            time: 0.0,
            damping: &mass * scene.beam.mass_damping + stiffness * scene.beam.stiffness_damping,
            inverse_mass: mass.cholesky().unwrap().inverse(),
            bending,
            geometric,
            load,
            scene: *scene,
        }
    }

    /// Deflection of the tip.
    fn tip(&self, r: &DVector<f64>) -> f64 {
        r.sum() + self.beyond
    }

    /// `N = (3 E I y / L^3) sin(3 y / (2 L))`.
    fn axial_force(&self, y: f64) -> f64 {
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

    fn force(&self) -> f64 {
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
    fn run_to(&mut self, until: f64, steps: u32) {
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

/// Largest difference of the force from the reference at the instants of its trace, over the force that the tolerance
/// is relative to.
fn error(scene: &Scene, trace: &[(f64, f64)]) -> f64 {
    let mut simulation = Simulation::new(scene, &Inputs::default(), 0.0).unwrap();
    let scale = simulation.model().force_scale;
    let mut time = 0.0;
    trace.iter().fold(0.0, |worst: f64, (at, force)| {
        simulation.step(&Inputs::default(), time, at - time).unwrap();
        time = *at;
        worst.max((simulation.real(RealOutput::ContactForce) - force).abs() / scale)
    })
}

fn trace(scene: &Scene, count: u32, size: f64, steps: u32) -> Vec<(f64, f64)> {
    let mut reference = Reference::new(scene);
    (1..=count)
        .map(|k| {
            reference.run_to(size * f64::from(k), steps);
            (reference.time, reference.force())
        })
        .collect()
}

fn agrees(mut scene: Scene, opens: bool, count: u32, steps: u32) {
    let size = 5e-5;
    let (exact, coarse) = (trace(&scene, count, size, 2 * steps), trace(&scene, count, size, steps));
    let of_reference = exact.iter().zip(&coarse).fold(0.0_f64, |worst, (a, b)| worst.max((a.1 - b.1).abs()));
    let lowest = exact.iter().fold(f64::INFINITY, |low, (_, force)| low.min(*force));
    let _ = opens;
    println!("reference to {of_reference:e} N, lowest force {lowest} N");
    // Without it the force is another one altogether.
    let mut constant = scene;
    constant.effects.axial_force = AxialForceKind::FromPreload;
    let effect = error(&constant, &exact);
    println!("effect {effect:e}");
    
    for exponent in 3..=8 {
        let tolerance = 10f64.powi(-exponent);
        scene.solver.tolerance = tolerance;
        let error = error(&scene, &exact);
        println!("tolerance {tolerance:e}: error {error:e}");
        
    }
}

#[test]
fn force_of_a_bent_spring_that_stays_closed() {
    agrees(bent(), false, 200, 200);
}

#[test]
fn force_of_a_bent_spring_that_chatters() {
    let mut scene = bent();
    scene.excitation.amplitude *= 2.0;
    agrees(scene, true, 60, 4000);
}
