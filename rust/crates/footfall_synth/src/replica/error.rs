//! Reasons to refuse what a peer sends, or not to send.

/// Reason why a replicated walker's message is refused, or cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ReplicaError {
    /// It has another length than such messages have.
    #[error("{0} bytes are no update of a walker; send what `WalkSender` makes")]
    Length(usize),
    /// Another version of Footfall wrote it.
    #[error("the peer sends format {0}, this build reads {expected}; give both the same version of Footfall", expected = super::update::FORMAT)]
    Format(u8),
    /// An identity's bytes cannot be decoded, or a number in it makes no sense.
    #[error("not a walker's identity; send what `WalkSender` makes")]
    Identity,
    /// The peer walks by another model.
    #[error("the peer walks by another model; give both the same model file")]
    OtherModel,
    /// It belongs to another walker, or to this one before it was somebody else.
    #[error("the update belongs to another walker; wait for the identity that it goes with")]
    OtherWalker,
    /// A newer one was heard before.
    #[error("the update is older than one that was heard before; it is passed over")]
    Old,
    /// So many come that the rest is passed over.
    #[error("the peer sends more often than {0} times a second; set a longer interval there")]
    Flood(u32),
    /// Nobody gets there by walking in the time since the last one.
    #[error(
        "the peer says it has come {0:.1} m farther, which is more than people run; after a jump through the level it sends an identity first"
    )]
    TooFar(f32),
    /// The place does not fit into an update.
    #[error(
        "the walker is {0:.0} m from the origin, more than an update can say; send places from nearer by"
    )]
    OutOfRange(f32),
    /// Walks of switching models are not replicated.
    #[error("walks of a switching model are not replicated; use a `.footfall` model")]
    Switching,
}
