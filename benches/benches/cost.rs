//! Cost of a communication step through the C interface, and of starting:
//! `cargo bench --package benches --bench cost`. Medians of several repetitions; the scene is the published one at
//! tolerance 1e-6.

use benches::machine;
use cpu_time::ThreadTime;
use relay_contact::fmi2::{fmi2OK, fmi2Status};
use testing::instance::Instance;

const TURNS: usize = 9;

fn main() {
    println!("{}\n", machine::description());
    println!(
        "{:<44}{:>12}{:>14}{:>14}",
        "", "us/doStep", "us/inner step", "s/simulated s"
    );
    for (name, step, count) in [
        ("shaken, step 1 us", 1e-6, 20_000_u32),
        ("shaken, step 10 us", 1e-5, 5_000),
        ("shaken, step 100 us", 1e-4, 1_000),
        ("shaken, step 1 ms", 1e-3, 100),
    ] {
        report(name, true, &vec![step; count as usize]);
    }
    let mut random = Random(1);
    let mut draw = |low: f64, high: f64| low * (high / low).powf(random.next());
    let around: Vec<f64> = (0..20_000).map(|_| draw(0.5e-6, 2e-6)).collect();
    report("shaken, random steps 0.5 to 2 us", true, &around);
    let wide: Vec<f64> = (0..5_000).map(|_| draw(1e-7, 1e-4)).collect();
    report("shaken, random steps 0.1 to 100 us", true, &wide);
    report("at rest, an hour in 1 step", false, &[3600.0]);
    report("at rest, an hour in 3600 steps", false, &vec![1.0; 3600]);

    let starts = median((0..TURNS).map(|_| {
        let start = ThreadTime::now();
        drop(started(true));
        start.elapsed().as_secs_f64()
    }));
    println!("\ninstantiate, set up, initialise, free: {:.1} us", 1e6 * starts);
}

/// Runs the communication steps several times, each from the start, and prints the cost of one.
fn report(name: &str, shaken: bool, sizes: &[f64]) {
    let simulated: f64 = sizes.iter().sum();
    let mut steps = 0;
    let time = median((0..TURNS).map(|_| {
        let contact = started(shaken);
        let start = ThreadTime::now();
        let mut time = 0.0;
        for size in sizes {
            check(contact.step(time, *size));
            time += size;
        }
        let taken = start.elapsed().as_secs_f64();
        steps = contact.integer("solver.steps");
        taken
    }));
    println!(
        "{name:<44}{:>12.3}{:>14.3}{:>14.2e}",
        1e6 * time / sizes.len() as f64,
        1e6 * time / f64::from(steps.max(1)),
        time / simulated
    );
}

fn median(times: impl Iterator<Item = f64>) -> f64 {
    let mut times: Vec<f64> = times.collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// An instance of the published scene, started.
fn started(shaken: bool) -> Instance {
    let instance = Instance::new();
    check(instance.set_integer("effects.excitation", if shaken { 2 } else { 1 }));
    check(instance.set_integer("effects.axialForce", 2));
    check(instance.set_real("excitation.amplitude", 98.0));
    check(instance.set_real("excitation.frequency", 1000.0));
    check(instance.set_real("solver.tolerance", 1e-6));
    check(instance.setup(None, 0.0, None));
    instance.initialize();
    instance
}

fn check(status: fmi2Status) {
    assert_eq!(status, fmi2OK);
}

/// Pseudorandom numbers from 0 to 1 (splitmix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 * 2f64.powi(-53)
    }
}
