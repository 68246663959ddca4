//! The container of every model file: magic, version, header, payload and its checksum.

use super::{FORMAT_VERSION, Header, ModelFileError, undecodable};
use crate::provenance::Provenance;

pub(super) const MAGIC: &[u8; 8] = b"FOOTFALL";

/// The header of any model file, also of one that a later version wrote.
///
/// # Errors
/// [`ModelFileError`] when the bytes are no model file or are cut short.
pub fn read_header(bytes: &[u8]) -> Result<(u32, Header), ModelFileError> {
    let truncated = || ModelFileError::Truncated { found: bytes.len() };
    let rest = bytes.strip_prefix(MAGIC).ok_or(ModelFileError::NotAModel)?;
    let (version, rest) = rest.split_first_chunk::<4>().ok_or_else(truncated)?;
    let (length, rest) = rest.split_first_chunk::<4>().ok_or_else(truncated)?;
    let header = rest
        .get(..u32::from_le_bytes(*length) as usize)
        .ok_or_else(truncated)?;
    let header = serde_json::from_slice(header).map_err(|error| undecodable("header", &error))?;
    Ok((u32::from_le_bytes(*version), header))
}

pub(super) fn write_container(
    version: u32,
    kind: &str,
    provenance: &Provenance,
    payload: &[u8],
) -> Result<Vec<u8>, ModelFileError> {
    let header = serde_json::to_vec(&Header {
        kind: kind.to_owned(),
        written_by: env!("CARGO_PKG_VERSION").to_owned(),
        provenance: provenance.clone(),
    })
    .map_err(|error| undecodable("header", &error))?;
    let mut bytes = MAGIC.to_vec();
    bytes.extend_from_slice(&version.to_le_bytes());
    bytes.extend_from_slice(&(header.len() as u32).to_le_bytes());
    bytes.extend_from_slice(&header);
    bytes.extend_from_slice(&(payload.len() as u64).to_le_bytes());
    bytes.extend_from_slice(payload);
    let checksum = crc32fast::hash(&bytes);
    bytes.extend_from_slice(&checksum.to_le_bytes());
    Ok(bytes)
}

pub(super) fn read_container(bytes: &[u8]) -> Result<(u32, Header, &[u8]), ModelFileError> {
    if !bytes.starts_with(MAGIC) {
        return Err(ModelFileError::NotAModel);
    }
    let truncated = || ModelFileError::Truncated { found: bytes.len() };
    // The checksum comes before the header is decoded: a damaged length or header must not be taken at its word. A
    // newer file is the exception, for it may end differently.
    let version = bytes
        .get(MAGIC.len()..)
        .and_then(<[u8]>::first_chunk::<4>)
        .ok_or_else(truncated)?;
    let version = u32::from_le_bytes(*version);
    if version > FORMAT_VERSION {
        let written_by = read_header(bytes).map_or_else(
            |_| "an unknown version".to_owned(),
            |(_, header)| header.written_by,
        );
        return Err(ModelFileError::Newer {
            version,
            written_by,
        });
    }
    let header_length = bytes
        .get(MAGIC.len() + 4..)
        .and_then(<[u8]>::first_chunk::<4>)
        .ok_or_else(truncated)?;
    let payload_length_at = MAGIC.len() + 8 + u32::from_le_bytes(*header_length) as usize;
    let payload_length = bytes
        .get(payload_length_at..)
        .and_then(<[u8]>::first_chunk::<8>)
        .ok_or_else(truncated)?;
    let payload_at = payload_length_at + 8;
    let payload_end = usize::try_from(u64::from_le_bytes(*payload_length))
        .ok()
        .and_then(|length| payload_at.checked_add(length))
        .ok_or_else(truncated)?;
    let payload = bytes.get(payload_at..payload_end).ok_or_else(truncated)?;
    let checksum = bytes
        .get(payload_end..)
        .and_then(<[u8]>::first_chunk::<4>)
        .ok_or_else(truncated)?;
    if crc32fast::hash(&bytes[..payload_end]) != u32::from_le_bytes(*checksum) {
        return Err(ModelFileError::Damaged);
    }
    let (_, header) = read_header(bytes)?;
    Ok((version, header, payload))
}
