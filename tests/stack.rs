//! Hosts run components on threads with small stacks: whole lives of instances, with every effect, need less than [`BAR`].
#![cfg(target_os = "linux")]
#![allow(clippy::undocumented_unsafe_blocks)] // every block calls a C function with what it needs

use std::ffi::c_void;
use std::{panic, ptr, slice};

use relay_contact::fmi2::*;
use relay_contact::variables::{AxialForceKind, ContactLawKind, ExcitationKind};
use testing::instance::{Instance, vr};

/// Stack of a thread that makes all calls, bytes.
const BAR: usize = 32 * 1024;

/// Stack that the test gives it, so that it can tell by how much the bar is missed, bytes.
const ROOM: usize = 1 << 20;

/// What the untouched stack is filled with.
const PAINT: u8 = 0xa5;

/// What touches the spring beside the first contact.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Beside {
    Nothing,
    Friction,
    SecondContact,
}

/// A scene by its choices.
#[derive(Clone, Copy, Debug)]
pub struct Choices {
    excitation: i32,
    law: i32,
    axial_force: i32,
    beside: Beside,
    spring: &'static str,
    /// Energy, extremes and interruptions.
    watched: bool,
    tolerance: f64,
}

/// All that can be combined.
pub fn all() -> impl Iterator<Item = Choices> {
    let mut tolerances = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10].into_iter().cycle();
    let mut choices = Vec::new();
    for &(_, excitation) in ExcitationKind::CHOICES {
        for &(law_name, law) in ContactLawKind::CHOICES {
            for &(axial_name, axial_force) in AxialForceKind::CHOICES {
                for beside in [Beside::Nothing, Beside::Friction, Beside::SecondContact] {
                    for spring in ["", "tapered-cube.toml", "tapered-cube-modes.toml"] {
                        for watched in [false, true] {
                            let linear = matches!(law_name, "Linearised" | "Bonded");
                            let follows = axial_name == "FromDeflection";
                            let by_modes = spring == "tapered-cube-modes.toml";
                            let refused = linear && beside != Beside::Nothing
                                || follows && beside == Beside::Friction
                                || by_modes && (axial_name != "None" || beside == Beside::Friction);
                            if refused {
                                continue;
                            }
                            choices.push(Choices {
                                excitation,
                                law,
                                axial_force,
                                beside,
                                spring,
                                watched,
                                tolerance: tolerances.next().unwrap_or(1e-4),
                            });
                        }
                    }
                }
            }
        }
    }
    choices.into_iter()
}

/// Sets parameters, and initialises.
pub fn begin(contact: &Instance, choices: &Choices) {
    let set = |status| assert_eq!(status, fmi2OK, "{choices:?}: {:?}", contact.messages());
    set(contact.setup(Some(choices.tolerance), 0.0, Some(1.0)));
    for (name, value) in [
        ("effects.excitation", choices.excitation),
        ("effects.contactLaw", choices.law),
        ("effects.axialForce", choices.axial_force),
        ("effects.friction", if choices.beside == Beside::Friction { 2 } else { 1 }),
    ] {
        set(contact.set_integer(name, value));
    }
    for name in ["effects.energy", "effects.extremes", "effects.chatter"] {
        set(contact.set_boolean(name, choices.watched));
    }
    set(contact.set_boolean("effects.secondContact", choices.beside == Beside::SecondContact));
    let names = [
        "excitation.amplitude",
        "excitation.frequency",
        "excitation.endFrequency",
        "excitation.duration",
        "excitation.spectralDensity",
        "second.gap",
        "tip.contactHeight",
        "contact.overtravel",
        "beam.stiffnessDamping",
    ];
    set(contact.set_reals(names, [800.0, 300.0, 3000.0, 1e-3, 40.0, 5e-5, 1e-3, 1e-4, 2e-6]));
    if !choices.spring.is_empty() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/springs/");
        set(contact.set_string("beam.file", &format!("{folder}{}", choices.spring)));
    }
    set(contact.enter_initialization_mode());
    assert!(contact.real("preload.force").is_finite());
    set(contact.exit_initialization_mode());
}

/// Steps of all sizes with inputs that are held, jump, or change linearly; every output and its derivative is read.
pub fn steps(contact: &Instance, choices: &Choices, mut time: f64, note: &mut dyn FnMut(f64)) {
    for n in 0..48 {
        let size = [1e-6, 1e-6, 1e-6, 2.5e-5, 1e-5, 1e-5][n % 6];
        if n % 12 < 6 {
            let acceleration = if n % 24 < 6 { 300.0 } else { -300.0 };
            assert_eq!(contact.set_reals(["base.acceleration", "contact.current"], [acceleration, 0.1]), fmi2OK);
        }
        if n % 12 == 9 {
            let (reference, order, rate) = (vr("base.acceleration"), 1, 1e6);
            let status = unsafe { fmi2SetRealInputDerivatives(contact.component, &reference, 1, &order, &rate) };
            assert_eq!(status, fmi2OK);
        }
        let status = contact.step(time, size);
        assert_eq!(status, fmi2OK, "{choices:?} at {time}: {:?}", contact.messages());
        time += size;
        let outputs = [
            "contact.force",
            "contact.resistance",
            "contact.slip",
            "second.force",
            "energy.balance",
            "tip.velocity",
        ];
        let (references, mut rates) = (outputs.map(vr), [0.0; 6]);
        let count = references.len();
        unsafe { fmi2GetRealOutputDerivatives(contact.component, references.as_ptr(), count, [1; 6].as_ptr(), rates.as_mut_ptr()) };
        contact.reals_of(references).into_iter().chain(rates).for_each(&mut *note);
    }
}

