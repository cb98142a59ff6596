//! A spring that is given by its modes.
//!
//! What the modes lack of the static compliance `c` is a spring in series with the contact, `c - sum T_i^2 / omega_i^2`
//! (residual flexibility: R. H. MacNeal, Computers & Structures 1 (1971) 581). It is one mode more, so fast that it follows
//! at once: `T^2 / omega^2` is that flexibility. It gives way in the damping time `c / omega^2` of the highest mode. With a contact's
//! damper in series its deflection is a state: steps are no longer than some fifty of the time after which the mode forgets that.

use nalgebra::{DMatrix, DVector};

use crate::beam::galerkin::{Places, Space};
use crate::beam::mode::{Last, MAX_MODES, Mode, Rayleigh};
use crate::beam::mode_count::Blow;
use crate::beam::section::Section;
use crate::math::roots;
use crate::math::simd::LANES;
use crate::scene::spring::{GivenMode, Modes};

/// Frequency of the residual flexibility over the highest of the modes, 1.
const RESIDUAL: f64 = 1e4;

/// Damping ratio of the highest mode that counts for the residual flexibility at least, 1: it then lags by 3e-3 of a period at that
/// frequency, where the modes that are missing make all the difference.
const DAMPED: f64 = 0.01;

/// Share of the compliance below which a residual flexibility is what was not printed, 1.
const ROUNDING: f64 = 1e-7;

/// The modes of a file, frequency ascending.
#[derive(Clone, Debug, PartialEq)]
pub struct Given {
    modes: Vec<GivenMode>,
    /// Static deflection of the contact per force there, m/N.
    compliance: f64,
    /// The same of a parallel contact; 0 without one.
    parallel_compliance: f64,
}

impl Given {
    pub fn new(spring: &Modes) -> Self {
        let mut modes = spring.modes.clone();
        modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
        Self {
            modes,
            // What the modes exceed it by are digits that were not printed.
            compliance: spring.compliance.max(spring.held()),
            parallel_compliance: spring.parallel_compliance(),
        }
    }

    /// The uniform spring of the same stiffness; its length has no meaning.
    pub fn equivalent(&self) -> Section {
        Section {
            length: 1.0,
            bending_stiffness: 1.0 / (3.0 * self.compliance),
            mass_per_length: 1.0,
            tip_mass: 0.0,
            tip_inertia: 0.0,
        }
    }

    /// Their number, with the residual flexibility of each contact.
    pub fn count(&self) -> usize {
        (self.modes.len() + self.residuals()).min(MAX_MODES)
    }

    pub fn residuals(&self) -> usize {
        if self.parallel_compliance > 0.0 { 2 } else { 1 }
    }

    /// Up to `count` modes, the residual flexibility of each contact among them, with the damping of those that have none of their own.
    pub fn modes(&self, count: usize, damping: Rayleigh) -> Vec<Mode> {
        let mode = |mode: &GivenMode| {
            let omega_squared = mode.omega_squared();
            let own = mode.damping.map(|ratio| 2.0 * ratio * omega_squared.sqrt());
            Mode {
                omega_squared,
                damping: own.unwrap_or(damping.of(omega_squared)),
                tip: mode.contact,
                participation: mode.participation,
                rotation: mode.rotation.unwrap_or_default(),
                pusher: mode.pusher.unwrap_or_default(),
                parallel: mode.parallel.unwrap_or_default(),
                ..Mode::default()
            }
        };
        let count = count.min(MAX_MODES).saturating_sub(self.residuals());
        let mut modes: Vec<_> = self.modes.iter().take(count).map(mode).collect();
        let Some(&Mode { omega_squared, damping, .. }) = modes.last() else { return modes };
        let damping = RESIDUAL.powi(2) * damping.max(2.0 * DAMPED * omega_squared.sqrt());
        let omega_squared = RESIDUAL.powi(2) * omega_squared;
        let residual = |compliance: f64, held: f64| {
            let rest = compliance - held;
            (rest > ROUNDING * compliance).then(|| (rest * omega_squared).sqrt())
        };
        let rest = Mode { omega_squared, damping, ..Mode::default() };
        let tip = residual(self.compliance, modes.iter().map(Mode::compliance).sum());
        let held = modes.iter().map(|mode| mode.parallel.powi(2) / mode.omega_squared);
        let parallel = residual(self.parallel_compliance, held.sum());
        modes.extend(tip.map(|tip| Mode { tip, ..rest }));
        modes.extend(parallel.map(|parallel| Mode { parallel, ..rest }));
        modes
    }

    /// Coefficients of these modes in the highest that are not left out, sqrt(J) per displacement; zero if none is left out.
    pub fn last<'a>(&'a self, modes: &'a [Mode]) -> impl Iterator<Item = Last> + 'a {
        let pairs = modes.iter().zip(&self.modes);
        let is_same = |(mode, given): &(&Mode, &GivenMode)| mode.omega_squared == given.omega_squared();
        let kept = pairs.take_while(is_same).count();
        let in_function = move |i: usize, k: usize| kept < self.modes.len() && i + LANES == kept + k;
        modes.iter().enumerate().map(move |(i, mode)| {
            let root = mode.omega_squared.sqrt();
            std::array::from_fn(|k| if in_function(i, k) { root } else { 0.0 })
        })
    }

    /// Modes as functions orthonormal in strain energy, in units of the equivalent section.
    pub fn space(&self, modes: &[Mode]) -> Space {
        let vector = |value: &dyn Fn(&Mode) -> f64| DVector::from_iterator(modes.len(), modes.iter().map(value));
        Space::with(
            &self.equivalent(),
            DMatrix::from_diagonal(&vector(&|mode| 1.0 / mode.omega_squared)),
            DMatrix::zeros(modes.len(), modes.len()),
            vector(&|mode| mode.participation / mode.omega_squared.sqrt()),
            Places {
                tip: vector(&|mode| mode.tip / mode.omega_squared.sqrt()),
                slope: vector(&|mode| mode.rotation / mode.omega_squared.sqrt()),
                pusher: vector(&|mode| mode.pusher / mode.omega_squared.sqrt()),
                parallel: vector(&|mode| mode.parallel / mode.omega_squared.sqrt()),
            },
        )
    }

    /// Frequencies (Hz) of the highest mode, and up to which a blow excites the spring, if that is above: where the contact
    /// is still stiffer than the spring.
    pub fn missed(&self, blow: &Blow) -> Option<(f64, f64)> {
        let stiffer = |s: f64| {
            let modes = self.modes.iter();
            let parts = modes.map(|mode| mode.contact.powi(2) / (s * s + mode.omega_squared()));
            let compliance: f64 = parts.sum();
            blow.contact_stiffness * (1.0 + blow.contact_damping * s) * compliance - 1.0
        };
        let highest = self.modes.last()?.omega_squared().sqrt();
        let reached = roots::bracketed(|logarithm| stiffer(logarithm.exp()), highest.ln(), 100.0)?;
        Some((highest, reached.exp())).map(|(a, b)| (a / std::f64::consts::TAU, b / std::f64::consts::TAU))
    }
}
