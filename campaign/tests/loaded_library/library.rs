//! The library file under test.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::PathBuf;
use std::sync::LazyLock;

use campaign::api::Api;

/// The dynamic library, which cargo builds beside the test.
pub fn path() -> PathBuf {
    let test = std::env::current_exe().unwrap();
    test.with_file_name(format!("{DLL_PREFIX}relay_contact{DLL_SUFFIX}"))
}

/// Its functions.
pub static LIBRARY: LazyLock<Api> = LazyLock::new(|| {
    let path = path();
    Api::load(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
});
