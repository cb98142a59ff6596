//! Long runs: small errors per step must not accumulate.

use anyhow::{Result, ensure};
use relay_contact::inputs::Inputs;
use relay_contact::reference::Model;
use relay_contact::simulation::Simulation;
use relay_contact::variables::RealOutput;

use crate::case::{Check, cases, closest};
use testing::rig::Rig;
use testing::scenes::{shaken, undamped};
use testing::worst;

cases! { CASES:
    "1000 contact cycles and more, no damping at all, 1 ms communication steps",
        "no damping removes energy added by errors; the contact oscillates at tens of kHz"
        => contact_cycles(1000, 1e-6, 1e-3);
    "1000 contact cycles, no damping at all, 10 µs communication steps, tolerance 1e-4, 1e-6, 1e-8",
        "no damping removes energy added by errors; the contact oscillates at tens of kHz"
        => closest([1e-4, 1e-6, 1e-8].map(|tolerance| contact_cycles(1000, tolerance, 1e-5)));
    "98 m/s² at 1 kHz for 10⁷ communication steps of 1 µs", "errors of steps accumulate to drift"
        => drift();
}

cases! { LONG:
    "A million contact cycles, no damping at all", "no damping removes energy added by errors; the contact oscillates at tens of kHz"
        => contact_cycles(1_000_000, 1e-6, 1e-5);
}

/// The published run for 10 000 periods of the sine with 1000 communication steps each: after the transients, the
/// force at whole periods stays constant.
fn drift() -> Result<Vec<Check>> {
    let mut contact = Simulation::new(&shaken(98.0, 1000.0), &Inputs::default(), 0.0)?;
    let (mut settled, mut off) = (0.0, 0.0);
    for period in 0..10_000 {
        for step in 1..=1000_u32 {
            let (start, end) = (contact.time(), f64::from(period * 1000 + step) * 1e-6);
            contact.step(&Inputs::default(), start, end - start)?;
        }
        let force = contact.real(RealOutput::ContactForce);
        if period == 40 {
            settled = force;
        }
        if period > 40 {
            off = worst(off, (force - settled).abs());
        }
    }
    ensure!(settled > 0.0, "the contact is open");
    let property = "the force at whole periods remains that at the 41st";
    let tolerance = 1e-6 * contact.model().force_scale;
    Ok(vec![Check::two_runs(property, off, tolerance)])
}

/// The specimen without damping, with an initial velocity, bouncing until it has closed `cycles` times, with a
/// communication step (s): energy error relative to the initial kinetic energy.
fn contact_cycles(cycles: u32, tolerance: f64, step: f64) -> Result<Vec<Check>> {
    let mut scene = undamped();
    scene.solver.tolerance = tolerance;
    scene.solver.modes = 6;
    let mut rig = Rig::new(Model::new(&scene, 0.0)?);
    rig.throw(0.1);
    let start = rig.energy();
    let (mut closings, mut last, mut off, mut point) = (0, None, 0.0, 0_u32);
    while closings < cycles {
        point += 1;
        rig.run_to(&Inputs::default(), f64::from(point) * step)?;
        off = worst(off, (rig.energy() / start - 1.0).abs());
        if rig.state.contact().last_closing > last {
            last = rig.state.contact().last_closing;
            closings += 1;
        }
    }
    let property = "the energy supplied is conserved (relative)";
    Ok(vec![Check::tolerance(property, off, tolerance, "")])
}
