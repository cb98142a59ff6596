//! The life cycle of an instance in FMI 2.0 for co-simulation (sections 2.1 and 4.2), implemented independently of the
//! component: the expected status of a call, and the state after it. Where the standard leaves a choice, the component
//! guarantees:
//! - the first error of a call determines its status: a state that does not allow it, a pointer, then the elements of
//!   its arrays in their order;
//! - inputs and parameters can be read before initialisation; outputs cannot;
//! - a value out of range is `fmi2Discard` and its call changes nothing; any other wrong call is `fmi2Error`;
//! - after `fmi2Error`, values and status can be read, a saved state restored, the instance reset or freed; but
//!   unsupported capabilities, or outputs read before initialisation or while the parameters are inconsistent, do not
//!   change the instance;
//! - a communication point may differ from the time of the instance by a small fraction of the step, which is a warning
//!   at the first time; the step then ends at the importer's end.

use relay_contact::fmi2::*;

use crate::call::{Call, Fault, Point, SLOTS};
use crate::description::{DESCRIPTION, Kind, Role, Variable};
use crate::moment::Moment;
use crate::states::{Phase, allowed};

use Phase::{Error, InitializationMode, Instantiated, StepComplete, Terminated};

/// The expected status of a call, and the effect of an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// `fmi2OK`.
    Accept,
    /// `fmi2OK` with a warning in the log: done except for what that says.
    Remark,
    /// `fmi2Discard`, nothing changed.
    Discard,
    /// `fmi2Error`, the instance is in the state error.
    Fail,
    /// `fmi2Error`, nothing changed.
    Refuse,
    /// `Accept` or `Remark`, depending on the physics: on how far errors have grown.
    AcceptOrRemark,
    /// `Accept` or `Refuse`, depending on the physics.
    AcceptOrRefuse,
    /// `Accept`, `Remark` or `Fail`, depending on the physics and on what the component takes for rounding or warns of.
    Open,
}

use Verdict::{Accept, AcceptOrRefuse, AcceptOrRemark, Discard, Fail, Open, Refuse, Remark};

impl Verdict {
    /// The statuses.
    pub fn statuses(self) -> &'static [fmi2Status] {
        match self {
            Accept | Remark | AcceptOrRemark => &[fmi2OK],
            Discard => &[fmi2Discard],
            Fail | Refuse => &[fmi2Error],
            Open | AcceptOrRefuse => &[fmi2OK, fmi2Error],
        }
    }

    /// Whether a call that returns `fmi2OK` warns: `None` if it may.
    pub fn warns(self) -> Option<bool> {
        match self {
            AcceptOrRemark | Open => None,
            _ => Some(self == Remark),
        }
    }
}

/// An instance, its saved states and their bytes.
#[derive(Clone, Debug)]
pub struct LifeCycle {
    /// The instance.
    pub now: Moment,
    /// The saved states.
    pub saved: [Option<Moment>; SLOTS],
    /// The contents of the bytes of each slot.
    pub written: [Option<Moment>; SLOTS],
    /// Whether errors are logged.
    pub errors: bool,
    /// Whether warnings are logged.
    pub warnings: bool,
    /// Whether a step was done with the warning that its communication point differs.
    pub warned: bool,
}

impl Default for LifeCycle {
    fn default() -> Self {
        Self {
            now: Moment::default(),
            saved: [const { None }; SLOTS],
            written: [const { None }; SLOTS],
            errors: true,
            warnings: true,
            warned: false,
        }
    }
}

