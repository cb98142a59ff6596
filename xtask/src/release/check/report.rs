//! What the checks of a library found.

use std::collections::BTreeSet;
use std::fmt::Write;

use relay_contact::C_HEADER;

/// A line of text for each check.
pub struct Report {
    /// The platform of the library, as rustc calls it.
    pub target: &'static str,
    /// The lines.
    pub text: String,
    /// The checks that failed.
    pub failed: Vec<&'static str>,
}

impl Report {
    pub fn add(&mut self, check: &'static str, found: impl AsRef<str>, allowed: impl AsRef<str>, passed: bool) {
        let (target, found) = (self.target, found.as_ref());
        let (verdict, allowed) = if passed {
            ("ok", String::new())
        } else {
            self.failed.push(check);
            ("FAILED", format!(" (allowed: {})", allowed.as_ref()))
        };
        _ = writeln!(self.text, "{target:<26} {check:<18} {verdict:<7} {found}{allowed}"); // a String takes any text
    }

    /// The format, and the processor that goes with the target.
    pub fn kind(&mut self, format: &str, is_library: bool, found: &str) {
        let expected = processor(self.target);
        let kind = if is_library { "library" } else { "no library" };
        self.add(
            "kind",
            format!("{format} {kind}, {found}"),
            format!("{format} library, {expected}"),
            is_library && found == expected,
        );
    }

    /// Exported are the functions of the C header, and nothing else.
    pub fn exports(&mut self, exported: &BTreeSet<String>) {
        let declared = declared();
        let stray: Vec<_> = exported.difference(&declared).collect();
        let missing: Vec<_> = declared.difference(exported).collect();
        let count = exported.len();
        let found = format!("{count} symbols, not declared: {}, missing: {}", listed(&stray), listed(&missing));
        let allowed = format!("the {} functions of the C header", declared.len());
        self.add("exported symbols", found, allowed, *exported == declared);
    }

    /// Every name is one of those allowed; a final `*` stands for any ending.
    pub fn only(&mut self, check: &'static str, found: &[impl AsRef<str>], allowed: &[&str]) {
        let fits = |name: &str| {
            allowed.iter().any(|pattern| match pattern.strip_suffix('*') {
                Some(start) => name.starts_with(start),
                None => name == *pattern,
            })
        };
        let passed = found.iter().all(|name| fits(name.as_ref()));
        self.add(check, listed(found), listed(allowed), passed);
    }
}

pub fn listed(names: &[impl AsRef<str>]) -> String {
    let names: Vec<_> = names.iter().map(AsRef::as_ref).collect();
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

/// The processor in a target's name.
pub fn processor(target: &str) -> &str {
    target.split('-').next().unwrap_or(target)
}

/// The functions that the C header declares.
pub fn declared() -> BTreeSet<String> {
    let code = C_HEADER.lines().filter(|line| !line.trim_start().starts_with('*'));
    code.filter_map(|line| {
        let (before, _) = line.split_once('(')?;
        let name = before.rsplit([' ', '*']).next()?;
        (name.starts_with("fmi2") || name.starts_with("relayContact")).then(|| name.to_owned())
    })
    .collect()
}
