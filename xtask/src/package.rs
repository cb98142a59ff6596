//! A zip archive whose bytes depend on its contents alone: entries sorted, fixed times, fixed permissions.

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

    fn files(paths: &[&str]) -> Files {
        let contents = |path: &&str| (path.to_string(), path.repeat(100).into_bytes());
        paths.iter().map(contents).collect()
    }

    #[test]
    fn same_files_give_same_bytes_whatever_their_order() -> Result<()> {
        let first = pack(&files(&["modelDescription.xml", "binaries/linux64/a.so", "b"]))?;
        let second = pack(&files(&["b", "binaries/linux64/a.so", "modelDescription.xml"]))?;
        assert_eq!(first, second);
        assert_ne!(first, pack(&files(&["b", "binaries/linux64/a.so"]))?);
        Ok(())
    }

    #[test]
    fn what_is_packed_can_be_read_back() -> Result<()> {
        let files = files(&["modelDescription.xml", "binaries/linux64/a.so"]);
        let mut archive = ZipArchive::new(Cursor::new(pack(&files)?))?;
        assert_eq!(archive.len(), files.len());
        for (path, contents) in &files {
            let mut read = Vec::new();
            archive.by_name(path)?.read_to_end(&mut read)?;
            assert_eq!(&read, contents);
        }
        assert_eq!(
            archive
                .by_name("binaries/linux64/a.so")?
                .unix_mode()
                .map(|mode| mode & 0o777),
            Some(0o755)
        );
        Ok(())
    }
}
