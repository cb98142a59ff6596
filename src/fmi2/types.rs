//! C types of FMI 2.0, platform "default".
//!
//! Enumerations are unsigned integers with named values, as C compilers hold them: an unknown value from C is then an
//! ordinary number, which is rejected.

use libc::{c_char, c_double, c_int, c_uint, c_void, size_t};

/// An instance of the component.
pub type fmi2Component = *mut c_void;
/// Passed back to the importer in its callbacks.
pub type fmi2ComponentEnvironment = *mut c_void;
/// A saved state of an instance.
pub type fmi2FMUstate = *mut c_void;
/// Value reference of a variable.
pub type fmi2ValueReference = c_uint;
/// Real number.
pub type fmi2Real = c_double;
/// Integer number.
pub type fmi2Integer = c_int;
/// `fmi2True` or `fmi2False`.
pub type fmi2Boolean = c_int;
/// Character.
pub type fmi2Char = c_char;
/// Null-terminated string in UTF-8.
pub type fmi2String = *const fmi2Char;
/// Byte.
pub type fmi2Byte = c_char;

/// True.
pub const fmi2True: fmi2Boolean = 1;
/// False.
pub const fmi2False: fmi2Boolean = 0;

/// Result of a call.
pub type fmi2Status = c_uint;
/// Success.
pub const fmi2OK: fmi2Status = 0;
/// Done, with a warning in the log.
pub const fmi2Warning: fmi2Status = 1;
/// Rejected and nothing changed; the instance can be used further.
pub const fmi2Discard: fmi2Status = 2;
/// Failed; the instance can only be reset or freed.
pub const fmi2Error: fmi2Status = 3;
/// All instances are unusable. Never returned by this component.
pub const fmi2Fatal: fmi2Status = 4;
/// Step pending. Never returned by this component.
pub const fmi2Pending: fmi2Status = 5;

/// Kind of component.
pub type fmi2Type = c_uint;
/// Model exchange, which this component does not offer.
pub const fmi2ModelExchange: fmi2Type = 0;
/// Co-simulation.
pub const fmi2CoSimulation: fmi2Type = 1;

/// The status values of the functions `fmi2Get...Status`.
pub type fmi2StatusKind = c_uint;
/// Status of a pending step.
pub const fmi2DoStepStatus: fmi2StatusKind = 0;
/// Message of a pending step.
pub const fmi2PendingStatus: fmi2StatusKind = 1;
/// The last successful time.
pub const fmi2LastSuccessfulTime: fmi2StatusKind = 2;
/// Whether the component asks to terminate.
pub const fmi2Terminated: fmi2StatusKind = 3;

/// Receives messages.
pub type fmi2CallbackLogger = Option<
    unsafe extern "C" fn(
        componentEnvironment: fmi2ComponentEnvironment,
        instanceName: fmi2String,
        status: fmi2Status,
        category: fmi2String,
        message: fmi2String,
        ...
    ),
>;
/// Allocates memory. Not used by this component.
pub type fmi2CallbackAllocateMemory = Option<unsafe extern "C" fn(nobj: size_t, size: size_t) -> *mut c_void>;
/// Frees memory. Not used by this component.
pub type fmi2CallbackFreeMemory = Option<unsafe extern "C" fn(obj: *mut c_void)>;
/// Called at the end of a step.
pub type fmi2StepFinished =
    Option<unsafe extern "C" fn(componentEnvironment: fmi2ComponentEnvironment, status: fmi2Status)>;

/// Callbacks of the importer.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct fmi2CallbackFunctions {
    /// Receives messages; may be null.
    pub logger: fmi2CallbackLogger,
    /// Not used.
    pub allocateMemory: fmi2CallbackAllocateMemory,
    /// Not used.
    pub freeMemory: fmi2CallbackFreeMemory,
    /// Called where a step is done, before `fmi2DoStep` returns; may be null.
    pub stepFinished: fmi2StepFinished,
    /// Passed back in every callback.
    pub componentEnvironment: fmi2ComponentEnvironment,
}
