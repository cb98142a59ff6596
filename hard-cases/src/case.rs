//! A case, and a measured value beside its bound.

use std::fmt;

use anyhow::{Result, bail};

/// A scene that breaks integrators, and what must hold in it.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// What is simulated.
    pub name: &'static str,
    /// What makes it hard.
    pub difficulty: &'static str,
    /// Whether it takes minutes.
    pub long: bool,
    run: fn() -> Result<Vec<Check>>,
}

impl Case {
    pub(crate) const fn new(name: &'static str, difficulty: &'static str, run: fn() -> Result<Vec<Check>>) -> Self {
        Self {
            name,
            difficulty,
            long: false,
            run,
        }
    }

    pub(crate) const fn long(self) -> Self {
        Self { long: true, ..self }
    }

    /// Simulates the case and measures each property.
    ///
    /// # Errors
    /// Where the simulation itself fails: a step that cannot be taken, a number that is not finite, a contact that pulls,
    /// more integration steps than the case allows.
    pub fn measure(&self) -> Result<Vec<Check>> {
        (self.run)()
    }

    /// As [`Case::measure`].
    ///
    /// # Errors
    /// Also where a property is not kept.
    pub fn keeps_its_properties(&self) -> Result<Vec<Check>> {
        let checks = self.measure()?;
        let broken: Vec<_> = checks.iter().filter(|check| !check.is_kept()).collect();
        if broken.is_empty() {
            return Ok(checks);
        }
        let broken: Vec<_> = broken.into_iter().map(Check::to_string).collect();
        bail!("{}: {}", self.name, broken.join("; "))
    }
}

/// The bound of an exact property.
const EXACT: &str = "exact";

/// The bound of the difference of two simulations.
pub(crate) const TWO_RUNS: &str = "two runs, each within the tolerance";

/// The bound of the number of integration steps.
pub(crate) const WORK: &str = "the work stays bounded";

/// The bound of the energy.
pub(crate) const FORCE_ERROR_TIMES_PATH: &str = "force error times path of the tip";

/// A property and how well it is kept.
#[derive(Clone, Debug)]
pub struct Check {
    /// What must hold.
    pub property: &'static str,
    /// Deviation from it, at most `allowed` where the property is kept.
    pub measured: f64,
    /// The bound.
    pub allowed: f64,
    /// Unit of both; empty for a pure number.
    pub unit: &'static str,
    /// Where the bound comes from.
    pub reason: &'static str,
}

impl Check {
    pub(crate) fn new(
        property: &'static str,
        (measured, allowed): (f64, f64),
        unit: &'static str,
        reason: &'static str,
    ) -> Self {
        Self {
            property,
            measured,
            allowed,
            unit,
            reason,
        }
    }

    /// A property that allows no deviation.
    pub(crate) fn exact(property: &'static str, measured: f64, unit: &'static str) -> Self {
        Self::new(property, (measured, 0.0), unit, EXACT)
    }

    /// False also for what is not a number.
    pub fn is_kept(&self) -> bool {
        self.measured <= self.allowed
    }

    /// How many times smaller the measured value is than the bound: infinite where the property is kept exactly, 0 for what is
    /// not a number.
    pub fn margin(&self) -> f64 {
        match self.measured {
            0.0 => f64::INFINITY,
            measured if measured.is_nan() => 0.0,
            measured => self.allowed / measured,
        }
    }

    /// An amount in the unit of the check.
    pub fn amount(&self, value: f64) -> String {
        let digits = if value == 0.0 {
            "0".to_owned()
        } else {
            format!("{value:.1e}")
        };
        format!("{digits} {}", self.unit).trim_end().to_owned()
    }
}

impl fmt::Display for Check {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (measured, allowed) = (self.amount(self.measured), self.amount(self.allowed));
        write!(
            f,
            "{}: measured {measured}, allowed {allowed} ({})",
            self.property, self.reason
        )
    }
}

/// Of each property, measured in several simulations, the check with the least margin.
pub(crate) fn closest(checks: impl IntoIterator<Item = Check>) -> Vec<Check> {
    let mut closest: Vec<Check> = Vec::new();
    for check in checks {
        match closest.iter_mut().find(|other| other.property == check.property) {
            Some(other) if check.margin() < other.margin() => *other = check,
            Some(_) => {}
            None => closest.push(check),
        }
    }
    closest
}

/// The larger deviation; what is not a number stays.
pub(crate) fn worst(a: f64, b: f64) -> f64 {
    if b.is_nan() || b > a { b } else { a }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_or_too_much_is_not_kept() {
        let check = |measured| Check::new("", (measured, 1e-9), "s", "");
        assert!(check(0.0).is_kept() && check(1e-9).is_kept());
        assert!(!check(1.1e-9).is_kept() && !check(f64::NAN).is_kept());
        assert!(worst(worst(1.0, f64::NAN), 2.0).is_nan());
        let found = closest([0.0, f64::NAN, 1e-9].map(check));
        assert!(matches!(&found[..], [one] if one.measured.is_nan()));
    }
}
