//! Values of the string parameter by number, as calls hold them: files that are springs, and others.

use std::ffi::{CStr, CString};
use std::path::Path;
use std::sync::LazyLock;

/// Numbers of the texts that are allowed.
pub const ALLOWED: [f64; 3] = [0.0, 1.0, 2.0];

static TEXTS: LazyLock<Vec<CString>> = LazyLock::new(|| {
    let springs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/springs");
    let in_springs = |name: &str| springs.join(name).to_string_lossy().into_owned().into_bytes();
    let texts = [
        b"".to_vec(),
        in_springs("tapered-cube.toml"),
        in_springs("tapered-cube-modes.toml"),
        // Not allowed: nothing there, a folder, no springs, no text, too long, relative to no resources.
        in_springs("none.toml"),
        in_springs(""),
        in_springs("../at-rest.toml"),
        b"/dev/zero".to_vec(),
        b"/tmp/\xff\xfe%s%n".to_vec(),
        vec![b'/'; 100_000],
        b"tapered-cube.toml".to_vec(),
    ];
    texts.map(|text| CString::new(text).expect("no zero inside")).to_vec()
});

/// The text of a number; numbers that are not allowed have one of the others.
pub fn text(number: f64) -> &'static CStr {
    let others = TEXTS.len() - ALLOWED.len();
    let known = ALLOWED.iter().position(|allowed| *allowed == number);
    #[allow(clippy::cast_possible_truncation)] // any of them
    let other = ALLOWED.len() + (number.to_bits() >> 40) as usize % others;
    &TEXTS[known.unwrap_or(other)]
}

/// The number of a text that is allowed.
pub fn number(text: &CStr) -> f64 {
    let known = TEXTS.iter().zip(ALLOWED).find(|(known, _)| known.as_c_str() == text);
    known.map_or(f64::NAN, |(_, number)| number)
}
