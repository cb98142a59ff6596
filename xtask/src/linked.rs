//! The crates linked into the component.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::{Context, Result};
use cargo_metadata::{Metadata, Package};

use crate::commands::{cargo, output};

/// The component itself among the crates.
pub const COMPONENT: &str = "relay-contact";

/// Name and version of a crate.
pub type Crate = (String, String);

/// Each crate, the component included, with those it uses itself; `targets` are the platforms as rustc calls them, this
/// machine's where there are none. `cargo tree` is asked because, unlike `cargo metadata`, it resolves features for this
/// one package.
pub fn graph(targets: &[&str]) -> Result<BTreeMap<Crate, BTreeSet<Crate>>> {
    let mut tree = cargo();
    tree.args(["tree", "--edges=normal,no-proc-macro", "--prefix=depth", "--format={p}"]);
    tree.arg(format!("--package={COMPONENT}"));
    for target in targets {
        tree.args(["--target", target]);
    }
    let mut graph: BTreeMap<Crate, BTreeSet<Crate>> = BTreeMap::new();
    let mut above: Vec<Crate> = Vec::new();
    // A tree for each platform, an empty line between them.
    for line in output(&mut tree)?.lines().filter(|line| !line.is_empty()) {
        let (depth, name, version) = parts(line).with_context(|| format!("cargo tree said: {line}"))?;
        let linked = (name.to_owned(), version.to_owned());
        above.truncate(depth);
        if let Some(user) = above.last() {
            graph.entry(user.clone()).or_default().insert(linked.clone());
        }
        graph.entry(linked.clone()).or_default();
        above.push(linked);
    }
    Ok(graph)
}

/// Of a line such as `2csv-core v0.1.13 (*)`.
fn parts(line: &str) -> Option<(usize, &str, &str)> {
    let (depth, crate_) = line.split_at(line.find(|c: char| !c.is_ascii_digit())?);
    let mut words = crate_.split(' ');
    Some((depth.parse().ok()?, words.next()?, words.next()?.strip_prefix('v')?))
}

/// What cargo knows about a crate.
pub fn package<'a>(metadata: &'a Metadata, (name, version): &Crate) -> Result<&'a Package> {
    metadata
        .packages
        .iter()
        .find(|package| package.name.as_str() == name && package.version.to_string() == *version)
        .with_context(|| format!("cargo metadata does not know {name} {version}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn several_platforms_give_the_crates_of_all_of_them() -> Result<()> {
        let targets = ["x86_64-pc-windows-gnu", "aarch64-apple-darwin"];
        let mut all = graph(&targets[..1])?;
        for (crate_, used) in graph(&targets[1..])? {
            all.entry(crate_).or_default().extend(used);
        }
        assert_eq!(graph(&targets)?, all);
        Ok(())
    }
}
