//! Errors of setting up a scene and of integrating it. Every message names the variable, its value and what is
//! allowed, so that it can be shown to the user unchanged.

use std::ops::{Range, RangeInclusive};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A scene that cannot be simulated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages tell what the fields are")]
pub enum SceneError {
    /// A value outside its range, or not a number.
    #[error("{name} = {}{}: not allowed, {allowed}", number(*value), spaced(unit))]
    OutOfRange { name: &'static str, value: f64, unit: &'static str, allowed: String },
    /// A choice that the enumeration does not have.
    #[error("{name} = {value}: no such choice, allowed are {allowed}")]
    UnknownChoice { name: &'static str, value: String, allowed: String },
    /// A name that no variable of the expected kind has.
    #[error("{name}: no such {what}; similar: {nearest}")]
    UnknownName { name: String, what: &'static str, nearest: String },
    /// Brackets inside each other that are more than a file may have.
    #[error("brackets inside each other: not allowed, allowed are {0}")]
    Nested(usize),
    /// Less memory than a simulation takes.
    #[error("out of memory: {0} bytes are needed, and the system does not give them")]
    Memory(usize),
    /// A value of the wrong type.
    #[error("{name} = {value}: wrong type, allowed is {allowed}")]
    WrongType { name: String, value: String, allowed: &'static str },
    /// An axial force above the buckling load of the spring without contact.
    #[error(
        "{name} = {} N: the spring buckles once the contact opens, allowed is less than {} N",
        number(*value), number(*limit)
    )]
    Buckled { name: &'static str, value: f64, limit: f64 },
    /// Two things that cannot be combined.
    #[error("{choice}: not allowed with {other}, allowed is {allowed}; or {instead}")]
    NotTogether { choice: String, allowed: &'static str, other: String, instead: &'static str },
    /// Friction so strong that the contact jams as it closes: no preload with it at its limit.
    #[error(
        "friction.coefficient = {} with tip.contactHeight = {} m: the contact jams as it closes, allowed is a product of less \
         than {} m for friction.initial = {}",
        number(*coefficient), number(*height), number(*limit), number(*initial)
    )]
    Jams { coefficient: f64, height: f64, limit: f64, initial: f64 },
    /// A second contact that the moving contact touches at the preload, or that touches the first.
    #[error(
        "second.gap = {} m with second.displacement = {} m: not allowed, what is left of the gap at the preload must be more \
         than {} m for the spring to lie between both contacts",
        number(*gap), number(*displacement), number(*least)
    )]
    NoGap { gap: f64, displacement: f64, least: f64 },
    /// A linear contact law without a contact force to linearise about.
    #[error("effects.contactLaw: Linearised and Bonded need a contact that is closed at rest, preload.force is 0 N")]
    NoPreload,
    /// A scene for which a quantity of the model is not finite.
    #[error("{name} is {} for this scene: this combination of parameters is too extreme", number(*value))]
    NotFinite { name: &'static str, value: f64 },
    /// A scene file that lacks a key.
    #[error("{name}: missing; expected {allowed}")]
    MissingKey { name: &'static str, allowed: &'static str },
    /// A name given twice.
    #[error("{name}: given twice, allowed is {allowed}")]
    GivenTwice { name: String, allowed: &'static str },
    /// A key that a file does not have.
    #[error("{name}: no such key, allowed are {allowed}{}", meant(*nearest))]
    UnknownKey { name: String, allowed: String, nearest: Option<&'static str> },
    /// Modes of a spring that are more compliant than the whole spring.
    #[error(
        "{name} = {} m/N: not allowed, allowed is {} m/N or more, which the modes hold alone (sum of {place}^2/omega^2); \
         modes and compliance contradict each other",
        number(*compliance), number(*held)
    )]
    Contradiction { name: &'static str, compliance: f64, place: &'static str, held: f64 },
    /// Any of these, with the entry of a list that it is in.
    #[error("{entry}: {error}")]
    InEntry { entry: String, error: Box<SceneError> },
    /// Any of these, with its line of the scene file or table.
    #[error("line {line}: {error}")]
    AtLine { line: usize, error: Box<SceneError> },
    /// A file that is not TOML.
    #[error("not TOML: {0}")]
    Toml(String),
    /// A table of inputs that is not CSV, or has no rows.
    #[error("not a table of inputs: {0}")]
    InputTable(String),
    /// Any of these, with the file it is in.
    #[error("{}", in_file(file, error))]
    InFile { file: String, error: Box<SceneError> },
    /// A file that cannot be read.
    #[error("{file}: cannot be read: {cause}")]
    Unreadable { file: String, cause: String },
}

