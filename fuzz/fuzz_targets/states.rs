//! Bytes as a saved state: as they are, with head and checksum repaired, and as changes of a real one.
#![no_main]

use std::sync::LazyLock;

use campaign::api::Api;
use campaign::choices::Choices;
use campaign::hostile::{changed, meet, repaired, specimen};
use libfuzzer_sys::fuzz_target;

static LINKED: LazyLock<Api> = LazyLock::new(Api::linked);
static SPECIMEN: LazyLock<Vec<u8>> = LazyLock::new(|| specimen(&LINKED, &[]));

fuzz_target!(|bytes: &[u8]| {
    let Some((&way, rest)) = bytes.split_first() else {
        return
    };
    let hostile = match way % 4 {
        0 => rest.to_vec(),
        1 => {
            // The head of a real one before bytes of any length.
            let head = &SPECIMEN[..campaign::hostile::head()];
            repaired([head, rest, &[0; 4]].concat())
        }
        _ => changed(&SPECIMEN, &mut Choices::new(rest)),
    };
    if let Err(failure) = meet(&LINKED, &hostile, 2) {
        panic!("{failure}");
    }
});
