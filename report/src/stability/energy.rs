//! Energy: none is made, and a blow gives back what it should.

use anyhow::Result;
use relay_contact::inputs::Inputs;
use relay_contact::model::Model;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ExcitationKind, RealOutput};

use super::common::{Rig, compose, hertz, oscillator, undamped};
use super::{Case, Check};

pub const CASES: &[Case] = &[
    dashpot,
    |_| {
        shaken_contact(
            "Contact 100 times stiffer",
            "it rings at ever higher frequencies",
            100.0,
        )
    },
    |_| {
        shaken_contact(
            "Contact 100 times softer",
            "it is pressed in 21 times as far, beyond what a tangent tells",
            0.01,
        )
    },
    hardest_shock,
    contact_cycles,
    impact,
    restitution,
];

/// What a run does to the energy that the component accounts for.
struct Ledger {
    /// Largest amount by which the balance is off, J.
    off: f64,
    /// What theory allows, J.
    allowed: f64,
    /// Least and greatest, N.
    forces: (f64, f64),
}

/// Runs a scene with an acceleration held over each microsecond.
fn ledger(mut scene: Scene, stop: f64, acceleration: impl Fn(f64) -> f64) -> Result<Ledger> {
    const STEP: f64 = 1e-6;
    scene.effects.energy = true;
    let mut contact = Simulation::new(&scene, &Inputs::default(), 0.0)?;
    let (mut off, mut way, mut forces) = (0.0_f64, 0.0, (f64::INFINITY, 0.0_f64));
    let mut step = 0_u32;
    while f64::from(step) * STEP < stop {
        let time = f64::from(step) * STEP;
        let inputs = Inputs {
            base_acceleration: acceleration(time),
            ..Inputs::default()
        };
        let before = contact.real(RealOutput::ContactIndentation);
        contact.step(&inputs, time, STEP)?;
        way += (contact.real(RealOutput::ContactIndentation) - before).abs();
        off = worst(off, contact.real(RealOutput::EnergyBalance).abs());
        forces.0 = forces.0.min(contact.real(RealOutput::StepMinimumForce));
        forces.1 = forces.1.max(contact.real(RealOutput::StepMaximumForce));
        step += 1;
    }
    Ok(Ledger {
        off,
        allowed: scene.solver.effective_tolerance() * contact.model().force_scale * way,
        forces,
    })
}

/// The larger one; what is not a number stays.
fn worst(a: f64, b: f64) -> f64 {
    if b.is_nan() || b > a { b } else { a }
}

impl Ledger {
    fn energy(&self, case: &'static str, hard: impl Into<String>) -> Check {
        Check {
            case,
            hard: hard.into(),
            property: "energy in = stored + dissipated",
            measured: self.off,
            allowed: self.allowed,
            unit: "J",
        }
    }

    fn push(&self, case: &'static str) -> Check {
        Check {
            case,
            hard: String::new(),
            property: "the contact never pulls",
            measured: -self.forces.0.min(0.0),
            allowed: 0.0,
            unit: "N",
        }
    }
}

/// A square wave that opens the specimen's contact.
fn square(time: f64) -> f64 {
    match time {
        time if time >= 1.2e-3 => 0.0,
        time if time.rem_euclid(6e-4) < 3e-4 => 500.0,
        _ => -500.0,
    }
}

fn dashpot(_: bool) -> Result<Vec<Check>> {
    let mut scene = Scene::default();
    // Times the tangent stiffness of 3.5e6 N/m on some milligrams: an eigenvalue beyond -1e9 1/s.
    scene.contact.damping = 1.0;
    let case = "Overdamped contact";
    let hard = "contact damping of 1 s: an eigenvalue beyond −10⁹ 1/s, stiff beyond any explicit step";
    let ledger = ledger(scene, 1.5e-3, square)?;
    Ok(vec![ledger.energy(case, hard), ledger.push(case)])
}

fn shaken_contact(case: &'static str, hard: &'static str, factor: f64) -> Result<Vec<Check>> {
    let mut scene = Scene::default();
    scene.contact.moving.youngs_modulus *= factor;
    scene.contact.fixed.youngs_modulus *= factor;
    Ok(vec![ledger(scene, 1.5e-3, square)?.energy(case, hard)])
}

