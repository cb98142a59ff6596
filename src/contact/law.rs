//! The contact law: a force that is a power of the indentation, with viscoelastic dissipation. Smooth spheres, rough surfaces, and
//! the law linearised about the preload.
//!
//! `F = max(0, c d^p + beta_c k(d) d')`, `k = p c d^(p-1)`, for `d > 0`, else 0. With `g = d + p beta_c d'` this is
//! `F = c d^(p-1) g`: the contact is closed while both `d` and `g` are positive.
//!
//! Hertz: `p = 3/2`, `c = (4/3) E* sqrt(R)`. Machines 2025, 13(1), 52, eqs. (7), (8), and (14) with the stiffness updated at
//! every instant, which is the law of Kuwabara and Kono (Jpn. J. Appl. Phys. 26 (1987) 1230).
//!
//! Rough: the stiffness grows with a power `n` of the elastic force, `dF/dd = k_r (F / F_r)^n`, as it does between rough
//! surfaces. Integrated, `F = ((1 - n) k_r d / F_r^n)^(1/(1-n))`, so that `p = 1 / (1 - n)`: `n = 0` is a linear spring that can
//! open, `n = 1/3` Hertz, `n` towards 1 the exponential law of J. A. Greenwood and J. B. P. Williamson (Proc. R. Soc. A 295
//! (1966) 300).
//!
//! Linearised: `F = max(0, F_0 + k_j0 (d - d_0) + beta_c k_j0 d')`, which the modal and frequency-domain analyses of Machines 2025,
//! 13(1), 52 use; bonded: the same without `max`. It is the power 1 of `d - d_0 + F_0 / k_j0`, and closed while `g` is positive.

use crate::math::nodal::Nodal;
use crate::scene::{Contact, Material, Parallel, Scene, Second};
use crate::variables::ContactLawKind;

/// Exponent of the indentation in the law of Hertz, 1. Powers of it are square roots.
pub(crate) const HERTZ: f64 = 1.5;

/// Force that counts as none at a contact softer than that of Hertz, in tolerances, 1: far below the errors allowed, far above
/// what the iteration for the forces leaves.
const TRACES: f64 = 1e-3;

/// The same that is mere rounding, in the force scale, 1.
const ROUNDING: f64 = f64::EPSILON;

/// Indentation below which bodies do not touch, m: far below all that differs from none, and large enough that a length over it is finite.
const TOUCH: f64 = 1e-200;

/// Force on the closed branch of the law, with its partial derivatives: of a motion, or of several by arrays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Branch<T = f64> {
    /// Force, N.
    pub force: T,
    /// dF/dd, N/m.
    pub stiffness: T,
    /// dF/dd', N s/m.
    pub damping: T,
}

/// What opens a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Opening {
    /// Bodies that part, or that their damper holds back.
    Parting,
    /// Tension alone, wherever the bodies are: the linearised law.
    Tension,
    /// Nothing: the bonded one.
    Never,
}

/// Constants of the contact law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    /// Force at an indentation of 1 m, `c`, N/m^p. Hertz: k_H = (4/3) E* sqrt(R).
    pub coefficient: f64,
    /// Exponent of the indentation p, 1 or more; 1 where tension opens it, or nothing.
    pub exponent: f64,
    /// Damping time beta_c, s.
    pub damping: f64,
    /// Indentation at which the force of a contact at rest is zero, m; 0 but for the linearised law: d_0 - F_0 / k_j0.
    pub offset: f64,
    /// What opens the contact.
    pub opening: Opening,
    /// Force that counts as none where the contact opens, N. It and the next two are set by `judged`.
    pub traces: f64,
    /// Indentation up to which the contact counts as open, m.
    pub least: f64,
    /// Tangent stiffness at the force scale, N/m: by it errors of a contact are judged that is open or hardly touches.
    pub firm: f64,
}

/// Reduced modulus E* of the two materials, Pa.
pub fn reduced_modulus(contact: &Contact) -> f64 {
    1.0 / compliance(contact)
}

