//! A call as plain data: it can be made at any moment, repeated and printed.

use relay_contact::fmi2::fmi2LastSuccessfulTime;

use crate::description::{DESCRIPTION, Kind};

/// Saved states that a sequence of calls can hold at once; each slot has its bytes beside it.
pub const SLOTS: usize = 3;

/// What is wrong with the pointers of a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Nothing.
    None,
    /// The first array or pointer is null.
    FirstNull,
    /// The array of orders of a derivative is null.
    MiddleNull,
    /// The last array or pointer is null.
    LastNull,
    /// The last array or pointer has an address that its type cannot have.
    Misaligned,
    /// The arrays are null, their length is the largest number.
    NullAndEndless,
    /// The arrays have the largest number as length.
    Endless,
    /// The saved state is foreign memory; the room or the bytes are one too few.
    Foreign,
}

impl Fault {
    /// All that are one.
    pub const ALL: [Self; 7] = [
        Self::FirstNull,
        Self::MiddleNull,
        Self::LastNull,
        Self::Misaligned,
        Self::NullAndEndless,
        Self::Endless,
        Self::Foreign,
    ];
}

/// The instant a step is to start from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Point {
    /// Where the instance stands.
    Here,
    /// So many spacings of floating-point numbers off.
    Rounded(i32),
    /// So many steps off.
    Off(f64),
    /// This instant, s.
    At(f64),
}

impl Point {
    /// The instant, s, for an instance that stands at `time` and a step of `size`.
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

/// What happens to the bytes of a saved state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Damage {
    /// Nothing.
    None,
    /// A bit flips; counted from the start, round and round.
    Flip(u32),
    /// The bytes end early; the length counts round and round.
    Cut(u32),
    /// Bytes follow.
    Longer(u8),
}

/// The functions `fmi2Get...Status`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum StatusFunction {
    Status,
    Real,
    Integer,
    Boolean,
    String,
}

impl StatusFunction {
    /// Every one.
    pub const ALL: [Self; 5] = [Self::Status, Self::Real, Self::Integer, Self::Boolean, Self::String];
}

/// A call.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // named as the functions and arguments of the standard
pub enum Call {
    SetDebugLogging {
        on: bool,
        categories: Vec<Option<String>>,
        fault: Fault,
    },
    SetupExperiment {
        tolerance: Option<f64>,
        start: f64,
        stop: Option<f64>,
    },
    EnterInitializationMode,
    ExitInitializationMode,
    Terminate,
    Reset,
    /// `fmi2FreeInstance` and `fmi2Instantiate`; the saved states stay.
    Renew,
    Get {
        kind: Kind,
        references: Vec<u32>,
        fault: Fault,
    },
    Set {
        kind: Kind,
        values: Vec<(u32, f64)>,
        fault: Fault,
    },
    GetState {
        slot: usize,
        fault: Fault,
    },
    SetState {
        slot: usize,
        fault: Fault,
    },
    FreeState {
        slot: usize,
        fault: Fault,
    },
    StateSize {
        slot: usize,
        fault: Fault,
    },
    /// The bytes stay with the slot.
    Serialize {
        slot: usize,
        fault: Fault,
    },
    /// From the bytes of the slot.
    Deserialize {
        slot: usize,
        damage: Damage,
        fault: Fault,
    },
    DirectionalDerivative,
    /// Reference, order, value.
    SetInputDerivatives {
        values: Vec<(u32, i32, f64)>,
        fault: Fault,
    },
    /// Reference, order.
    GetOutputDerivatives {
        values: Vec<(u32, i32)>,
        fault: Fault,
    },
    DoStep {
        point: Point,
        size: f64,
    },
    CancelStep,
    Status {
        function: StatusFunction,
        kind: u32,
        fault: Fault,
    },
    /// Twice: the state of the slot set, the inputs set, steps made. Both must give the same bits.
    Replay {
        slot: usize,
        inputs: Vec<(u32, f64)>,
        steps: u32,
        size: f64,
    },
}

