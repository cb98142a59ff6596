//! Makes a call and compares it with the expected life cycle.

use std::collections::BTreeSet;

use relay_contact::fmi2::*;

use crate::api::Api;
use crate::call::{Call, Fault};
use crate::description::{DESCRIPTION, Kind, Role};
use crate::importer::{Answer, Importer};
use crate::life_cycle::{LifeCycle, of_kind};
use crate::states::{Phase, allowed};

/// An instance under test.
#[derive(Debug)]
pub struct Judge<'a> {
    pub importer: Importer<'a>,
    /// Its expected state.
    pub life: LifeCycle,
    pub calls: u64,
    /// The functions called.
    pub met: BTreeSet<String>,
}

impl<'a> Judge<'a> {
    pub fn new(api: &'a Api) -> Self {
        Self { importer: Importer::new(api), life: LifeCycle::default(), calls: 0, met: BTreeSet::new() }
    }

    /// Makes calls, up to the first wrong answer.
    pub fn run<'c>(&mut self, calls: impl IntoIterator<Item = &'c Call>) -> Result<(), String> {
        calls.into_iter().try_for_each(|call| self.call(call))
    }

    /// Makes a call without a fault.
    pub fn call(&mut self, call: &Call) -> Result<(), String> {
        self.call_with(call, Fault::None)
    }

    pub fn call_with(&mut self, call: &Call, fault: Fault) -> Result<(), String> {
        if let Call::Replay { slot, inputs, steps, size } = call {
            return self.replay(*slot, inputs, *steps, *size);
        }
        self.learn_whether_it_fits(call)?;
        let ((status, values), warned) = self.answer(call, fault)?;
        if status == fmi2OK {
            self.check_values(call, &values)?;
        }
        self.life.follow(call, fault, status, warned);
        self.check_state(call, status)
    }

    /// Status and values, and whether a warning was logged.
    fn answer(&mut self, call: &Call, fault: Fault) -> Result<(Answer, bool), String> {
        let verdict = self.life.verdict(call, fault);
        let (status, values) = self.importer.make(call, fault, self.life.now.time);
        self.calls += 1;
        self.met.insert(call.function());
        let messages = self.importer.messages();
        if !verdict.statuses().contains(&status) {
            let phase = self.life.now.phase;
            return Err(format!(
                "{call:?} ({fault:?}) in {phase:?}: status {status}, expected {verdict:?}; {messages:?}"
            ));
        }
        let function = call.function();
        let (logged, category, shown) = match status {
            fmi2OK => (fmi2Warning, "logStatusWarning", self.life.warnings),
            fmi2Discard => (fmi2Discard, "logStatusWarning", self.life.warnings),
            _ => (status, "logStatusError", self.life.errors),
        };
        let expected = if status == fmi2OK { verdict.warns() } else { Some(true) };
        let about_status: Vec<_> =
            messages.iter().filter(|message| message.category.starts_with("logStatus")).collect();
        let right = match about_status[..] {
            [] => !shown || expected != Some(true),
            [told] => {
                let out_of_order = format!("not allowed in the state {}", self.life.now.phase.name());
                shown
                    && expected != Some(false)
                    && told.status == logged
                    && told.category == category
                    && told.text.starts_with(&format!("{function}: "))
                    && told.text.contains(&out_of_order) != allowed(&function, self.life.now.phase)
            }
            _ => false,
        };
        if right {
            Ok(((status, values), status == fmi2OK && !about_status.is_empty()))
        } else {
            Err(format!("{call:?} ({fault:?}): status {status}, but the messages are {messages:?} (shown: {shown})"))
        }
    }

    /// If outputs can be read in Initialization Mode, initialisation must succeed, and vice versa.
    fn learn_whether_it_fits(&mut self, call: &Call) -> Result<(), String> {
        let asks = matches!(call, Call::Get(_, references) if references.len() > 1);
        let unknown = !self.life.now.computed && self.life.now.fits != Some(false);
        if asks && unknown && self.life.now.phase == Phase::InitializationMode {
            let one = DESCRIPTION.outputs(Kind::Real)[0];
            self.call(&Call::Get(Kind::Real, vec![one]))?;
        }
        Ok(())
    }

    fn check_values(&self, call: &Call, values: &[f64]) -> Result<(), String> {
        let now = &self.life.now;
        match call {
            Call::Get(kind, references) => {
                for (&reference, &value) in references.iter().zip(values) {
                    let known = of_kind(*kind, reference).is_some_and(|variable| variable.role != Role::Output);
                    if known && value.to_bits() != now.value(reference).to_bits() {
                        return Err(format!("{reference} is {value}, was set to {}", now.value(reference)));
                    }
                    if !value.is_finite() || (*kind == Kind::Boolean && ![0.0, 1.0].contains(&value)) {
                        return Err(format!("{reference} is {value}; {:?}", now.values));
                    }
                }
            }
            Call::GetOutputDerivatives(..) if !values.iter().all(|value| value.is_finite()) => {
                return Err(format!("{call:?}: {values:?}"));
            }
            Call::Status(Some(Kind::Real), ..) if values != [now.time] => {
                return Err(format!("last successful time {values:?} instead of {}", now.time));
            }
            Call::Status(Some(Kind::Boolean), ..) if values != [0.0] => {
                return Err(format!("terminated: {values:?}"));
            }
            _ => {}
        }
        Ok(())
    }

    /// Checks the outputs after calls that may change them, and the values after calls that set all or none.
    fn check_state(&mut self, call: &Call, status: fmi2Status) -> Result<(), String> {
        let moves = match call {
            Call::DoStep(..) => true,
            Call::ExitInitializationMode | Call::SetState(..) | Call::Terminate | Call::Set(..) => status == fmi2OK,
            _ => false,
        };
        let readable = matches!(self.life.now.phase, Phase::StepComplete | Phase::Terminated)
            || (self.life.now.phase == Phase::Error && self.life.now.computed);
        if moves && readable {
            let outputs = self.outputs()?;
            let anew = matches!(call, Call::DoStep(..) | Call::ExitInitializationMode) && status == fmi2OK;
            if let Some(before) = self.life.now.outputs.as_ref().filter(|before| !anew && **before != outputs) {
                return Err(format!("{call:?}: outputs were {before:x?}, are {outputs:x?}"));
            }
            self.life.now.outputs = Some(outputs);
        }
        if matches!(call, Call::DoStep(..)) && status == fmi2OK {
            self.call(&Call::TIME)?;
        }
        let sets = match call {
            Call::SetState(..) | Call::Reset => status == fmi2OK,
            Call::Set(..) => status == fmi2Discard,
            _ => false,
        };
        if sets {
            for kind in Kind::ALL {
                let settable =
                    DESCRIPTION.references(|variable| variable.role != Role::Output && variable.kind == kind);
                self.call(&Call::Get(kind, settable))?;
            }
        }
        Ok(())
    }

    /// The bits of all outputs, which must be finite.
    fn outputs(&mut self) -> Result<Vec<u64>, String> {
        let mut bits = Vec::new();
        for kind in [Kind::Real, Kind::Integer, Kind::Boolean] {
            let get = Call::Get(kind, DESCRIPTION.outputs(kind));
            let ((_, values), _) = self.answer(&get, Fault::None)?;
            self.check_values(&get, &values)?;
            bits.extend(values.iter().map(|value| value.to_bits()));
        }
        Ok(bits)
    }

    fn replay(&mut self, slot: usize, inputs: &[(u32, f64)], steps: u32, size: f64) -> Result<(), String> {
        let mut run = || {
            self.run(&[Call::SetState(slot), Call::set_reals(inputs.to_vec())])?;
            let mut trace = Vec::new();
            for _ in 0..steps {
                self.call(&Call::step(size))?;
                trace.push((self.life.now.phase, self.life.now.outputs.clone()));
            }
            Ok::<_, String>(trace)
        };
        let (first, second) = (run()?, run()?);
        if first == second { Ok(()) } else { Err(format!("a replay differs: {first:x?}\n{second:x?}")) }
    }
}
