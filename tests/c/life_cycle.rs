//! A C program uses the library through the generated header: it must compile without a warning, link and run.

use crate::program;

#[test]
fn a_c_program_lives_a_full_life_with_two_instances() {
    let compiled = program::compile("tests/c/life_cycle.c");
    let ran = program::command(&compiled).output().unwrap();
    let said = String::from_utf8_lossy(&ran.stdout);
    assert!(ran.status.success(), "{said}{}", String::from_utf8_lossy(&ran.stderr));
    assert!(said.contains("life cycle passed"), "{said}");
}
