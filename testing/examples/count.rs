use testing::relays::Relay;
use relay_contact::{simulation::Simulation, inputs::Inputs, variables::{IntegerOutput, RealOutput}};
fn run(n: u64, tol: f64) -> Option<(i64, bool, Vec<f64>, f64)> {
    let mut r = Relay::draw(n);
    r.scene.solver.tolerance = tol;
    r.scene.solver.modes = 40;
    let (size, count) = r.steps;
    let mut sim = Simulation::new(&r.scene, &Inputs::default(), 0.0).ok()?;
    let mut open = false; let mut f = vec![];
    for k in 0..count { sim.step(&Inputs::default(), f64::from(k)*size, size).ok()?; open |= sim.events().0.count()>0; f.push(sim.real(RealOutput::ContactForce)); }
    let work = i64::from(sim.integer(IntegerOutput::SolverSteps))+i64::from(sim.integer(IntegerOutput::SolverRejectedSteps));
    let scale = sim.model().force_scale().max(f.iter().fold(0.0, |a: f64,b| a.max(*b)));
    Some((work, open, f, scale))
}
fn main(){
    let tols: Vec<f64> = std::env::args().skip(1).map(|a| a.parse().unwrap()).collect();
    if let Ok(n) = std::env::var("ONE") { let n: u64 = n.parse().unwrap(); let r = Relay::draw(n); println!("{:?} axial {:?} law {:?} zeta {} steps {:?}", r.scene.excitation, r.scene.effects.axial_force, r.scene.effects.contact_law, r.damping, r.steps); println!("{:?}", r.scene.effects.excitation); let (_,_,f,s)=run(n,1e-11).unwrap(); let b: Vec<f64> = std::fs::read_to_string(format!("/tmp/ref/{n}")).unwrap().lines().map(|l| l.parse().unwrap()).collect(); for k in (0..f.len()).step_by((f.len()/40).max(1)) { println!("{k} {:.6e} {:.2e}", f[k], (f[k]-b[k])/s); } return; }
    for n in 30000..30080u64 {
        let Some(rs) = tols.iter().map(|t| run(n,*t)).collect::<Option<Vec<_>>>() else {println!("{n} none"); continue};
        let mut base = rs[rs.len()-1].clone();
        let file = format!("/tmp/ref/{n}");
        if let Ok(text) = std::fs::read_to_string(&file) { base.2 = text.lines().map(|l| l.parse().unwrap()).collect(); }
        else { let _ = std::fs::write(&file, base.2.iter().map(|f| format!("{f:e}\n")).collect::<String>()); }
        let base = &base;
        let work: Vec<_> = rs.iter().map(|r| format!("{}", r.0)).collect();
        let diff: Vec<_> = rs.iter().map(|r| format!("{:.1e}", r.2.iter().zip(&base.2).fold(0.0f64, |m,(a,b)| m.max((a-b).abs()))/r.3)).collect();
        let worst = rs.windows(2).map(|w| w[1].0 as f64/w[0].0 as f64).fold(0.0, f64::max);
        println!("{n} {} worst {:.1} work {} diff {}", base.1, worst, work.join(" "), diff.join(" "));
    }
}
