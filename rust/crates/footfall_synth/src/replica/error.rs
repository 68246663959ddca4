//! Reasons to refuse what a peer sends, or not to send.

/// Reason why a replicated walker's message is refused, or cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ReplicaError {
    /// Its length is wrong.
    #[error("{0} bytes are not a walker's update; send what `WalkSender` returns")]
    Length(usize),
    /// Another version of Footfall wrote it.
    #[error("the peer sends format {0}, this build reads {expected}; use the same version of Footfall on both", expected = super::update::FORMAT)]
    Format(u8),
    /// An identity's bytes cannot be decoded, or a number in it is invalid.
    #[error("the bytes are not a walker's identity; send what `WalkSender` returns")]
    Identity,
    /// The peer uses another model.
    #[error("the peer uses another model; use the same model file on both")]
    OtherModel,
    /// It belongs to another walker, or to an earlier identity of this one.
    #[error("the update belongs to another walker; wait for its identity")]
    OtherWalker,
    /// A newer one arrived before.
    #[error("the update is older than a previous one and was dropped")]
    Old,
    /// Too many arrive; the rest is ignored.
    #[error("the peer sends more than {0} updates a second; set a longer interval there")]
    Flood(u32),
    /// The place is out of walking range for the time since the last one.
    #[error(
        "the peer's walker moved by {0:.1} m, farther than people run; after a teleport, send an identity first"
    )]
    TooFar(f32),
    /// The place does not fit into an update.
    #[error(
        "the walker is {0:.0} m from the origin, out of an update's range; send places relative to a nearer origin"
    )]
    OutOfRange(f32),
    /// Walks of switching models are not replicated.
    #[error("walks of a switching model are not replicated; use a `.footfall` model")]
    Switching,
}
