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
//! A parallel contact presses with `F_2` of its own indentation; its deflection follows from both forces by the compliances at and
//! between the two places.
//!
//! With friction `T_0 = tau F_0` at the height `h` of the contact point, its moment adds `c_m(N) h tau` to `c(N)`, `c_m` the
//! deflection per moment.

use serde::{Deserialize, Serialize};

use crate::armature::AtRest;
use crate::beam::spring::Spring;
use crate::beam::springs::Springs;
use crate::contact::friction::tangential_share;
use crate::contact::law::Law;
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
    /// Force of the parallel contact, N; 0 without one.
    pub parallel_force: f64,
    /// Its indentation, m; negative: a gap.
    pub parallel_indentation: f64,
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
        Self { displacements: [0.0; INPUTS], coil: 1.0 }
    }
}

impl Preload {
    /// Equilibrium of the scene with these inputs, with these laws of the contact and of a parallel one.
    ///
    /// # Errors
    /// [`SceneError::Buckled`] where the axial force reaches the buckling load of the cantilever, [`SceneError::Jams`] by
    /// friction, [`SceneError::NotFinite`] where the armature or a contact finds no rest.
    pub fn new(
        scene: &Scene,
        springs: &Springs,
        laws: (&Law, Option<&Law>),
        initial: &Initial,
    ) -> Result<Self, SceneError> {
        let Some(armature) = &springs.armature else {
            return Pressed::new(scene, springs, laws, initial.displacements).equilibrium();
        };
        let at = |place: f64| {
            let [support, ..] = initial.displacements;
            Pressed::new(scene, springs, laws, [support, 0.0, place]).equilibrium()
        };
        let force = |place: f64| at(place).map_or(f64::NAN, |preload| preload.pusher_force);
        let Some(armature) = armature.at_rest(initial.coil, force) else {
            // Where the spring has no equilibrium under the pusher, it says why.
            at(scene.armature.rest_position)?;
            at(scene.armature.core_position)?;
            return Err(not_finite(RealOutput::ArmatureDisplacement, f64::NAN));
        };
        Ok(Self { armature, ..at(armature.place)? })
    }
}

/// Springs, contacts and pusher pressed onto each other with the inputs at these places.
struct Pressed<'a> {
    scene: &'a Scene,
    springs: &'a Springs,
    law: &'a Law,
    parallel: Option<&'a Law>,
    /// Where the pusher would touch the unloaded spring, towards the contact, m.
    pushed: Option<f64>,
    /// Moment of the friction force per contact force, m; 0 without friction.
    lever: f64,
    /// Overtravel with what inputs and the deflection of the fixed contact's spring alone add, m.
    overtravel: f64,
    /// Deflection of that spring alone, m.
    fixed_alone: f64,
    /// What it gives way per contact force with the friction that comes with it, m/N.
    give: f64,
}

impl<'a> Pressed<'a> {
    fn new(
        scene: &'a Scene,
        springs: &'a Springs,
        (law, parallel): (&'a Law, Option<&'a Law>),
        [support, _, pushed]: Ways,
    ) -> Self {
        let lever = tangential_share(scene).map_or(0.0, |share| share * scene.tip.contact_height);
        let (mut fixed_alone, mut give) = (0.0, 0.0);
        if let Some(Spring { statics, .. }) = &springs.fixed {
            fixed_alone = statics.gravity_compliance(0.0) * scene.environment.gravity;
            give = statics.tip_compliance(0.0) - lever * statics.moment_compliance(0.0);
        }
        Self {
            scene,
            springs,
            law,
            parallel,
            pushed: scene.pushed_at().map(|_| pushed),
            lever,
            overtravel: scene.contact.overtravel + support + fixed_alone,
            fixed_alone,
            give,
        }
    }

    /// Axial force at a deflection of the tip (m), N.
    fn axial(&self, y: f64) -> f64 {
        self.springs.moving.axial_force(self.scene, y)
    }

    fn check_buckling(&self, axial_force: f64) -> Result<(), SceneError> {
        let limit = self.springs.moving.statics.buckling_load();
        if axial_force < limit {
            return Ok(());
        }
        let name = match self.scene.effects.axial_force {
            AxialForceKind::Prescribed => RealParameter::BeamAxialForce.variable().name,
            _ => RealOutput::PreloadAxialForce.variable().name,
        };
        Err(SceneError::Buckled { name, value: axial_force, limit })
    }

