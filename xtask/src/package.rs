//! A zip archive whose bytes depend only on its contents: entries sorted, fixed times, fixed permissions.

use std::collections::BTreeMap;
use std::io::{Cursor, Write};

use anyhow::Result;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Contents of the archive by path, with `/` between folders.
pub type Files = BTreeMap<String, Vec<u8>>;

/// Packs the files.
pub fn pack(files: &Files) -> Result<Vec<u8>> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (path, contents) in files {
        let permissions = if path.starts_with("binaries/") { 0o755 } else { 0o644 };
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .last_modified_time(DateTime::default())
            .unix_permissions(permissions);
        archive.start_file(path.as_str(), options)?;
        archive.write_all(contents)?;
    }
    Ok(archive.finish()?.into_inner())
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use zip::ZipArchive;

    use super::*;

    #[test]
    fn what_is_packed_can_be_read_back() -> Result<()> {
        let paths = ["modelDescription.xml", "binaries/linux64/a.so"];
        let files = Files::from(paths.map(|path| (path.to_owned(), path.repeat(100).into_bytes())));
        let packed = pack(&files)?;
        assert_eq!(packed, pack(&files)?, "the same bytes every time");
        let mut archive = ZipArchive::new(Cursor::new(packed))?;
        assert_eq!(archive.len(), files.len());
        for (path, contents) in &files {
            let mut read = Vec::new();
            archive.by_name(path)?.read_to_end(&mut read)?;
            assert_eq!(&read, contents);
        }
        let mode = archive.by_name(paths[1])?.unix_mode();
        assert_eq!(mode.map(|mode| mode & 0o777), Some(0o755));
        Ok(())
    }
}