/// Saves the instance to bytes, and sets it to the state restored from them.
pub fn save_and_restore(contact: &Instance) {
    let (component, mut state, mut again, mut size) = (contact.component, ptr::null_mut(), ptr::null_mut(), 0);
    unsafe {
        assert_eq!(fmi2GetFMUstate(component, &raw mut state), fmi2OK);
        assert_eq!(fmi2SerializedFMUstateSize(component, state, &raw mut size), fmi2OK);
        let mut bytes = vec![0; size];
        assert_eq!(fmi2SerializeFMUstate(component, state, bytes.as_mut_ptr(), size), fmi2OK);
        assert_eq!(fmi2DeSerializeFMUstate(component, bytes.as_ptr(), size, &raw mut again), fmi2OK);
        assert_eq!(fmi2SetFMUstate(component, again), fmi2OK);
        assert_eq!(fmi2FreeFMUstate(component, &raw mut state), fmi2OK);
        assert_eq!(fmi2FreeFMUstate(component, &raw mut again), fmi2OK);
    }
}

/// The life of an instance: run, saved, restored, run on; reset, restored as it was, run anew.
pub fn live(choices: &Choices, note: &mut dyn FnMut(f64)) {
    let contact = Instance::new();
    begin(&contact, choices);
    steps(&contact, choices, 0.0, note);
    save_and_restore(&contact);
    let mut state = ptr::null_mut();
    assert_eq!(unsafe { fmi2GetFMUstate(contact.component, &raw mut state) }, fmi2OK);
    let time = contact.last_successful_time().1;
    steps(&contact, choices, time, note);
    assert_eq!(contact.reset(), fmi2OK);
    assert_eq!(unsafe { fmi2SetFMUstate(contact.component, state) }, fmi2OK);
    steps(&contact, choices, time, note);
    assert_eq!(contact.reset(), fmi2OK);
    begin(&contact, choices);
}

/// How much of its stack a thread has touched in all, bytes.
pub fn touched(body: &mut (dyn FnMut() + Send)) -> usize {
    extern "C" fn run(body: *mut c_void) -> *mut c_void {
        let body = unsafe { &mut *body.cast::<&mut (dyn FnMut() + Send)>() };
        let done = panic::catch_unwind(panic::AssertUnwindSafe(body)).is_ok();
        ptr::without_provenance_mut(usize::from(done))
    }
    unsafe {
        let protection = libc::PROT_READ | libc::PROT_WRITE;
        let kind = libc::MAP_PRIVATE | libc::MAP_ANONYMOUS;
        let stack = libc::mmap(ptr::null_mut(), ROOM, protection, kind, -1, 0);
        assert_ne!(stack, libc::MAP_FAILED);
        stack.write_bytes(PAINT, ROOM);
        let (mut attributes, mut thread, mut done) = (std::mem::zeroed(), 0, ptr::null_mut());
        assert_eq!(libc::pthread_attr_init(&raw mut attributes), 0);
        assert_eq!(libc::pthread_attr_setstack(&raw mut attributes, stack, ROOM), 0);
        let mut body = body;
        let created = libc::pthread_create(&raw mut thread, &raw const attributes, run, (&raw mut body).cast());
        assert_eq!(created, 0);
        assert_eq!(libc::pthread_join(thread, &raw mut done), 0);
        let bytes = slice::from_raw_parts(stack.cast::<u8>(), ROOM);
        let untouched = bytes.iter().take_while(|byte| **byte == PAINT).count();
        libc::munmap(stack, ROOM);
        assert!(!done.is_null(), "the thread has failed");
        ROOM - untouched
    }
}

#[test]
fn every_life_takes_less_than_the_bar() {
    let none = touched(&mut || {});
    let lives = all().map(|choices| (touched(&mut || live(&choices, &mut |_| ())), choices));
    let mut lives: Vec<_> = lives.collect();
    lives.sort_by_key(|(touched, _)| *touched);
    for (touched, choices) in lives.iter().rev().take(12) {
        println!("{touched} {choices:?}");
    }
    let most = lives.last().map_or(0, |(touched, _)| *touched);
    println!("{} lives take {most} bytes at most, a thread without {none}", lives.len());
    assert!(most < BAR, "{lives:?}");
}
