use testing::promise::tighten;
use testing::relays::Relay;
fn main() {
    for arg in std::env::args().skip(1) {
        let n: u64 = arg.parse().unwrap();
        let r = Relay::draw(n);
        let s = &r.scene;
        println!(
            "{n}: tol {:.2e} exc {:?} {:?} axial {:?} law {:?} damp {:?} shake {:?} travel {:?} steps {:?} zeta {:.3} seg",
            s.solver.tolerance,
            s.effects.excitation,
            s.excitation,
            s.effects.axial_force,
            s.effects.contact_law,
            s.effects.contact_damping,
            r.shake,
            r.travel,
            r.steps,
            r.damping
        );
        let (a, _) = r.run(|_| {}).unwrap();
        let (b, _) = r.run(|x| tighten(x, 0.0)).unwrap();
        let (c, _) = r
            .run(|x| {
                x.solver.modes = relay_contact::reference::MAX_MODES as i32;
            })
            .unwrap();
        println!("error {:?} with all modes {:?}", a.error(&b), c.error(&b));
        let mut scale: f64 = b.scale;
        let mut rows = vec![];
        for k in 0..b.force.len() {
            scale = scale.max(b.greatest[k]);
            rows.push((
                ((a.force[k] - b.force[k]) / scale).abs(),
                ((a.least[k] - b.least[k]) / scale).abs(),
                ((a.greatest[k] - b.greatest[k]) / scale).abs(),
                ((c.force[k] - b.force[k]) / scale).abs(),
                k,
            ));
        }
        let every = (rows.len() / 24).max(1);
        for chunk in rows.chunks(every) {
            let m = chunk.iter().fold((0.0f64, 0.0f64, 0.0f64, 0.0f64), |m, r| {
                (m.0.max(r.0), m.1.max(r.1), m.2.max(r.2), m.3.max(r.3))
            });
            println!(
                "  k {:5} t {:.3e}  f {:.2e} min {:.2e} max {:.2e}  allmodes {:.2e}   F {:.4e}..{:.4e} scale {:.3e}",
                chunk[0].4,
                chunk[0].4 as f64 * r.steps.0,
                m.0,
                m.1,
                m.2,
                m.3,
                b.least[chunk[0].4],
                b.greatest[chunk[0].4],
                b.scale
            );
        }
    }
}
