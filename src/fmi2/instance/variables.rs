//! The variables of an instance by value reference: which may be read and set in which state.

use std::ffi::{CStr, CString};

use super::Instance;
use crate::error::SceneError;
use crate::fmi2::failure::Failure;
use crate::fmi2::states::State;
use crate::simulation::Simulation;
use crate::variables::{Group, Variable};

/// A value to set: a number, true as 1, or a text.
#[derive(Clone, Copy)]
pub(in crate::fmi2) enum Value<'a> {
    Number(f64),
    Text(&'a CStr),
}

impl Instance {
    /// The simulation to read the output `variable` from.
    fn computed(&mut self, variable: &Variable) -> Result<&Simulation, Failure> {
        if self.state == State::InitializationMode {
            return self.prepare().map_err(Failure::Preview);
        }
        self.simulation.as_deref().ok_or(Failure::NotComputed { name: variable.name, state: self.state })
    }

    /// The value of a variable of a type as a real.
    pub(in crate::fmi2) fn value(&mut self, kind: &'static str, reference: u32) -> Result<f64, Failure> {
        self.number(self.typed(kind, reference)?)
    }

    /// The value of a variable as a real: a choice by its number, true as 1.
    pub(in crate::fmi2) fn number(&mut self, variable: &Variable) -> Result<f64, Failure> {
        Ok(match (variable.group, self.scene.number(variable)) {
            (Group::RealInput(input), _) => self.inputs.real(input),
            (Group::StringParameter(_), _) => return Err(wrong_type("Real", variable)),
            (_, Some(parameter)) => parameter,
            (_, None) => self.computed(variable)?.output(variable).unwrap_or_default(),
        })
    }

    /// Sets inputs and parameters of a type; all of them or, on an error, none.
    pub(in crate::fmi2) fn set<'a>(
        &mut self,
        kind: &'static str,
        references: &[u32],
        values: impl Iterator<Item = Result<Value<'a>, Failure>>,
    ) -> Result<(), Failure> {
        let (mut scene, mut inputs) = (self.scene.clone(), self.inputs);
        for (&reference, value) in references.iter().zip(values) {
            let value = value?;
            let variable = self.typed(kind, reference)?;
            self.check_settable(variable)?;
            let set = match (variable.group, value) {
                (Group::RealInput(input), Value::Number(value)) => inputs.set_real(input, value),
                (Group::StringParameter(parameter), Value::Text(value)) => {
                    path_text(variable, value).and_then(|path| self.set_string(&mut scene, parameter, path))
                }
                (_, Value::Number(value)) => scene.set_number(variable, value),
                (_, Value::Text(_)) => return Err(wrong_type(kind, variable)),
            };
            set.map_err(Failure::Value)?;
        }
        (self.scene, self.inputs) = (scene, inputs);
        if self.state == State::InitializationMode {
            self.simulation = None;
        }
        Ok(())
    }

    /// Refuses outputs, and fixed parameters after initialisation.
    fn check_settable(&self, variable: &Variable) -> Result<(), Failure> {
        let reason = match variable.group {
            Group::RealInput(_) => return Ok(()),
            Group::RealOutput(_) | Group::IntegerOutput(_) | Group::BooleanOutput(_) => {
                "it is computed; inputs and parameters can be set"
            }
            _ if matches!(self.state, State::Instantiated | State::InitializationMode) => return Ok(()),
            _ => "a fixed parameter can be set until initialisation ends",
        };
        Err(Failure::NotSettable { name: variable.name, state: self.state, reason })
    }

    /// The variable of this type; all numbers of the plain component are Reals.
    fn typed(&self, kind: &'static str, reference: u32) -> Result<&'static Variable, Failure> {
        let variable = find(kind, reference)?;
        let own = own_type(variable);
        let fits = own == kind || self.plain && kind == "Real" && own != "String";
        fits.then_some(variable).ok_or_else(|| wrong_type(kind, variable))
    }

    /// The value of a string parameter, kept until it is read again: a call may ask for all, and for the same one twice.
    pub(in crate::fmi2) fn string(&mut self, reference: u32) -> Result<&CStr, Failure> {
        let variable = self.typed("String", reference)?;
        let wrong = || wrong_type("String", variable);
        let Group::StringParameter(parameter) = variable.group else { return Err(wrong()) };
        let value = self.scene.string(parameter);
        let text = self.texts.get_mut(parameter as usize).ok_or_else(wrong)?;
        if text.to_bytes() != value.as_bytes() {
            // Set from C, or by a state, which may hold anything.
            *text = CString::new(value).unwrap_or_default();
        }
        Ok(text)
    }

    /// Sets first derivatives of continuous inputs; all of them or, on an error, none. Higher ones have no effect.
    pub(in crate::fmi2) fn set_input_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &[f64],
    ) -> Result<(), Failure> {
        let (mut inputs, mut ignored) = (self.inputs, None);
        for ((&reference, &order), &value) in references.iter().zip(orders).zip(values) {
            let variable = find("Real", reference)?;
            let Group::RealInput(input) = variable.group else { return Err(no_derivative(variable, "inputs")) };
            if order > 1 {
                ignored = ignored.or(Some((variable.name, order)));
                continue;
            }
            first_order(variable, order)?;
            inputs.set_rate(input, value).map_err(Failure::Value)?;
        }
        self.inputs = inputs;
        match ignored {
            Some((name, order)) if !std::mem::replace(&mut self.told.of_order, true) => {
                Err(Failure::Ignored { name, order })
            }
            _ => Ok(()),
        }
    }

    /// The first derivative of an output, of a discrete one 0 (FMI 2.0.4, 4.2.1).
    pub(in crate::fmi2) fn output_derivative(&mut self, reference: u32, order: i32) -> Result<f64, Failure> {
        let variable = find("Real", reference)?;
        let rate = match variable.group {
            Group::RealOutput(output) => self.computed(variable)?.rate(output),
            Group::IntegerOutput(_) | Group::BooleanOutput(_) if self.plain => self.computed(variable).map(|_| None)?,
            _ => return Err(no_derivative(variable, "outputs")),
        };
        first_order(variable, order)?;
        Ok(rate.unwrap_or_default())
    }
}

