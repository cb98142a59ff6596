//! Scenes that break integrators, each with the properties that must hold in it: one list, which the tests of this crate run
//! case by case, and the report prints with the margins.
//!
//! [`case`]: a case, and a measured value beside its bound;   [`ride`]: a scene with prescribed motions, and the properties that
//! every scene keeps;   [`energy_balance`]: the component's own account of the energy.   Cases: [`contact`], [`spring`], [`excitation`], [`support`] (a fixed contact that moves), [`instants`] (of opening and
//! closing), [`solver`] (tolerances, numbers of modes, communication steps), [`endurance`].
//!
//! Bounds are what theory leaves: a contact force wrong by the tolerance makes at most that force times the path of the tip in
//! energy, and two runs within the tolerance differ by at most twice that.

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
    instants::CASES,
    solver::CASES,
    endurance::CASES,
];

/// Cases that take minutes.
pub const LONG_CASES: &[Case] = endurance::LONG;
