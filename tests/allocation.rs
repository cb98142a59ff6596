//! A time step, and setting and reading around it, allocates nothing.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::ffi::CString;
use std::ptr;

use relay_contact::fmi2::*;
use relay_contact::variables::{ExcitationKind, GUID, Variable};

/// The system's allocator, which counts what this thread asks for.
struct Counting;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: every call goes to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.set(COUNT.get() + 1);
        // SAFETY: passed on to the caller.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        COUNT.set(COUNT.get() + 1);
        // SAFETY: passed on to the caller.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// With every choice of `effects.excitation`.
#[test]
fn a_communication_step_allocates_nothing() {
    for &(_, excitation) in ExcitationKind::CHOICES {
        check(excitation);
    }
}

fn check(excitation: i32) {
    let guid = CString::new(GUID).unwrap();
    let silent = fmi2CallbackFunctions {
        logger: None,
        allocateMemory: None,
        freeMemory: None,
        stepFinished: None,
        componentEnvironment: ptr::null_mut(),
    };
    let references =
        ["base.acceleration", "contact.current"].map(|name| Variable::by_name(name).unwrap().value_reference);
    let outputs = ["contact.force", "contact.resistance"].map(|name| Variable::by_name(name).unwrap().value_reference);
    let mut values = [f64::NAN; 2];
    // SAFETY: pointers to what is declared here, with its length.
    unsafe {
        let c = fmi2Instantiate(
            c"relay".as_ptr(),
            fmi2CoSimulation,
            guid.as_ptr(),
            ptr::null(),
            &raw const silent,
            0,
            0,
        );
        let kind = Variable::by_name("effects.excitation").unwrap().value_reference;
        assert_eq!(fmi2SetInteger(c, &raw const kind, 1, &raw const excitation), fmi2OK);
        let energy = Variable::by_name("effects.energy").unwrap().value_reference;
        assert_eq!(fmi2SetBoolean(c, &raw const energy, 1, [fmi2True].as_ptr()), fmi2OK);
        assert_eq!(fmi2EnterInitializationMode(c), fmi2OK);
        assert_eq!(fmi2ExitInitializationMode(c), fmi2OK);
        let before = COUNT.get();
        assert!(before > 0, "nothing is counted");
        for n in 0..1000 {
            let time = f64::from(n) * 1e-5;
            // A square wave of 204 g: the contact opens and bounces.
            let acceleration = if n % 100 < 50 { 2000.0 } else { -2000.0 };
            assert_eq!(
                fmi2SetReal(c, references.as_ptr(), 2, [acceleration, 0.1].as_ptr()),
                fmi2OK
            );
            assert_eq!(fmi2DoStep(c, time, 1e-5, fmi2True), fmi2OK);
            assert_eq!(fmi2GetReal(c, outputs.as_ptr(), 2, values.as_mut_ptr()), fmi2OK);
        }
        assert_eq!(COUNT.get(), before, "allocated in a step");
        let opening = Variable::by_name("contact.lastOpening").unwrap().value_reference;
        assert_eq!(fmi2GetReal(c, &raw const opening, 1, values.as_mut_ptr()), fmi2OK);
        assert!(values[0] > 0.0, "the contact never opened: events are not covered");
        fmi2FreeInstance(c);
    }
}
