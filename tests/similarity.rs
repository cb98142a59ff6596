//! Similarity: with all times halved and all masses a quarter, forces and lengths stay as they are. So must every bit, as only powers of
//! two have changed: a second that is hidden in a constant shows.

use relay_contact::inputs::Inputs;
use relay_contact::scene::spring::Shape;
use relay_contact::variables::{Group, VARIABLES};
use testing::kinds::KINDS;
use testing::relays::Relay;
use testing::springs::spring_file;

/// The factor on what has this unit.
fn factor(unit: &str) -> f64 {
    match unit {
        "kg" | "kg.m2" | "kg/m3" => 0.25,
        "s" | "N.s/m" => 0.5,
        "Hz" | "1/s" | "m/s" => 2.0,
        "m/s2" => 4.0,
        "m2/s3" => 8.0,
        "" | "1" | "rad" | "m" | "N" | "N/m" | "Pa" | "J" | "A" | "V" | "Ohm" | "Ohm.m" | "S" | "K" => 1.0,
        other => panic!("{other}"),
    }
}

fn faster(shape: &Shape) -> Shape {
    let mut shape = shape.clone();
    match &mut shape {
        Shape::Segments(segments) => {
            for segment in &mut segments.segments {
                segment.density = segment.density.map(|density| 0.25 * density);
            }
            for mass in &mut segments.masses {
                (mass.mass, mass.rotary_inertia) = (0.25 * mass.mass, 0.25 * mass.rotary_inertia);
            }
        }
        Shape::Modes(modes) => {
            for mode in &mut modes.modes {
                (mode.frequency, mode.contact) = (2.0 * mode.frequency, 2.0 * mode.contact);
                mode.participation *= 0.5;
                for place in [&mut mode.rotation, &mut mode.pusher, &mut mode.parallel] {
                    *place = place.map(|place| 2.0 * place);
                }
            }
        }
    }
    shape
}

/// The relay twice as fast, if all its parameters stay in range.
fn twice_as_fast(relay: &Relay) -> Option<Relay> {
    let mut fast = relay.clone();
    for variable in &VARIABLES {
        if let Group::RealParameter(parameter) = variable.group {
            let value = relay.scene.real(parameter);
            fast.scene.set_number(variable, factor(variable.unit) * value).ok()?;
        }
    }
    for spring in [&mut fast.scene.spring, &mut fast.scene.fixed_spring] {
        *spring = spring.as_ref().and_then(|file| spring_file(&file.name, faster(&file.shape)));
    }
    fast.shake = (4.0 * relay.shake.0, 2.0 * relay.shake.1);
    fast.travel.1 *= 2.0;
    fast.steps.0 *= 0.5;
    for knot in &mut fast.knots {
        *knot = Inputs {
            base_acceleration: 4.0 * knot.base_acceleration,
            base_acceleration_rate: 8.0 * knot.base_acceleration_rate,
            support_displacement_rate: 2.0 * knot.support_displacement_rate,
            pusher_displacement_rate: 2.0 * knot.pusher_displacement_rate,
            ..*knot
        };
    }
    Some(fast)
}

#[test]
fn a_relay_twice_as_fast_has_the_same_bits() {
    for (kind, _, draw) in KINDS {
        let mut compared = 0;
        for number in 300..306 {
            let relay = draw(number);
            let Some(fast) = twice_as_fast(&relay) else { continue };
            let of = |relay: &Relay, second: f64| {
                let (course, failed) = relay.run(|_| {}).ok()?;
                let events: Vec<f64> = course.events.iter().map(|event| event / second).collect();
                let read = (course.force, course.least, course.greatest, events, course.estimate, course.steps);
                Some((read, failed.is_some()))
            };
            let run = of(&relay, 1.0);
            assert_eq!(run, of(&fast, 0.5), "{kind} {number}");
            compared += u32::from(run.is_some());
        }
        assert!(compared >= 3, "{kind}: {compared}");
    }
}
