//! Static equilibrium of spring and contact before any vibration.
//!
//! The tip deflection `y = w(L)` obeys `y = c(N) F_e(d) + c_g(N) g0` with `d = s + u - y`; `c` and `c_g` are the
//! compliances of the cantilever under the axial force `N`, which may depend on `y`. The unknown is the indentation
//! `d`, as `s - y` would lose four digits by cancellation.
//!
//! A spring of the fixed contact adds its deflection under gravity to `s` and gives way by its compliance per contact force.
//!
//! A pusher at the place `p` towards the contact presses with `P = k_p (p + w(x_p))`, where positive, and `w(x_p)` follows from
//! contact force, gravity, and `P` itself.
//!
//! With friction `T_0 = tau F_0` at the height `h` of the contact point, its moment adds `c_m(N) h tau` to `c(N)`, `c_m` the
//! deflection per moment.

use serde::{Deserialize, Serialize};

use crate::armature::AtRest;
use crate::beam::springs::{FixedSpring, Springs};
use crate::beam::statics::Statics;
use crate::contact::friction::tangential_share;
use crate::contact::power::Power;
use crate::error::SceneError;
use crate::link::{INPUTS, Ways};
use crate::math::roots;
use crate::scene::Scene;
use crate::variables::{AxialForceKind, RealOutput, RealParameter};

/// The equilibrium.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Preload {
    /// Contact force F_0, N; 0 if the contact is open.
    pub force: f64,
    /// Indentation d_0, m; negative: a gap.
    pub indentation: f64,
    /// Tangent stiffness k_j0, N/m.
    pub contact_stiffness: f64,
    /// Deflection of the tip, m.
    pub deflection: f64,
    /// Deflection of the fixed contact's spring, m; positive closes.
    pub fixed_deflection: f64,
    /// Axial force, compression positive, N.
    pub axial_force: f64,
    /// Force of the pusher, N; 0 without one.
    pub pusher_force: f64,
    /// Overlap of pusher and spring, m; negative: a gap.
    pub pusher_overlap: f64,
    /// The armature.
    pub armature: AtRest,
}

/// What belongs to the preload of the inputs at the start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Initial {
    /// Displacements of the bodies that inputs move, m; that of the second contact is not among them.
    pub displacements: Ways,
    /// Current of the coil, relative.
    pub coil: f64,
}

impl Initial {
    /// Whether all of it is finite.
    pub fn is_finite(&self) -> bool {
        self.coil.is_finite() && self.displacements.iter().all(|way| way.is_finite())
    }
}

impl Default for Initial {
    fn default() -> Self {
        Self {
            displacements: [0.0; INPUTS],
            coil: 1.0,
        }
    }
}

/// A pusher at rest against the spring.
#[derive(Clone, Copy, Debug)]
struct Pusher {
    /// Where it would touch the unloaded spring, towards the contact, m.
    place: f64,
    /// Of the touch, N/m.
    stiffness: f64,
    /// Share of friction in its turning the spring: tangential force times height per contact force, m.
    lever: f64,
    gravity: f64,
}

impl Pusher {
    fn of(scene: &Scene, displacement: f64) -> Option<Self> {
        scene.pushed_at().map(|_| Self {
            place: displacement,
            stiffness: scene.pusher.stiffness,
            lever: tangential_share(scene).map_or(0.0, |share| share * scene.tip.contact_height),
            gravity: scene.environment.gravity,
        })
    }

    /// Force of a pusher (N), and its overlap with the spring (m), under a contact force and an axial force (N).
    fn press(&self, statics: &Statics, force: f64, axial_force: f64) -> (f64, f64) {
        let by = statics.at_pusher(axial_force);
        // Of the spring without the pusher, which is where it pushes.
        let spring = (by.across + self.lever * by.turning) * force + by.sag * self.gravity;
        let alone = self.place + spring;
        if alone <= 0.0 {
            return (0.0, alone);
        }
        let force = alone / (1.0 / self.stiffness + by.own);
        (force, force / self.stiffness)
    }
}

impl Preload {
    /// Equilibrium of the scene with these inputs.
    ///
    /// # Errors
    /// [`SceneError::Buckled`] where the axial force reaches the buckling load of the cantilever.
    pub fn new(scene: &Scene, springs: &Springs, law: &Power, initial: &Initial) -> Result<Self, SceneError> {
        let Some(armature) = &springs.armature else {
            return Self::pushed(scene, springs, law, initial.displacements);
        };
        let at = |place: f64| {
            let [support, ..] = initial.displacements;
            Self::pushed(scene, springs, law, [support, 0.0, place])
        };
        let force = |place: f64| at(place).map_or(f64::NAN, |preload| preload.pusher_force);
        let armature = armature.at_rest(initial.coil, force);
        Ok(Self {
            armature,
            ..at(armature.place)?
        })
    }

