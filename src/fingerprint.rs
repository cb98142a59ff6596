//! Fingerprints of what is packed, by which importers tell components apart. Part of the build script too.

/// The GUID of these parts: a 128-bit FNV-1a hash.
pub fn guid(parts: &[&[u8]]) -> String {
    let end: &[u8] = &[0];
    let bytes = parts.iter().flat_map(|part| [part, end]).flatten();
    let hash = bytes.fold(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d_u128, |hash, byte| {
        (hash ^ u128::from(*byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b)
    });
    format!("{{{hash:032x}}}")
}
