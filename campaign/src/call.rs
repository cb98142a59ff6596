//! A call as plain data, which can be made at any time, with a fault or without, repeated and printed.

use relay_contact::fmi2::fmi2LastSuccessfulTime;

use crate::description::{DESCRIPTION, Kind};

/// Number of slots for saved states of a sequence of calls; each slot also holds the serialized bytes.
pub const SLOTS: usize = 3;

/// What is wrong with the pointers of a call, or with the bytes of a saved state. Calls that it does not concern are made as without.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    None,
    /// The first array or pointer is null.
    FirstNull,
    /// The array of orders of a derivative is null.
    MiddleNull,
    /// The last array or pointer is null.
    LastNull,
    /// The last array or pointer is misaligned.
    Misaligned,
    /// The arrays are null, their length is the largest number.
    NullAndEndless,
    /// The arrays have the largest number as length.
    Endless,
    /// The saved state is foreign memory.
    Foreign,
    /// A bit of the bytes is flipped; its number is taken modulo their length.
    Flip(u32),
    /// The bytes are truncated; the length is taken modulo the full length.
    Cut(u32),
    /// So many bytes and one more are added.
    Longer(u8),
}

impl Fault {
    /// Each kind.
    pub const ALL: [Self; 11] = [
        Self::None,
        Self::FirstNull,
        Self::MiddleNull,
        Self::LastNull,
        Self::Misaligned,
        Self::NullAndEndless,
        Self::Endless,
        Self::Foreign,
        Self::Flip(500),
        Self::Cut(60),
        Self::Longer(0),
    ];
}

/// The communication point passed to a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Point {
    /// The time of the instance.
    Here,
    /// Off by a number of floating-point spacings.
    Rounded(i32),
    /// Off by a number of steps.
    Off(f64),
    /// This time, s.
    At(f64),
}

impl Point {
    /// The communication point, s, for an instance at `time` and a step of `size`.
    pub fn instant(self, time: f64, size: f64) -> f64 {
        match self {
            Self::Here => time,
            Self::Rounded(count) => {
                let next = |time: f64, _| if count < 0 { time.next_down() } else { time.next_up() };
                (0..count.abs()).fold(time, next)
            }
            Self::Off(steps) => time + steps * size,
            Self::At(instant) => instant,
        }
    }
}

/// A call, named as the function of the standard, with its arguments.
#[derive(Clone, Debug, PartialEq)]
pub enum Call {
    SetDebugLogging(bool, Vec<Option<String>>),
    /// Tolerance, start and stop.
    SetupExperiment(Option<f64>, f64, Option<f64>),
    EnterInitializationMode,
    ExitInitializationMode,
    Terminate,
    Reset,
    /// `fmi2FreeInstance`, which frees the saved states too, and `fmi2Instantiate`; the bytes stay.
    Renew,
    Get(Kind, Vec<u32>),
    Set(Kind, Vec<(u32, f64)>),
    /// Of a slot, as in the following.
    GetState(usize),
    SetState(usize),
    FreeState(usize),
    StateSize(usize),
    /// The bytes are stored in the slot.
    Serialize(usize),
    /// From the bytes of the slot.
    Deserialize(usize),
    DirectionalDerivative,
    /// Reference, order, value.
    SetInputDerivatives(Vec<(u32, i32, f64)>),
    /// Reference, order.
    GetOutputDerivatives(Vec<(u32, i32)>),
    /// Communication point and length of the step, s.
    DoStep(Point, f64),
    CancelStep,
    /// `fmi2GetStatus`, or the function for a type; and the kind of status it is asked for.
    Status(Option<Kind>, u32),
    /// Performed twice: set the state of the slot, set the inputs, make steps. Both must give the same bits.
    Replay {
        slot: usize,
        inputs: Vec<(u32, f64)>,
        steps: u32,
        size: f64,
    },
}

impl Call {
    /// Name of the C function.
    pub fn function(&self) -> String {
        let name = match self {
            Self::SetDebugLogging(..) => "SetDebugLogging",
            Self::SetupExperiment(..) => "SetupExperiment",
            Self::EnterInitializationMode => "EnterInitializationMode",
            Self::ExitInitializationMode => "ExitInitializationMode",
            Self::Terminate => "Terminate",
            Self::Reset => "Reset",
            Self::Renew => "FreeInstance",
            Self::Get(kind, ..) => &format!("Get{kind:?}"),
            Self::Set(kind, ..) => &format!("Set{kind:?}"),
            Self::GetState(..) => "GetFMUstate",
            Self::SetState(..) | Self::Replay { .. } => "SetFMUstate",
            Self::FreeState(..) => "FreeFMUstate",
            Self::StateSize(..) => "SerializedFMUstateSize",
            Self::Serialize(..) => "SerializeFMUstate",
            Self::Deserialize(..) => "DeSerializeFMUstate",
            Self::DirectionalDerivative => "GetDirectionalDerivative",
            Self::SetInputDerivatives(..) => "SetRealInputDerivatives",
            Self::GetOutputDerivatives(..) => "GetRealOutputDerivatives",
            Self::DoStep(..) => "DoStep",
            Self::CancelStep => "CancelStep",
            Self::Status(None, ..) => "GetStatus",
            Self::Status(Some(kind), ..) => &format!("Get{kind:?}Status"),
        };
        format!("fmi2{name}")
    }

    /// The calls of a complete initialisation.
    pub const INITIALISE: [Self; 2] = [Self::EnterInitializationMode, Self::ExitInitializationMode];

    /// Initialisation with a sine excitation of this amplitude, m/s2.
    pub fn shaken(amplitude: f64) -> [Self; 4] {
        let excitation = vec![(DESCRIPTION.reference("effects.excitation"), 2.0)];
        let amplitude = vec![(DESCRIPTION.reference("excitation.amplitude"), amplitude)];
        let [enter, exit] = Self::INITIALISE;
        [Self::Set(Kind::Integer, excitation), Self::set_reals(amplitude), enter, exit]
    }

    pub fn set_reals(values: Vec<(u32, f64)>) -> Self {
        Self::Set(Kind::Real, values)
    }

    /// A step from the time of the instance.
    pub fn step(size: f64) -> Self {
        Self::DoStep(Point::Here, size)
    }

    /// The last successful time.
    pub const TIME: Self = Self::Status(Some(Kind::Real), fmi2LastSuccessfulTime);
}
