//! Small libraries for every platform, linked on any machine: what the checks are tried on.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::Result;
use object::write::{Object, Relocation, Symbol, SymbolSection};
use object::{
    Architecture, BinaryFormat, Endianness, RelocationEncoding, RelocationFlags, RelocationKind, SectionKind,
    SymbolFlags, SymbolKind, SymbolScope,
};

use crate::commands::output;
use crate::release::tools::lld;

/// What to put into a library.
#[derive(Clone)]
pub struct Tiny {
    /// As rustc calls it.
    pub target: &'static str,
    /// The functions it exports.
    pub exports: Vec<String>,
    /// Bytes it holds.
    pub data: Vec<u8>,
    /// The libraries it imports a function from, each with the version of that function where there is one.
    pub imports: Vec<(String, Option<String>)>,
    /// Whether it also asks for a function that none of them has.
    pub undefined: bool,
    /// What else the linker is told.
    pub arguments: Vec<String>,
}

impl Tiny {
    /// Links it.
    pub fn bytes(&self) -> Result<Vec<u8>> {
        let folder = tempfile::tempdir()?;
        Ok(fs::read(self.link(folder.path(), "library")?)?)
    }

    /// Links it, and before it the libraries it imports from, each with one function.
    fn link(&self, folder: &Path, name: &str) -> Result<PathBuf> {
        let mut functions = Vec::new();
        let mut linker = linker();
        linker.current_dir(folder).args(self.flavour());
        for (number, (library, version)) in self.imports.iter().enumerate() {
            let function = format!("imported{number}");
            let mut other = Tiny {
                target: self.target,
                exports: vec![function.clone()],
                data: Vec::new(),
                imports: Vec::new(),
                undefined: false,
                arguments: Vec::new(),
            };
            match self.format() {
                BinaryFormat::Elf => other.arguments.push(format!("--soname={library}")),
                BinaryFormat::Coff => {}
                _ => other.macos("10.13", library),
            }
            if let Some(version) = version {
                fs::write(folder.join("versions"), format!("{version} {{ global: {function}; }};"))?;
                other.arguments.push("--version-script=versions".to_owned());
            }
            let file = if self.format() == BinaryFormat::Coff {
                library.clone()
            } else {
                format!("other{number}")
            };
            let linked = other.link(folder, &file)?;
            let imported = if self.format() == BinaryFormat::Coff {
                linked.with_extension("lib")
            } else {
                linked
            };
            linker.arg(imported);
            functions.push(function);
        }
        if self.undefined {
            functions.push("undefined".to_owned());
        }
        fs::write(folder.join("object.o"), self.object(&functions)?)?;
        linker.arg("object.o").args(&self.arguments);
        if self.format() == BinaryFormat::Coff {
            linker.args([
                format!("/out:{name}"),
                format!("/implib:{}", Path::new(name).with_extension("lib").display()),
            ]);
            linker.args(self.exports.iter().map(|export| format!("/export:{export}")));
        } else {
            linker.args(["-o", name]);
        }
        output(&mut linker)?;
        Ok(folder.join(name))
    }

    /// The oldest macOS it is for, and its name there.
    pub fn macos(&mut self, version: &str, install_name: &str) {
        let arguments = [
            "-platform_version",
            "macos",
            version,
            version,
            "-install_name",
            install_name,
        ];
        self.arguments = arguments.map(str::to_owned).to_vec();
    }

    fn format(&self) -> BinaryFormat {
        if self.target.contains("linux") {
            BinaryFormat::Elf
        } else if self.target.contains("windows") {
            BinaryFormat::Coff
        } else {
            BinaryFormat::MachO
        }
    }

    fn flavour(&self) -> Vec<&'static str> {
        let arm = self.target.starts_with("aarch64");
        match self.format() {
            BinaryFormat::Elf => vec!["-flavor", "gnu", "-shared"],
            BinaryFormat::Coff => vec!["-flavor", "link", "/dll", "/noentry", "/timestamp:0"],
            _ => vec![
                "-flavor",
                "darwin",
                "-dylib",
                "-arch",
                if arm { "arm64" } else { "x86_64" },
            ],
        }
    }

    /// Functions without code, the data, and the addresses of the functions from elsewhere.
    fn object(&self, imported: &[String]) -> Result<Vec<u8>> {
        let arm = self.target.starts_with("aarch64");
        let architecture = if arm {
            Architecture::Aarch64
        } else {
            Architecture::X86_64
        };
        let mut object = Object::new(self.format(), architecture, Endianness::Little);
        let text = object.add_section(b"__TEXT".to_vec(), b".text".to_vec(), SectionKind::Text);
        let data = object.add_section(b"__DATA".to_vec(), b".data".to_vec(), SectionKind::Data);
        let symbol = |name: &str, section, value| Symbol {
            name: name.as_bytes().to_vec(),
            value,
            size: 0,
            kind: SymbolKind::Text,
            scope: SymbolScope::Dynamic,
            weak: false,
            section,
            flags: SymbolFlags::None,
        };
        for export in &self.exports {
            let at = object.append_section_data(text, &[0; 16], 16);
            object.add_symbol(symbol(export, SymbolSection::Section(text), at));
        }
        for function in imported {
            let symbol = object.add_symbol(symbol(function, SymbolSection::Undefined, 0));
            let relocation = Relocation {
                offset: object.append_section_data(data, &[0; 8], 8),
                symbol,
                addend: 0,
                flags: RelocationFlags::Generic {
                    kind: RelocationKind::Absolute,
                    encoding: RelocationEncoding::Generic,
                    size: 64,
                },
            };
            object.add_relocation(data, relocation)?;
        }
        object.append_section_data(data, &self.data, 8);
        Ok(object.write()?)
    }
}

/// The linker that comes with Rust, or that of LLVM.
fn linker() -> Command {
    Command::new(lld(Path::new("rustc")).unwrap_or_else(|_| "lld".into()))
}
