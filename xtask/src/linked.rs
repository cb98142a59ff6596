//! The crates linked into the component.

use std::collections::{BTreeMap, BTreeSet};

use crate::commands::{cargo, output, root};
use anyhow::{Context, Result};
use cargo_metadata::{Metadata, MetadataCommand, Package};

/// What cargo knows about the project.
pub fn metadata() -> Result<Metadata> {
    Ok(MetadataCommand::new().current_dir(root()).exec()?)
}

/// The component itself among the crates.
pub const COMPONENT: &str = "relay-contact";

/// Name and version of a crate.
pub type Crate = (String, String);

/// A crate that is linked.
pub struct Linked<'a> {
    /// Its metadata from cargo.
    pub package: &'a Package,
    /// Its direct dependencies.
    pub uses: BTreeSet<Crate>,
}

/// All of them, the component included.
pub type Crates<'a> = BTreeMap<Crate, Linked<'a>>;

/// Finds them. `targets` are the target triples; empty for this machine. `cargo tree` is used because, unlike `cargo
/// metadata`, it resolves features for this package only.
pub fn crates<'a>(metadata: &'a Metadata, targets: &[&str]) -> Result<Crates<'a>> {
    let mut tree = cargo();
    tree.args(["tree", "--edges=normal,no-proc-macro", "--prefix=depth", "--format={p}"]);
    tree.arg(format!("--package={COMPONENT}"));
    for target in targets {
        tree.args(["--target", target]);
    }
    let mut crates = Crates::new();
    let mut above: Vec<Crate> = Vec::new();
    // A tree for each platform, an empty line between them.
    for line in output(&mut tree)?.lines().filter(|line| !line.is_empty()) {
        let (depth, name, version) =
            parts(line).with_context(|| format!("cannot read a line of cargo tree: {line}"))?;
        let crate_ = (name.to_owned(), version.to_owned());
        above.truncate(depth);
        if let Some(user) = above.last().and_then(|user| crates.get_mut(user)) {
            user.uses.insert(crate_.clone());
        }
        if !crates.contains_key(&crate_) {
            let mut known = metadata.packages.iter();
            let package = known.find(|known| known.name.as_str() == name && known.version.to_string() == version);
            let package = package.with_context(|| format!("cargo metadata does not know {name} {version}"))?;
            let uses = BTreeSet::new();
            crates.insert(crate_.clone(), Linked { package, uses });
        }
        above.push(crate_);
    }
    Ok(crates)
}

/// Depth, name and version in a line such as `2csv-core v0.1.13 (*)`.
fn parts(line: &str) -> Option<(usize, &str, &str)> {
    let (depth, crate_) = line.split_at(line.find(|c: char| !c.is_ascii_digit())?);
    let mut words = crate_.split(' ');
    Some((depth.parse().ok()?, words.next()?, words.next()?.strip_prefix('v')?))
}
