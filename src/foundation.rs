//! How a model follows from a scene, one after the other: springs, preload, contact laws, modes, lowest frequency.

use crate::assembly::{Assembly, Laws, Roles};
use crate::beam::axial::Feedback;
use crate::beam::mode::{MAX_MODES, Mode, Rayleigh};
use crate::beam::mode_count::Blow;
use crate::beam::springs::Springs;
use crate::closed_loop::system::ClosedLoop;
use crate::contact::law::{Law, Opening};
use crate::error::SceneError;
use crate::excitation::generator::Generator;
use crate::integrator::tolerance::Tolerance;
use crate::math::simd::{Simd, apart};
use crate::model::Model;
use crate::preload::{Initial, Preload};
use crate::scene::Scene;
use crate::variables::{AxialForceKind, ContactLawKind, RealParameter};

impl Model {
    /// The model of a scene, with the fixed contact displaced by `support` (m) at the start.
    ///
    /// # Errors
    /// A [`SceneError`] if the scene cannot be simulated.
    pub fn new(scene: &Scene, support: f64) -> Result<Self, SceneError> {
        let initial = Initial { displacements: [support, 0.0, 0.0], ..Initial::default() };
        Ok(*Self::starting(scene, &initial)?)
    }

    /// The model of a scene, with these inputs at the start: springs, preload, contact laws, modes, and the rest of it.
    ///
    /// # Errors
    /// A [`SceneError`] if the scene cannot be simulated.
    #[inline(never)]
    pub fn starting(scene: &Scene, initial: &Initial) -> Result<Box<Self>, SceneError> {
        scene.validate()?;
        scene.check_combinations()?;
        let springs = Springs::new(scene);
        let (spring, section) = (&springs.moving, springs.moving.statics.section);
        let power = Law::of(scene);
        let (parallel, second) = (Law::of_parallel(scene), Law::of_second(scene));
        let preload = Preload::new(scene, &springs, (&power, parallel.as_ref()), initial)?;
        let tolerance = scene.solver.effective_tolerance();
        let bending_force = bending_force(scene, &springs);
        let force_scale = preload.force.max(bending_force);
        let contact = law(scene, power, &preload)?;
        let laws = Laws { contact, parallel, second };
        let blows = blows(scene, bending_force, &power, [parallel, second]);
        let asked = usize::try_from(scene.solver.modes).unwrap_or_default();
        let counts = springs.counts(&blows, tolerance, asked);
        let Some(basis) = springs.modes(counts, preload.axial_force) else {
            return Err(SceneError::Buckled {
                name: RealParameter::BeamAxialForce.variable().name,
                value: preload.axial_force,
                limit: spring.statics.buckling_load(),
            });
        };
        // What is missing shows in the stiffer of two contacts on one tip.
        let [own, other, ..] = &blows;
        let hardest = if other.contact_stiffness > own.contact_stiffness { other } else { own };
        let resolution = springs.resolution(&basis, hardest);
        let axial = (scene.effects.axial_force == AxialForceKind::FromDeflection)
            .then(|| Feedback::new(&section, &preload, scene.environment.gravity, &basis))
            .map(Box::new);
        let modes = basis.modes;
        let frequency = axial
            .as_ref()
            .and_then(|axial| axial.frequency(&modes, preload.contact_stiffness))
            .or_else(|| frequency((scene, &springs, &preload), laws, initial.coil));
        let generator = Generator::new(scene);
        let is_linear =
            contact.opening != Opening::Parting && generator.is_harmonic() && is_linear(scene, &modes, spring.damping);
        let closed_loop = || ClosedLoop::new((&modes, &resolution), spring.damping, contact, &generator).map(Box::new);
        let closed_loop = is_linear.then(closed_loop).flatten();
        let at_contact = modes.iter().find(|mode| mode.tip != 0.0);
        let memory = at_contact.map_or(0.0, |mode| 1.0 / mode.omega_squared.sqrt());
        // Out of line, since it is large on the stack.
        let build = || {
            Box::new(Self {
                law: laws.contact,
                ports: Vec::new(),
                links: Vec::new(),
                roles: Roles::default(),
                participations: [0.0; MAX_MODES],
                roots: Vec::new(),
                resolution,
                inertia: inertia(&modes),
                memory,
                scene: scene.clone(),
                section,
                preload,
                modes,
                axial,
                closed_loop,
                generator,
                initial: *initial,
                few_modes: springs.few_modes(scene, hardest),
                spring_length: spring.length(),
                armature: springs.armature,
                force_scale,
                unstable_slip: Vec::new(),
                tolerance: Tolerance::new(tolerance, force_scale),
                frequency: frequency.map_or(0.0, |omega| omega / std::f64::consts::TAU),
                simd: Simd::detect(),
            })
        };
        let mut model = apart(build);
        model.link(laws);
        Ok(model)
    }
}