/// Largest compliance of a relay's spring, m/N, and the least share of it that modes hold, 1.
pub(crate) const SOFTEST: f64 = 0.1;
pub(crate) const HELD: f64 = 0.5;

/// What a user should know of a scene that can be simulated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages tell what the fields are")]
pub enum Remark {
    /// What describes another kind of spring, set beside a spring file.
    #[error("{name} = {}{}: not used, the spring is that of beam.file = {file}", number(*value), spaced(unit))]
    NotUsed { name: &'static str, value: f64, unit: &'static str, file: String },
    /// A spring that forks, and does not in the scene.
    #[error(
        "{name} = {file}: fork_position = {} m: not used, both tongues move as one; only those of beam.file with \
         effects.parallelContact = true move apart",
        number(*fork)
    )]
    Joined { name: &'static str, file: String, fork: f64 },
    /// A damping that may be meant in per cent, or in another unit than s.
    #[error(
        "{spring}.stiffnessDamping, {spring}.massDamping or damping in {spring}.file: the lowest mode has {:.0} % of its critical \
         damping; are they in s, 1/s and parts of 1?",
        100.0 * damping
    )]
    Damped { spring: &'static str, damping: f64 },
    /// A value that may be meant in another unit.
    #[error(
        "{name} = {} {unit}: usual is {} to {}; is it meant in another unit?",
        number(*value), number(*usual.start()), number(*usual.end())
    )]
    Unusual { name: &'static str, value: f64, unit: &'static str, usual: RangeInclusive<f64> },
    /// Modes of a spring that are hardly a part of it, or a spring softer than any, as in other units or with modal masses other than
    /// 1 kg.
    #[error(
        "{name} = {file}: compliance = {} m/N, of which its modes hold {:.2} %: usual is up to {} m/N, and at least {:.0} %; are they \
         in m/N, Hz and 1/sqrt(kg), of modal masses of 1 kg, and is the lowest among them?",
        number(*compliance), 100.0 * held / compliance, number(SOFTEST), 100.0 * HELD
    )]
    Compliance { name: &'static str, file: String, compliance: f64, held: f64 },
    /// A spring bent so far that a linear beam misses a part of its force.
    #[error(
        "contact.overtravel = {} m: the spring is bent by {bent:.2} of its length of {} m; an elastica under a load along y is \
         there {stiffer:.1} % stiffer than this linear beam (first order)",
        number(*overtravel), number(*length)
    )]
    BentFar { overtravel: f64, length: f64, bent: f64, stiffer: f64 },
    /// Friction between contacts that are much softer or much stiffer at first touch than those of Hertz.
    #[error(
        "effects.friction = Coulomb with contact.stiffnessExponent = {}: where such a contact opens and closes, the tolerance is \
         not promised for its friction, nor does solver.forceError tell; from {} to {} it is",
        number(*exponent), number(range.start), number(range.end)
    )]
    FrictionAtTouch { exponent: f64, range: Range<f64> },
    /// Friction with which slip is unstable.
    #[error(
        "effects.friction = Coulomb: slip {} the clamp is unstable with friction.coefficient = {} and tip.contactHeight = {} m: at \
         a contact force of {force:.2e} N its small motions grow by {growth:.2e} 1/s {}, until the contact sticks or opens. Where \
         they grow far, forces are not predictable and solver.tolerance is not kept, as solver.forceError tells; less friction or \
         height makes slip stable, more damping may",
        if *away { "away from" } else { "towards" }, number(*coefficient), number(*height), sounding(*frequency)
    )]
    UnstableSlip { away: bool, force: f64, growth: f64, frequency: f64, coefficient: f64, height: f64 },
    /// A criterion of interruptions that even an open contact does not meet.
    #[error(
        "chatter.resistanceThreshold = {} Ohm: an open contact has resistance.open = {} Ohm, so that no interruption is counted",
        number(*threshold), number(*open)
    )]
    NoInterruption { threshold: f64, open: f64 },
    /// Modes that end below what an impact excites.
    #[error(
        "{name} = {file}: its modes end at {highest:.0} Hz, an impact of the contact excites the spring up to {reached:.0} Hz; \
         forces of impacts, and what rings on after them, are right only as far as the modes reach"
    )]
    FewModes { name: &'static str, file: String, highest: f64, reached: f64 },
}

