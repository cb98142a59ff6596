//! The variables of an instance by value reference: which may be read and set in which state.

use std::ffi::{CStr, CString};

use super::Instance;
use crate::error::SceneError;
use crate::fmi2::failure::Failure;
use crate::fmi2::states::State;
use crate::scene::Scene;
use crate::simulation::Simulation;
use crate::variables::{Group, Variable};

/// A value to be set.
#[derive(Clone, Copy)]
pub(in crate::fmi2) enum Value<'a> {
    Real(f64),
    Integer(i32),
    Boolean(bool),
    Text(&'a CStr),
}

impl Value<'_> {
    fn kind(self) -> &'static str {
        match self {
            Self::Real(_) => "Real",
            Self::Integer(_) => "Integer",
            Self::Boolean(_) => "Boolean",
            Self::Text(_) => "String",
        }
    }
}

impl Instance {
    /// The simulation to read the output `variable` from.
    fn computed(&mut self, variable: &Variable) -> Result<&Simulation, Failure> {
        if self.state == State::InitializationMode {
            return self.prepare().map_err(Failure::Preview);
        }
        self.simulation.as_deref().ok_or(Failure::NotComputed {
            name: variable.name,
            state: self.state,
        })
    }

    pub(in crate::fmi2) fn real(&mut self, reference: u32) -> Result<f64, Failure> {
        let variable = find("Real", reference)?;
        match variable.group {
            Group::RealOutput(output) => Ok(self.computed(variable)?.real(output)),
            Group::RealInput(input) => Ok(self.inputs.real(input)),
            Group::RealParameter(parameter) => Ok(self.scene.real(parameter)),
            _ if self.plain => self.number(reference),
            _ => Err(wrong_type("Real", variable)),
        }
    }

    /// The value of a variable as a real: a choice by its number, true as 1.
    pub(in crate::fmi2) fn number(&mut self, reference: u32) -> Result<f64, Failure> {
        let variable = find("Real", reference)?;
        match variable.group {
            Group::RealOutput(_) | Group::RealInput(_) | Group::RealParameter(_) => self.real(reference),
            Group::BooleanOutput(_) | Group::BooleanParameter(_) => {
                self.boolean(reference).map(|value| f64::from(u8::from(value)))
            }
            Group::StringParameter(_) => Err(wrong_type("Real", variable)),
            _ => self.integer(reference).map(f64::from),
        }
    }

    pub(in crate::fmi2) fn integer(&mut self, reference: u32) -> Result<i32, Failure> {
        let variable = find("Integer", reference)?;
        match variable.group {
            Group::IntegerOutput(output) => Ok(self.computed(variable)?.integer(output)),
            Group::IntegerParameter(parameter) => Ok(self.scene.integer(parameter)),
            Group::EnumerationParameter(parameter) => Ok(self.scene.enumeration(parameter)),
            _ => Err(wrong_type("Integer", variable)),
        }
    }

    pub(in crate::fmi2) fn boolean(&mut self, reference: u32) -> Result<bool, Failure> {
        let variable = find("Boolean", reference)?;
        match variable.group {
            Group::BooleanOutput(output) => Ok(self.computed(variable)?.boolean(output)),
            Group::BooleanParameter(parameter) => Ok(self.scene.boolean(parameter)),
            _ => Err(wrong_type("Boolean", variable)),
        }
    }

