//! Habits of importers: how they reckon time, where they say the resources are.

use std::f64::consts::TAU;
use std::ffi::CString;

use relay_contact::fmi2::*;
use testing::instance::{Arguments, Instance};
use testing::near;

const STEP: f64 = 1e-5;

/// The communication points of an importer: number, and sum of the steps so far, to time.
type Clock = fn(f64, f64) -> f64;

/// `n h`, a sum, and grids in other units.
const CLOCKS: [(&str, Clock); 6] = [
    ("product", |n, _| n * STEP),
    ("sum", |_, sum| sum),
    ("quotient", |n, _| n / 1e5),
    ("nanoseconds", |n, _| n * 1e4 / 1e9),
    ("milliseconds", |n, _| n * 0.01 * 1e-3),
    ("hours", |n, _| n * (STEP / 3600.0) * 3600.0),
];

/// Forces after each of `count` steps, under a base acceleration of this amplitude (m/s2), held over each. The importer reckons time
/// and length of a step from its number and the sum of those before.
fn forces(
    importer: impl Fn(u32, f64) -> (f64, f64),
    count: u32,
    stop: Option<f64>,
    amplitude: f64,
) -> (Instance, Vec<f64>) {
    let fmu = Instance::new();
    assert_eq!(fmu.setup(None, 0.0, stop), fmi2OK);
    fmu.initialize();
    let mut sum = 0.0;
    let force = |n| {
        let (time, length) = importer(n, sum);
        sum += STEP;
        // Any numbers that do not repeat.
        assert_eq!(fmu.set_real("base.acceleration", amplitude * (0.06 * f64::from(n)).sin()), fmi2OK);
        assert_eq!(fmu.step(time, length), fmi2OK, "step {n}: {:?}", fmu.messages());
        fmu.real("contact.force")
    };
    let forces = (0..count).map(force).collect();
    (fmu, forces)
}

/// Forces by a clock, with steps that are [`STEP`] or the difference of the points. Nothing is to be warned of.
fn by_clock(clock: Clock, differences: bool, count: u32, stop: Option<f64>, amplitude: f64) -> Vec<f64> {
    let importer = |n: u32, sum| {
        let time = clock(n.into(), sum);
        let end = clock((n + 1).into(), sum + STEP);
        (time, if differences { end - time } else { STEP })
    };
    let (fmu, forces) = forces(importer, count, stop, amplitude);
    assert!(fmu.messages().is_empty());
    forces
}

#[test]
fn how_an_importer_reckons_time_makes_no_difference() {
    let expected = by_clock(CLOCKS[0].1, false, 500, None, 400.0);
    assert!(expected.contains(&0.0));
    for (name, clock) in CLOCKS {
        assert_eq!(by_clock(clock, false, 500, None, 400.0), expected, "{name}");
        // Steps that are differences of points are off by the rounding of two points. Where each point is rounded once
        // the length counts as the one before; where it is rounded more often it is another length, and each of two runs
        // may be wrong by the tolerance, 1e-6 of the preload.
        let allowed = match name {
            "milliseconds" | "hours" => 2.0 * 1e-6 * 0.152,
            _ => 0.0,
        };
        for (force, expected) in by_clock(clock, true, 500, None, 400.0).iter().zip(&expected) {
            near(name, *force, *expected, allowed);
        }
    }
}

#[test]
fn a_million_steps_reach_the_stop_time_however_they_are_counted() {
    let steps = 1_000_000;
    let stop = f64::from(steps) * STEP;
    for (_, clock) in CLOCKS {
        by_clock(clock, false, steps, Some(stop), 0.0);
    }
}

#[test]
fn a_point_off_by_a_small_part_of_the_step_is_a_warning_at_the_first_time() {
    let (_, exact) = forces(|n, _| (f64::from(n) * STEP, STEP), 1000, None, 98.0);
    // Where the last step ends, and how far the instants are off, s. Each run may be wrong by the tolerance, and the force
    // of 0.05 N at 1 kHz changes by 2 pi f times it within the time.
    let check = |importer: &dyn Fn(u32, f64) -> (f64, f64), end: f64, off: f64| {
        let (fmu, found) = forces(importer, 1000, None, 98.0);
        let parts = ["fmi2DoStep: currentCommunicationPoint = ", "the time of the instance was"];
        fmu.expect_message(fmi2Warning, &parts);
        near("end, s", fmu.last_successful_time().1, end, f64::EPSILON * end);
        for (n, (found, exact)) in found.iter().zip(&exact).enumerate() {
            near(n, *found, *exact, 2.0 * 1e-6 * 0.152 + 0.1 * TAU * 1000.0 * off);
        }
    };
    // Sums in single precision.
    let sums: Vec<_> = (0..1000).scan(0.0_f32, |sum, _| Some(f64::from(std::mem::replace(sum, *sum + 1e-5)))).collect();
    check(&|n, _| (sums[n as usize], STEP), sums[999] + STEP, (sums[999] - 999e-5).abs());
    // The length of the step in single precision, and points that are multiples of the exact one.
    let size = f64::from(1e-5_f32);
    check(&|n, _| (f64::from(n) * STEP, size), 999e-5 + size, STEP - size);
    // Off by 1e-12 s once, at 1e-5 s.
    let point = |n| f64::from(n) * STEP + if n == 1 { 1e-12 } else { 0.0 };
    check(&|n, _| (point(n), STEP), 1e-2, 1e-12);
}

#[test]
fn the_location_of_the_resources_is_free() {
    let places: [Option<&[u8]>; 12] = [
        None,
        Some(b""),
        Some(b"file:///tmp/fmu/resources"),
        Some(b"file:/tmp/fmu/resources"),
        Some(b"file://localhost/tmp/fmu/resources/"),
        Some(b"file:///tmp/a%20folder/resources"),
        Some(b"file:///tmp/a folder/resources"),
        Some(b"/tmp/fmu/resources"),
        Some(b"../resources"),
        Some(b"file:///C:/fmu/resources"),
        Some(b"C:\\fmu\\resources"),
        Some(b"file:///tmp/\xff\xfe/%zz/%s%n"),
    ];
    for place in places {
        let place = place.map(|place| CString::new(place).unwrap());
        let fmu = Instance::with(&Arguments { resources: place.as_deref(), logging_on: true, ..Arguments::default() });
        fmu.initialize();
        assert_eq!(fmu.step(0.0, STEP), fmi2OK);
        assert!(fmu.messages().is_empty());
    }
}
