//! A case, and a measured value with its bound.

use std::fmt;

use anyhow::{Result, ensure};

/// A scene that is hard for integrators, and the properties that must hold.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub name: &'static str,
    pub difficulty: &'static str,
    /// Simulates it and measures each property.
    pub(crate) measure: fn() -> Result<Vec<Check>>,
}

/// A list of cases: `NAME: "case", "what makes it hard" => checks; ...`.
macro_rules! cases {
    ($list:ident: $($name:literal, $difficulty:literal => $checks:expr;)*) => {
        pub const $list: &[$crate::case::Case] = &[$($crate::case::Case {
            name: $name,
            difficulty: $difficulty,
            measure: || $checks,
        }),*];
    };
}
pub(crate) use cases;

impl Case {
    /// The properties, if all hold.
    /// Else an error, also of a failed step, a number that is not finite, a tensile contact force, or more integration steps than the
    /// case allows.
    pub fn keeps_its_properties(&self) -> Result<Vec<Check>> {
        let checks = (self.measure)()?;
        let broken = checks.iter().filter(|check| !check.is_kept());
        let broken: Vec<_> = broken.map(Check::to_string).collect();
        ensure!(broken.is_empty(), "{}: {}", self.name, broken.join("; "));
        Ok(checks)
    }
}

/// A property and its deviation.
#[derive(Clone, Debug)]
pub struct Check {
    pub property: &'static str,
    /// Deviation from it, at most `allowed` if the property holds.
    pub measured: f64,
    /// The bound.
    pub allowed: f64,
    /// Unit of both; empty for a pure number.
    pub unit: &'static str,
    /// Origin of the bound.
    pub reason: &'static str,
}

impl Check {
    pub(crate) fn new(
        property: &'static str,
        (measured, allowed): (f64, f64),
        unit: &'static str,
        reason: &'static str,
    ) -> Self {
        Self { property, measured, allowed, unit, reason }
    }

    /// No deviation is allowed.
    pub(crate) fn exact(property: &'static str, measured: f64, unit: &'static str) -> Self {
        Self::new(property, (measured, 0.0), unit, "exact")
    }

    /// Instants of openings and closings are right to a nanosecond.
    pub(crate) fn instants(property: &'static str, measured: f64) -> Self {
        Self::new(property, (measured, 1e-9), "s", "accuracy guaranteed for event times")
    }

    /// A result is accurate to the tolerance.
    pub(crate) fn tolerance(property: &'static str, measured: f64, allowed: f64, unit: &'static str) -> Self {
        Self::new(property, (measured, allowed), unit, "the tolerance")
    }

    /// Two simulations differ in the force by at most twice the tolerance (N).
    pub(crate) fn two_runs(property: &'static str, difference: f64, tolerance: f64) -> Self {
        let reason = "two runs, each within the tolerance";
        Self::new(property, (difference, 2.0 * tolerance), "N", reason)
    }

    /// A force error of the tolerance along the path of the tip generates or removes energy (J).
    pub(crate) fn energy(property: &'static str, measured: f64, allowed: f64) -> Self {
        Self::new(property, (measured, allowed), "J", "force error × path of the tip")
    }

    /// The work is bounded.
    pub(crate) fn steps(measured: u64, allowed: u64) -> Self {
        let counts = (measured as f64, allowed as f64);
        Self::new("integration steps", counts, "", "bounded work")
    }

    /// False also for NaN.
    pub fn is_kept(&self) -> bool {
        self.measured <= self.allowed
    }

    /// How many times smaller the measured value is than the bound: infinite if the property holds exactly, 0 for NaN.
    pub fn margin(&self) -> f64 {
        match self.measured {
            0.0 => f64::INFINITY,
            measured if measured.is_nan() => 0.0,
            measured => self.allowed / measured,
        }
    }

    /// A value in the unit of the check.
    pub fn amount(&self, value: f64) -> String {
        let digits = if value == 0.0 { "0".to_owned() } else { format!("{value:.1e}") };
        format!("{digits} {}", self.unit).trim_end().to_owned()
    }
}

impl fmt::Display for Check {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (measured, allowed) = (self.amount(self.measured), self.amount(self.allowed));
        write!(f, "{}: measured {measured}, allowed {allowed} ({})", self.property, self.reason)
    }
}

/// Of each property, measured in several simulations, the check with the least margin.
pub(crate) fn closest(simulations: impl IntoIterator<Item = Result<Vec<Check>>>) -> Result<Vec<Check>> {
    let mut closest: Vec<Check> = Vec::new();
    for checks in simulations {
        for check in checks? {
            match closest.iter_mut().find(|other| other.property == check.property) {
                Some(other) if check.margin() < other.margin() => *other = check,
                Some(_) => {}
                None => closest.push(check),
            }
        }
    }
    Ok(closest)
}

#[cfg(test)]
mod tests {
    use testing::worst;

    use super::*;

    #[test]
    fn a_measured_value_that_is_no_number_or_too_large_violates_its_property() {
        let check = |measured| Check::new("", (measured, 1e-9), "s", "");
        assert!(check(0.0).is_kept() && check(1e-9).is_kept());
        assert!(!check(1.1e-9).is_kept() && !check(f64::NAN).is_kept());
        assert!(worst(worst(1.0, f64::NAN), 2.0).is_nan());
        let found = closest([0.0, f64::NAN, 1e-9].map(|measured| Ok(vec![check(measured)])));
        assert!(matches!(&found.unwrap()[..], [one] if one.measured.is_nan()));
    }
}