/// Its reciprocal, 1/Pa: `1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2`.
pub(crate) fn compliance(contact: &Contact) -> f64 {
    let of = |material: Material| (1.0 - material.poisson_ratio.powi(2)) / material.youngs_modulus;
    of(contact.moving) + of(contact.fixed)
}

impl Law {
    /// A power of the indentation.
    pub fn power(coefficient: f64, exponent: f64, damping: f64) -> Self {
        Self {
            coefficient,
            exponent,
            damping,
            offset: 0.0,
            opening: Opening::Parting,
            traces: 0.0,
            least: 0.0,
            firm: 0.0,
        }
    }

    /// Smooth spheres: Hertz, from the two materials and the radius of curvature.
    pub fn hertz(contact: &Contact) -> Self {
        let coefficient = 4.0 / 3.0 * reduced_modulus(contact) * contact.curvature_radius.sqrt();
        Self::power(coefficient, HERTZ, contact.damping)
    }

    /// A linear spring (N/m) with a damper (N s/m) that acts while it is compressed.
    pub fn linear(stiffness: f64, damping: f64) -> Self {
        Self::power(stiffness, 1.0, damping / stiffness)
    }

    /// Rough surfaces, from the tangent stiffness at a force, and how it grows with the force.
    pub fn rough(contact: &Contact) -> Self {
        let n = contact.stiffness_exponent;
        let exponent = 1.0 / (1.0 - n);
        // A third, as near as a number comes to it, is Hertz: square roots are cheaper than powers.
        let is_hertz = (exponent - HERTZ).abs() < 2.0 * f64::EPSILON;
        let exponent = if is_hertz { HERTZ } else { exponent };
        let base = (1.0 - n) * contact.stiffness * contact.stiffness_force.powf(-n);
        Self::power(base.powf(exponent), exponent, contact.damping)
    }

    /// The contact of a scene before it is linearised.
    pub(crate) fn of(scene: &Scene) -> Self {
        Self::of_contact(scene, scene.contact)
    }

    /// The second contact of a scene, if it has one.
    pub(crate) fn of_second(scene: &Scene) -> Option<Self> {
        let Second { curvature_radius, damping, stiffness, .. } = scene.second;
        let own = Contact { curvature_radius, damping, stiffness, ..scene.contact };
        scene.effects.second_contact.then(|| Self::of_contact(scene, own))
    }

    /// The parallel contact of a scene, if it has one.
    pub(crate) fn of_parallel(scene: &Scene) -> Option<Self> {
        let Parallel { curvature_radius, damping, stiffness, .. } = scene.parallel;
        let own = Contact { curvature_radius, damping, stiffness, ..scene.contact };
        scene.effects.parallel_contact.then(|| Self::of_contact(scene, own))
    }

    /// A contact in the place of that of the scene, without damping if that is switched off.
    fn of_contact(scene: &Scene, mut contact: Contact) -> Self {
        if !scene.effects.contact_damping {
            contact.damping = 0.0;
        }
        match scene.effects.contact_law {
            ContactLawKind::Rough => Self::rough(&contact),
            ContactLawKind::Hertz | ContactLawKind::Linearised | ContactLawKind::Bonded => Self::hertz(&contact),
        }
    }

    /// With its stiffness at a force scale (N), and what counts as none of a force computed to a relative tolerance of that. A contact
    /// softer than that of Hertz parts so gradually that its force stays below the error allowed for long, where a computed
    /// force changes its sign at random, and then below rounding, where nothing tells closed from open.
    #[must_use]
    pub(crate) fn judged(self, tolerance: f64, scale: f64) -> Self {
        let firm = self.tangent_stiffness(scale);
        if self.exponent <= HERTZ {
            return Self { firm, ..self };
        }
        Self { traces: TRACES * tolerance * scale, least: self.indentation(ROUNDING * scale), firm, ..self }
    }

