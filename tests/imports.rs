//! No files import each other in a circle: each can be read with only those below it in mind.

#![allow(clippy::unwrap_used)]

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::{fs, iter};

/// The files by module (`a::b`; the root is empty), each with the paths that it imports outside its unit tests.
type Imports = BTreeMap<String, Vec<String>>;

fn read(folder: &Path, module: &str, found: &mut Imports) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        let inner = format!("{module}::{name}");
        if path.is_dir() {
            read(&path, &inner, found);
        } else if name != "main" {
            let own = if ["mod", "lib"].contains(&name) { module } else { &inner };
            let text = fs::read_to_string(&path).unwrap();
            let product = text.split("#[cfg(test)]\nmod tests").next().unwrap();
            found.insert(own.to_owned(), imported(product));
        }
    }
}

/// The paths in `use crate::...;`.
fn imported(text: &str) -> Vec<String> {
    let statements = text
        .split("\nuse crate")
        .skip(1)
        .filter_map(|rest| rest.split(';').next());
    let paths = statements.flat_map(|statement| {
        let (path, items) = statement.split_once('{').unwrap_or((statement, ""));
        let items = items.trim_end_matches('}').split(',');
        items.map(move |item| format!("{path}{}", item.trim()))
    });
    paths.collect()
}

/// The files in circles, and between them.
fn circles(imports: &Imports) -> Vec<&str> {
    let file = |path: &str| {
        let mut paths = iter::successors(Some(path), |path| Some(path.rsplit_once("::")?.0));
        paths.find_map(|path| imports.get_key_value(path))
    };
    let mut left: BTreeMap<&str, BTreeSet<&str>> = imports
        .iter()
        .map(|(own, paths)| {
            let others = paths.iter().filter_map(|path| Some(file(path)?.0.as_str()));
            (own.as_str(), others.filter(|other| other != own).collect())
        })
        .collect();
    loop {
        let count = left.len();
        let importing: BTreeSet<_> = left.keys().copied().collect();
        left.retain(|_, others| !others.is_disjoint(&importing));
        let imported: BTreeSet<_> = left.values().flatten().copied().collect();
        left.retain(|own, _| imported.contains(own));
        if left.len() == count {
            return left.into_keys().collect();
        }
    }
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for folder in ["", "benches", "campaign", "hard-cases", "report", "testing", "xtask"] {
        let mut imports = Imports::new();
        read(&root.join(folder).join("src"), "", &mut imports);
        assert!(imports.values().flatten().count() > 0, "{folder}");
        assert_eq!(circles(&imports), [""; 0], "{folder}/src");
    }
}

#[test]
fn a_circle_is_found() {
    let texts = [
        ("::a", "\nuse crate::b::{self, x};"),
        ("::b::c", "\nuse crate::a::x;"),
        ("::d", "\nuse crate::a;"),
    ];
    let mut imports: Imports = texts.map(|(own, text)| (own.to_owned(), imported(text))).into();
    imports.insert("::b".to_owned(), imported("\nuse crate::b::c;"));
    assert_eq!(circles(&imports), ["::a", "::b", "::b::c"]);
    imports.insert("::b".to_owned(), Vec::new());
    assert_eq!(circles(&imports), [""; 0]);
}