fn hardest_shock(_: bool) -> Result<Vec<Check>> {
    let mut scene = Scene::default();
    scene.effects.excitation = ExcitationKind::HalfSine;
    scene.excitation.amplitude = 1e6;
    scene.excitation.duration = 1e-4;
    let case = "Shock of 10⁶ m/s² (100 000 g), 0.1 ms";
    let ledger = ledger(scene, 2e-3, |_| 0.0)?;
    let hard = format!("forces up to {:.0} N, then flight and blows", ledger.forces.1);
    Ok(vec![ledger.energy(case, hard), ledger.push(case)])
}

/// A model without damping, thrown at its contact: its energy (computed outside the component) and the way of its tip.
fn thrown(scene: &Scene, speed: f64) -> Result<(Rig, f64)> {
    let mut rig = Rig::new(Model::new(scene, 0.0)?);
    let velocities: Vec<f64> = rig.model.modes.iter().map(|mode| speed * mode.participation).collect();
    rig.launch(&velocities);
    let start = rig.energy();
    Ok((rig, start))
}

fn contact_cycles(quick: bool) -> Result<Vec<Check>> {
    let cycles = if quick { 100 } else { 1000 };
    let mut scene = undamped();
    scene.solver.modes = 6;
    let (mut rig, start) = thrown(&scene, 0.1)?;
    let (mut closings, mut last, mut off, mut point) = (0, -1.0, 0.0, 0_u32);
    while closings < cycles {
        point += 1;
        rig.run_to(&Inputs::default(), f64::from(point) * 1e-3)?;
        off = worst(off, (rig.energy() / start - 1.0).abs());
        if rig.state.last_closing > last {
            last = rig.state.last_closing;
            closings += 1;
        }
    }
    Ok(vec![Check {
        case: if quick {
            "100 contact cycles and more, no damping at all, 1 ms communication steps"
        } else {
            "1000 contact cycles and more, no damping at all, 1 ms communication steps"
        },
        hard: "nothing takes away what errors add; the contact rings at tens of kHz".to_owned(),
        property: "energy stays what was thrown in",
        measured: off,
        allowed: scene.solver.effective_tolerance(),
        unit: "",
    }])
}

fn impact(_: bool) -> Result<Vec<Check>> {
    let mut scene = undamped();
    scene.contact.overtravel = -1e-4;
    let (mut rig, start) = thrown(&scene, -10.0)?;
    let (mut off, mut way, mut greatest) = (0.0, 0.0, 0.0_f64);
    for point in 1..=300_u32 {
        let before = rig.state.indentation;
        rig.run_to(&Inputs::default(), f64::from(point) * 1e-6)?;
        way += (rig.state.indentation - before).abs();
        greatest = greatest.max(rig.state.force);
        off = worst(off, (rig.energy() - start).abs());
    }
    Ok(vec![Check {
        case: "Impact at 10 m/s, no damping at all",
        hard: format!("a blow of {greatest:.0} N that excites every mode"),
        property: "energy stays what was thrown in",
        measured: off,
        // Rounding: the last of thirteen digits of it.
        allowed: scene.solver.effective_tolerance() * rig.model.force_scale * way + 1e-13 * start,
        unit: "J",
    }])
}

/// Unit mass on a Hertzian contact of unit stiffness at unit speed, with the damping of Kuwabara and Kono. Without damping
/// the speed comes back whole; else as in Ramirez, Poeschel, Brilliantov, Schwager, Phys. Rev. E 60 (1999) 4465, with the
/// digits of a Runge-Kutta method in a variable in which the equation is smooth.
fn restitution(_: bool) -> Result<Vec<Check>> {
    let tolerance = 1e-8;
    let cases = [
        ("Blow on a contact without damping", 0.0, 1.0),
        ("Blow on a damped contact", 0.3, 0.623_642_991_4),
    ];
    let check = |(case, damping, exact): (&'static str, f64, f64)| {
        let model = compose(&[oscillator(1.0, 0.0)], hertz(1.0, damping), 0.5, tolerance, 1.0);
        let mut rig = Rig::new(model);
        rig.launch(&[-1.0]);
        rig.run_to(&Inputs::default(), 20.0)?;
        Ok(Check {
            case,
            hard: "flight, touch, blow and release in one communication step; the force starts as a power 3/2"
                .to_owned(),
            property: "coefficient of restitution as in the literature, or 1 (tolerance 1e-8)",
            measured: (-rig.state.indentation_rate - exact).abs(),
            // The contact lasts less than 4 s; ten digits are published.
            allowed: 4.0 * tolerance + 1e-10,
            unit: "",
        })
    };
    cases.into_iter().map(check).collect()
}