    /// `d^(p-1)`, m^(p-1), of a positive indentation (m).
    #[inline(always)]
    fn slope(&self, d: f64) -> f64 {
        if self.exponent == HERTZ { d.sqrt() } else { d.powf(self.exponent - 1.0) }
    }

    /// Elastic force of a power of the indentation (m), N.
    pub fn elastic_force(&self, indentation: f64) -> f64 {
        let d = indentation.max(0.0);
        self.coefficient * d * self.slope(d)
    }

    /// Tangent stiffness at the indentation (m), N/m; 0 where bodies that part have none.
    #[inline(always)]
    pub fn stiffness(&self, d: f64) -> f64 {
        let touches = d > 0.0 || self.opening != Opening::Parting;
        if touches { self.exponent * self.coefficient * self.slope(d) } else { 0.0 }
    }

    /// Tangent stiffness under `force` (N), N/m.
    pub fn tangent_stiffness(&self, force: f64) -> f64 {
        self.stiffness(self.indentation(force))
    }

    /// Force (N) as the bodies touch at a velocity (m/s): a jump where the stiffness does not vanish at first touch.
    pub fn force_at_touch(&self, rate: f64) -> f64 {
        let jumps = self.exponent == 1.0 && self.opening == Opening::Parting;
        if jumps { self.coefficient * self.damping * rate.max(0.0) } else { 0.0 }
    }

    /// Static indentation beyond first touch under `force` (N), m.
    pub fn indentation(&self, force: f64) -> f64 {
        (force / self.coefficient).powf(1.0 / self.exponent)
    }

    /// Whether the force of its damper grows more steeply at first touch than a root of time, `d^(p-1)` with `1 < p < 3/2`: nearly
    /// a jump, which no polynomial follows.
    pub(crate) fn is_steep_at_touch(&self) -> bool {
        self.damping > 0.0 && self.exponent > 1.0 && self.exponent < HERTZ
    }

    /// Whether the contact can bear tension.
    pub fn never_opens(&self) -> bool {
        self.opening == Opening::Never
    }

    /// The force (N), or zero if tensile in a contact that cannot bear tension.
    pub fn without_pull(&self, force: f64) -> f64 {
        // Not `max`, which would make zero of NaN: an opening that never was.
        if force < 0.0 && !self.never_opens() { 0.0 } else { force }
    }

    /// Constant force over a step from one indentation to another (m) that does the work of the elastic force and
    /// dissipates, N: the discrete gradient of the elastic energy, plus damping time times mean stiffness times `speed`
    /// (m/s), the mean velocity. It increases with the second indentation, and is never tensile unless bonded.
    pub fn mean_force(&self, from: f64, to: f64, speed: f64) -> f64 {
        self.without_pull(self.mean_elastic_force(from, to) + self.damping * self.mean_stiffness(from, to) * speed)
    }

    /// Tangent stiffness as a power of the elastic force: factor (at 1 N, N/m) and exponent (1).
    pub fn stiffness_by_force(&self) -> (f64, f64) {
        let inverse = 1.0 / self.exponent;
        (self.exponent * self.coefficient.powf(inverse), 1.0 - inverse)
    }

    /// Mean elastic force between two indentations (m), N: divided difference of the elastic energy
    /// `c d^(p+1) / (p+1)`, free of cancellation if they are close.
    pub fn mean_elastic_force(&self, a: f64, b: f64) -> f64 {
        let (low, high) = (a.min(b) - self.offset, a.max(b) - self.offset);
        if self.never_opens() {
            return self.coefficient * f64::midpoint(low, high);
        }
        if self.exponent != HERTZ {
            let power = self.exponent + 1.0;
            return self.coefficient / power * divided_power(power, low, high);
        }
        if high <= 0.0 {
            return 0.0;
        }
        // In the square roots of the indentations it is a polynomial over a sum.
        let y = high.sqrt();
        if low <= 0.0 {
            return 0.4 * self.coefficient * high * y * (high / (high - low));
        }
        let x = low.sqrt();
        let sum = (high * high + low * low) + (high + low) * (x * y) + high * low;
        0.4 * self.coefficient * (sum / (x + y))
    }