/// A path in UTF-8 of a length that systems allow.
fn path_text<'a>(variable: &Variable, value: &'a CStr) -> Result<&'a str, SceneError> {
    let text = value.to_str().ok().filter(|text| text.len() <= LONGEST_PATH);
    text.ok_or_else(|| {
        let shown: String = value.to_string_lossy().chars().take(60).collect();
        SceneError::WrongType {
            name: variable.name.to_owned(),
            value: format!("{shown:?}"),
            allowed: "a path in UTF-8 of at most 4096 bytes",
        }
    })
}

/// Longest path, bytes.
const LONGEST_PATH: usize = 4096;

pub(in crate::fmi2) fn find(kind: &'static str, reference: u32) -> Result<&'static Variable, Failure> {
    Variable::by_value_reference(reference).ok_or(Failure::UnknownReference { kind, reference, owner: None })
}

/// Only derivatives of order 1 are supported.
fn first_order(variable: &Variable, order: i32) -> Result<(), Failure> {
    let name = variable.name;
    (order == 1).then_some(()).ok_or(Failure::Order { name, order })
}

fn no_derivative(variable: &Variable, role: &'static str) -> Failure {
    Failure::NoDerivative { name: variable.name, role }
}

fn wrong_type(kind: &'static str, variable: &Variable) -> Failure {
    let owner = Some((variable.name, own_type(variable)));
    Failure::UnknownReference { kind, reference: variable.value_reference, owner }
}

/// The type by whose functions a variable is read and set.
fn own_type(variable: &Variable) -> &'static str {
    match variable.group {
        Group::RealInput(_) | Group::RealParameter(_) | Group::RealOutput(_) => "Real",
        Group::IntegerParameter(_) | Group::EnumerationParameter(_) | Group::IntegerOutput(_) => "Integer",
        Group::BooleanParameter(_) | Group::BooleanOutput(_) => "Boolean",
        Group::StringParameter(_) => "String",
    }
}
