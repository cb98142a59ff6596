//! Creating and freeing instances repeatedly does not leak memory. Alone in its process, as the memory of the whole
//! process is measured.
#![cfg(target_os = "linux")]

use campaign::api::LIBRARY;
use campaign::call::Call;
use campaign::judge::Judge;

/// Private resident memory of this process, bytes.
fn resident() -> u64 {
    let statm = std::fs::read_to_string("/proc/self/statm").unwrap();
    let pages: u64 = statm.split_whitespace().nth(1).unwrap().parse().unwrap();
    pages * 4096
}

/// A complete life cycle with a saved state, its bytes, an error and a reset.
fn live() {
    let [enter, exit] = Call::INITIALISE;
    let life = [
        enter,
        exit,
        Call::step(1e-5),
        Call::save(0),
        Call::serialize(0),
        Call::deserialize(0),
        Call::step(-1.0),
        Call::restore(0),
        Call::step(1e-5),
        Call::Reset,
        Call::Renew,
    ];
    Judge::new(&LIBRARY).run(&life).unwrap();
}

#[test]
fn a_thousand_instances_made_and_freed_leave_nothing_behind() {
    let thousand = || (0..1000).for_each(|_| live());
    thousand();
    let before = resident();
    thousand();
    let grown = resident().saturating_sub(before);
    println!("{grown} bytes more after 1000 instances, {before} before");
    // No growth is expected. The allocator grows in units of 128 KiB (M_TOP_PAD); a leak of 100 bytes in each life
    // cycle would be about as much, that of an instance or a saved state a hundred times more.
    assert!(grown <= 128 * 1024, "{grown} bytes more after 1000 instances");
}