    /// Elastic energy at `d0 + deviation` above its tangent at `d0` (m), J; never negative, and free of cancellation for
    /// small deviations.
    pub fn energy_above_tangent(&self, d0: f64, deviation: f64) -> f64 {
        if self.never_opens() {
            return 0.5 * self.coefficient * deviation * deviation;
        }
        let d0 = d0 - self.offset;
        let d = d0 + deviation;
        if self.exponent != HERTZ {
            return self.energy_of_power(d0, deviation);
        }
        // In the square roots of the indentations it is a sum of positive terms.
        let (x, y) = (d0.max(0.0).sqrt(), d.max(0.0).sqrt());
        self.coefficient
            * if d0 <= 0.0 {
                0.4 * y.powi(5)
            } else if d <= 0.0 {
                x.powi(3) * (0.6 * d0 - d)
            } else {
                let difference = deviation / (x + y);
                difference * difference * (0.4 * y.powi(3) + 0.8 * y * y * x + 1.2 * y * x * x + 0.6 * x.powi(3))
            }
    }

    /// [`Law::energy_above_tangent`] for any exponent: `c d_0^(p+1) ((1 + r)^(p+1) - 1 - (p+1) r) / (p+1)` with the relative
    /// deviation `r`, by the binomial series where the difference would cancel.
    fn energy_of_power(&self, d0: f64, deviation: f64) -> f64 {
        let d = d0 + deviation;
        let power = self.exponent + 1.0;
        let energy = |d: f64| self.elastic_force(d) * d.max(0.0) / power;
        if d0 <= 0.0 {
            return energy(d);
        }
        let r = deviation / d0;
        if r.abs() > 0.1 {
            return (energy(d) - energy(d0) - self.elastic_force(d0) * deviation).max(0.0);
        }
        let (mut term, mut sum) = (power * r, 0.0);
        for k in 2..40 {
            let k = f64::from(k);
            term *= r * (power + 1.0 - k) / k;
            sum += term;
            if term.abs() <= f64::EPSILON * sum.abs() {
                break;
            }
        }
        (energy(d0) * sum).max(0.0)
    }

    /// Mean tangent stiffness between two indentations (m), N/m: divided difference of the elastic force.
    pub fn mean_stiffness(&self, a: f64, b: f64) -> f64 {
        let (low, high) = (a.min(b) - self.offset, a.max(b) - self.offset);
        if self.never_opens() {
            return self.coefficient;
        }
        if self.exponent != HERTZ {
            return self.coefficient * divided_power(self.exponent, low, high);
        }
        if high <= 0.0 {
            return 0.0;
        }
        let y = high.sqrt();
        if low <= 0.0 {
            return self.coefficient * y * (high / (high - low));
        }
        let x = low.sqrt();
        self.coefficient * ((high + low + x * y) / (x + y))
    }

    /// Time (s) by which the velocity counts in `g`.
    #[inline(always)]
    pub(crate) fn by_rate(&self) -> f64 {
        self.exponent * self.damping
    }

    /// `g`, the part of the engagement that the damper resists, m; the engagement of a contact that can open is no more than that.
    #[inline(always)]
    pub(crate) fn resisted(&self, d: f64, rate: f64) -> f64 {
        d - self.offset + self.by_rate() * rate
    }

    /// A length with the sign of the contact force, m: positive while the contact is closed. Of bodies that part the lesser of `d`,
    /// above the least, and `g`.
    pub fn engagement(&self, d: f64, rate: f64) -> f64 {
        match self.opening {
            Opening::Parting => {
                let (by_way, by_rate) = (d - self.least, d + self.by_rate() * rate);
                // One instruction, where `f64::min` looks whether both are numbers.
                if by_rate < by_way { by_rate } else { by_way }
            }
            Opening::Tension => self.resisted(d, rate),
            Opening::Never => f64::INFINITY,
        }
    }

