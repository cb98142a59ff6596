//! A saved state as bytes, the same on every platform.
//!
//! ```text
//! 8 bytes   "relay\0st"
//! 4 bytes   version of the format, little-endian like all that follows
//! 34 bytes  GUID of the description the state belongs to
//! 8 bytes   length of the contents
//! ...       contents, in postcard's format
//! 4 bytes   CRC-32 of all before
//! ```

use super::failure::Failure;
use super::instance::snapshot::Snapshot;
use crate::variables::GUID;

const MAGIC: &[u8] = b"relay\0st";

/// Incremented whenever the contents change.
const VERSION: u32 = 6;

/// Largest number of bytes: no state of a spring with as many entries as it may have takes a quarter of it.
const LARGEST: usize = 1 << 20;

pub(super) fn to_bytes(snapshot: &Snapshot) -> Result<Vec<u8>, Failure> {
    let contents = postcard::to_allocvec(snapshot).map_err(|error| Failure::Panic(error.to_string()))?;
    let mut bytes = [MAGIC, &VERSION.to_le_bytes(), GUID.as_bytes()].concat();
    bytes.extend((contents.len() as u64).to_le_bytes());
    bytes.extend(contents);
    bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
    Ok(bytes)
}

/// The saved state of the bytes, or what is wrong with them.
pub(super) fn from_bytes(bytes: &[u8]) -> Result<Snapshot, Failure> {
    let wrong = |reason: String| Failure::Serialized(reason);
    let truncated = || wrong(format!("it ends after {} bytes, before it is complete", bytes.len()));
    if bytes.len() > LARGEST {
        return Err(wrong(format!("it has {} bytes, allowed are {LARGEST}", bytes.len())));
    }
    let (magic, rest) = bytes.split_at_checked(MAGIC.len()).ok_or_else(truncated)?;
    if magic != MAGIC {
        return Err(wrong("it was not made by this component".to_owned()));
    }
    let (version, rest) = rest.split_first_chunk().ok_or_else(truncated)?;
    let version = u32::from_le_bytes(*version);
    if version != VERSION {
        return Err(wrong(format!("its format is version {version}, allowed is {VERSION}")));
    }
    let (guid, rest) = rest.split_at_checked(GUID.len()).ok_or_else(truncated)?;
    if guid != GUID.as_bytes() {
        let guid = String::from_utf8_lossy(guid);
        return Err(wrong(format!("it belongs to the component {guid}, this is {GUID}")));
    }
    let (length, rest) = rest.split_first_chunk().ok_or_else(truncated)?;
    let length = u64::from_le_bytes(*length);
    let contents = usize::try_from(length).ok().and_then(|length| rest.split_at_checked(length));
    let (contents, checksum) = contents.ok_or_else(truncated)?;
    let (checksum, beyond) = checksum.split_first_chunk().ok_or_else(truncated)?;
    if !beyond.is_empty() {
        return Err(wrong(format!("{} bytes follow its end", beyond.len())));
    }
    let body = bytes.get(..bytes.len() - checksum.len()).unwrap_or_default();
    if u32::from_le_bytes(*checksum) != crc32fast::hash(body) {
        return Err(wrong("its checksum is wrong: bytes have changed".to_owned()));
    }
    let snapshot: Snapshot = postcard::from_bytes(contents).map_err(|error| wrong(error.to_string()))?;
    let sound = snapshot.is_sound().then_some(snapshot);
    sound.ok_or_else(|| wrong("no simulation can reach such a state".to_owned()))
}
