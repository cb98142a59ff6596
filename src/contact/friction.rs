//! Friction between the contacts (`effects.friction`): the law, and what it keeps.
//!
//! The contact point lies `h` (`tip.contactHeight`) from the neutral axis of the spring. As the spring turns there by `phi`,
//! it moves along the spring by `v = h (phi - phi_0)`, counted from the preload; the foreshortening of the bent spring, of
//! second order, is left out. A force `T` on the moving contact along the spring is a moment `h T` on it, a second load on
//! the modes; what it does along the spring, as an axial force of millinewtons, is left out:
//!
//! ```text
//! v = h sum T_i' q_i
//! q_i'' + c_i q_i' + omega_i^2 q_i = T_i (F - F_0) - g_i a + h T_i' (T - T_0)
//! ```
//!
//! with `T_i'` the rotation of mode i at the contact ([`Mode::rotation`]): a link ([`crate::link`]) at the port `v`, with the
//! approach `-v`. Under the contact force `F` (a power `p` of the
//! indentation, damped) the contact sticks on the tangential stiffness of R. D. Mindlin (J. Appl. Mech. 16 (1949) 259) with the damping
//! time of the contact, up to Coulomb's limit:
//!
//! ```text
//! k_t = (4 G*/E*) k,  1/G* = (2 - nu_1)/G_1 + (2 - nu_2)/G_2,  G = E / (2 (1 + nu))
//! stick:  T = -k_t(d) (z + beta_c z'),  z' = v'       while |T| < mu F
//! slip:   |T| = mu F against the slip velocity v' - z',  z' from T = -k_t(d) (z + beta_c z')
//! open:   T = 0, z = 0
//! ```
//!
//! `k_t` is a fixed multiple of the tangent stiffness `k` of the contact, for spheres `8 G* sqrt(R d)`, so while it slips
//! `beta_c z' + z = -+ (mu k / k_t) (d / p + beta_c d')`, in which nothing is singular as it opens. With damping `T` is the trial force of stick, cut at the
//! limit: it is continuous, and stick and slip change where the trial force passes the limit.
//!
//! The closing that led to the preload has slid: `T_0 = -mu F_0` (`friction.initial` = -1), which is part of its
//! equilibrium; it does not exist where `mu h` reaches the deflection per force over that per moment, two thirds of the length
//! of a uniform spring: the contact jams. Slip is `v - z`; its distance counts to and fro, and the work of the friction force
//! on it is dissipated.
//!
//! The energy of the tangential spring is `k_t z^2 / 2`. Where `k_t` changes with the indentation while the spring is
//! deflected, that part of it has no counterpart in the force along the normal (as in Mindlin's own law without history): it
//! is at most `(mu F)^2 / (2 k_t)` at a time. `energy.balance` compares with the law as it stands.

use serde::{Deserialize, Serialize};

use crate::beam::mode::Mode;
use crate::contact::law::{Law, compliance};
use crate::scene::{Contact, Material, Scene};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Coefficient mu.
    pub coefficient: f64,
    /// Tangential stiffness over the stiffness along the normal, 1.
    pub ratio: f64,
    /// Height of the contact point h, m.
    pub height: f64,
    /// Stiffness of the spring against a displacement along it of the contact point, N/m; 0 at no height.
    pub(crate) stiffness: f64,
    /// Friction force that holds the contact point per base acceleration that varies slowly, kg.
    pub(crate) inertia: f64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// It sticks, or is open.
    #[default]
    Stick,
    /// It slips towards the clamp: the friction force is positive.
    SlipBack,
    /// It slips away from the clamp: the friction force is negative.
    SlipForth,
}

impl Phase {
    /// Sign of the friction force; `None` without slip.
    #[inline(always)]
    pub fn sign(self) -> Option<f64> {
        match self {
            Self::Stick => None,
            Self::SlipBack => Some(1.0),
            Self::SlipForth => Some(-1.0),
        }
    }

    /// Slip under a friction force of this sign.
    pub fn slip(sign: f64) -> Self {
        if sign < 0.0 { Self::SlipForth } else { Self::SlipBack }
    }
}

