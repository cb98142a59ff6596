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
//! with `T_i'` the rotation of mode i at the contact ([`Mode::rotation`]). Under the contact force `F` (a power `p` of the
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

use crate::beam::mode::{MAX_MODES, Modal, Mode, ModeStates};
use crate::contact::power::Power;
use crate::error::SceneError;
use crate::math::prediction::Prediction;
use crate::scene::spring::Shape;
use crate::scene::{Contact, Scene, choices};
use crate::variables::{AxialForceKind, ContactLawKind, EnumerationParameter, FrictionKind};

/// Constants of friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Coefficient mu.
    pub coefficient: f64,
    /// Tangential stiffness over the stiffness along the normal, 1.
    pub ratio: f64,
    /// Height of the contact point h, m.
    pub height: f64,
    /// Friction force at the preload T_0, N.
    pub preload: f64,
    /// Displacement of the contact point along the spring per displacement of each mode, `h T_i'`, 1/sqrt(kg).
    pub levers: Modal,
    /// Stiffness of the spring against a displacement along it of the contact point, N/m; 0 at no height.
    pub(crate) stiffness: f64,
    /// Friction force that holds the contact point per base acceleration that varies slowly, kg.
    pub(crate) inertia: f64,
}

/// Whether the contact slips.
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

/// What changes of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tangential {
    /// Displacement v of the contact point along the spring since the preload, m.
    pub displacement: f64,
    /// Its velocity v', m/s.
    pub rate: f64,
    /// Slip s = v - z, m; z: deflection of the tangential spring.
    pub slip: f64,
    /// Friction force T, N.
    pub force: f64,
    /// Friction force over the last step, N.
    pub course: Prediction,
    /// Whether it slips.
    pub phase: Phase,
    /// Distance slipped so far, m.
    pub distance: f64,
    /// Energy dissipated by slip so far, J.
    pub dissipated: f64,
    /// Length of the first step after slip has begun, and after it has ended, s: as long as the last of them that was taken;
    /// 0: none was.
    pub first_steps: [f64; 2],
    /// Time of the last change between stick and slip, s; `None`: none.
    pub last_change: Option<f64>,
}

impl Tangential {
    /// Deflection z of the tangential spring, m.
    pub fn deflection(&self) -> f64 {
        self.displacement - self.slip
    }

    /// The length of the first step in this phase.
    pub(crate) fn first_step(&mut self) -> &mut f64 {
        let [of_slip, of_stick] = &mut self.first_steps;
        if self.phase == Phase::Stick { of_stick } else { of_slip }
    }

