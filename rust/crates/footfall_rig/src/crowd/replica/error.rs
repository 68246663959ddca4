//! Reasons to refuse what a peer tells of a crowd.

use crate::crowd::MOST_AGENTS;

/// Reason why a message about a crowd is refused. Nothing changes then.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CrowdReplicaError {
    /// It is none, or breaks off.
    #[error("{0} bytes are no message about a crowd; pass on what `CrowdSender` makes, whole")]
    Damaged(usize),
    /// Another version of Footfall wrote it.
    #[error("the peer tells its crowd in format {0}, this build reads {expected}; give both the same version of Footfall", expected = super::message::FORMAT)]
    Format(u8),
    /// The peer's crowd walks by another model or in other styles.
    #[error(
        "the peer's crowd walks by another model or other styles; give both the same model and the same list of styles"
    )]
    OtherModel,
    /// A walker of it makes no sense.
    #[error("the peer tells of a walker that cannot be; pass on what `CrowdSender` makes")]
    Nonsense,
    /// It would be larger than crowds are.
    #[error("the peer tells of more than {MOST_AGENTS} walkers; tell fewer")]
    TooMany,
    /// So much comes that the rest is passed over.
    #[error(
        "the peer sends more than {0} bytes in a second of this crowd's time; lower its budget, or let time pass here"
    )]
    Flood(u32),
}