impl Call {
    /// Name of the C function.
    pub fn function(&self) -> &'static str {
        match self {
            Self::SetDebugLogging { .. } => "fmi2SetDebugLogging",
            Self::SetupExperiment { .. } => "fmi2SetupExperiment",
            Self::EnterInitializationMode => "fmi2EnterInitializationMode",
            Self::ExitInitializationMode => "fmi2ExitInitializationMode",
            Self::Terminate => "fmi2Terminate",
            Self::Reset => "fmi2Reset",
            Self::Renew => "fmi2FreeInstance",
            Self::Get { kind, .. } => match kind {
                Kind::Real => "fmi2GetReal",
                Kind::Integer => "fmi2GetInteger",
                Kind::Boolean => "fmi2GetBoolean",
                Kind::String => "fmi2GetString",
            },
            Self::Set { kind, .. } => match kind {
                Kind::Real => "fmi2SetReal",
                Kind::Integer => "fmi2SetInteger",
                Kind::Boolean => "fmi2SetBoolean",
                Kind::String => "fmi2SetString",
            },
            Self::GetState { .. } => "fmi2GetFMUstate",
            Self::SetState { .. } | Self::Replay { .. } => "fmi2SetFMUstate",
            Self::FreeState { .. } => "fmi2FreeFMUstate",
            Self::StateSize { .. } => "fmi2SerializedFMUstateSize",
            Self::Serialize { .. } => "fmi2SerializeFMUstate",
            Self::Deserialize { .. } => "fmi2DeSerializeFMUstate",
            Self::DirectionalDerivative => "fmi2GetDirectionalDerivative",
            Self::SetInputDerivatives { .. } => "fmi2SetRealInputDerivatives",
            Self::GetOutputDerivatives { .. } => "fmi2GetRealOutputDerivatives",
            Self::DoStep { .. } => "fmi2DoStep",
            Self::CancelStep => "fmi2CancelStep",
            Self::Status { function, .. } => match function {
                StatusFunction::Status => "fmi2GetStatus",
                StatusFunction::Real => "fmi2GetRealStatus",
                StatusFunction::Integer => "fmi2GetIntegerStatus",
                StatusFunction::Boolean => "fmi2GetBooleanStatus",
                StatusFunction::String => "fmi2GetStringStatus",
            },
        }
    }

    /// Initialisation from begin to end.
    pub const INITIALISE: [Self; 2] = [Self::EnterInitializationMode, Self::ExitInitializationMode];

    /// Initialisation of an instance that a sine of this amplitude shakes, m/s2.
    pub fn shaken(amplitude: f64) -> [Self; 4] {
        let excitation = vec![(DESCRIPTION.reference("effects.excitation"), 2.0)];
        let amplitude = vec![(DESCRIPTION.reference("excitation.amplitude"), amplitude)];
        let [enter, exit] = Self::INITIALISE;
        [
            Self::set(Kind::Integer, excitation),
            Self::set_reals(amplitude),
            enter,
            exit,
        ]
    }

    /// Reads variables, no pointer wrong, as with all below.
    pub fn get(kind: Kind, references: Vec<u32>) -> Self {
        let fault = Fault::None;
        Self::Get {
            kind,
            references,
            fault,
        }
    }

    /// Sets variables.
    pub fn set(kind: Kind, values: Vec<(u32, f64)>) -> Self {
        let fault = Fault::None;
        Self::Set { kind, values, fault }
    }

    /// Sets real variables.
    pub fn set_reals(values: Vec<(u32, f64)>) -> Self {
        Self::set(Kind::Real, values)
    }

    /// A step from where the instance stands.
    pub fn step(size: f64) -> Self {
        let point = Point::Here;
        Self::DoStep { point, size }
    }

    /// The last successful time.
    pub fn time() -> Self {
        Self::Status {
            function: StatusFunction::Real,
            kind: fmi2LastSuccessfulTime,
            fault: Fault::None,
        }
    }

    /// Saves the state.
    pub fn save(slot: usize) -> Self {
        let fault = Fault::None;
        Self::GetState { slot, fault }
    }

    /// Goes back to a saved state.
    pub fn restore(slot: usize) -> Self {
        let fault = Fault::None;
        Self::SetState { slot, fault }
    }

    /// Makes bytes of a saved state.
    pub fn serialize(slot: usize) -> Self {
        let fault = Fault::None;
        Self::Serialize { slot, fault }
    }

    /// Makes a saved state of the bytes, undamaged.
    pub fn deserialize(slot: usize) -> Self {
        let (damage, fault) = (Damage::None, Fault::None);
        Self::Deserialize { slot, damage, fault }
    }
}