    /// Whether the engagement of bodies that approach this fast (m/s), or faster, is their way alone.
    pub(crate) fn engages_by_way(&self, slowest: f64) -> bool {
        match self.opening {
            Opening::Parting => self.by_rate() * slowest >= -self.least,
            Opening::Tension | Opening::Never => self.damping == 0.0,
        }
    }

    /// Whether [`Law::resisted`] is all of the engagement at this indentation (m): bodies without a force that are still indented, as
    /// their damper holds what they would push.
    pub(crate) fn is_indented(&self, d: f64) -> bool {
        d > self.least || self.opening != Opening::Parting
    }

    /// Contact force at the indentation `d` (m) growing at `rate` (m/s), N.
    pub fn force(&self, d: f64, rate: f64) -> f64 {
        if self.engagement(d, rate) > 0.0 { self.closed_branch(d, rate).force } else { 0.0 }
    }

    /// The closed branch, continued smoothly beyond opening (the force may be negative), for steps in which the contact
    /// opens.
    #[inline(always)]
    pub fn closed_branch(&self, d: f64, rate: f64) -> Branch {
        let Branch { force: [force], stiffness: [stiffness], damping: [damping] } = self.closed_branches(&[d], &[rate]);
        Branch { force, stiffness, damping }
    }

    /// The same at several indentations (m) and velocities (m/s), which the processor computes in parallel.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "arrays of fixed size")]
    pub(crate) fn closed_branches<const S: usize>(&self, d: &Nodal<S>, rate: &Nodal<S>) -> Branch<Nodal<S>> {
        if self.opening != Opening::Parting {
            return self.linear_branches(d, rate);
        }
        // Chosen rather than branched to, and anything where it is open; NaN is not.
        let held = d.map(|d| if d < TOUCH { 1.0 } else { d });
        let slopes = if self.exponent == HERTZ { held.map(f64::sqrt) } else { powers(&held, self.exponent - 1.0) };
        let (coefficient, exponent, by_rate) = (self.coefficient, self.exponent, self.by_rate());
        let [mut force, mut stiffness, mut damping] = [[0.0; S]; 3];
        for k in 0..S {
            let slope = coefficient * slopes[k];
            let slope = if d[k] < TOUCH { 0.0 } else { slope };
            let g = d[k] + by_rate * rate[k];
            force[k] = slope * g;
            stiffness[k] = slope * (1.0 + (exponent - 1.0) * g / held[k]);
            damping[k] = by_rate * slope;
        }
        Branch { force, stiffness, damping }
    }

    /// The same of the linearised law.
    #[inline(always)]
    fn linear_branches<const S: usize>(&self, d: &Nodal<S>, rate: &Nodal<S>) -> Branch<Nodal<S>> {
        let mut force = *d;
        for (force, rate) in force.iter_mut().zip(rate) {
            *force = self.coefficient * self.resisted(*force, *rate);
        }
        Branch { force, stiffness: [self.coefficient; S], damping: [self.damping * self.coefficient; S] }
    }
}

/// Powers of several numbers, out of the way of the law of Hertz.
#[inline(never)]
fn powers<const S: usize>(values: &Nodal<S>, exponent: f64) -> Nodal<S> {
    values.map(|value| value.powf(exponent))
}

/// `(b^power - a^power) / (b - a)` of two lengths (m) in ascending order, of which negative ones count as powers of zero.
fn divided_power(power: f64, a: f64, b: f64) -> f64 {
    if b <= 0.0 {
        return 0.0;
    }
    // With s = (b - a) / b: b^(power-1) (1 - (1-s)^power) / s, which tends to power as s vanishes.
    let s = (b - a.max(0.0)) / b;
    let ratio = if s > 0.0 { -(power * (-s).ln_1p()).exp_m1() / s } else { power };
    let inside = if a < 0.0 { b / (b - a) } else { 1.0 };
    b.powf(power - 1.0) * ratio * inside
}
