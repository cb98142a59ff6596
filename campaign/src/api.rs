//! The 34 functions of FMI 2.0 for co-simulation, with the types of the standard.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::Path;
use std::sync::LazyLock;

use libloading::Library;
use relay_contact::fmi2::*;

/// The dynamic library that cargo has built beside this program, or beside the tests.
pub static LIBRARY: LazyLock<Api> = LazyLock::new(|| {
    let program = std::env::current_exe().expect("a program");
    let folder = program.parent().expect("a folder");
    let name = format!("{DLL_PREFIX}relay_contact{DLL_SUFFIX}");
    let path = if folder.ends_with("deps") { folder.join(name) } else { folder.join("deps").join(name) };
    Api::load(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
});

/// `size_t` of C.
type Size = usize;

macro_rules! functions {
    ($($name:ident($($argument:ty),*) -> $result:ty;)*) => {
        /// The functions by their C names.
        #[allow(non_snake_case, missing_docs)]
        #[derive(Debug)]
        pub struct Api {
            $(pub $name: unsafe extern "C" fn($($argument),*) -> $result,)*
            /// Keeps the library loaded.
            _library: Option<Library>,
        }

        impl Api {
            /// The functions of the library linked into this program.
            pub fn linked() -> Self {
                Self { $($name: relay_contact::fmi2::$name,)* _library: None }
            }

            /// The functions of a library file.
            pub fn load(path: &Path) -> Result<Self, libloading::Error> {
                // SAFETY: the component does nothing on loading; names and types are those of the standard.
                unsafe {
                    let library = Library::new(path)?;
                    Ok(Self { $($name: *library.get(concat!(stringify!($name), "\0"))?,)* _library: Some(library) })
                }
            }
        }
    };
}

functions! {
    fmi2GetTypesPlatform() -> fmi2String;
    fmi2GetVersion() -> fmi2String;
    fmi2SetDebugLogging(fmi2Component, fmi2Boolean, Size, *const fmi2String) -> fmi2Status;
    fmi2Instantiate(fmi2String, fmi2Type, fmi2String, fmi2String, *const fmi2CallbackFunctions, fmi2Boolean, fmi2Boolean) -> fmi2Component;
    fmi2FreeInstance(fmi2Component) -> ();
    fmi2SetupExperiment(fmi2Component, fmi2Boolean, fmi2Real, fmi2Real, fmi2Boolean, fmi2Real) -> fmi2Status;
    fmi2EnterInitializationMode(fmi2Component) -> fmi2Status;
    fmi2ExitInitializationMode(fmi2Component) -> fmi2Status;
    fmi2Terminate(fmi2Component) -> fmi2Status;
    fmi2Reset(fmi2Component) -> fmi2Status;
    fmi2GetReal(fmi2Component, *const fmi2ValueReference, Size, *mut fmi2Real) -> fmi2Status;
    fmi2GetInteger(fmi2Component, *const fmi2ValueReference, Size, *mut fmi2Integer) -> fmi2Status;
    fmi2GetBoolean(fmi2Component, *const fmi2ValueReference, Size, *mut fmi2Boolean) -> fmi2Status;
    fmi2GetString(fmi2Component, *const fmi2ValueReference, Size, *mut fmi2String) -> fmi2Status;
    fmi2SetReal(fmi2Component, *const fmi2ValueReference, Size, *const fmi2Real) -> fmi2Status;
    fmi2SetInteger(fmi2Component, *const fmi2ValueReference, Size, *const fmi2Integer) -> fmi2Status;
    fmi2SetBoolean(fmi2Component, *const fmi2ValueReference, Size, *const fmi2Boolean) -> fmi2Status;
    fmi2SetString(fmi2Component, *const fmi2ValueReference, Size, *const fmi2String) -> fmi2Status;
    fmi2GetFMUstate(fmi2Component, *mut fmi2FMUstate) -> fmi2Status;
    fmi2SetFMUstate(fmi2Component, fmi2FMUstate) -> fmi2Status;
    fmi2FreeFMUstate(fmi2Component, *mut fmi2FMUstate) -> fmi2Status;
    fmi2SerializedFMUstateSize(fmi2Component, fmi2FMUstate, *mut Size) -> fmi2Status;
    fmi2SerializeFMUstate(fmi2Component, fmi2FMUstate, *mut fmi2Byte, Size) -> fmi2Status;
    fmi2DeSerializeFMUstate(fmi2Component, *const fmi2Byte, Size, *mut fmi2FMUstate) -> fmi2Status;
    fmi2GetDirectionalDerivative(fmi2Component, *const fmi2ValueReference, Size, *const fmi2ValueReference, Size, *const fmi2Real, *mut fmi2Real) -> fmi2Status;
    fmi2SetRealInputDerivatives(fmi2Component, *const fmi2ValueReference, Size, *const fmi2Integer, *const fmi2Real) -> fmi2Status;
    fmi2GetRealOutputDerivatives(fmi2Component, *const fmi2ValueReference, Size, *const fmi2Integer, *mut fmi2Real) -> fmi2Status;
    fmi2DoStep(fmi2Component, fmi2Real, fmi2Real, fmi2Boolean) -> fmi2Status;
    fmi2CancelStep(fmi2Component) -> fmi2Status;
    fmi2GetStatus(fmi2Component, fmi2StatusKind, *mut fmi2Status) -> fmi2Status;
    fmi2GetRealStatus(fmi2Component, fmi2StatusKind, *mut fmi2Real) -> fmi2Status;
    fmi2GetIntegerStatus(fmi2Component, fmi2StatusKind, *mut fmi2Integer) -> fmi2Status;
    fmi2GetBooleanStatus(fmi2Component, fmi2StatusKind, *mut fmi2Boolean) -> fmi2Status;
    fmi2GetStringStatus(fmi2Component, fmi2StatusKind, *mut fmi2String) -> fmi2Status;
}
