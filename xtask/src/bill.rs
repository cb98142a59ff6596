//! The software bill of materials: what the component is made of, as CycloneDX 1.6.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use cargo_metadata::{Metadata, Package};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::commands::{command, output, root};
use crate::linked::{COMPONENT, Crate, graph, package};

/// The document. `rustc` is the compiler whose standard library is linked; `targets` are as for [`graph`]. It has neither
/// time nor serial number: the same parts give the same bytes.
pub fn text(metadata: &Metadata, rustc: &Path, targets: &[&str]) -> Result<String> {
    let digests = digests(&fs::read_to_string(root().join("Cargo.lock"))?)?;
    let standard = standard_library(rustc)?;
    let standard_reference = standard["bom-ref"].clone();
    let mut component = Value::Null;
    let (mut components, mut dependencies) = (vec![standard], Vec::new());
    for (crate_, used) in graph(targets)? {
        let mut used: Vec<_> = used.iter().map(|crate_| json!(reference(crate_))).collect();
        let package = package(metadata, &crate_)?;
        if crate_.0 == COMPONENT {
            used.push(standard_reference.clone());
            component = described(package, &crate_)?;
        } else {
            components.push(foreign(package, &crate_, &digests)?);
        }
        dependencies.push(json!({ "ref": reference(&crate_), "dependsOn": used }));
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
    let licence = licence.with_context(|| format!("crate {} names no licence", reference(crate_)))?;
    Ok(json!({
        "type": "library",
        "bom-ref": reference(crate_),
        "name": crate_.0,
        "version": crate_.1,
        "description": description.split_whitespace().collect::<Vec<_>>().join(" "),
        // Before SPDX had expressions, crates separated their licences by a slash.
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
    let told = output(command(rustc).args(["--version", "--verbose"]))?;
    let release = told.lines().find_map(|line| line.strip_prefix("release: "));
    let version = release.context("rustc does not tell its version")?;
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
fn digests(lock: &str) -> Result<BTreeMap<Crate, String>> {
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
    let lock: Lock = toml::from_str(lock).context("cannot read Cargo.lock")?;
    let packages = lock.package.into_iter();
    let digests = packages.filter_map(|locked| Some(((locked.name, locked.version), locked.checksum?)));
    Ok(digests.collect())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use cargo_metadata::MetadataCommand;

    use super::*;
    use crate::release::platform::PLATFORMS;

    fn metadata() -> Result<Metadata> {
        Ok(MetadataCommand::new().current_dir(root()).exec()?)
    }

    fn bill(targets: &[&str]) -> Result<Value> {
        Ok(serde_json::from_str(&text(&metadata()?, Path::new("rustc"), targets)?)?)
    }

    #[test]
    fn the_same_bytes_every_time() -> Result<()> {
        let metadata = metadata()?;
        let text = || text(&metadata, Path::new("rustc"), &[]);
        assert_eq!(text()?, text()?);
        Ok(())
    }

    /// The crates that `Cargo.toml` asks for directly are known without cargo's help.
    #[test]
    fn every_crate_of_the_manifest_is_in_it_with_its_digest() -> Result<()> {
        #[derive(Deserialize)]
        struct Manifest {
            dependencies: BTreeMap<String, toml::Value>,
        }
        let manifest: Manifest = toml::from_str(&fs::read_to_string(root().join("Cargo.toml"))?)?;
        let bill = bill(&[])?;
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
        assert!(
            !components.iter().any(|component| component["name"] == "proptest"),
            "only for tests"
        );
        Ok(())
    }

    #[test]
    fn every_part_is_reached_from_the_component_and_told_once() -> Result<()> {
        let targets: Vec<_> = PLATFORMS
            .iter()
            .flat_map(|platform| platform.targets)
            .copied()
            .collect();
        let bill = bill(&targets)?;
        let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let mut reached = BTreeSet::new();
        let mut next = vec![text(&bill["metadata"]["component"]["bom-ref"])];
        while let Some(part) = next.pop() {
            let dependencies = bill["dependencies"].as_array().context("no dependencies")?;
            let dependency = dependencies
                .iter()
                .find(|dependency| dependency["ref"] == part.as_str());
            if reached.insert(part) {
                next.extend(
                    dependency
                        .and_then(|d| d["dependsOn"].as_array())
                        .into_iter()
                        .flatten()
                        .map(text),
                );
            }
        }
        let components = bill["components"].as_array().context("no components")?;
        let parts: BTreeSet<_> = components.iter().map(|component| text(&component["bom-ref"])).collect();
        assert_eq!(parts.len(), components.len());
        assert_eq!(reached.len(), parts.len() + 1, "and the component");
        assert!(parts.is_subset(&reached) && parts.iter().any(|part| part.starts_with("rust-standard-library@")));
        Ok(())
    }
}
