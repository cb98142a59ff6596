//! Cost of a communication step through the C interface, and of starting:
//! `cargo bench --package benches --bench cost`. Medians of several repetitions; the scene is the published one at
//! tolerance 1e-6.

use std::f64::consts::TAU;

use benches::machine;
use cpu_time::ThreadTime;
use relay_contact::fmi2::{fmi2OK, fmi2Status};
use testing::instance::Instance;

const TURNS: usize = 9;

/// Acceleration of the base, m/s2, and its frequency, Hz.
const AMPLITUDE: f64 = 98.0;
const FREQUENCY: f64 = 1000.0;

fn main() {
    println!("{}\n", machine::description());
    println!(
        "{:<44}{:>12}{:>14}{:>14}",
        "", "us/doStep", "us/inner step", "s/simulated s"
    );
    let grids = [
        ("1 us", vec![1e-6; 20_000]),
        ("10 us", vec![1e-5; 5_000]),
        ("100 us", vec![1e-4; 1_000]),
        ("1 ms", vec![1e-3; 100]),
    ];
    for (name, sizes) in &grids {
        report(&format!("shaken, step {name}"), &SHAKEN, sizes);
    }
    let mut random = Random(1);
    let mut draw = |low: f64, high: f64| low * (high / low).powf(random.next());
    let around: Vec<f64> = (0..20_000).map(|_| draw(0.5e-6, 2e-6)).collect();
    report("shaken, random steps 0.5 to 2 us", &SHAKEN, &around);
    let wide: Vec<f64> = (0..5_000).map(|_| draw(1e-7, 1e-4)).collect();
    report("shaken, random steps 0.1 to 100 us", &SHAKEN, &wide);
    let [(_, each), ..] = &grids;
    report("input new each step, step 1 us", &DRIVEN, each);
    report("input new each step, random 0.5 to 2 us", &DRIVEN, &around);
    report("at rest, an hour in 1 step", &REST, &[3600.0]);
    report("at rest, an hour in 3600 steps", &REST, &vec![1.0; 3600]);

    println!("\nnothing asked for within steps, over the Hertz contact under a sine:");
    for (name, sizes) in &grids {
        let time = |law, excitation| {
            let watched = false;
            let settings = Settings {
                law,
                excitation,
                watched,
                ..SHAKEN
            };
            time(&settings, sizes).0
        };
        let hertz = time(1, 2);
        let [linearised, bonded, random] = [time(2, 2), time(3, 2), time(1, 5)].map(|time| time / hertz);
        println!("step {name}: linearised {linearised:.2}, bonded {bonded:.2}, random excitation {random:.2}");
    }

    let starts = median((0..TURNS).map(|_| {
        let start = ThreadTime::now();
        drop(SHAKEN.start());
        start.elapsed().as_secs_f64()
    }));
    println!("\ninstantiate, set up, initialise, free: {:.1} us", 1e6 * starts);
}

/// A scene and how it is driven: the published one, if not told otherwise.
#[derive(Clone, Copy)]
struct Settings {
    /// `effects.contactLaw`.
    law: i32,
    /// `effects.excitation`.
    excitation: i32,
    /// Whether interruptions and extremes are asked for.
    watched: bool,
    /// Whether the base acceleration comes from outside, held over each step.
    driven: bool,
}

const SHAKEN: Settings = Settings {
    law: 1,
    excitation: 2,
    watched: true,
    driven: false,
};

const REST: Settings = Settings {
    excitation: 1,
    ..SHAKEN
};

const DRIVEN: Settings = Settings { driven: true, ..REST };

impl Settings {
    /// An instance, started.
    fn start(&self) -> Instance {
        let instance = Instance::new();
        check(instance.set_integer("effects.excitation", self.excitation));
        check(instance.set_integer("effects.contactLaw", self.law));
        check(instance.set_integer("effects.axialForce", 2));
        check(instance.set_boolean("effects.chatter", self.watched));
        check(instance.set_boolean("effects.extremes", self.watched));
        check(instance.set_real("excitation.amplitude", AMPLITUDE));
        check(instance.set_real("excitation.frequency", FREQUENCY));
        if self.excitation == 5 {
            check(instance.set_real("excitation.frequency", 0.02 * FREQUENCY));
            check(instance.set_real("excitation.endFrequency", 2.0 * FREQUENCY));
            check(instance.set_real("excitation.spectralDensity", 1.0));
        }
        check(instance.set_real("solver.tolerance", 1e-6));
        check(instance.setup(None, 0.0, None));
        instance.initialize();
        instance
    }
}

/// Runs the communication steps several times, each from the start: median of the time, s, and integration steps.
fn time(settings: &Settings, sizes: &[f64]) -> (f64, i32) {
    let mut steps = 0;
    let time = median((0..TURNS).map(|_| {
        let contact = settings.start();
        let start = ThreadTime::now();
        let mut time = 0.0;
        for size in sizes {
            if settings.driven {
                let acceleration = AMPLITUDE * (TAU * FREQUENCY * time).sin();
                check(contact.set_real("base.acceleration", acceleration));
            }
            check(contact.step(time, *size));
            time += size;
        }
        let taken = start.elapsed().as_secs_f64();
        steps = contact.integer("solver.steps");
        taken
    }));
    (time, steps)
}

/// Prints the cost of a communication step.
fn report(name: &str, settings: &Settings, sizes: &[f64]) {
    let simulated: f64 = sizes.iter().sum();
    let (time, steps) = time(settings, sizes);
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
