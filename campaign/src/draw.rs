//! Random calls: mostly ones allowed in the state of the instance, so that sequences continue, and some wrong ones.

use crate::call::{Call, Fault, Point, SLOTS};
use crate::choices::Choices;
use crate::description::{DESCRIPTION, Kind, Role, Variable};
use crate::moment::Moment;
use crate::states::Phase;

/// Longest step drawn, s, so that stiff scenes do not take minutes.
const LONGEST_STEP: f64 = 1e-4;

/// The next call of an instance, with a fault, mostly none.
pub fn call(choices: &mut Choices, now: &Moment) -> (Call, Fault) {
    let call = if choices.percent(6) { anything(choices, now) } else { fitting(choices, now) };
    let fault = match (&call, choices.below(100)) {
        (_, 0 | 1) => choices.one(&Fault::ALL),
        (Call::Deserialize(_), 2..14) => Fault::Flip(choices.bits()),
        (Call::Deserialize(_), 14..26) => Fault::Cut(choices.bits()),
        (Call::Deserialize(_), 26..38) => Fault::Longer(choices.one(&[0, 3, 255])),
        _ => Fault::None,
    };
    (call, fault)
}

/// A call that is mostly allowed in the state.
fn fitting(choices: &mut Choices, now: &Moment) -> Call {
    let pick = choices.below(100);
    match now.phase {
        Phase::Instantiated => match pick {
            0..15 => setup(choices),
            15..45 => set(choices, now, Kind::Real),
            45..53 => set(choices, now, Kind::Integer),
            53..55 => set(choices, now, Kind::String),
            55..65 => get(choices, now),
            65..70 => state(choices),
            _ => Call::EnterInitializationMode,
        },
        Phase::InitializationMode => match pick {
            0..25 => set(choices, now, Kind::Real),
            25..34 => set(choices, now, Kind::Integer),
            34 => set(choices, now, Kind::String),
            35..55 => get(choices, now),
            55..60 => state(choices),
            _ => Call::ExitInitializationMode,
        },
        Phase::StepComplete => match pick {
            0..45 => step(choices),
            45..60 => set(choices, now, Kind::Real),
            60..70 => get(choices, now),
            70..84 => state(choices),
            84..89 => replay(choices, now),
            89..92 => status(choices),
            92..96 => input_derivatives(choices),
            96..99 => output_derivatives(choices),
            _ => Call::Terminate,
        },
        Phase::Terminated | Phase::Error => match pick {
            0..20 => get(choices, now),
            20..30 => status(choices),
            30..60 => Call::SetState(choices.below(SLOTS)),
            60..70 => state(choices),
            70..75 => Call::Renew,
            _ => Call::Reset,
        },
    }
}

/// Any call, independent of the state.
fn anything(choices: &mut Choices, now: &Moment) -> Call {
    match choices.below(18) {
        0 => logging(choices),
        1 => setup(choices),
        2 => Call::EnterInitializationMode,
        3 => Call::ExitInitializationMode,
        4 => Call::Terminate,
        5 => Call::Reset,
        6 => Call::Renew,
        7 => get(choices, now),
        8 => {
            let kind = choices.one(&Kind::ALL);
            set(choices, now, kind)
        }
        9 | 10 => state(choices),
        11 => Call::DirectionalDerivative,
        12 => input_derivatives(choices),
        13 => output_derivatives(choices),
        14 => step(choices),
        15 => Call::CancelStep,
        16 => status(choices),
        _ => replay(choices, now),
    }
}

fn logging(choices: &mut Choices) -> Call {
    let count = choices.below(3);
    let known = &DESCRIPTION.categories;
    let category = |choices: &mut Choices| match choices.below(10) {
        0 => None,
        1 => Some("log%sAll".to_owned()),
        _ => Some(known[choices.below(known.len())].clone()),
    };
    Call::SetDebugLogging(choices.percent(50), (0..count).map(|_| category(choices)).collect())
}

fn setup(choices: &mut Choices) -> Call {
    let start = choices.one(&[0.0, 0.0, 0.0, 1.0, -5.0, 1e4]);
    let tolerance = choices.one(&[1e-6, 1e-6, 1e-4, 1e-9, 1e300, 0.0, -1.0, f64::NAN, f64::INFINITY]);
    let stop = start + choices.one(&[1e-2, 1.0, 1e-4, 0.0]);
    let strange = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, start - 1.0];
    Call::SetupExperiment(
        choices.percent(50).then_some(tolerance),
        if choices.percent(3) { choices.one(&strange[..3]) } else { start },
        choices.percent(30).then(|| if choices.percent(5) { choices.one(&strange) } else { stop }),
    )
}

/// A variable of the type if there is one; rarely of any type, or an unknown reference.
fn reference(choices: &mut Choices, wanted: impl Fn(&Variable) -> bool) -> u32 {
    if choices.percent(2) {
        return choices.bits();
    }
    if choices.percent(2) {
        return DESCRIPTION.variables[choices.below(DESCRIPTION.variables.len())].reference;
    }
    let fitting: Vec<_> = DESCRIPTION.variables.iter().filter(|variable| wanted(variable)).collect();
    match fitting.get(choices.below(fitting.len())) {
        Some(variable) => variable.reference,
        None => choices.bits(),
    }
}

