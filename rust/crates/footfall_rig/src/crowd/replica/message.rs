//! Header of messages about a crowd: kind and session.
//!
//! | bytes | content |
//! | --- | --- |
//! | 0 | format (upper half), kind (lower half) |
//! | 1–2 | session: another number when the crowd was created again |
//!
//! Steps go on with the sender's time (2 bytes, 4 ms) and 19 bytes each; people with the fingerprint of model and styles (4), the sender's time, and one after the
//! other in `postcard`; those who left with four bytes each, their names.

use super::CrowdReplicaError;

/// Format that this build writes and reads.
pub(super) const FORMAT: u8 = 1;

/// Length of the header.
pub(super) const HEAD_BYTES: usize = 3;

/// Greatest length of a message, so that networks pass it on in one packet.
pub(super) const MOST_BYTES: usize = 1200;

/// Kinds of messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Steps = 0,
    People = 1,
    Left = 2,
}

/// A message about a crowd, to be passed on unchanged.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CrowdMessage {
    /// Recipient; `None` for all peers that have [joined](super::CrowdSender::join).
    pub to: Option<i32>,
    /// True if it must arrive, in order; messages about steps may be lost, late, repeated and in any order.
    pub reliable: bool,
    /// The message, at most 1200 bytes.
    pub bytes: Vec<u8>,
}

/// Begins a message.
pub(super) fn begin(kind: Kind, session: u16, bytes: &mut Vec<u8>) {
    bytes.clear();
    bytes.push(FORMAT << 4 | kind as u8);
    bytes.extend(session.to_le_bytes());
}

/// Kind, session and content of a message.
///
/// # Errors
/// [`CrowdReplicaError::Damaged`] or [`CrowdReplicaError::Format`].
pub(super) fn open(bytes: &[u8]) -> Result<(Kind, u16, &[u8]), CrowdReplicaError> {
    let damaged = CrowdReplicaError::Damaged(bytes.len());
    let (&[first, low, high], content) = bytes.split_first_chunk().ok_or(damaged)?;
    let format = first >> 4;
    if format != FORMAT {
        return Err(CrowdReplicaError::Format(format));
    }
    let kind = match first & 0x0f {
        0 => Kind::Steps,
        1 => Kind::People,
        2 => Kind::Left,
        _ => return Err(damaged),
    };
    let fits = bytes.len() <= MOST_BYTES;
    fits.then_some((kind, u16::from_le_bytes([low, high]), content))
        .ok_or(damaged)
}
