//! Checksums as `sha256sum --check` reads them.

use std::fmt::Write;

use sha2::{Digest, Sha256};

use crate::package::Files;

/// One line for each file: its SHA-256 and its path.
pub fn text(files: &Files) -> String {
    let line = |(path, contents): (&String, &Vec<u8>)| format!("{}  {path}\n", hexadecimal(&Sha256::digest(contents)));
    files.iter().map(line).collect()
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        _ = write!(text, "{byte:02x}"); // Writing to a text cannot fail.
        text
    })
}

#[cfg(test)]
mod tests {
    use std::process::Command;
    use std::{env, fs, process};

    use anyhow::Result;

    use super::*;

    /// The example "abc" of FIPS 180-4.
    #[test]
    fn a_line_is_the_digest_and_the_path() {
        let files = Files::from([("lib/a.so".to_owned(), b"abc".to_vec())]);
        let digest = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(text(&files), format!("{digest}  lib/a.so\n"));
    }

    #[test]
    #[cfg_attr(not(target_os = "linux"), ignore = "sha256sum belongs to Linux")]
    fn sha256sum_accepts_the_files_and_refuses_a_changed_one() -> Result<()> {
        let folder = env::temp_dir().join(format!("relay-contact-sums-{}", process::id()));
        fs::create_dir_all(&folder)?;
        let files = Files::from(["RelayContact.fmu", "relay_contact.h"].map(|name| (name.to_owned(), name.into())));
        for (name, contents) in &files {
            fs::write(folder.join(name), contents)?;
        }
        fs::write(folder.join("SHA256SUMS"), text(&files))?;
        let check = || {
            let mut program = Command::new("sha256sum");
            program
                .args(["--check", "--strict", "SHA256SUMS"])
                .current_dir(&folder)
                .output()
        };
        let accepted = check()?;
        assert_eq!(
            String::from_utf8(accepted.stdout)?,
            "RelayContact.fmu: OK\nrelay_contact.h: OK\n"
        );
        assert!(accepted.status.success());
        fs::write(folder.join("relay_contact.h"), "changed")?;
        assert!(!check()?.status.success());
        Ok(fs::remove_dir_all(folder)?)
    }
}