    /// Sets inputs and parameters; all of them or, on an error, none.
    pub(in crate::fmi2) fn set<'a>(
        &mut self,
        references: &[u32],
        values: impl Iterator<Item = Result<Value<'a>, Failure>>,
    ) -> Result<(), Failure> {
        let (mut scene, mut inputs) = (self.scene.clone(), self.inputs);
        for (&reference, value) in references.iter().zip(values) {
            let value = value?;
            let variable = find(value.kind(), reference)?;
            let fixed = || self.check_fixed(variable);
            let set = match (variable.group, value) {
                (Group::RealInput(input), Value::Real(value)) => inputs.set_real(input, value),
                (Group::RealParameter(parameter), Value::Real(value)) => {
                    fixed().map(|()| scene.set_real(parameter, value))?
                }
                (Group::IntegerParameter(parameter), Value::Integer(value)) => {
                    fixed().map(|()| scene.set_integer(parameter, value))?
                }
                (Group::EnumerationParameter(parameter), Value::Integer(value)) => {
                    fixed().map(|()| scene.set_enumeration(parameter, value))?
                }
                (Group::BooleanParameter(parameter), Value::Boolean(value)) => {
                    fixed().map(|()| scene.set_boolean(parameter, value))?;
                    Ok(())
                }
                (Group::StringParameter(parameter), Value::Text(value)) => {
                    fixed()?;
                    path_text(variable, value).and_then(|path| self.set_string(&mut scene, parameter, path))
                }
                (Group::RealOutput(_), Value::Real(_))
                | (Group::IntegerOutput(_), Value::Integer(_))
                | (Group::BooleanOutput(_), Value::Boolean(_)) => return Err(self.output_set(variable)),
                (_, Value::Real(value)) if self.plain => {
                    self.set_number(&mut scene, variable, value)?;
                    Ok(())
                }
                _ => return Err(wrong_type(value.kind(), variable)),
            };
            set.map_err(Failure::Value)?;
        }
        (self.scene, self.inputs) = (scene, inputs);
        if self.state == State::InitializationMode {
            self.simulation = None;
        }
        Ok(())
    }

    /// Sets an integer, a choice or a Boolean of the plain component, where it is a Real.
    fn set_number(&self, scene: &mut Scene, variable: &Variable, value: f64) -> Result<(), Failure> {
        let refused = |allowed: &str| SceneError::out_of_range(variable, value, format!("allowed is {allowed}"));
        // As text, which a fraction and what is too large do not survive.
        let whole = value.to_string().parse::<i32>().ok();
        let whole = whole.ok_or_else(|| refused("a whole number"));
        let set = match variable.group {
            Group::IntegerParameter(parameter) => whole.and_then(|whole| scene.set_integer(parameter, whole)),
            Group::EnumerationParameter(parameter) => whole.and_then(|whole| scene.set_enumeration(parameter, whole)),
            Group::BooleanParameter(parameter) => match whole {
                Ok(whole @ (0 | 1)) => {
                    scene.set_boolean(parameter, whole == 1);
                    Ok(())
                }
                _ => Err(refused("0 or 1")),
            },
            Group::IntegerOutput(_) | Group::BooleanOutput(_) => return Err(self.output_set(variable)),
            _ => return Err(wrong_type("Real", variable)),
        };
        self.check_fixed(variable)?;
        set.map_err(Failure::Value)
    }

    /// The value of a string parameter, kept until it is read again: a call may ask for all, and for the same one twice.
    pub(in crate::fmi2) fn string(&mut self, reference: u32) -> Result<&CStr, Failure> {
        let variable = find("String", reference)?;
        let wrong = || wrong_type("String", variable);
        let Group::StringParameter(parameter) = variable.group else {
            return Err(wrong());
        };
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
            let Group::RealInput(input) = variable.group else {
                return Err(no_derivative(variable, "inputs"));
            };
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
            Group::RealOutput(output) => self.computed(variable)?.rate(output).unwrap_or_default(),
            Group::IntegerOutput(_) | Group::BooleanOutput(_) if self.plain => {
                self.computed(variable)?;
                0.0
            }
            _ => return Err(no_derivative(variable, "outputs")),
        };
        first_order(variable, order)?;
        Ok(rate)
    }

    /// Fixed parameters can be set until initialisation ends.
    fn check_fixed(&self, variable: &Variable) -> Result<(), Failure> {
        match self.state {
            State::Instantiated | State::InitializationMode => Ok(()),
            state => Err(Failure::NotSettable {
                name: variable.name,
                state,
                reason: "a fixed parameter can be set until initialisation ends",
            }),
        }
    }

    fn output_set(&self, variable: &Variable) -> Failure {
        Failure::NotSettable {
            name: variable.name,
            state: self.state,
            reason: "it is computed; inputs and parameters can be set",
        }
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

fn find(kind: &'static str, reference: u32) -> Result<&'static Variable, Failure> {
    Variable::by_value_reference(reference).ok_or(Failure::UnknownReference {
        kind,
        reference,
        owner: None,
    })
}

/// Only derivatives of order 1 are supported.
fn first_order(variable: &Variable, order: i32) -> Result<(), Failure> {
    let name = variable.name;
    (order == 1).then_some(()).ok_or(Failure::Order { name, order })
}

fn no_derivative(variable: &Variable, role: &'static str) -> Failure {
    Failure::NoDerivative {
        name: variable.name,
        role,
    }
}

fn wrong_type(kind: &'static str, variable: &Variable) -> Failure {
    Failure::UnknownReference {
        kind,
        reference: variable.value_reference,
        owner: Some(variable.name),
    }
}