impl LifeCycle {
    /// The expected outcome of a call.
    pub fn verdict(&self, call: &Call, fault: Fault) -> Verdict {
        if !allowed(&call.function(), self.now.phase) {
            return Fail;
        }
        match call {
            Call::SetDebugLogging(_, categories) => logging(categories, fault),
            Call::SetupExperiment(tolerance, start, stop) => {
                if !start.is_finite() || stop.is_some_and(|stop| stop.is_nan() || stop < *start) {
                    Fail
                } else if tolerance.is_some_and(|tolerance| !(tolerance.is_finite() && tolerance > 0.0)) {
                    Remark
                } else {
                    Accept
                }
            }
            // A dimension beside a spring file is worth a warning, and a spring bent far.
            Call::ExitInitializationMode => match (self.now.fits, self.has_spring()) {
                (Some(true), false) => AcceptOrRemark,
                (Some(false), _) => Fail,
                _ => Open,
            },
            Call::EnterInitializationMode | Call::Terminate | Call::Reset | Call::Renew => Accept,
            Call::Get(kind, references) => {
                arrays(fault, references.len()).unwrap_or_else(|| self.get(*kind, references))
            }
            Call::Set(kind, values) => arrays(fault, values.len()).unwrap_or_else(|| self.set(*kind, values)),
            Call::DoStep(point, size) => self.step(*point, *size),
            Call::Status(function, kind) => match (fault, function, kind) {
                (Fault::LastNull | Fault::Misaligned, ..) => Fail,
                (_, Some(Kind::Real), 2) | (_, Some(Kind::Boolean), 3) => Accept,
                _ => Discard,
            },
            Call::DirectionalDerivative => Refuse,
            Call::SetInputDerivatives(values) => {
                let judge = |&(reference, order, value): &(u32, i32, f64)| match continuous_input(reference) {
                    true if order == 1 && value.is_finite() => Accept,
                    true if order == 1 => Discard,
                    true if order > 1 => Accept,
                    _ => Fail,
                };
                let verdict =
                    three_arrays(fault, values.len()).unwrap_or_else(|| first_wrong(values.iter().map(judge)));
                let higher = values.iter().any(|&(_, order, _)| order > 1);
                // The first time.
                if verdict == Accept && higher { AcceptOrRemark } else { verdict }
            }
            Call::GetOutputDerivatives(values) => {
                let judge = |&(reference, order): &(u32, i32)| {
                    if of_kind(Kind::Real, reference).is_some_and(|variable| variable.role == Role::Output)
                        && order == 1
                        && self.now.computed
                    {
                        Accept
                    } else {
                        Fail
                    }
                };
                three_arrays(fault, values.len()).unwrap_or_else(|| first_wrong(values.iter().map(judge)))
            }
            Call::CancelStep => Fail,
            Call::GetState(_) => no_fault(fault, &[Fault::FirstNull, Fault::Foreign]),
            Call::FreeState(_) => no_fault(fault, &[Fault::Foreign]),
            Call::SetState(slot) => self.held(*slot, fault, &[]),
            Call::StateSize(slot) => self.held(*slot, fault, &[Fault::LastNull]),
            Call::Serialize(slot) => self.held(*slot, fault, &[Fault::LastNull, Fault::Endless, Fault::NullAndEndless]),
            Call::Deserialize(slot) => match fault {
                // The other faults concern it.
                Fault::None | Fault::MiddleNull | Fault::Misaligned if self.written[*slot].is_some() => Accept,
                _ => Fail,
            },
            Call::Replay { .. } => unreachable!("a replay consists of other calls"),
        }
    }

    /// Whether a spring file is named.
    fn has_spring(&self) -> bool {
        self.now.value(DESCRIPTION.reference("beam.file")) != 0.0
    }

    fn held(&self, slot: usize, fault: Fault, also: &[Fault]) -> Verdict {
        let wrong = [Fault::FirstNull, Fault::Foreign, Fault::Misaligned].contains(&fault);
        if wrong || self.saved[slot].is_none() { Fail } else { no_fault(fault, also) }
    }

    fn get(&self, kind: Kind, references: &[u32]) -> Verdict {
        first_wrong(references.iter().map(|&reference| match of_kind(kind, reference) {
            None => Fail,
            Some(variable) if variable.role != Role::Output => Accept,
            Some(_) => match (self.now.phase, self.now.fits) {
                (InitializationMode, Some(true)) | (StepComplete | Terminated, _) => Accept,
                (InitializationMode, None) => AcceptOrRefuse,
                (Error, _) if self.now.computed => Accept,
                (InitializationMode, Some(false)) | (Instantiated | Error, _) => Refuse,
            },
        }))
    }

