//! A crowd over a network: sent to other peers, or following another peer's.

use super::GaitCrowd3D;
use footfall_rig::crowd::{Crowd, CrowdReplicaError, CrowdSender};
use godot::global::randi;
use godot::prelude::*;

/// Shortest time between two refusals that are reported, seconds.
const QUIET_SECS: f64 = 5.0;

/// Warning where walkers are added to a crowd that is another peer's.
const FOLLOWS: &str = "This crowd follows another peer's, which alone says who is in it: add and restore walkers there.";

/// Crowd's part in a multiplayer game.
#[derive(Debug, Default)]
pub(super) struct Replica {
    pub(super) follows: bool,
    /// Peers that follow the crowd.
    peers: Vec<i32>,
    sender: Option<CrowdSender>,
    /// The crowd's time when its messages were taken last, seconds.
    taken_secs: f64,
    /// Time until another refusal is reported, seconds.
    quiet_secs: f64,
}

impl Replica {
    /// Returns true while any peer follows the crowd.
    pub(super) const fn is_told(&self) -> bool {
        !self.peers.is_empty()
    }

    /// Forgets what was sent: the crowd is created again.
    pub(super) fn renew(&mut self) {
        self.sender = None;
    }

    /// Advances the time between reports.
    pub(super) fn pass(&mut self, secs: f32) {
        self.quiet_secs -= f64::from(secs);
    }
}

#[godot_api(secondary)]
impl GaitCrowd3D {
    /// Begins to send this crowd to another peer of a multiplayer game: its walkers, and every step. `take_messages()` returns the messages. A repeated call sends
    /// all walkers again, at most once a second. `controller/crowd_synchronizer.tscn` does all this.
    ///
    /// While any peer follows, distant walkers share no steps: 5,000 walkers take two fifths of a core.
    #[func]
    fn tell_peer(&mut self, peer: i32) {
        if !self.replica.peers.contains(&peer) {
            self.replica.peers.push(peer);
        }
        if let Some(sender) = &mut self.replica.sender {
            sender.join(peer);
        }
    }

    /// Stops sending the crowd to a peer.
    #[func]
    fn forget_peer(&mut self, peer: i32) {
        self.replica.peers.retain(|other| *other != peer);
        if let Some(sender) = &mut self.replica.sender {
            sender.leave(peer);
        }
    }

    /// Returns the peers to which this crowd is sent.
    #[func]
    fn get_told_peers(&self) -> PackedInt32Array {
        self.replica.peers.as_slice().into()
    }

    /// Returns the messages about this crowd since the last call, to be sent in this order: dictionaries of `peer` (`int`, 0 for all that follow), `reliable` (`bool`) and
    /// `bytes` (`PackedByteArray`, at most 1200). Call it in every frame.
    ///
    /// At most `bytes_per_second` carry steps, first those whose absence would cause the largest errors, and as many introduce walkers to each new peer. 100 bytes per second and
    /// walker repeat steps as often as lossy networks need. A crowd that follows another one has no messages.
    #[func]
    fn take_messages(&mut self, bytes_per_second: i64) -> Array<VarDictionary> {
        let Some(walkers) = self
            .walkers
            .as_ref()
            .filter(|walkers| self.replica.is_told() && !walkers.is_following())
        else {
            return Array::new();
        };
        let peers = &self.replica.peers;
        let now_secs = walkers.time_secs();
        let taken_secs = &mut self.replica.taken_secs;
        let sender = self.replica.sender.get_or_insert_with(|| {
            // A session number other than that of an earlier crowd, or of an earlier server.
            let mut sender = CrowdSender::new(randi() as u16);
            for peer in peers {
                sender.join(*peer);
            }
            *taken_secs = now_secs;
            sender
        });
        let secs = (now_secs - *taken_secs) as f32;
        *taken_secs = now_secs;
        let budget = u32::try_from(bytes_per_second.max(0)).unwrap_or(u32::MAX);
        sender.step(secs, walkers, budget);
        let messages = sender.messages().iter().map(|message| {
            let bytes: PackedByteArray = message.bytes.as_slice().into();
            vdict! {
                "peer" => message.to.unwrap_or(0),
                "reliable" => message.reliable,
                "bytes" => &bytes,
            }
        });
        messages.collect()
    }

    /// Takes a message of the crowd that this one follows. An invalid message is refused: nothing changes, and `message_refused` gives the reason, every five seconds at most.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn hear_message(&mut self, bytes: PackedByteArray) {
        self.make();
        let Some(walkers) = &mut self.walkers else {
            return;
        };
        match walkers.hear(bytes.as_slice()) {
            Ok(left) => self.left(&left),
            Err(error) => self.refuse(error),
        }
    }

    /// Returns `true` if the crowd follows another peer's crowd and has received its walkers.
    #[func]
    fn is_introduced(&self) -> bool {
        let walkers = self.walkers.as_ref();
        walkers.is_some_and(Crowd::is_introduced)
    }
}

impl GaitCrowd3D {
    /// Begins or stops to follow another peer's crowd.
    pub(super) fn let_follow(&mut self, follows: bool) {
        if follows == self.replica.follows {
            return;
        }
        self.replica.follows = follows;
        if let Some(walkers) = &mut self.walkers {
            if follows {
                let everybody = walkers.follow();
                self.left(&everybody);
            } else {
                walkers.lead();
            }
        }
    }

    /// Returns true, and warns, if the crowd follows another peer's.
    pub(super) fn is_others(&self) -> bool {
        if self.replica.follows {
            let node = self.base().get_path();
            godot_warn!("{node}: {FOLLOWS}");
        }
        self.replica.follows
    }

    fn refuse(&mut self, error: CrowdReplicaError) {
        if self.replica.quiet_secs > 0.0 {
            return;
        }
        self.replica.quiet_secs = QUIET_SECS;
        let node = self.base().get_path();
        godot_warn!("{node}: {error}");
        let reason = GString::from(&error.to_string());
        self.signals().message_refused().emit(&reason);
    }
}
