//! scratch
use relay_contact::inputs::Inputs;
use relay_contact::scene::Scene;
use relay_contact::simulation::Simulation;
use relay_contact::variables::{ExcitationKind, FrictionKind, IntegerOutput, RealOutput};

fn run(amplitude: f64, tol: f64, mu: f64, step: f64, count: u32) -> Vec<f64> {
    let mut scene = Scene::default();
    scene.effects.excitation = ExcitationKind::Sine;
    scene.excitation.amplitude = amplitude;
    scene.effects.friction = if mu < 0.0 { FrictionKind::None } else { FrictionKind::Coulomb };
    scene.friction.coefficient = mu.max(0.0);
    scene.solver.tolerance = tol;
    scene.solver.modes = 16;
    scene.effects.energy = true;
    let mut s = Simulation::new(&scene, &Inputs::default(), 0.0).unwrap();
    let mut out = Vec::new();
    for k in 0..count {
        if let Err(e) = s.step(&Inputs::default(), f64::from(k) * step, step) {
            println!("{e}");
            break;
        }
        out.push(s.real(RealOutput::ContactForce));
        if count <= 40 {
            println!(
                "{:.2e} F {:.6} T {:.6} slip {:.4e} dist {:.4e} E {:.4e} bal {:.2e} v {:.3e}",
                s.time(), s.real(RealOutput::ContactForce), s.real(RealOutput::ContactTangentialForce),
                s.real(RealOutput::ContactSlip), s.real(RealOutput::ContactSlipDistance), s.real(RealOutput::FrictionEnergy),
                s.real(RealOutput::EnergyBalance), s.real(RealOutput::TipVelocity)
            );
        }
    }
    println!("a {amplitude} tol {tol} mu {mu}: steps {} rejected {} iterations {} dist {:.5e} E {:.5e} bal {:.2e}",
        s.integer(IntegerOutput::SolverSteps), s.integer(IntegerOutput::SolverRejectedSteps), s.integer(IntegerOutput::SolverIterations),
        s.real(RealOutput::ContactSlipDistance), s.real(RealOutput::FrictionEnergy), s.real(RealOutput::EnergyBalance));
    out
}

#[test]
fn scratch() {
    run(98.0, 1e-6, 0.2, 5e-5, 40);
    run(400.0, 1e-6, 0.2, 5e-5, 40);
    for amplitude in [98.0, 400.0] {
        for mu in [-1.0, 0.0, 0.2, 1.0] {
            let best = run(amplitude, 1e-10, mu, 7e-6, 700);
            for tol in [1e-4, 1e-6, 1e-8] {
                let other = run(amplitude, tol, mu, 7e-6, 700);
                let worst = best.iter().zip(&other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                let peak = best.iter().copied().fold(0.152, f64::max);
                println!("   tol {tol:e}: {:e} of tolerance", worst / peak / tol);
            }
        }
    }
}
