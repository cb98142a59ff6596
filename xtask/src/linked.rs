//! The crates linked into the component, for its licences and its bill of materials.
//!
//! cargo-about and cargo-cyclonedx are not used: both take minutes to install, list crates that only macros or other
//! packages of the project need, and leave out the standard library. The first replaces some crates' licence files by a
//! common text, the second writes no CycloneDX 1.6.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

use crate::commands::{cargo, output, root};
use anyhow::{Context, Result};
use cargo_metadata::{Metadata, MetadataCommand, Package};

/// What cargo knows about the project, asked once.
pub fn metadata() -> Result<&'static Metadata> {
    static KNOWN: OnceLock<Metadata> = OnceLock::new();
    if let Some(known) = KNOWN.get() {
        return Ok(known);
    }
    let metadata = MetadataCommand::new().current_dir(root()).exec()?;
    Ok(KNOWN.get_or_init(|| metadata))
}

/// The component itself among the crates.
pub const COMPONENT: &str = "relay-contact";

/// A crate that is linked.
pub struct Linked {
    /// Its metadata from cargo.
    pub package: &'static Package,
    /// Its direct dependencies.
    pub uses: BTreeSet<String>,
}

/// All of them, the component included, as `name@version`.
pub type Crates = BTreeMap<String, Linked>;

/// Finds them. `targets` are the target triples; empty for this machine. `cargo tree` is used because, unlike `cargo
/// metadata`, it resolves features for this package only.
pub fn crates(targets: &[&str]) -> Result<Crates> {
    let metadata = metadata()?;
    let mut tree = cargo();
    tree.args(["tree", "--prefix=depth", "--format= {p}"]);
    tree.args(["--edges=normal,no-proc-macro", "--package", COMPONENT]);
    for target in targets {
        tree.args(["--target", target]);
    }
    let mut crates = Crates::new();
    let mut above: Vec<String> = Vec::new();
    // A tree for each platform, an empty line between them.
    for line in output(&mut tree)?.lines().filter(|line| !line.is_empty()) {
        let (depth, crate_) = parts(line).with_context(|| format!("cannot read a line of cargo tree: {line}"))?;
        let mut known = metadata.packages.iter();
        let package = known.find(|known| format!("{}@{}", known.name, known.version) == crate_);
        let package = package.with_context(|| format!("cargo metadata does not know {crate_}"))?;
        above.truncate(depth);
        if let Some(user) = above.last().and_then(|user| crates.get_mut(user)) {
            user.uses.insert(crate_.clone());
        }
        let uses = BTreeSet::new();
        crates.entry(crate_.clone()).or_insert(Linked { package, uses });
        above.push(crate_);
    }
    Ok(crates)
}

/// Depth and crate in a line such as `2 csv-core v0.1.13 (*)`.
fn parts(line: &str) -> Option<(usize, String)> {
    let mut words = line.split(' ');
    let (depth, name, version) = (words.next()?, words.next()?, words.next()?);
    Some((depth.parse().ok()?, format!("{name}@{}", version.strip_prefix('v')?)))
}
