//! Steps that arrive before the introduction of their walkers.
//!
//! Introductions are reliable: one that is lost is sent again, and arrives up to a second after steps that were sent later. Without those steps the walker would
//! continue from an old one, on a path of its own.

use std::collections::VecDeque;

/// Time for which such messages are kept, seconds, and their greatest total length, bytes.
const KEPT_SECS: f64 = 3.0;
const MOST_BYTES: usize = 1 << 18;

/// Content of a message about steps.
#[derive(Debug)]
pub(super) struct EarlyMessage {
    session: u16,
    /// Our time of its arrival, seconds.
    pub(super) arrived_secs: f64,
    pub(super) content: Vec<u8>,
}

/// Messages about steps of walkers that are not introduced yet.
#[derive(Debug, Default)]
pub(super) struct EarlySteps {
    messages: VecDeque<EarlyMessage>,
    bytes: usize,
}

impl EarlySteps {
    /// Keeps a message; the oldest are dropped.
    pub(super) fn keep(&mut self, session: u16, arrived_secs: f64, content: &[u8]) {
        self.bytes += content.len();
        self.messages.push_back(EarlyMessage {
            session,
            arrived_secs,
            content: content.to_vec(),
        });
        while let Some(oldest) = self.messages.front()
            && (self.bytes > MOST_BYTES || arrived_secs - oldest.arrived_secs > KEPT_SECS)
        {
            self.bytes -= oldest.content.len();
            self.messages.pop_front();
        }
    }

    /// Takes all messages of a session in the order of their arrival; those of others are dropped.
    pub(super) fn take(&mut self, session: u16) -> impl Iterator<Item = EarlyMessage> {
        self.bytes = 0;
        let messages = core::mem::take(&mut self.messages).into_iter();
        messages.filter(move |message| message.session == session)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn old_messages_many_bytes_and_other_sessions_are_dropped() {
        let mut early = EarlySteps::default();
        early.keep(1, 0.0, &[1; 10]);
        early.keep(1, 2.0, &[2; 10]);
        early.keep(2, 2.5, &[3; 10]);
        early.keep(1, 3.5, &[4; 10]);
        let taken: Vec<u8> = early.take(1).map(|message| message.content[0]).collect();
        assert_eq!(taken, [2, 4]);
        assert_eq!(early.take(1).count(), 0);
        for _ in 0..3 {
            early.keep(1, 4.0, &vec![0; MOST_BYTES / 2]);
        }
        assert_eq!(early.take(1).count(), 2);
    }
}
