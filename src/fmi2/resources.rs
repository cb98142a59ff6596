//! The folder of the component's resources, from the URI of `fmi2Instantiate`, and the spring file carried in it.

use std::fs;
use std::path::{Path, PathBuf};

use crate::scene::spring_file;
use crate::variables::{GUID, PLAIN_GUID, guid_carrying};

/// Which component the GUID of `fmi2Instantiate` stands for.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Identity {
    /// Whether all numbers are Reals.
    pub(super) plain: bool,
    /// The name of the spring file that it carries in its resources.
    pub(super) spring: Option<String>,
}

impl Identity {
    /// None if the GUID is neither of this library's nor that of one of these with a spring file in the folder.
    pub(super) fn of(guid: &str, resources: Option<&Path>) -> Option<Self> {
        let own = [(GUID, false), (PLAIN_GUID, true)];
        if let Some((_, plain)) = own.into_iter().find(|(own, _)| guid == *own) {
            return Some(Self { plain, spring: None });
        }
        fs::read_dir(resources?).ok()?.flatten().find_map(|file| {
            let name = file.file_name().into_string().ok()?;
            let text = spring_file::text(&file.path()).ok()?;
            let (_, plain) = own.into_iter().find(|(own, _)| guid == guid_carrying(own, &name, &text))?;
            Some(Self { plain, spring: Some(name) })
        })
    }
}

/// The folder of a `file:` URI, or of a path, which some importers pass instead; none for another URI.
pub(super) fn folder(location: &str) -> Option<PathBuf> {
    // A single letter is a drive, and a path may have a colon.
    let in_scheme = |c: char| c.is_ascii_alphanumeric() || "+-.".contains(c);
    let uri = location.split_once(':').filter(|(scheme, _)| scheme.len() > 1 && scheme.chars().all(in_scheme));
    let path = match uri {
        None => location.to_owned(),
        Some((scheme, rest)) if scheme.eq_ignore_ascii_case("file") => {
            let path = match rest.strip_prefix("//") {
                None => rest,
                Some(rest) => {
                    let (host, path) = rest.split_at(rest.find('/').unwrap_or(rest.len()));
                    let is_here = host.is_empty() || host.eq_ignore_ascii_case("localhost");
                    is_here.then_some(path)?
                }
            };
            let path = decoded(path)?;
            // `/C:/folder`
            match path.strip_prefix('/') {
                Some(rest) if cfg!(windows) && rest.chars().nth(1) == Some(':') => rest.to_owned(),
                _ => path,
            }
        }
        Some(_) => return None,
    };
    (!path.is_empty()).then(|| PathBuf::from(path))
}

/// The text with `%20` and the like decoded; none if that is not UTF-8.
fn decoded(text: &str) -> Option<String> {
    let mut parts = text.split('%');
    let mut bytes = parts.next()?.as_bytes().to_vec();
    for part in parts {
        // A sign, which Rust would take, is no digit.
        let digits = part.get(..2).filter(|digits| digits.chars().all(|digit| digit.is_ascii_hexdigit()));
        let code = digits.and_then(|digits| u8::from_str_radix(digits, 16).ok());
        bytes.push(code.unwrap_or(b'%'));
        bytes.extend(part.bytes().skip(if code.is_some() { 2 } else { 0 }));
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uris_and_paths_lead_to_the_folder() {
        for (location, expected) in [
            ("file:///tmp/a%20b/resources", Some("/tmp/a b/resources")),
            ("file:/tmp/resources", Some("/tmp/resources")),
            ("FILE://localhost/tmp/%C3%A4", Some("/tmp/ä")),
            ("/tmp/100%/resources", Some("/tmp/100%/resources")),
            ("/tmp/12:30/resources", Some("/tmp/12:30/resources")),
            ("file:///tmp/%+5", Some("/tmp/%+5")),
            ("file:///tmp/100%/x%zz", Some("/tmp/100%/x%zz")),
            ("file://server/share", None),
            ("http://example.org/resources", None),
            ("file:///%ff", None),
            ("", None),
        ] {
            assert_eq!(folder(location), expected.map(PathBuf::from), "{location}");
        }
    }
}
