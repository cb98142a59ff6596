//! The software bill of materials, as CycloneDX 1.6.

use std::collections::BTreeMap;
use std::path::Path;

use crate::commands::{command, output, read};
use anyhow::{Context, Result};
use cargo_metadata::Package;
use serde_json::{Value, json};

use crate::linked::{COMPONENT, Crates, Linked};

/// The document. `rustc` is the compiler whose standard library is linked. The document has neither time nor serial
/// number, so that the same parts give the same bytes.
pub fn text(crates: &Crates, rustc: &Path) -> Result<String> {
    let digests = digests()?;
    let mut component = Value::Null;
    let (mut components, mut dependencies) = (vec![standard_library(rustc)?], Vec::new());
    for (crate_, Linked { package, uses }) in crates {
        let mut used: Vec<_> = uses.iter().map(|used| json!(used)).collect();
        let mut part = described(package, crate_)?;
        if package.name == COMPONENT {
            used.push(components[0]["bom-ref"].clone());
            component = part;
        } else {
            let digest = digests.get(crate_);
            let digest = digest.with_context(|| format!("Cargo.lock has no digest of {crate_}"))?;
            part["hashes"] = json!([{ "alg": "SHA-256", "content": digest }]);
            part["purl"] = json!(format!("pkg:cargo/{}", crate_.replace('+', "%2B")));
            components.push(part);
        }
        dependencies.push(json!({ "ref": crate_, "dependsOn": used }));
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

fn described(package: &Package, crate_: &str) -> Result<Value> {
    let description = package.description.as_deref().unwrap_or_default();
    let licence = package.license.as_deref();
    let licence = licence.with_context(|| format!("crate {crate_} states no licence"))?;
    Ok(json!({
        "type": "library",
        "bom-ref": crate_,
        "name": package.name,
        "version": package.version,
        "description": description.split_whitespace().collect::<Vec<_>>().join(" "),
        // Older crates separate their licences by a slash instead of an SPDX expression.
        "licenses": [{ "expression": licence.replace('/', " OR ") }],
    }))
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
fn digests() -> Result<BTreeMap<String, String>> {
    let lock: Value = toml::from_slice(&read("Cargo.lock")?).context("cannot read Cargo.lock")?;
    let packages = lock["package"].as_array().context("Cargo.lock lists no packages")?;
    let digest = |package: &Value| {
        let [name, version, digest] = ["name", "version", "checksum"].map(|key| package[key].as_str());
        Some((format!("{}@{}", name?, version?), digest?.to_owned()))
    };
    Ok(packages.iter().filter_map(digest).collect())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use cargo_metadata::DependencyKind;

    use super::*;
    use crate::linked::{crates, metadata};
    use crate::release::platform::PLATFORMS;

    /// Compares with the direct dependencies in `Cargo.toml`.
    #[test]
    fn every_part_is_listed_once_with_its_digest_and_is_used() -> Result<()> {
        let targets = PLATFORMS.map(|platform| platform.targets).concat();
        let bill: Value = serde_json::from_str(&text(&crates(&targets)?, Path::new("rustc"))?)?;
        assert_eq!(bill["metadata"]["component"]["name"], COMPONENT);
        let components = bill["components"].as_array().context("no components")?;
        let direct = metadata()?.root_package().context("no package")?.dependencies.iter();
        for dependency in direct.filter(|dependency| dependency.kind == DependencyKind::Normal) {
            let name = dependency.name.as_str();
            let component = components.iter().find(|component| component["name"] == name);
            let component = component.with_context(|| format!("{name} is missing"))?;
            let purl = component["purl"].as_str().context("no purl")?;
            let start = format!("pkg:cargo/{name}@");
            assert!(purl.starts_with(&start) && !purl.contains('+'), "{purl}");
            assert!(!component["licenses"][0]["expression"].to_string().contains('/'));
            let digest = component["hashes"][0]["content"].as_str().unwrap_or_default();
            assert!(digest.len() == 64 && digest.bytes().all(|digit| digit.is_ascii_hexdigit()));
        }
        let parts: BTreeSet<_> = components.iter().map(|part| part["bom-ref"].to_string()).collect();
        assert_eq!(parts.len(), components.len(), "each once");
        let dependencies = bill["dependencies"].as_array().context("no dependencies")?;
        let lists = dependencies.iter().filter_map(|part| part["dependsOn"].as_array());
        let used: BTreeSet<_> = lists.flatten().map(ToString::to_string).collect();
        assert_eq!(used, parts, "what is used is listed, and nothing else is");
        Ok(())
    }
}
