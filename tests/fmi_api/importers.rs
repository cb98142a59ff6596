//! Habits of importers: how they reckon time, where they say the resources are, what they ask for at initialisation.

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

/// Forces at some of the communication points, with steps that are `STEP` or the difference of the points.
fn forces(clock: Clock, differences: bool, steps: u32, stop: Option<f64>, amplitude: f64) -> Vec<f64> {
    let fmu = Instance::new();
    assert_eq!(fmu.setup(None, 0.0, stop), fmi2OK);
    fmu.initialize();
    let (mut forces, mut sum) = (Vec::new(), 0.0);
    for n in 0..steps {
        let time = clock(f64::from(n), sum);
        sum += STEP;
        let length = if differences { clock(f64::from(n + 1), sum) - time } else { STEP };
        if amplitude != 0.0 {
            // Any numbers that do not repeat.
            let acceleration = amplitude * (0.06 * f64::from(n)).sin();
            assert_eq!(fmu.set_real("base.acceleration", acceleration), fmi2OK);
        }
        assert_eq!(fmu.step(time, length), fmi2OK, "step {n}: {:?}", fmu.messages());
        if n % 10 == 0 {
            forces.push(fmu.real("contact.force"));
        }
    }
    assert!(fmu.messages().is_empty());
    forces
}

#[test]
fn how_an_importer_reckons_time_makes_no_difference() {
    let expected = forces(CLOCKS[0].1, false, 500, None, 400.0);
    assert!(expected.contains(&0.0));
    for (name, clock) in CLOCKS {
        assert_eq!(forces(clock, false, 500, None, 400.0), expected, "{name}");
        // Steps that are differences of points are off by the rounding of two points. Where each point is rounded once
        // the length counts as the one before; where it is rounded more often it is another length, and each of two runs
        // may be wrong by the tolerance, 1e-6 of the preload.
        let allowed = match name {
            "milliseconds" | "hours" => 2.0 * 1e-6 * 0.152,
            _ => 0.0,
        };
        for (force, expected) in forces(clock, true, 500, None, 400.0).iter().zip(&expected) {
            near(name, *force, *expected, allowed);
        }
    }
}

#[test]
fn a_million_steps_reach_the_stop_time_however_they_are_counted() {
    let steps = 1_000_000;
    let stop = f64::from(steps) * STEP;
    for (_, clock) in CLOCKS {
        assert_eq!(forces(clock, false, steps, Some(stop), 0.0).len(), 100_000);
    }
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
