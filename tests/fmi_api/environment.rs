//! Hosts with another floating-point environment: traps on, other roundings, small numbers flushed to zero. The component
//! must neither die nor give other bits, and must leave the environment as it was.

use std::arch::asm;

use relay_contact::fmi2::fmi2OK;
use relay_contact::scene::file::SceneFile;
use relay_contact::variables::{Group, VARIABLES};
use testing::instance::Instance;
use testing::scenes;

/// Control words: of SSE, all exceptions trapped, rounding down, up and to zero, subnormals flushed to zero.
#[cfg(target_arch = "x86_64")]
const ENVIRONMENTS: [u64; 6] = [0x1f80, 0x0000, 0x3f80, 0x5f80, 0x7f80, 0x9fc0];
/// Control words: of FPCR, rounding up, down and to zero, subnormals flushed to zero; few processors have traps.
#[cfg(target_arch = "aarch64")]
const ENVIRONMENTS: [u64; 5] = [0, 0x40_0000, 0x80_0000, 0xc0_0000, 0x100_0000];

/// Exceptions that have occurred, in the control word.
#[cfg(target_arch = "x86_64")]
const OCCURRED: u64 = 0x3f;
#[cfg(target_arch = "aarch64")]
const OCCURRED: u64 = 0;

#[cfg(target_arch = "x86_64")]
fn exchange(next: u64) -> u64 {
    let (next, mut now) = (u32::try_from(next).unwrap(), 0_u32);
    unsafe { asm!("stmxcsr [{}]", "ldmxcsr [{}]", in(reg) &raw mut now, in(reg) &raw const next) };
    now.into()
}

#[cfg(target_arch = "aarch64")]
fn exchange(next: u64) -> u64 {
    let now;
    unsafe { asm!("mrs {}, fpcr", "msr fpcr, {}", out(reg) now, in(reg) next) };
    now
}

/// One call as a host with this environment makes it.
#[inline(never)]
fn within<T>(environment: u64, call: impl FnOnce() -> T) -> T {
    let own = exchange(environment);
    let result = call();
    let left = exchange(own);
    assert_eq!(left & !OCCURRED, environment, "the environment was changed");
    result
}

/// All real outputs after some communication steps of a scene.
fn outputs(file: &SceneFile, environment: u64) -> Vec<u64> {
    let fmu = within(environment, Instance::new);
    within(environment, || fmu.set_scene(&file.scene));
    let steps: Vec<_> = file.steps().take(1500).collect();
    within(environment, || fmu.initialize());
    let mut bits = Vec::new();
    for (k, &(time, size)) in steps.iter().enumerate() {
        let inputs = file.inputs_over(time, size).unwrap();
        within(environment, || fmu.set_inputs(&inputs));
        assert_eq!(within(environment, || fmu.step(time, size)), fmi2OK, "{:?}", fmu.messages());
        if k % 10 == 0 {
            for variable in VARIABLES.iter().filter(|variable| matches!(variable.group, Group::RealOutput(_))) {
                let [value] = within(environment, || fmu.reals_of([variable.value_reference]));
                bits.push(value.to_bits());
            }
        }
    }
    bits
}

#[test]
fn every_scene_has_the_same_bits_in_every_environment() {
    for path in scenes::files() {
        let file = SceneFile::read(&path).unwrap();
        let [usual, others @ ..] = ENVIRONMENTS;
        let expected = outputs(&file, usual);
        for environment in others {
            assert!(outputs(&file, environment) == expected, "{path:?} in {environment:#x}");
        }
    }
}
