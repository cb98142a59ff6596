//! What parameters, each within its range, must be together.

use crate::error::{SceneError, number};
use crate::scene::spring::{GivenMode, Shape};
use crate::scene::{Scene, refused};
use crate::variables::{
    AxialForceKind, ContactLawKind, EnumerationParameter, ExcitationKind, PusherKind, RealParameter, ResistanceKind,
};

/// What something is not allowed beside, and what that may be instead.
type Beside<'a> = (&'a str, &'static str);

const FRICTION: Beside = ("effects.friction = Coulomb", "effects.friction = None");
const SECOND: Beside = ("effects.secondContact = true", "effects.secondContact = false");
const PARALLEL: Beside = ("effects.parallelContact = true", "effects.parallelContact = false");
const NO_RESISTANCE: Beside = ("effects.resistance = None", "any other effects.resistance");

const TANGENTIAL: &str = "Hertz and Rough, whose tangential stiffness follows that along the normal";
const POWERS: &str = "Hertz and Rough, which are no laws about the preload of the first contact";

const CONSTANT: &str = "None, FromPreload and Prescribed, which are constant";

impl Scene {
    /// Refuses parameters that do not go together.
    pub(crate) fn check_combinations(&self) -> Result<(), SceneError> {
        let effects = &self.effects;
        let (rubs, pushed) = (self.rubs(), effects.pusher != PusherKind::None);
        let law = self.chosen(EnumerationParameter::EffectsContactLaw);
        let axial = self.chosen(EnumerationParameter::EffectsAxialForce);
        let pusher = self.chosen(EnumerationParameter::EffectsPusher);
        let contacts = [(effects.second_contact, SECOND), (effects.parallel_contact, PARALLEL)];
        let linear = matches!(effects.contact_law, ContactLawKind::Linearised | ContactLawKind::Bonded);
        let follows = effects.axial_force == AxialForceKind::FromDeflection;
        exclude(linear && rubs, &law, TANGENTIAL, FRICTION)?;
        for (has, contact) in contacts {
            exclude(linear && has, &law, POWERS, contact)?;
            exclude(rubs && has, contact.0, "false", FRICTION)?;
        }
        let rigid = ("fixed.file", "no fixed.file");
        for (has, beside) in [
            (rubs, FRICTION),
            (effects.parallel_contact, PARALLEL),
            (pushed, (&pusher, "effects.pusher = None")),
            (self.fixed_spring.is_some(), rigid),
        ] {
            exclude(follows && has, &axial, CONSTANT, beside)?;
        }
        let unknown = effects.resistance == ResistanceKind::None;
        let counted = effects.chatter && unknown;
        exclude(counted, "effects.chatter = true", "false", NO_RESISTANCE)?;
        // What the fixed contact's spring need not know is where others touch the moving one.
        let springs = [("beam.file", &self.spring, true), ("fixed.file", &self.fixed_spring, false)];
        for (name, spring, moves) in springs {
            if let Some(spring) = spring
                && let Shape::Modes(given) = &spring.shape
            {
                let lacks = |entry: fn(&GivenMode) -> Option<f64>| given.modes.iter().any(|mode| entry(mode).is_none());
                let modes = format!("the modes of {name} = {}", spring.name);
                let beside = |instead| (modes.as_str(), instead);
                let pressed = moves && effects.axial_force != AxialForceKind::None;
                let geometry = beside("[[segment]], whose geometry an axial force needs");
                exclude(pressed, &axial, "None", geometry)?;
                let turned = beside("the rotation of the contact, rotation, in each [[mode]]");
                exclude(rubs && lacks(|mode| mode.rotation), FRICTION.0, "None", turned)?;
                let touched = beside("the displacement there, pusher, in each [[mode]]");
                exclude(moves && pushed && lacks(|mode| mode.pusher), &pusher, "None", touched)?;
                let closed = beside("the displacement there, parallel, in each [[mode]]");
                let parallel = moves && effects.parallel_contact && lacks(|mode| mode.parallel);
                exclude(parallel, PARALLEL.0, "false", closed)?;
            }
        }
        self.check_order()
    }

    /// Refuses values that are not on the right side of another one.
    fn check_order(&self) -> Result<(), SceneError> {
        let length = match self.spring.as_ref().map(|file| &file.shape) {
            None => self.beam.length,
            Some(Shape::Segments(segments)) => segments.length(),
            Some(Shape::Modes(_)) => f64::INFINITY,
        };
        let (rest, core) = (self.armature.rest_position, self.armature.core_position);
        let (lowest, highest) = (self.excitation.frequency, self.excitation.end_frequency);
        let (parameter, allowed) = if self.pushed_at().is_some_and(|position| position > length) {
            let allowed = format!("at most the length of the spring, {} m", number(length));
            (RealParameter::PusherPosition, allowed)
        } else if self.effects.pusher == PusherKind::Armature && core <= rest {
            let allowed = format!("more than armature.restPosition = {} m", number(rest));
            (RealParameter::ArmatureCorePosition, allowed)
        } else if self.effects.excitation == ExcitationKind::Random && highest <= lowest {
            let lowest = number(lowest);
            let allowed = format!("above excitation.frequency = {lowest} Hz, as a band has a width");
            (RealParameter::ExcitationEndFrequency, allowed)
        } else {
            return Ok(());
        };
        Err(refused(parameter.variable(), self.real(parameter), &allowed))
    }
}

fn exclude(broken: bool, choice: &str, allowed: &'static str, (other, instead): Beside) -> Result<(), SceneError> {
    if !broken {
        return Ok(());
    }
    Err(SceneError::NotTogether { choice: choice.to_owned(), allowed, other: other.to_owned(), instead })
}
