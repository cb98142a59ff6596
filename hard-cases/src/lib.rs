//! Scenes that are hard for integrators, with the properties that must hold: one list, run by the tests of this crate
//! and printed with margins by the report. [`case`]: a case, and a measured value with its bound;   [`ride`]: a scene
//! with prescribed motions, and the properties that hold in every scene;   [`energy_balance`]: the energy balance of
//! the component.   Cases: [`contact`], [`spring`], [`excitation`], [`support`] (a fixed contact that moves), [`armature`],
//! [`instants`] (of opening and closing), [`solver`] (tolerances, numbers of modes, communication steps),
//! [`endurance`]. The bounds follow from theory: a force error of the tolerance generates at most that force times the
//! path of the tip in energy, and two runs within the tolerance differ by at most twice the tolerance.
#![allow(missing_docs, clippy::missing_errors_doc)] // used only by tests

mod armature;
pub mod case;
mod contact;
mod endurance;
mod energy_balance;
mod excitation;
mod instants;
pub mod ride;
mod solver;
mod spring;
mod support;

use case::Case;

/// Cases that take seconds.
pub const CASES: &[&[Case]] = &[
    contact::CASES,
    spring::CASES,
    excitation::CASES,
    support::CASES,
    armature::CASES,
    instants::CASES,
    solver::CASES,
    endurance::CASES,
];

/// Cases that take minutes.
pub const LONG_CASES: &[Case] = endurance::LONG;
