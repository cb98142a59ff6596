//! The effects, how each is switched on, and when it matters.

/// Names of variables and their values.
pub type Settings = &'static [(&'static str, &'static str)];

/// Name of what the effects are added to.
pub const MINIMAL: &str = "minimal scene";

/// An effect that a scene may ask for.
pub struct Effect {
    /// As in the table.
    pub name: &'static str,
    /// What asks for it.
    pub setting: Settings,
    /// What else the run needs to show its cost.
    pub with: Settings,
    /// Outputs that it is for, read after each communication step, with commas between them.
    pub reads: &'static str,
    /// The effect that it cannot be without, and is compared with.
    pub beside: Option<&'static str>,
    /// What takes it away from a scene; empty where there is nothing to compare.
    pub off: Settings,
    /// When it matters.
    pub matters: &'static str,
}

const POWER_LAW: &str = "resistance by the power law";

const NOTHING: Effect = Effect {
    name: "",
    setting: &[],
    with: &[],
    reads: "contact.force",
    beside: None,
    off: &[],
    matters: "",
};

/// All of them, those that others are compared with first.
pub const EFFECTS: &[Effect] = &[
    Effect {
        name: "no excitation",
        setting: &[("effects.excitation", "None")],
        matters: "where the inputs drive the contact; a contact at rest takes no integration step, however long the run.",
        ..NOTHING
    },
    Effect {
        name: "logarithmic sweep",
        setting: &[("effects.excitation", "LogSweep")],
        with: &[("excitation.duration", "0.1")],
        matters: "to find resonances; it costs more than a sine mostly because of the higher frequencies.",
        ..NOTHING
    },
    Effect {
        name: "half sine",
        setting: &[("effects.excitation", "HalfSine")],
        with: &[("excitation.duration", "0.1")],
        matters: "for shocks; no cost after its duration.",
        ..NOTHING
    },
    Effect {
        name: "random excitation",
        setting: &[("effects.excitation", "Random")],
        with: &[("excitation.spectralDensity", "9.617"), ("excitation.frequency", "50")],
        matters: "for vibration of vehicles and the like, which a sine does not represent.",
        ..NOTHING
    },
    Effect {
        name: "contact damping",
        setting: &[("effects.contactDamping", "true")],
        off: &[("effects.contactDamping", "false")],
        matters: "where the contact opens: it sets the force of the impact at closing and the bounce time; it hardly affects a closed contact.",
        ..NOTHING
    },
    Effect {
        name: "rough contact",
        setting: &[("effects.contactLaw", "Rough")],
        off: &[("effects.contactLaw", "Hertz")],
        matters: "for every real surface: roughness makes the contact softer than spheres, a hundred times in the specimen, and softer \
                  still at small forces (docs/contact-law.md).",
        ..NOTHING
    },
    Effect {
        name: "linearised contact",
        setting: &[("effects.contactLaw", "Linearised")],
        off: &[("effects.contactLaw", "Hertz")],
        matters: "to compare with modal and frequency-domain analyses; accurate while the force stays far from zero, wrong where the \
                  contact opens.",
        ..NOTHING
    },
    Effect {
        name: "bonded contact",
        setting: &[("effects.contactLaw", "Bonded")],
        off: &[("effects.contactLaw", "Hertz")],
        matters: "where the contact cannot open: steps are exact and as long as the communication step, so long communication steps cost least.",
        ..NOTHING
    },
    Effect {
        name: "axial force from the preload",
        setting: &[("effects.axialForce", "FromPreload")],
        off: &[("effects.axialForce", "None")],
        matters: "hardly ever: it is some millinewtons for the specimen; the modes include it, computed once.",
        ..NOTHING
    },
    Effect {
        name: "axial force from the deflection",
        setting: &[("effects.axialForce", "FromDeflection")],
        off: &[("effects.axialForce", "FromPreload")],
        matters: "where the tip moves by much of its deflection at preload, in wide openings; for a closed contact the result is that \
                  of the force from the preload.",
        ..NOTHING
    },
    Effect {
        name: "prescribed axial force",
        setting: &[("effects.axialForce", "Prescribed"), ("beam.axialForce", "1")],
        off: &[("effects.axialForce", "None")],
        matters: "where the spring is clamped under compression, which lowers its frequencies; the modes include it, computed \
                  once.",
        ..NOTHING
    },
    Effect {
        name: POWER_LAW,
        setting: &[("effects.resistance", "PowerLaw")],
        reads: "contact.force,contact.resistance",
        matters: "for every question about resistance; it is evaluated only where the resistance is read.",
        ..NOTHING
    },
    Effect {
        name: "resistance by Barber",
        setting: &[("effects.resistance", "Barber")],
        reads: "contact.force,contact.resistance",
        off: &[("effects.resistance", "PowerLaw")],
        matters: "to hold the stiffness of the contact against its measured resistance, and where no resistance was measured.",
        ..NOTHING
    },
    Effect {
        name: "resistance by Holm",
        setting: &[("effects.resistance", "Holm")],
        reads: "contact.force,contact.resistance",
        off: &[("effects.resistance", "PowerLaw")],
        matters: "for clean metal of known hardness and resistivity, instead of the power law fitted to one contact.",
        ..NOTHING
    },
    Effect {
        name: "heating",
        setting: &[("effects.heating", "true")],
        with: &[("effects.resistance", "PowerLaw"), ("contact.current", "0.1")],
        reads: "contact.force,contact.resistance,contact.temperature",
        beside: Some(POWER_LAW),
        off: &[("effects.heating", "false")],
        matters: "for `contact.temperature` alone; motion and resistance do not depend on it.",
    },
    Effect {
        name: "chatter",
        setting: &[("effects.chatter", "true")],
        with: &[("effects.resistance", "PowerLaw")],
        reads: "contact.force,contact.resistance,chatter.count",
        beside: Some(POWER_LAW),
        off: &[("effects.chatter", "false")],
        matters: "where interruptions are counted: those shorter than a communication step show nowhere else.",
    },
    Effect {
        name: "extremes",
        setting: &[("effects.extremes", "true")],
        reads: "contact.force,step.minimumForce,step.maximumForce",
        off: &[("effects.extremes", "false")],
        matters: "where communication steps are long compared with the period of the vibration.",
        ..NOTHING
    },
    Effect {
        name: "energy balance",
        setting: &[("effects.energy", "true")],
        reads: "contact.force,energy.balance",
        off: &[("effects.energy", "false")],
        matters: "to check a run; the motion does not depend on it.",
        ..NOTHING
    },
    Effect {
        name: "second contact",
        setting: &[("effects.secondContact", "true")],
        // Reading its force as well would show what reading any output costs, not the effect.
        reads: "contact.force",
        off: &[("effects.secondContact", "false")],
        matters: "where the spring may reach the other fixed contact of a changeover relay or a backstop: once the contact opens; out of \
                  reach it changes nothing. Measured out of reach, without reading its outputs.",
        ..NOTHING
    },
    Effect {
        name: "friction",
        setting: &[("effects.friction", "Coulomb")],
        reads: "contact.force,contact.tangentialForce,friction.energy",
        off: &[("effects.friction", "None")],
        matters: "where the contact point lies off the neutral axis, so that the spring rubs as it bends: it stiffens the spring while it \
                  sticks and damps it while it slips; and for fretting, by slip and dissipated energy.",
        ..NOTHING
    },
];

/// What is changed in the minimal scene to see the effect.
pub fn changes(effect: &Effect) -> Vec<(String, String)> {
    let outputs = [("outputs", effect.reads)];
    let settings = effect.with.iter().chain(effect.setting).chain(&outputs);
    settings
        .map(|(name, value)| ((*name).to_owned(), (*value).to_owned()))
        .collect()
}

/// Settings as code.
pub fn code(settings: Settings) -> String {
    let settings = settings.iter().map(|(name, value)| format!("`{name} = {value}`"));
    settings.collect::<Vec<_>>().join(", ")
}
