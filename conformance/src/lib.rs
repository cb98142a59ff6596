//! The C interface compared with the official headers, by the compiler: this file compiles or the types differ.
//!
//! The other side is the crate `fmi`, whose types bindgen makes from the headers of the standard. Building it needs
//! libclang (`LIBCLANG_PATH`: its folder) and, where only the bare library is installed, the folder of the C compiler's own
//! headers (`BINDGEN_EXTRA_CLANG_ARGS=-I$(cc -print-file-name=include)`). `cargo xtask test` sets both.
#![cfg(feature = "types")]
#![allow(non_camel_case_types)]

use fmi::fmi2::binding as official;
use relay_contact::fmi2 as ours;

/// A function has the official type, argument by argument: an assignment does not compile otherwise.
macro_rules! has_official_type {
    ($($function:ident: $type:ident,)*) => { $(const _: official::$type = Some(ours::$function);)* };
}

has_official_type! {
    fmi2GetTypesPlatform: fmi2GetTypesPlatformTYPE,
    fmi2GetVersion: fmi2GetVersionTYPE,
    fmi2SetDebugLogging: fmi2SetDebugLoggingTYPE,
    fmi2FreeInstance: fmi2FreeInstanceTYPE,
    fmi2SetupExperiment: fmi2SetupExperimentTYPE,
    fmi2EnterInitializationMode: fmi2EnterInitializationModeTYPE,
    fmi2ExitInitializationMode: fmi2ExitInitializationModeTYPE,
    fmi2Terminate: fmi2TerminateTYPE,
    fmi2Reset: fmi2ResetTYPE,
    fmi2GetReal: fmi2GetRealTYPE,
    fmi2GetInteger: fmi2GetIntegerTYPE,
    fmi2GetBoolean: fmi2GetBooleanTYPE,
    fmi2GetString: fmi2GetStringTYPE,
    fmi2SetReal: fmi2SetRealTYPE,
    fmi2SetInteger: fmi2SetIntegerTYPE,
    fmi2SetBoolean: fmi2SetBooleanTYPE,
    fmi2SetString: fmi2SetStringTYPE,
    fmi2GetFMUstate: fmi2GetFMUstateTYPE,
    fmi2SetFMUstate: fmi2SetFMUstateTYPE,
    fmi2FreeFMUstate: fmi2FreeFMUstateTYPE,
    fmi2SerializedFMUstateSize: fmi2SerializedFMUstateSizeTYPE,
    fmi2SerializeFMUstate: fmi2SerializeFMUstateTYPE,
    fmi2DeSerializeFMUstate: fmi2DeSerializeFMUstateTYPE,
    fmi2GetDirectionalDerivative: fmi2GetDirectionalDerivativeTYPE,
    fmi2SetRealInputDerivatives: fmi2SetRealInputDerivativesTYPE,
    fmi2GetRealOutputDerivatives: fmi2GetRealOutputDerivativesTYPE,
    fmi2DoStep: fmi2DoStepTYPE,
    fmi2CancelStep: fmi2CancelStepTYPE,
    fmi2GetStatus: fmi2GetStatusTYPE,
    fmi2GetRealStatus: fmi2GetRealStatusTYPE,
    fmi2GetIntegerStatus: fmi2GetIntegerStatusTYPE,
    fmi2GetBooleanStatus: fmi2GetBooleanStatusTYPE,
    fmi2GetStringStatus: fmi2GetStringStatusTYPE,
}

/// The last of the 34, `fmi2Instantiate`, but for the struct of callbacks, which each side declares for itself.
type Instantiate<Callbacks> = Option<
    unsafe extern "C" fn(
        official::fmi2String,
        official::fmi2Type,
        official::fmi2String,
        official::fmi2String,
        *const Callbacks,
        official::fmi2Boolean,
        official::fmi2Boolean,
    ) -> official::fmi2Component,
>;
const _: Instantiate<ours::fmi2CallbackFunctions> = Some(ours::fmi2Instantiate);
const _: fn(official::fmi2InstantiateTYPE) -> Instantiate<official::fmi2CallbackFunctions> = |function| function;

/// The callbacks have the same members of the same types in the same places.
macro_rules! same_members {
    ($($member:ident),*) => {
        const _: fn(official::fmi2CallbackFunctions) -> ours::fmi2CallbackFunctions = |callbacks| {
            let official::fmi2CallbackFunctions { $($member),* } = callbacks;
            ours::fmi2CallbackFunctions { $($member),* }
        };
        const _: () = { $(
            assert!(
                std::mem::offset_of!(ours::fmi2CallbackFunctions, $member)
                    == std::mem::offset_of!(official::fmi2CallbackFunctions, $member)
            );
        )* };
    };
}

same_members!(logger, allocateMemory, freeMemory, stepFinished, componentEnvironment);

const _: () = {
    assert!(size_of::<ours::fmi2CallbackFunctions>() == size_of::<official::fmi2CallbackFunctions>());
    assert!(align_of::<ours::fmi2CallbackFunctions>() == align_of::<official::fmi2CallbackFunctions>());
};

/// The values of the enumerations are the same.
const _: () = {
    assert!(ours::fmi2OK == official::fmi2Status_fmi2OK);
    assert!(ours::fmi2Warning == official::fmi2Status_fmi2Warning);
    assert!(ours::fmi2Discard == official::fmi2Status_fmi2Discard);
    assert!(ours::fmi2Error == official::fmi2Status_fmi2Error);
    assert!(ours::fmi2Fatal == official::fmi2Status_fmi2Fatal);
    assert!(ours::fmi2Pending == official::fmi2Status_fmi2Pending);
    assert!(ours::fmi2ModelExchange == official::fmi2Type_fmi2ModelExchange);
    assert!(ours::fmi2CoSimulation == official::fmi2Type_fmi2CoSimulation);
    assert!(ours::fmi2DoStepStatus == official::fmi2StatusKind_fmi2DoStepStatus);
    assert!(ours::fmi2PendingStatus == official::fmi2StatusKind_fmi2PendingStatus);
    assert!(ours::fmi2LastSuccessfulTime == official::fmi2StatusKind_fmi2LastSuccessfulTime);
    assert!(ours::fmi2Terminated == official::fmi2StatusKind_fmi2Terminated);
    assert!(ours::fmi2True.unsigned_abs() == official::fmi2True);
    assert!(ours::fmi2False.unsigned_abs() == official::fmi2False);
};