    /// Whether a simulation can reach these numbers.
    pub fn is_sound(&self) -> bool {
        let Self {
            displacement,
            rate,
            slip,
            force,
            course,
            phase: _,
            distance,
            dissipated,
            first_steps,
            last_change: _,
        } = self;
        [displacement, rate, slip, force, distance, dissipated]
            .into_iter()
            .chain(course)
            .all(|number| number.is_finite())
            && *distance >= 0.0
            && first_steps.iter().all(|step| (0.0..f64::INFINITY).contains(step))
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
    /// Of a scene, if it has friction, with the contact force at the preload (N).
    pub(crate) fn new(scene: &Scene, preload: f64) -> Option<Self> {
        let share = tangential_share(scene)?;
        Some(Self {
            coefficient: scene.friction.coefficient,
            ratio: stiffness_ratio(&scene.contact),
            height: scene.tip.contact_height,
            preload: share * preload,
            levers: [0.0; MAX_MODES],
            stiffness: 0.0,
            inertia: 0.0,
        })
    }

    /// With the levers of these modes.
    pub(crate) fn on(mut self, modes: &[Mode]) -> Self {
        self.levers = [0.0; MAX_MODES];
        for (lever, mode) in self.levers.iter_mut().zip(modes) {
            *lever = self.height * mode.rotation;
        }
        let sum = |load: &dyn Fn(&Mode, f64) -> f64| -> f64 {
            let pairs = modes.iter().zip(&self.levers);
            pairs
                .map(|(mode, lever)| lever * load(mode, *lever) / mode.omega_squared)
                .sum()
        };
        let stiffness = 1.0 / sum(&|_, lever| lever);
        let inertia = stiffness * sum(&|mode, _| mode.participation).abs();
        let held = stiffness.is_finite() && inertia.is_finite();
        (self.stiffness, self.inertia) = if held { (stiffness, inertia) } else { (0.0, 0.0) };
        self
    }

    /// Displacement (m) and velocity (m/s) of the contact point along the spring.
    #[inline(always)]
    pub(crate) fn motion(&self, modes: &ModeStates, count: usize) -> (f64, f64) {
        let pairs = self.levers.iter().zip(modes).take(count);
        pairs.fold((0.0, 0.0), |(v, rate), (lever, mode)| {
            (v + lever * mode.q, rate + lever * mode.v)
        })
    }

    /// Trial force of stick at the indentation `d` (m), where the tangential spring is deflected by `z` (m) and goes on at
    /// `rate` (m/s).
    #[inline(always)]
    pub(crate) fn trial(&self, law: &Power, d: f64, z: f64, rate: f64) -> Stick {
        let stiffness = self.ratio * law.tangent_stiffness(d);
        let force = -stiffness * (z + law.damping * rate);
        Stick {
            force,
            by_indentation: if d > 0.0 { (law.exponent - 1.0) * force / d } else { 0.0 },
            stiffness,
        }
    }

    /// Deflection to which the tangential spring of a slipping contact tends, m: -T / k_t.
    #[inline(always)]
    pub(crate) fn limit_deflection(&self, law: &Power, sign: f64, d: f64, rate: f64) -> f64 {
        -sign * self.coefficient / self.ratio * (1.0 / law.exponent * d + law.damping * rate)
    }

    /// Slip velocity times the damping time of the contact, m, positive against the slip under a friction force of this sign:
    /// as the tangential spring, deflected by `z` (m), tends to its limit, the contact point moving at `along` (m/s), at the
    /// indentation `d` (m) that grows at `rate` (m/s).
    pub(crate) fn turned(&self, law: &Power, sign: f64, (d, rate): (f64, f64), (z, along): (f64, f64)) -> f64 {
        sign * (z + law.damping * along - self.limit_deflection(law, sign, d, rate))
    }
}

/// Whether a scene has friction.
pub(crate) fn rubs(scene: &Scene) -> bool {
    scene.effects.friction != FrictionKind::None
}

/// Friction force at the preload per contact force, if the scene has friction.
pub(crate) fn tangential_share(scene: &Scene) -> Option<f64> {
    rubs(scene).then_some(scene.friction.initial * scene.friction.coefficient)
}

/// `k_t / k = 4 G* / E*`.
fn stiffness_ratio(contact: &Contact) -> f64 {
    let materials = [contact.moving, contact.fixed];
    let normal: f64 = materials
        .iter()
        .map(|material| (1.0 - material.poisson_ratio.powi(2)) / material.youngs_modulus)
        .sum();
    let tangential: f64 = materials
        .iter()
        .map(|material| (2.0 - material.poisson_ratio) * 2.0 * (1.0 + material.poisson_ratio) / material.youngs_modulus)
        .sum();
    4.0 * normal / tangential
}

/// Refuses what friction cannot be combined with.
///
/// # Errors
/// [`SceneError::NoFriction`] or [`SceneError::NoRotation`].
pub(crate) fn check(scene: &Scene) -> Result<(), SceneError> {
    if !rubs(scene) {
        return Ok(());
    }
    let named = |parameter: EnumerationParameter| {
        let chosen = scene.enumeration(parameter);
        let choice = choices(parameter).iter().find(|(_, number)| *number == chosen);
        choice.map_or("", |(label, _)| *label)
    };
    if !matches!(scene.effects.contact_law, ContactLawKind::Hertz | ContactLawKind::Rough) {
        return Err(SceneError::NoFriction {
            name: "effects.contactLaw",
            choice: named(EnumerationParameter::EffectsContactLaw),
            allowed: "Hertz and Rough, whose tangential stiffness follows that along the normal",
        });
    }
    if scene.effects.second_contact {
        return Err(SceneError::NoFriction {
            name: "effects.secondContact",
            choice: "true",
            allowed: "false",
        });
    }
    if scene.effects.axial_force == AxialForceKind::FromDeflection {
        return Err(SceneError::NoFriction {
            name: "effects.axialForce",
            choice: named(EnumerationParameter::EffectsAxialForce),
            allowed: "None, FromPreload and Prescribed, which are constant",
        });
    }
    match &scene.spring {
        Some(file) => match &file.shape {
            Shape::Modes(modes) if modes.modes.iter().any(|mode| mode.rotation.is_none()) => {
                Err(SceneError::NoRotation {
                    file: file.name.clone(),
                })
            }
            _ => Ok(()),
        },
        None => Ok(()),
    }
}