impl SceneError {
    pub(crate) fn out_of_range(name: &'static str, value: f64, unit: &'static str, allowed: &str) -> Self {
        Self::OutOfRange { name, value, unit, allowed: format!("allowed is {allowed}") }
    }
}

/// A number in a message: with an exponent where that is shorter, below 1e-4 and from 1e16 on.
pub(crate) fn number(value: f64) -> String {
    let mut text = format!("{value:?}");
    if text.ends_with(".0") {
        text.truncate(text.len() - 2);
    }
    text
}

/// How a growing motion sounds, at this frequency (Hz).
fn sounding(frequency: f64) -> String {
    if frequency > 0.0 { format!("at {frequency:.2e} Hz") } else { "without vibration".to_owned() }
}

fn meant(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |name| format!("; did you mean {name}?"))
}

/// An error of a file as `FILE:LINE: ERROR`, as editors and compilers have it.
fn in_file(file: &str, error: &SceneError) -> String {
    match error {
        SceneError::AtLine { line, error } => format!("{file}:{line}: {error}"),
        error => format!("{file}: {error}"),
    }
}

fn spaced(unit: &str) -> String {
    match unit {
        "" | "1" => String::new(),
        unit => format!(" {unit}"),
    }
}

/// A communication step that could not be integrated. The state remains that before the step.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("integration stopped at t = {} s: {cause}", number(*time))]
pub struct StepError {
    /// The time reached, s.
    pub time: f64,
    /// The cause.
    pub cause: StepErrorCause,
}

/// Why a communication step could not be integrated.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages tell what the fields are")]
pub enum StepErrorCause {
    /// A step size that is not a positive finite number.
    #[error("the communication step size must be positive and finite")]
    StepSize,
    /// More integration steps than allowed within a communication step.
    #[error("one communication step takes too many integration steps; use shorter communication steps")]
    Budget,
    /// A time so large that the spacing of floating-point numbers exceeds what the motion or the communication step needs.
    #[error("the floating-point spacing of time is {spacing:e} s, allowed is {allowed:e} s")]
    Resolution { spacing: f64, allowed: f64 },
    /// A body that an input moves faster than light.
    #[error("{input} would move at {speed:e} m/s, allowed is the speed of light")]
    Speed { input: &'static str, speed: f64 },
    /// Two fixed contacts that touch.
    #[error("second.displacement = {} m brings the second fixed contact to the first, allowed is less than {} m", number(*displacement), number(*limit))]
    NoRoom { displacement: f64, limit: f64 },
    /// A number in the state is no longer finite.
    #[error("the state is no longer finite")]
    NotFinite,
}

/// What `body` returns, or the text of its panic.
pub(crate) fn caught<T>(body: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(body)).map_err(|panic| {
        let text = panic.downcast_ref::<&str>().map(ToString::to_string);
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
        text.unwrap_or_else(|| "panic".to_owned())
    })
}