/// Slip of a contact: what changes of it beside the friction force and the displacement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Slip {
    /// Slip s = v - z since the preload, m; z: deflection of the tangential spring.
    pub way: f64,
    pub phase: Phase,
    /// Distance slipped so far, m.
    pub distance: f64,
    /// Energy dissipated by slip so far, J.
    pub dissipated: f64,
    /// Time of the last change between stick and slip, s; `None`: none.
    pub last_change: Option<f64>,
}

impl Slip {
    /// Whether a simulation can reach these numbers by a time (s).
    pub fn is_sound(&self, time: f64) -> bool {
        let Self { way, phase: _, distance, dissipated, last_change } = self;
        let finite = [way, distance, dissipated].into_iter().all(|number| number.is_finite());
        finite && *distance >= 0.0 && last_change.is_none_or(|change| change.is_finite() && change <= time)
    }
}

/// Trial force of stick, and its derivatives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stick {
    /// -k_t (z + beta_c v'), N.
    pub(crate) force: f64,
    /// Its derivative by the indentation, N/m.
    pub(crate) by_indentation: f64,
    /// Tangential stiffness k_t, N/m.
    pub(crate) stiffness: f64,
}

impl Friction {
    /// Of a scene, if it has friction, on these modes.
    pub(crate) fn new(scene: &Scene, modes: &[Mode]) -> Option<Self> {
        let height = scene.tip.contact_height;
        let sum = |load: &dyn Fn(&Mode) -> f64| -> f64 {
            let parts = modes.iter().map(|mode| mode.rotation * load(mode) / mode.omega_squared);
            height * parts.sum::<f64>()
        };
        let stiffness = 1.0 / sum(&|mode| height * mode.rotation);
        let inertia = stiffness * sum(&|mode| mode.participation).abs();
        let held = stiffness.is_finite() && inertia.is_finite();
        let (stiffness, inertia) = if held { (stiffness, inertia) } else { (0.0, 0.0) };
        scene.rubs().then(|| Self {
            coefficient: scene.friction.coefficient,
            ratio: stiffness_ratio(&scene.contact),
            height,
            stiffness,
            inertia,
        })
    }

    /// Trial force of stick at the indentation `d` (m), where the tangential spring is deflected by `z` (m) and goes on at
    /// `rate` (m/s).
    #[inline(always)]
    pub(crate) fn trial(&self, law: &Law, d: f64, z: f64, rate: f64) -> Stick {
        let stiffness = self.ratio * law.stiffness(d);
        let force = -stiffness * (z + law.damping * rate);
        Stick { force, by_indentation: if d > 0.0 { (law.exponent - 1.0) * force / d } else { 0.0 }, stiffness }
    }

    /// Deflection to which the tangential spring of a slipping contact tends, m: -T / k_t.
    #[inline(always)]
    pub(crate) fn limit_deflection(&self, law: &Law, sign: f64, d: f64, rate: f64) -> f64 {
        -sign * self.coefficient / self.ratio * (1.0 / law.exponent * d + law.damping * rate)
    }

    /// Slip velocity times the damping time of the contact, m, positive against the slip under a friction force of this sign:
    /// as the tangential spring, deflected by `z` (m), tends to its limit, the contact point moving at `along` (m/s), at the
    /// indentation `d` (m) that grows at `rate` (m/s).
    pub(crate) fn turned(&self, law: &Law, sign: f64, (d, rate): (f64, f64), (z, along): (f64, f64)) -> f64 {
        sign * (z + law.damping * along - self.limit_deflection(law, sign, d, rate))
    }
}

/// Friction force at the preload per contact force, if the scene has friction.
pub(crate) fn tangential_share(scene: &Scene) -> Option<f64> {
    scene.rubs().then_some(scene.friction.initial * scene.friction.coefficient)
}

/// `k_t / k = 4 G* / E*`.
fn stiffness_ratio(contact: &Contact) -> f64 {
    let of = |material: Material| {
        (2.0 - material.poisson_ratio) * 2.0 * (1.0 + material.poisson_ratio) / material.youngs_modulus
    };
    let tangential = of(contact.moving) + of(contact.fixed);
    4.0 * compliance(contact) / tangential
}
