//! No files import each other in a circle: each can be read with only those below it in mind.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::{fs, iter};

/// The files by module (`a::b`; the root is empty), each with the paths that it imports outside its unit tests.
type Imports = BTreeMap<String, Vec<String>>;

/// The text of each file without its unit tests, by module.
type Texts = BTreeMap<String, String>;

fn read(folder: &Path, module: &str, found: &mut Texts) {
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
            found.insert(own.to_owned(), product.to_owned());
        }
    }
}

/// The paths in `use crate::...;`, of whichever visibility, and `use super::...;` of a module.
fn imported(own: &str, text: &str) -> Vec<String> {
    let parent = own.rsplit_once("::").map_or("", |(parent, _)| parent);
    let paths_from = |start: &str, base: &str| -> Vec<String> {
        let statements = text.split(start).skip(1).filter_map(|rest| rest.split(';').next());
        let paths = statements.flat_map(|statement| {
            let (path, items) = statement.split_once('{').unwrap_or((statement, ""));
            let items = items.trim_end_matches('}').split(',');
            items.map(move |item| format!("{base}{path}{}", item.trim()))
        });
        paths.collect()
    };
    [paths_from("use crate", ""), paths_from("\nuse super", parent)].concat()
}

/// Names after each occurrence of `before`.
fn names<'a>(text: &'a str, before: &'a str) -> impl Iterator<Item = &'a str> {
    let after = text.split(before).skip(1);
    after.filter_map(|rest| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next())
}

/// The imports of all files; a call of a method that stands elsewhere than its type is one too, where the name of the method tells
/// which it is.
fn imports(texts: &Texts) -> Imports {
    let mut imports: Imports = texts.iter().map(|(own, text)| (own.clone(), imported(own, text))).collect();
    let mut homes: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for (own, text) in texts {
        for name in names(text, "fn ") {
            homes.entry(name).or_default().push(own);
        }
    }
    let defines =
        |text: &str, kind: &str| ["struct ", "enum "].iter().any(|what| names(text, what).any(|name| name == kind));
    for (home, text) in texts {
        for block in text.split("\nimpl").skip(1) {
            let head = block.split('{').next().unwrap();
            let kind = head.trim_start_matches(|c: char| c != ' ').trim();
            let kind = kind.split(|c: char| !c.is_alphanumeric()).next().unwrap();
            if head.contains(" for ") || defines(text, kind) {
                continue;
            }
            let body = block.split("\n}").next().unwrap();
            for method in names(body, "    fn ").chain(names(body, ") fn ")).chain(names(body, "pub fn ")) {
                if homes.get(method).is_none_or(|homes| homes.len() > 1) {
                    continue;
                }
                let calls = [format!(".{method}("), format!("::{method}(")];
                for (own, _) in
                    texts.iter().filter(|(own, text)| *own != home && calls.iter().any(|call| text.contains(call)))
                {
                    imports.get_mut(own).unwrap().push(home.clone());
                }
            }
        }
    }
    imports
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
    let folders = fs::read_dir(root).unwrap().map(|entry| entry.unwrap().path());
    let crates: Vec<_> = folders.filter(|folder| folder.join("Cargo.toml").exists()).collect();
    let sources = crates.iter().map(|folder| folder.join("src"));
    let mut importing = 0;
    for source in sources.chain([root.join("src")]).filter(|source| source.exists()) {
        let mut texts = Texts::new();
        read(&source, "", &mut texts);
        let imports = imports(&texts);
        importing += usize::from(imports.values().any(|paths| !paths.is_empty()));
        assert_eq!(circles(&imports), [""; 0], "{}", source.display());
    }
    assert!(importing > crates.len() / 2, "{importing} of {} crates", crates.len());
}

#[test]
fn a_circle_is_found() {
    let found = |texts: &[(&str, &str)]| -> Vec<String> {
        let texts = texts.iter().map(|(own, text)| ((*own).to_owned(), (*text).to_owned())).collect();
        circles(&imports(&texts)).into_iter().map(str::to_owned).collect()
    };
    let of_three =
        [("::a", "\nuse crate::b::{self, x};"), ("::b::c", "\npub use crate::a::x;"), ("::d", "\nuse crate::a;")];
    assert_eq!(found(&[&of_three[..], &[("::b", "\nuse super::b::c;")]].concat()), ["::a", "::b", "::b::c"]);
    assert_eq!(found(&[&of_three[..], &[("::b", "")]].concat()), [""; 0]);
    // A method that stands in a file of its own, which imports its type.
    let kind = ("::kind", "\npub struct Kind;\nfn call(kind: &Kind) {\n    kind.spread();\n}\n");
    let method = ("::method", "\nuse crate::kind::Kind;\nimpl Kind {\n    pub fn spread(&self) {}\n}\n");
    assert_eq!(found(&[kind, method]), ["::kind", "::method"]);
    assert_eq!(found(&[(kind.0, "\npub struct Kind;\n"), method]), [""; 0]);
}