    /// Deflection of the tip per contact force with the friction that comes with it, m/N.
    fn compliance(&self, n: f64) -> f64 {
        self.springs.tip_compliance(n) + self.lever * self.springs.moving.statics.moment_compliance(n)
    }

    /// Force of the pusher (N) and its overlap with the spring (m), 0 without one, under the forces of both contacts and an axial
    /// force (N).
    fn press(&self, [force, parallel]: [f64; 2], n: f64) -> (f64, f64) {
        let Some(place) = self.pushed else { return (0.0, 0.0) };
        let by = self.springs.moving.statics.at_pusher(n);
        let by_parallel = self.parallel.map_or(0.0, |_| self.springs.at_parallel(n).pushed * parallel);
        // Of the spring without the pusher, which is where it pushes; friction turns it as it presses the contact.
        let spring =
            (by.across + self.lever * by.turning) * force + by_parallel + by.sag * self.scene.environment.gravity;
        let alone = place + spring;
        if alone <= 0.0 {
            return (0.0, alone);
        }
        let stiffness = self.scene.pusher.stiffness;
        let force = alone / (1.0 / stiffness + by.own);
        (force, force / stiffness)
    }

    /// What gravity, pusher and the parallel contact do to the tip under the forces of both contacts and an axial force (N), m.
    fn loaded(&self, forces: [f64; 2], n: f64) -> f64 {
        let statics = &self.springs.moving.statics;
        let by_gravity = statics.gravity_compliance(n) * self.scene.environment.gravity;
        let by_parallel = |_| self.springs.at_parallel(n).across * forces[1];
        let by_pusher = |_| statics.at_pusher(n).across * self.press(forces, n).0;
        by_gravity + self.parallel.map_or(0.0, by_parallel) - self.pushed.map_or(0.0, by_pusher)
    }

    /// Indentation of the parallel contact with this force (N) in an equilibrium with it, m.
    fn parallel_indentation(&self, preload: &Preload, parallel: f64) -> f64 {
        let by = self.springs.at_parallel(preload.axial_force);
        let deflection = by.across * preload.force + by.own * parallel + by.sag * self.scene.environment.gravity
            - by.pushed * preload.pusher_force;
        self.overtravel - self.scene.parallel.offset - deflection - self.give * (preload.force + parallel)
    }

    /// The equilibrium. The more a parallel contact presses, the less it is indented by where the spring is then.
    fn equilibrium(&self) -> Result<Preload, SceneError> {
        let first = self.with(0.0)?;
        let Some(law) = self.parallel else { return Ok(first) };
        let open = self.parallel_indentation(&first, 0.0);
        if open <= 0.0 {
            return Ok(Preload { parallel_indentation: open, ..first });
        }
        let excess = |d: f64| {
            let force = law.elastic_force(d);
            // A force that the spring cannot take is too large.
            self.with(force).map_or(f64::MAX, |with| d - self.parallel_indentation(&with, force))
        };
        // From small forces on, to hardly more than twice the one sought: far beyond it, where the spring were bent by more than its
        // length, what it seems to do jumps through zero.
        let most = self.springs.at_parallel(first.axial_force).own + self.give;
        let (mut force, mut below, mut above) = (0.0, (0.0, -open), (0.0, -open));
        while above.1 < 0.0 && above.0 < open {
            below = above;
            force = 2.0 * force - above.1 / most.max(f64::MIN_POSITIVE);
            let d = law.indentation(force).min(open);
            above = (d, excess(d));
        }
        let Some(indentation) = roots::between(excess, below, above, 0.0) else {
            return Err(not_finite(RealOutput::ParallelForce, above.1));
        };
        let force = law.elastic_force(indentation);
        let rests = Preload { parallel_force: force, parallel_indentation: indentation, ..self.with(force)? };
        // What is no root but a jump is no equilibrium.
        if (indentation - self.parallel_indentation(&rests, force)).abs() > 1e-6 * open {
            return Err(not_finite(RealOutput::ParallelForce, force));
        }
        Ok(rests)
    }

