//! Bytes choose calls, which are judged as those of the random campaign are.
#![no_main]

use std::sync::LazyLock;

use campaign::api::Api;
use campaign::random::sequence;
use libfuzzer_sys::fuzz_target;

static LINKED: LazyLock<Api> = LazyLock::new(Api::linked);

fuzz_target!(|bytes: &[u8]| {
    if let Err(failure) = sequence(&LINKED, bytes) {
        panic!("{failure}");
    }
});