/// The law of the contact, linearised about the preload where the scene has it so.
fn law(scene: &Scene, power: Law, preload: &Preload) -> Result<Law, SceneError> {
    let opening = match scene.effects.contact_law {
        ContactLawKind::Hertz | ContactLawKind::Rough => return Ok(power),
        ContactLawKind::Linearised | ContactLawKind::Bonded if preload.force <= 0.0 => {
            return Err(SceneError::NoPreload);
        }
        ContactLawKind::Linearised => Opening::Tension,
        ContactLawKind::Bonded => Opening::Never,
    };
    let offset = preload.indentation - preload.force / preload.contact_stiffness;
    Ok(Law { offset, opening, ..Law::power(preload.contact_stiffness, 1.0, power.damping) })
}

/// Lowest angular frequency about the preload with every closed link as a spring, rad/s: of one spring with one contact exact.
fn frequency((scene, springs, preload): (&Scene, &Springs, &Preload), laws: Laws, coil: f64) -> Option<f64> {
    let (axial_force, stiffness) = (preload.axial_force, preload.contact_stiffness);
    if scene.pushed_at().is_none() && springs.fixed.is_none() && laws.parallel.is_none() {
        return springs.moving.frequency(axial_force, stiffness);
    }
    let modes = springs.many_modes(axial_force)?;
    let parts = (scene, modes.as_slice(), preload);
    Assembly::new(parts, laws, springs.armature.as_ref()).frequency(&modes, coil)
}

/// Blows of the contact, of a parallel and a second one, and of the pusher, as the scene may have them; of what is not there like
/// those of the contact.
fn blows(scene: &Scene, bending_force: f64, power: &Law, [parallel, second]: [Option<Law>; 2]) -> [Blow; 4] {
    // A blow fifty times the force of the bent spring; with Hertz the number of modes follows it by the 18th root.
    let force = match scene.effects.contact_law {
        ContactLawKind::Hertz | ContactLawKind::Rough => 50.0 * bending_force,
        ContactLawKind::Linearised | ContactLawKind::Bonded => bending_force,
    };
    let pusher = scene.pushed_at().map(|_| Law::linear(scene.pusher.stiffness, scene.pusher.damping));
    [Some(*power), parallel, second, pusher].map(|law| {
        let law = law.unwrap_or(*power);
        Blow {
            contact_stiffness: law.tangent_stiffness(force),
            contact_damping: law.damping,
            bare: scene.tip.mass == 0.0,
            steep: scene.rubs() || law.exponent < 1.4,
        }
    })
}

/// Force of the springs bent by the overtravel, at least by 0.1 mm, N: of one of them 3 E I max(|s|, 0.1 mm) / L^3.
fn bending_force(scene: &Scene, springs: &Springs) -> f64 {
    springs.stiffness() * scene.contact.overtravel.abs().max(1e-4)
}

/// Force at the held tip per base acceleration that varies slowly, kg.
fn inertia(modes: &[Mode]) -> f64 {
    let tip = |load: fn(&Mode) -> f64| -> f64 {
        let parts = modes.iter().map(|mode| mode.tip * load(mode) / mode.omega_squared);
        parts.sum()
    };
    (tip(|mode| mode.participation) / tip(|mode| mode.tip)).abs()
}

/// Whether nothing but the contact law can keep the scene from being linear, nothing within a step is requested, and all damping is
/// Rayleigh's, as exact steps need it.
fn is_linear(scene: &Scene, modes: &[Mode], damping: Rayleigh) -> bool {
    let is_rayleigh = |mode: &Mode| mode.damping == damping.of(mode.omega_squared);
    scene.effects.axial_force != AxialForceKind::FromDeflection
        && scene.fixed_spring.is_none()
        && scene.pushed_at().is_none()
        && !scene.effects.extremes
        && modes.iter().all(is_rayleigh)
}
