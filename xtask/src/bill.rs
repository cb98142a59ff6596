//! The software bill of materials, as CycloneDX 1.6.

use std::collections::BTreeMap;
use std::path::Path;

use crate::commands::{command, output, read};
use anyhow::{Context, Result};
use cargo_metadata::Package;
use serde::Deserialize;
use serde_json::{Value, json};

use crate::linked::{COMPONENT, Crate, Crates};

/// The document. `rustc` is the compiler whose standard library is linked. The document has neither time nor serial
/// number, so that the same parts give the same bytes.
pub fn text(crates: &Crates, rustc: &Path) -> Result<String> {
    let digests = digests()?;
    let standard = standard_library(rustc)?;
    let standard_reference = standard["bom-ref"].clone();
    let mut component = Value::Null;
    let (mut components, mut dependencies) = (vec![standard], Vec::new());
    for (crate_, linked) in crates {
        let mut used: Vec<_> = linked.uses.iter().map(|used| json!(reference(used))).collect();
        if crate_.0 == COMPONENT {
            used.push(standard_reference.clone());
            component = described(linked.package, crate_)?;
        } else {
            components.push(foreign(linked.package, crate_, &digests)?);
        }
        dependencies.push(json!({ "ref": reference(crate_), "dependsOn": used }));
    }
    let bill = json!({
        "$schema": "http://cyclonedx.org/schema/bom-1.6.schema.json",
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "version": 1,
        "metadata": { "component": component },
        "components": components,
        "dependencies": dependencies,
    });
    Ok(serde_json::to_string_pretty(&bill)? + "\n")
}

fn reference((name, version): &Crate) -> String {
    format!("{name}@{version}")
}

fn described(package: &Package, crate_: &Crate) -> Result<Value> {
    let description = package.description.as_deref().unwrap_or_default();
    let licence = package.license.as_deref();
    let licence = licence.with_context(|| format!("crate {} states no licence", reference(crate_)))?;
    Ok(json!({
        "type": "library",
        "bom-ref": reference(crate_),
        "name": crate_.0,
        "version": crate_.1,
        "description": description.split_whitespace().collect::<Vec<_>>().join(" "),
        // Older crates separate their licences by a slash instead of an SPDX expression.
        "licenses": [{ "expression": licence.replace('/', " OR ") }],
    }))
}

/// A crate from the registry, of which the lock file has the digest.
fn foreign(package: &Package, crate_: &Crate, digests: &BTreeMap<Crate, String>) -> Result<Value> {
    let mut component = described(package, crate_)?;
    let digest = digests.get(crate_);
    let digest = digest.with_context(|| format!("Cargo.lock has no digest of {}", reference(crate_)))?;
    component["hashes"] = json!([{ "alg": "SHA-256", "content": digest }]);
    let version = crate_.1.replace('+', "%2B");
    component["purl"] = json!(format!("pkg:cargo/{}@{version}", crate_.0));
    Ok(component)
}

/// The Rust standard library has the version of its compiler.
fn standard_library(rustc: &Path) -> Result<Value> {
    let printed = output(command(rustc).args(["--version", "--verbose"]))?;
    let release = printed.lines().find_map(|line| line.strip_prefix("release: "));
    let version = release.context("rustc does not print its version")?;
    Ok(json!({
        "type": "library",
        "bom-ref": format!("rust-standard-library@{version}"),
        "name": "rust-standard-library",
        "version": version,
        "description": "The Rust standard library",
        "licenses": [{ "expression": "MIT OR Apache-2.0" }],
        "cpe": format!("cpe:2.3:a:rust-lang:rust:{version}:*:*:*:*:*:*:*"),
    }))
}

/// The SHA-256 of every crate's archive in the registry.
fn digests() -> Result<BTreeMap<Crate, String>> {
    #[derive(Deserialize)]
    struct Lock {
        package: Vec<Locked>,
    }
    #[derive(Deserialize)]
    struct Locked {
        name: String,
        version: String,
        checksum: Option<String>,
    }
    let lock: Lock = toml::from_slice(&read("Cargo.lock")?).context("cannot read Cargo.lock")?;
    let packages = lock.package.into_iter();
    let digests = packages.filter_map(|locked| Some(((locked.name, locked.version), locked.checksum?)));
    Ok(digests.collect())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::linked::{crates, metadata};
    use crate::release::platform::PLATFORMS;

    /// Compares with the direct dependencies in `Cargo.toml`.
    #[test]
    fn every_part_is_listed_once_with_its_digest_and_is_used() -> Result<()> {
        #[derive(Deserialize)]
        struct Manifest {
            dependencies: BTreeMap<String, toml::Value>,
        }
        let manifest: Manifest = toml::from_slice(&read("Cargo.toml")?)?;
        let targets: Vec<_> = PLATFORMS
            .iter()
            .flat_map(|platform| platform.targets)
            .copied()
            .collect();
        let bill: Value = serde_json::from_str(&text(&crates(&metadata()?, &targets)?, Path::new("rustc"))?)?;
        assert_eq!(bill["metadata"]["component"]["name"], COMPONENT);
        let components = bill["components"].as_array().context("no components")?;
        for name in manifest.dependencies.keys() {
            let component = components.iter().find(|component| component["name"] == name.as_str());
            let component = component.with_context(|| format!("{name} is missing"))?;
            let purl = component["purl"].as_str().context("no purl")?;
            assert!(
                purl.starts_with(&format!("pkg:cargo/{name}@")) && !purl.contains('+'),
                "{purl}"
            );
            assert!(!component["licenses"][0]["expression"].to_string().contains('/'));
            let digest = component["hashes"][0]["content"].as_str().unwrap_or_default();
            assert!(digest.len() == 64 && digest.bytes().all(|digit| digit.is_ascii_hexdigit()));
        }
        let parts: BTreeSet<_> = components.iter().map(|part| part["bom-ref"].to_string()).collect();
        assert_eq!(parts.len(), components.len(), "each once");
        let dependencies = bill["dependencies"].as_array().context("no dependencies")?;
        let lists = dependencies.iter().filter_map(|part| part["dependsOn"].as_array());
        let used: BTreeSet<_> = lists.flatten().map(ToString::to_string).collect();
        assert_eq!(
            used, parts,
            "what is used by another part is listed, and nothing else is"
        );
        Ok(())
    }
}