fn get(choices: &mut Choices, now: &Moment) -> Call {
    let kind = choices.one(&[Kind::Real, Kind::Real, Kind::Integer, Kind::Boolean]);
    let kind = if choices.percent(1) { Kind::String } else { kind };
    let before = now.phase == Phase::Instantiated;
    let wanted = |variable: &Variable| variable.kind == kind && !(before && variable.role == Role::Output);
    let count = choices.below(4);
    let count = if before && kind == Kind::Boolean { 0 } else { count };
    Call::Get(kind, (0..count).map(|_| reference(choices, wanted)).collect())
}

fn set(choices: &mut Choices, now: &Moment, kind: Kind) -> Call {
    let fixed = now.phase == Phase::StepComplete;
    let wanted = |variable: &Variable| {
        variable.kind == kind && variable.role != Role::Output && !(fixed && variable.role == Role::Parameter)
    };
    let count = choices.below(4);
    let values = (0..count).map(|_| {
        let reference = reference(choices, wanted);
        (reference, value(choices, reference))
    });
    Call::Set(kind, values.collect())
}

/// Mostly near the start value, sometimes a bound, rarely out of range.
fn value(choices: &mut Choices, reference: u32) -> f64 {
    let Some(variable) = DESCRIPTION.variable(reference) else { return choices.unit() };
    let Variable { start, min, max, .. } = *variable;
    let strange = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, max * 1.5 + 1.0, min - 1.0, 1e306, -1e306, 5e-324];
    let pick = choices.below(100);
    if pick < 4 {
        return choices.one(&strange);
    }
    if !variable.choices.is_empty() {
        return choices.one(&variable.choices);
    }
    let nominal = match variable.name.as_str() {
        "base.acceleration" => 2000.0,
        "support.displacement" | "second.displacement" => 1e-4,
        "contact.current" => 1.0,
        _ if start == 0.0 => (max * 1e-3).min(1.0),
        _ => start,
    };
    let value = match pick {
        4 | 5 if min.is_finite() => min,
        6 | 7 if max.is_finite() => max,
        8..20 => start,
        20..50 if variable.role == Role::Input => -nominal * choices.unit(),
        _ if variable.role == Role::Input => nominal * choices.unit(),
        20..30 => nominal * 10_f64.powf(2.0 * choices.unit() - 1.0),
        _ => nominal * (0.8 + 0.4 * choices.unit()),
    };
    if variable.kind == Kind::Real { value } else { value.round() }
}

fn step(choices: &mut Choices) -> Call {
    let size = if choices.percent(2) {
        choices.one(&[0.0, -1e-5, f64::NAN, f64::INFINITY, 1e-300, 1e300])
    } else {
        step_size(choices)
    };
    let point = match choices.below(100) {
        0 => Point::Off(choices.one(&[-1.0, 1.0, 0.01, -0.3, 2e-5, -2e-5])),
        1 => choices.one(&[Point::At(f64::NAN), Point::At(f64::INFINITY), Point::At(1e300), Point::At(-1.0)]),
        2..8 => Point::Rounded(choices.one(&[-2, -1, 1, 2])),
        _ => Point::Here,
    };
    Call::DoStep(point, size)
}

/// A step size within four decades, often the previous one.
fn step_size(choices: &mut Choices) -> f64 {
    if choices.percent(50) {
        choices.one(&[1e-6, 1e-5, LONGEST_STEP])
    } else {
        LONGEST_STEP * 10_f64.powf(-4.0 * choices.unit())
    }
}

fn state(choices: &mut Choices) -> Call {
    let slot = choices.below(SLOTS);
    match choices.below(20) {
        0..6 => Call::GetState(slot),
        6..11 => Call::SetState(slot),
        11 | 12 => Call::FreeState(slot),
        13 => Call::StateSize(slot),
        14..17 => Call::Serialize(slot),
        _ => Call::Deserialize(slot),
    }
}

fn status(choices: &mut Choices) -> Call {
    let [real, integer, boolean, string] = Kind::ALL.map(Some);
    let function = choices.one(&[real, real, boolean, None, integer, string]);
    Call::Status(function, choices.one(&[2, 2, 3, 0, 1, 4, u32::MAX]))
}

fn input_derivatives(choices: &mut Choices) -> Call {
    let count = choices.below(3);
    let values = (0..count).map(|_| {
        let reference = reference(choices, |variable| variable.role == Role::Input);
        let rate = value(choices, reference) / LONGEST_STEP;
        (reference, if choices.percent(3) { 2 } else { 1 }, rate)
    });
    Call::SetInputDerivatives(values.collect())
}

fn output_derivatives(choices: &mut Choices) -> Call {
    let count = choices.below(3);
    let values = (0..count).map(|_| {
        let reference = reference(choices, |variable| {
            variable.role == Role::Output && variable.continuous && variable.kind == Kind::Real
        });
        (reference, i32::from(!choices.percent(3)))
    });
    Call::GetOutputDerivatives(values.collect())
}

fn replay(choices: &mut Choices, now: &Moment) -> Call {
    let Call::Set(_, values) = set(choices, now, Kind::Real) else { return Call::Reset };
    Call::Replay {
        slot: choices.below(SLOTS),
        inputs: values,
        steps: 1 + u32::try_from(choices.below(5)).unwrap_or(0),
        size: step_size(choices),
    }
}
