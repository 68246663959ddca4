//! Reasons to refuse a peer's message about a crowd.

use crate::crowd::MOST_AGENTS;

/// Reason why a message about a crowd is refused. A refused message changes nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CrowdReplicaError {
    /// It is no such message, or incomplete.
    #[error("{0} bytes are no message about a crowd; pass on what `CrowdSender` makes, whole")]
    Damaged(usize),
    /// Another version of Footfall wrote it.
    #[error("the peer sends format {0}, this build reads {expected}; install the same version of Footfall on both", expected = super::message::FORMAT)]
    Format(u8),
    /// The peer's crowd walks by another model or in other styles.
    #[error(
        "the peer's crowd walks by another model or other styles; give both the same model and the same list of styles"
    )]
    OtherModel,
    /// A walker in it is invalid.
    #[error("the message holds an invalid walker; pass on the messages of `CrowdSender` unchanged")]
    Nonsense,
    /// The crowd would be larger than the limit.
    #[error("the peer's crowd has more than {MOST_AGENTS} walkers; remove some")]
    TooMany,
    /// The peer sends too much; the rest is ignored.
    #[error(
        "the peer sends more than {0} bytes in a second of this crowd's time; lower its budget, or let time pass here"
    )]
    Flood(u32),
}