    /// The equilibrium with a parallel contact that presses with this force, N.
    fn with(&self, parallel: f64) -> Result<Preload, SceneError> {
        let Self { law, give, .. } = *self;
        let total_overtravel = self.overtravel - give * parallel;
        let rests = |force: f64, deflection: f64, n: f64| Preload {
            force,
            deflection,
            fixed_deflection: self.fixed_alone - give * (force + parallel),
            axial_force: n,
            pusher_force: self.press([force, parallel], n).0,
            pusher_overlap: self.press([force, parallel], n).1,
            ..Preload::default()
        };
        let alone = self.alone(parallel)?;
        if total_overtravel <= alone {
            let axial_force = self.axial(alone);
            self.check_buckling(axial_force)?;
            return Ok(Preload { indentation: total_overtravel - alone, ..rests(0.0, alone, axial_force) });
        }
        self.check_jam(self.axial(total_overtravel))?;
        // Whatever the force, it does not draw the spring beyond where it is alone.
        let deflection = |d: f64| (total_overtravel - d - give * law.elastic_force(d)).max(alone);
        let residual = |d: f64| {
            let (y, n) = (deflection(d), self.axial(deflection(d)));
            let force = law.elastic_force(d);
            force - (y - self.loaded([force, parallel], n)) / self.compliance(n)
        };
        // No sign change: the spring exerts no force on the contact, it has buckled under its own deflection.
        let Some(indentation) = roots::bracketed(residual, 0.0, total_overtravel - alone) else {
            let buckled = self.check_buckling(self.axial(total_overtravel)).err();
            return Err(buckled.unwrap_or(not_finite(RealOutput::PreloadIndentation, residual(0.0))));
        };
        let (force, deflection) = (law.elastic_force(indentation), deflection(indentation));
        let axial_force = self.axial(deflection);
        self.check_buckling(axial_force)?;
        Ok(Preload {
            indentation,
            contact_stiffness: law.stiffness(indentation),
            ..rests(force, deflection, axial_force)
        })
    }

    /// Deflection of the tip without contact under this force of a parallel one (N), m: that of its loads under an axial force that may
    /// depend on it, as `N` grows with the square of `y`. A spring that bends further and further is refused if it leaves the contact; one
    /// that is stopped by it is as far as it came.
    fn alone(&self, parallel: f64) -> Result<f64, SceneError> {
        let length = self.springs.moving.statics.section.length;
        let (mut y, mut last) = (0.0, f64::INFINITY);
        for _ in 0..1000 {
            let n = self.axial(y);
            if self.check_buckling(n).is_err() {
                break;
            }
            let next = self.loaded([0.0, parallel], n);
            let change = (next - y).abs();
            // To rounding.
            if change <= f64::EPSILON * next.abs() || last <= change && change < 1e-9 * next.abs() {
                return Ok(next);
            }
            if y.abs() > length {
                break;
            }
            (y, last) = (next, change);
        }
        if y < 0.0 {
            return Ok(y);
        }
        self.check_buckling(self.axial(y))?;
        Err(not_finite(RealOutput::PreloadIndentation, self.overtravel - y))
    }

    /// Refuses friction under which the spring gives way more than it presses back, at an axial force (N), and a spring that has
    /// buckled under that.
    fn check_jam(&self, n: f64) -> Result<(), SceneError> {
        let compliance = self.compliance(n);
        if !self.scene.rubs() || compliance.min(compliance + self.give) > 0.0 {
            return Ok(());
        }
        // A buckled spring gives way too, at any friction.
        self.check_buckling(n)?;
        let Scene { friction, tip, .. } = self.scene;
        // Both compliances fall linearly with the product of coefficient and height.
        let statics = &self.springs.moving.statics;
        let rubbed = friction.coefficient * tip.contact_height;
        let alone = statics.tip_compliance(n);
        let both = alone + self.springs.fixed.as_ref().map_or(0.0, |fixed| fixed.statics.tip_compliance(0.0));
        let limit = |free: f64, now: f64| {
            if now > 0.0 { f64::INFINITY } else { rubbed * free / (free - now) }
        };
        Err(SceneError::Jams {
            coefficient: friction.coefficient,
            height: tip.contact_height,
            limit: limit(alone, compliance).min(limit(both, compliance + self.give)),
            initial: friction.initial,
        })
    }
}

fn not_finite(output: RealOutput, value: f64) -> SceneError {
    SceneError::NotFinite { name: output.variable().name, value }
}