    fn set(&self, kind: Kind, values: &[(u32, f64)]) -> Verdict {
        first_wrong(values.iter().map(|&(reference, value)| match of_kind(kind, reference) {
            None => Fail,
            Some(variable) => match variable.role {
                Role::Output => Fail,
                Role::Parameter if self.now.phase == StepComplete => Fail,
                _ if variable.allows(as_held(kind, value)) => Accept,
                _ => Discard,
            },
        }))
    }

    fn step(&self, point: Point, size: f64) -> Verdict {
        let point = point.instant(self.now.time, size);
        let end = point + size;
        if !(size.is_finite() && size > 0.0 && point.is_finite() && end.is_finite() && end > point) {
            return Fail;
        }
        // The importer's time may differ from the component's by a few roundings without and by less than 1e-4 of a step
        // with a warning, but not by a thousandth of a step; between these the component decides. The same holds for the
        // stop time.
        let rounding = f64::EPSILON * point.abs().max(end.abs());
        let off = (point - self.now.time).abs();
        if off > 1e2 * rounding + 1e-3 * size {
            return Fail;
        }
        let late = end - self.now.stop;
        if late > 1e2 * rounding + 1e-2 * size {
            return Fail;
        }
        let mut courses = DESCRIPTION.variables.iter().zip(&self.now.values).zip(&self.now.rates);
        if courses.any(|((variable, value), rate)| *rate != 0.0 && !variable.allows(value + rate * size)) {
            return Fail;
        }
        let ordinary = ORDINARY_STEPS.contains(&size) && late <= 0.0 && !self.now.extreme && !self.now.pushed_hard();
        match (ordinary, off <= 4.0 * rounding, is_off(off, rounding, size) && off < 9e-5 * size) {
            (true, true, _) => AcceptOrRemark,
            (true, false, true) if self.warned => AcceptOrRemark,
            (true, false, true) => Remark,
            _ => Open,
        }
    }

    /// Updates the expected state after the call returned `status`, which the verdict allows.
    /// `warned`: with a warning in the log.
    pub fn follow(&mut self, call: &Call, fault: Fault, status: fmi2Status, warned: bool) {
        let verdict = self.verdict(call, fault);
        let now = &mut self.now;
        if let (Call::Get(kind, references), InitializationMode) = (call, now.phase) {
            let reads_output = references
                .iter()
                .any(|&reference| of_kind(*kind, reference).is_some_and(|variable| variable.role == Role::Output));
            if reads_output && now.fits.is_none() && verdict == AcceptOrRefuse {
                now.fits = Some(status == fmi2OK);
            }
            now.computed |= reads_output && status == fmi2OK;
        }
        if status == fmi2Error {
            if !matches!(verdict, Refuse | AcceptOrRefuse) {
                now.phase = Error;
            }
            return;
        }
        if status == fmi2Discard {
            return;
        }
        match call {
            Call::SetDebugLogging(on, categories) if verdict != Remark => {
                let named = |name: &str| categories.iter().flatten().any(|category| category == name);
                let (errors, warnings) = (named("logStatusError"), named("logStatusWarning"));
                (self.errors, self.warnings) = match (on, categories.is_empty()) {
                    (true, true) => (true, true),
                    (true, false) => (errors, warnings),
                    (false, _) => (self.errors && !errors, self.warnings && !warnings),
                };
            }
            Call::SetupExperiment(_, start, stop) => {
                (now.time, now.stop) = (*start, stop.unwrap_or(f64::INFINITY));
            }
            Call::EnterInitializationMode => {
                now.phase = InitializationMode;
                // The start values are consistent.
                now.fits = now.is_untouched().then_some(true);
            }
            Call::ExitInitializationMode => (now.phase, now.fits, now.computed) = (StepComplete, Some(true), true),
            Call::Terminate => now.phase = Terminated,
            Call::Reset => {
                *now = Moment::default();
                (self.errors, self.warnings, self.warned) = (true, true, false);
            }
            Call::Renew => *self = Self { written: std::mem::take(&mut self.written), ..Self::default() },
            Call::Set(kind, values) => {
                for &(reference, value) in values {
                    if let Some(position) = DESCRIPTION.position(reference) {
                        now.values[position] = as_held(*kind, value);
                    }
                }
                if now.phase == InitializationMode {
                    (now.fits, now.computed) = (None, false);
                }
            }
            Call::SetInputDerivatives(values) => {
                for &(reference, _, rate) in values.iter().filter(|(_, order, _)| *order == 1) {
                    if let Some(position) = DESCRIPTION.position(reference) {
                        now.rates[position] = rate;
                    }
                }
            }
            Call::DoStep(point, size) => {
                self.warned |= warned;
                let point = point.instant(now.time, *size);
                let (end, off) = (point + size, (point - now.time).abs());
                let rounding = f64::EPSILON * point.abs().max(end.abs());
                // The length of the step is rounded.
                now.time = if is_off(off, rounding, *size) { now.time + (end - now.time) } else { end };
                self.now.extreme |= self.now.pushed_hard();
                self.now.rates.fill(0.0);
            }
            Call::GetState(slot) => self.saved[*slot] = Some(now.clone()),
            Call::SetState(slot) => {
                if let Some(moment) = &self.saved[*slot] {
                    *now = moment.clone();
                }
            }
            Call::FreeState(slot) if fault != Fault::FirstNull => self.saved[*slot] = None,
            Call::Serialize(slot) => self.written[*slot].clone_from(&self.saved[*slot]),
            Call::Deserialize(slot) => self.saved[*slot].clone_from(&self.written[*slot]),
            _ => {}
        }
    }
}

