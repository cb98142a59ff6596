//! Extreme contacts, and impacts on them.

use anyhow::{Result, ensure};
use relay_contact::reference::Model;
use relay_contact::scene::Scene;
use relay_contact::variables::ContactLawKind;
use testing::scenes::{accelerated, undamped};

use crate::case::{Check, cases, closest};
use crate::energy_balance::{balances, square};
use crate::ride::{Ride, Segment, changed, conserved};
use testing::rig::{Rig, compose, hertz, oscillator};

cases! { CASES:
    "Contact 100 times stiffer", "contact oscillations of high frequency"
        => shaken(with_stiffness(100.0));
    "Contact 100 times softer", "indentation 21 times as deep: far from the linearised contact"
        => shaken(with_stiffness(0.01));
    "Contact without damping", "only the spring dissipates"
        => Ride::shaken(with_damping(0.0)).checks();
    // Times the tangent stiffness of 3.5e6 N/m on some milligrams: an eigenvalue beyond -1e9 1/s.
    "Overdamped contact", "contact damping of 1 s: an eigenvalue beyond −10⁹ 1/s, stiff beyond any explicit step"
        => shaken(with_damping(1.0));
    "Linearised and bonded contact, damped and undamped", "constant stiffness, and the bonded contact also carries tension"
        => linear_laws();
    "Rough contacts from a linear spring to a nearly exponential law, damped and undamped",
        "a force that jumps at first touch, and one that is lost in rounding long before the contact opens"
        => rough_laws();
    "Neither gap nor overtravel", "the contact opens and closes from a preload of zero"
        => Ride::shaken(with_overtravel(0.0)).checks();
    "Impact at 10 m/s, damped contact and spring", "the impact excites every mode"
        => impact(8.063e-5);
    "Impact at 10 m/s, undamped contact", "the impact excites every mode"
        => impact(0.0);
    "Impact at 10 m/s, no damping at all",
        "600 N that excite every mode, without dissipation"
        => undamped_impact();
    "Spring pressed against the contact across a gap of 10 µm", "weakly damped: it bounces until it rests"
        => pressed();
    "A mass bouncing to rest under its weight, in one communication step and in 50 000",
        "ever more impacts in ever shorter time"
        => accumulating();
}

fn with_stiffness(factor: f64) -> Scene {
    changed(|scene| {
        scene.contact.moving.youngs_modulus *= factor;
        scene.contact.fixed.youngs_modulus *= factor;
    })
}

pub(crate) fn with_damping(damping: f64) -> Scene {
    changed(|scene| scene.contact.damping = damping)
}

pub(crate) fn with_overtravel(overtravel: f64) -> Scene {
    changed(|scene| scene.contact.overtravel = overtravel)
}

fn shaken(scene: Scene) -> Result<Vec<Check>> {
    let mut checks = Ride::shaken(scene.clone()).checks()?;
    checks.extend(balances(scene, 1.5e-3, square)?);
    Ok(checks)
}

fn rough_laws() -> Result<Vec<Check>> {
    let exponents = [0.0, 0.1, 0.54, 0.75, 0.9];
    let rides = exponents.iter().flat_map(|exponent| [0.0, 8.063e-5].map(|damping| (*exponent, damping)));
    closest(rides.map(|(exponent, damping)| {
        let mut scene = with_damping(damping);
        scene.effects.contact_law = ContactLawKind::Rough;
        scene.contact.stiffness_exponent = exponent;
        shaken(scene)
    }))
}

fn linear_laws() -> Result<Vec<Check>> {
    let laws = [
        (ContactLawKind::Linearised, 0.0),
        (ContactLawKind::Linearised, 8.063e-5),
        (ContactLawKind::Bonded, 0.0),
        (ContactLawKind::Bonded, 8.063e-5),
    ];
    closest(laws.map(|(law, damping)| {
        let mut scene = with_damping(damping);
        scene.effects.contact_law = law;
        Ride::shaken(scene).checks()
    }))
}

fn impact(damping: f64) -> Result<Vec<Check>> {
    let mut scene = with_damping(damping);
    scene.contact.overtravel = -1e-4;
    Ride { speed: -10.0, ..Ride::new(scene, [Segment::accelerated(1e-4, 0.0); 3]) }.checks()
}

fn undamped_impact() -> Result<Vec<Check>> {
    let mut scene = undamped();
    scene.contact.overtravel = -1e-4;
    let mut rig = Rig::new(Model::new(&scene, 0.0)?);
    rig.throw(-10.0);
    conserved(rig, 300)
}

fn pressed() -> Result<Vec<Check>> {
    let mut scene = with_overtravel(-1e-5);
    scene.contact.damping = 1e-6;
    scene.beam.stiffness_damping = 1e-6;
    Ride::new(scene, [Segment::accelerated(2e-3, 300.0); 3]).checks()
}

fn accumulating() -> Result<Vec<Check>> {
    let (mass, weight) = (1e-4, 100.0);
    let model = compose(&[oscillator(mass, 0.0)], hertz(9.3e9, 1e-6), 1e-6, 1e-6, mass * weight);
    let mut coarse = Rig::new(model.clone());
    let mut fine = Rig::new(model);
    let inputs = accelerated(weight, 0.0);
    coarse.run_to(&inputs, 0.05)?;
    let (mut closings, mut last) = (0, None);
    for point in 1..=50_000 {
        fine.run_to(&inputs, 1e-6 * f64::from(point))?;
        ensure!(fine.state.contact().force >= 0.0 && fine.state.contact().approach.is_finite());
        closings += u32::from(fine.state.contact().last_closing > last);
        last = fine.state.contact().last_closing;
    }
    ensure!(closings > 5, "only {closings} impacts");
    closest([&coarse, &fine].map(|rig| {
        let off = (rig.state.contact().force - mass * weight).abs();
        Ok(vec![
            Check::tolerance("the final force is the weight", off, 1e-6 * mass * weight, "N"),
            Check::steps(rig.state.steps, 99_999),
        ])
    }))
}
