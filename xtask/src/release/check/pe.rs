//! Libraries for Windows.

use std::collections::BTreeSet;

use anyhow::{Context, Result};
use goblin::pe::PE;
use goblin::pe::header::COFF_MACHINE_X86_64;

use super::report::Report;

/// Those that every Windows has, of the system and the C library.
const LIBRARIES: [&str; 4] = ["kernel32.dll", "ntdll.dll", "api-ms-win-core-synch-*", "api-ms-win-crt-*"];

/// The oldest Windows that the Rust standard library runs on: what a library asks for may not be newer.
const WINDOWS: [u16; 2] = [10, 0];

pub fn check(report: &mut Report, bytes: &[u8]) -> Result<()> {
    let pe = PE::parse(bytes).context("not a Windows file")?;
    let processor = match pe.header.coff_header.machine {
        COFF_MACHINE_X86_64 => "x86_64",
        _ => "another processor",
    };
    report.kind("Windows", pe.is_lib, processor);
    let unnamed = || "one without a name".to_owned();
    let exported: BTreeSet<_> =
        pe.exports.iter().map(|export| export.name.map_or_else(unnamed, str::to_owned)).collect();
    report.exports(&exported);
    let optional = pe.header.optional_header.context("a Windows file without its header")?;
    let mut imported: BTreeSet<_> = pe.libraries.iter().map(|name| name.to_lowercase()).collect();
    if optional.data_directories.get_delay_import_descriptor().is_some() {
        imported.insert("some at first use".to_owned());
    }
    report.only("imported libraries", &imported.into_iter().collect::<Vec<_>>(), &LIBRARIES);
    let asked = optional.windows_fields;
    let system = [asked.major_operating_system_version, asked.minor_operating_system_version];
    let subsystem = [asked.major_subsystem_version, asked.minor_subsystem_version];
    report.add(
        "Windows version",
        format!("{}.{}, subsystem {}.{}", system[0], system[1], subsystem[0], subsystem[1]),
        format!("up to {}.{}", WINDOWS[0], WINDOWS[1]),
        system.max(subsystem) <= WINDOWS,
    );
    let time = pe.header.coff_header.time_date_stamp;
    report.add("time of linking", format!("{time}"), "0", time == 0);
    Ok(())
}

/// Sets the time of linking to zero, so that the same source gives the same bytes.
pub fn without_time(mut library: Vec<u8>) -> Result<Vec<u8>> {
    const TIME: usize = 8; // after the processor's number and that of the sections
    let header = PE::parse(&library).context("not a Windows file")?.header.dos_header.pe_pointer as usize;
    let time = library.get_mut(header + TIME..header + TIME + 4);
    time.context("a Windows file without its header")?.fill(0);
    Ok(library)
}