/// Communication steps (s) for which inputs and time stay within the floating-point range.
const ORDINARY_STEPS: std::ops::RangeInclusive<f64> = 1e-9..=1e3;

/// Whether the difference of a communication point is more than anything that may be taken for rounding, all in s.
fn is_off(off: f64, rounding: f64, size: f64) -> bool {
    off > 1e2 * rounding + 1e-7 * size
}

/// The variable of the reference, if it has the type.
pub fn of_kind(kind: Kind, reference: u32) -> Option<&'static Variable> {
    DESCRIPTION.variable(reference).filter(|variable| variable.kind == kind)
}

fn continuous_input(reference: u32) -> bool {
    of_kind(Kind::Real, reference).is_some_and(|variable| variable.role == Role::Input && variable.continuous)
}

/// The value as stored by a variable of the type.
fn as_held(kind: Kind, value: f64) -> f64 {
    #[allow(clippy::cast_possible_truncation)] // saturates
    match kind {
        Kind::Real | Kind::String => value,
        Kind::Integer => f64::from(value as i32),
        Kind::Boolean => f64::from(u8::from(value as i32 != 0)),
    }
}

fn first_wrong(verdicts: impl Iterator<Item = Verdict>) -> Verdict {
    let mut wrong = verdicts.filter(|verdict| *verdict != Accept);
    wrong.next().unwrap_or(Accept)
}

/// The verdict on the pointers of arrays of a length, unless they are valid. Pointers of empty arrays are not checked.
fn arrays(fault: Fault, length: usize) -> Option<Verdict> {
    let wrong = match fault {
        Fault::FirstNull | Fault::LastNull | Fault::Misaligned => length > 0,
        Fault::NullAndEndless | Fault::Endless => true,
        _ => false,
    };
    wrong.then_some(Fail)
}

/// The same with a third array between the two.
fn three_arrays(fault: Fault, length: usize) -> Option<Verdict> {
    let missing = fault == Fault::MiddleNull && length > 0;
    missing.then_some(Fail).or_else(|| arrays(fault, length))
}

fn no_fault(fault: Fault, wrong: &[Fault]) -> Verdict {
    if wrong.contains(&fault) { Fail } else { Accept }
}

fn logging(categories: &[Option<String>], fault: Fault) -> Verdict {
    if fault != Fault::FirstNull && arrays(fault, categories.len()).is_some() || categories.contains(&None) {
        return Fail;
    }
    let known = |category: &String| DESCRIPTION.categories.contains(category);
    if categories.iter().flatten().all(known) { Accept } else { Remark }
}
