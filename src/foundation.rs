//! What a model stands on, found one after the other from a scene: springs, preload, contact laws, modes, lowest frequency.

use crate::armature::Armature;
use crate::assembly::{Assembly, Laws};
use crate::beam::axial::Feedback;
use crate::beam::mode::Mode;
use crate::beam::mode_count::Blow;
use crate::beam::resolution::Resolution;
use crate::beam::section::Section;
use crate::beam::spring::Basis;
use crate::beam::springs::{Counts, Springs};
use crate::contact::law::Law;
use crate::contact::linear::Linear;
use crate::contact::power::Power;
use crate::error::SceneError;
use crate::preload::{Initial, Preload};
use crate::scene::Scene;
use crate::variables::{AxialForceKind, ContactLawKind, RealParameter};

/// What a model stands on.
pub struct Foundation {
    /// See [`Model::section`](crate::model::Model::section).
    pub section: Section,
    /// The static equilibrium.
    pub preload: Preload,
    /// The laws of the contacts.
    pub laws: Laws,
    /// The modes of one body after the other, frequency ascending in each.
    pub modes: Vec<Mode>,
    /// What the modes left out do.
    pub resolution: Resolution,
    /// The axial force, if it follows the deflection continuously.
    pub axial: Option<Box<Feedback>>,
    /// The armature, if there is one.
    pub armature: Option<Armature>,
    /// Force scale of the tolerance, N.
    pub force_scale: f64,
    /// Lowest angular frequency about the preload, rad/s, if there is one.
    pub frequency: Option<f64>,
    /// See [`Springs::missed`].
    pub missed: Option<(f64, f64, bool)>,
    /// Length of the spring, if it is known, m.
    pub spring_length: Option<f64>,
}

impl Foundation {
    /// That of a scene with these inputs at the start.
    ///
    /// # Errors
    /// A [`SceneError`] if the scene cannot be simulated.
    #[inline(never)]
    pub fn of(scene: &Scene, initial: &Initial) -> Result<Box<Self>, SceneError> {
        scene.validate()?;
        scene.check_combinations()?;
        let springs = Springs::new(scene);
        let (spring, section) = (&springs.moving, springs.moving.section);
        let power = Power::of(scene);
        let (parallel, second) = (Power::of_parallel(scene), Power::of_second(scene));
        let preload = Preload::new(scene, &springs, (&power, parallel.as_ref()), initial)?;
        let tolerance = scene.solver.effective_tolerance();
        let bending_force = bending_force(scene, &springs);
        let force_scale = preload.force.max(bending_force);
        let other = |power: Power| Law::Power(power).parting(tolerance, force_scale);
        let laws = Laws {
            contact: law(scene, power, &preload)?.parting(tolerance, force_scale),
            parallel: parallel.map(other),
            second: second.map(other),
        };
        let own = blow(scene, bending_force, &power);
        let counts = counts(scene, &springs, (&own, [parallel, second], bending_force));
        let Some(basis) = springs.modes(scene, counts, preload.axial_force) else {
            return Err(SceneError::Buckled {
                name: RealParameter::BeamAxialForce.variable().name,
                value: preload.axial_force,
                limit: spring.buckling_load,
            });
        };
        let resolution = springs.resolution(&basis, &own, scene.pushed_at().is_some());
        let Basis {
            modes, shapes, space, ..
        } = basis;
        let axial = (scene.effects.axial_force == AxialForceKind::FromDeflection)
            .then(|| Feedback::new(&section, &preload, scene.environment.gravity, &space, &modes, &shapes))
            .map(Box::new);
        let frequency = axial
            .as_ref()
            .and_then(|axial| axial.frequency(&modes, preload.contact_stiffness))
            .or_else(|| frequency((scene, &springs, &preload), laws, initial.coil));
        Ok(Box::new(Self {
            section,
            preload,
            laws,
            modes,
            resolution,
            axial,
            armature: springs.armature,
            force_scale,
            frequency,
            missed: springs.missed(&own),
            spring_length: spring.length(),
        }))
    }
}

/// The law of the first contact.
fn law(scene: &Scene, power: Power, preload: &Preload) -> Result<Law, SceneError> {
    match scene.effects.contact_law {
        ContactLawKind::Hertz | ContactLawKind::Rough => Ok(Law::Power(power)),
        ContactLawKind::Linearised | ContactLawKind::Bonded if preload.force <= 0.0 => Err(SceneError::NoPreload),
        kind @ (ContactLawKind::Linearised | ContactLawKind::Bonded) => Ok(Law::Linear(Linear {
            stiffness: preload.contact_stiffness,
            damping: power.damping,
            offset: preload.indentation - preload.force / preload.contact_stiffness,
            bonded: kind == ContactLawKind::Bonded,
        })),
    }
}

/// Lowest angular frequency about the preload with every closed link as a spring, rad/s: of one spring with one contact exact.
fn frequency((scene, springs, preload): (&Scene, &Springs, &Preload), laws: Laws, coil: f64) -> Option<f64> {
    let (axial_force, stiffness) = (preload.axial_force, preload.contact_stiffness);
    if scene.pushed_at().is_none() && springs.fixed.is_none() && laws.parallel.is_none() {
        return springs.moving.frequency(axial_force, stiffness);
    }
    let modes = springs.many_modes(scene, axial_force)?;
    let parts = (scene, modes.as_slice(), preload);
    Assembly::new(parts, laws, springs.armature.as_ref()).frequency(&modes, coil)
}

/// Numbers of modes for blows of the contact (`own`) and of all others: as many as the tolerance needs, or as the scene asks for.
fn counts(
    scene: &Scene,
    springs: &Springs,
    (own, [parallel, second], bending_force): (&Blow, [Option<Power>; 2], f64),
) -> Counts {
    let pusher = scene
        .pushed_at()
        .map(|_| Power::linear(scene.pusher.stiffness, scene.pusher.damping));
    let blow = |power: Power| blow(scene, bending_force, &power);
    let others = [parallel, second, pusher].map(|power| power.map_or(*own, blow));
    springs
        .counts(own, &others, scene.solver.effective_tolerance())
        .or(usize::try_from(scene.solver.modes).unwrap_or_default())
        .within_room(springs.room())
}

/// A blow as the scene may have it.
fn blow(scene: &Scene, bending_force: f64, power: &Power) -> Blow {
    // A blow fifty times the force of the bent spring; with Hertz the number of modes follows it by the 18th root.
    let force = match scene.effects.contact_law {
        ContactLawKind::Hertz | ContactLawKind::Rough => 50.0 * bending_force,
        ContactLawKind::Linearised | ContactLawKind::Bonded => bending_force,
    };
    Blow {
        mass_damping: scene.beam.mass_damping,
        stiffness_damping: scene.beam.stiffness_damping,
        contact_stiffness: power.tangent_stiffness(power.indentation(force)),
        contact_damping: power.damping,
        steep: scene.rubs() || power.exponent < 1.4,
    }
}

/// Force of the springs bent by the overtravel, at least by 0.1 mm, N: of one of them 3 E I max(|s|, 0.1 mm) / L^3.
fn bending_force(scene: &Scene, springs: &Springs) -> f64 {
    springs.stiffness() * scene.contact.overtravel.abs().max(1e-4)
}