    /// Equilibrium with the inputs that move bodies displaced so far (m).
    ///
    /// # Errors
    /// [`SceneError::Buckled`] where the axial force reaches the buckling load of the cantilever.
    fn pushed(scene: &Scene, springs: &Springs, law: &Power, [support, _, pushed]: Ways) -> Result<Self, SceneError> {
        let (spring, fixed) = (&springs.moving, springs.fixed.as_ref());
        let statics = &spring.statics;
        let total_overtravel = scene.contact.overtravel + support;
        let gravity = scene.environment.gravity;
        let axial = |y: f64| spring.axial_force(scene, y);
        let limit = spring.buckling_load;
        let check = |axial_force: f64| {
            if axial_force < limit {
                return Ok(());
            }
            let name = match scene.effects.axial_force {
                AxialForceKind::Prescribed => RealParameter::BeamAxialForce.variable().name,
                _ => RealOutput::PreloadAxialForce.variable().name,
            };
            Err(SceneError::Buckled {
                name,
                value: axial_force,
                limit,
            })
        };

        let share = tangential_share(scene);
        let compliance = |n: f64| {
            let by_force = statics.tip_compliance(n);
            share.map_or(by_force, |share| {
                by_force + share * scene.tip.contact_height * statics.moment_compliance(n)
            })
        };

        // The fixed contact's spring: its deflection alone, and what the contact force bends it back.
        let fixed_alone = fixed.map_or(0.0, FixedSpring::free_deflection);
        let give = fixed.map_or(0.0, FixedSpring::compliance);
        let total_overtravel = total_overtravel + fixed_alone;

        let pusher = Pusher::of(scene, pushed);
        let press = |force: f64, n: f64| pusher.map_or((0.0, 0.0), |pusher| pusher.press(statics, force, n));
        // What gravity and pusher do to the tip under a contact force and an axial force (N).
        let loaded = |force: f64, n: f64| {
            let by_gravity = statics.gravity_compliance(n) * gravity;
            pusher.map_or(by_gravity, |pusher| {
                by_gravity - statics.at_pusher(n).across * pusher.press(statics, force, n).0
            })
        };
        let alone = free_deflection(|n| loaded(0.0, n), &axial);
        if total_overtravel <= alone {
            let axial_force = axial(alone);
            check(axial_force)?;
            return Ok(Self {
                force: 0.0,
                indentation: total_overtravel - alone,
                contact_stiffness: 0.0,
                deflection: alone,
                fixed_deflection: fixed_alone,
                axial_force,
                pusher_force: press(0.0, axial_force).0,
                pusher_overlap: press(0.0, axial_force).1,
                armature: AtRest::default(),
            });
        }
        let n = axial(total_overtravel);
        if share.is_some() && compliance(n).min(compliance(n) + give) <= 0.0 {
            return Err(SceneError::Jams {
                coefficient: scene.friction.coefficient,
                height: scene.tip.contact_height,
                limit: statics.tip_compliance(n) / statics.moment_compliance(n) / scene.friction.initial.abs(),
                initial: scene.friction.initial,
            });
        }
        // Whatever the force, it does not draw the spring beyond where it is alone.
        let deflection = |d: f64| (total_overtravel - d - give * law.elastic_force(d)).max(alone);
        let residual = |d: f64| {
            let (y, n) = (deflection(d), axial(deflection(d)));
            let force = law.elastic_force(d);
            force - (y - loaded(force, n)) / compliance(n)
        };
        // No sign change: the spring exerts no force on the contact, it has buckled under its own deflection.
        let Some(indentation) = roots::bracketed(residual, 0.0, total_overtravel - alone) else {
            return Err(check(axial(total_overtravel)).err().unwrap_or(SceneError::NotFinite {
                name: RealOutput::PreloadIndentation.variable().name,
                value: residual(0.0),
            }));
        };
        let (force, deflection) = (law.elastic_force(indentation), deflection(indentation));
        let axial_force = axial(deflection);
        check(axial_force)?;
        Ok(Self {
            force,
            indentation,
            contact_stiffness: law.tangent_stiffness(indentation),
            deflection,
            fixed_deflection: fixed_alone - give * force,
            pusher_force: press(force, axial_force).0,
            pusher_overlap: press(force, axial_force).1,
            armature: AtRest::default(),
            axial_force,
        })
    }
}

/// Deflection of the tip without contact, m: that of its loads under an axial force (N), which may depend on it; this feedback is
/// weak (N grows with the square of y), so the fixed-point iteration converges fast.
fn free_deflection(loaded: impl Fn(f64) -> f64, axial: &impl Fn(f64) -> f64) -> f64 {
    let mut y = 0.0;
    for _ in 0..50 {
        let next = loaded(axial(y));
        if next == y {
            break;
        }
        y = next;
    }
    y
}
