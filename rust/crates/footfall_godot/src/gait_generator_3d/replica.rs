//! The walk over a network: sent to other peers, or generated from what another peer sends.

use super::GaitGenerator3D;
use super::session::WalkSession;
use crate::character;
use crate::modifier::BodyModifier as _;
use core::cell::Cell;
use footfall_synth::GeneratorConfig;
use footfall_synth::replica::{ReplicaError, WalkFollower, WalkIdentity, WalkSender};
use godot::classes::multiplayer_peer::ConnectionStatus;
use godot::prelude::*;

/// Shortest time between two refusals that are reported, seconds.
const QUIET_SECS: f32 = 5.0;
/// Longest time that updates may come before their identity, as after a teleport, seconds: lost identities are sent again.
const EARLY_SECS: f32 = 2.0;

/// Part of the walk in a multiplayer game.
#[derive(Debug, Default)]
pub(super) struct Replica {
    /// In a cell, because the getter of a property reads it.
    sender: Cell<WalkSender>,
    led: Option<Led>,
    /// Refusal that waits to be reported, and the time until another may be, seconds.
    refusal: Cell<Option<ReplicaError>>,
    quiet_secs: Cell<f32>,
    /// Time since the last update of the same walker, seconds.
    strange_secs: f32,
}

/// Walker of another peer.
#[derive(Debug)]
struct Led {
    identity: WalkIdentity,
    follower: WalkFollower,
    /// True if the walk under way uses the same model; `None` before that is known.
    fits: Option<bool>,
}

#[godot_api(secondary)]
impl GaitGenerator3D {
    /// Returns `true` if the character makes the steps of another peer: it has received an identity, and this peer has no multiplayer authority over the node that travels.
    #[func]
    fn is_replica(&self) -> bool {
        self.replica.is_led()
    }
}

impl GaitGenerator3D {
    /// Identity of the walk, for other peers.
    pub(super) fn identity_bytes(&self) -> PackedByteArray {
        let bytes = match (&self.replica.led, &self.session) {
            (Some(led), _) => led.identity.to_bytes(),
            // A walk that another peer is about to lead has no identity here.
            (None, Some(session)) if self.leads() => {
                let identity = self.replica.sender.get().identity(&session.generator);
                identity
                    .map(|identity| identity.to_bytes())
                    .unwrap_or_default()
            }
            (None, _) => Vec::new(),
        };
        bytes.as_slice().into()
    }

    /// Takes the identity of another peer's walker.
    pub(super) fn receive_identity(&mut self, identity: &PackedByteArray) {
        if identity.is_empty() || self.leads() {
            return;
        }
        if let Err(error) = self.begin_replica(identity.as_slice()) {
            self.replica.refuse(error);
        }
    }

    /// Progress of the walk, for other peers.
    pub(super) fn state_bytes(&self) -> PackedByteArray {
        let session = self.session.as_ref();
        let Some(session) = session.filter(|_| !self.replica.is_led()) else {
            return PackedByteArray::new();
        };
        let mut sender = self.replica.sender.get();
        let update = sender.update(&session.generator, &session.shared_from_start());
        self.replica.sender.set(sender);
        match update {
            Ok(update) => update.as_slice().into(),
            Err(error) => {
                self.replica.refuse(error);
                PackedByteArray::new()
            }
        }
    }

    /// Takes the progress of another peer's walker.
    pub(super) fn receive_state(&mut self, state: &PackedByteArray) {
        if state.is_empty() || self.leads() {
            return;
        }
        // Without an identity or a walk the update has no walker yet; a later one will.
        let (Some(led), Some(session)) = (&mut self.replica.led, &self.session) else {
            return;
        };
        match led.follower.hear(state.as_slice(), &session.generator) {
            Ok(()) => self.replica.strange_secs = 0.0,
            // Networks turn the order of packets round.
            Err(ReplicaError::Old) => {}
            Err(ReplicaError::OtherWalker) if self.replica.strange_secs < EARLY_SECS => {}
            Err(error) => self.replica.refuse(error),
        }
    }

    /// Returns whether this peer walks the character itself: it has the authority over the node that travels. Nodes that are added below that one later do not inherit it.
    fn leads(&self) -> bool {
        let skeleton = self.base().get_skeleton();
        let travels = skeleton.and_then(|skeleton| self.find_character(&skeleton).ok());
        let Some(carrier) = travels
            .filter(|node| node.is_inside_tree())
            .map(|node| character::carrier(&node))
        else {
            return false;
        };
        // Without a connection there is no number to compare the authority with.
        let peer = carrier
            .get_multiplayer()
            .and_then(|game| game.get_multiplayer_peer());
        if peer.is_some_and(|peer| peer.get_connection_status() == ConnectionStatus::DISCONNECTED) {
            return !self.replica.is_led();
        }
        carrier.is_multiplayer_authority()
    }

    fn begin_replica(&mut self, bytes: &[u8]) -> Result<(), ReplicaError> {
        let identity = WalkIdentity::from_bytes(bytes)?;
        if let Some(led) = &mut self.replica.led
            && led.identity.is_same_walker(&identity)
        {
            led.follower.become_walker(&identity)?;
            led.identity = identity;
            return Ok(());
        }
        // The new follower keeps the count of how often the walker was replaced.
        let mut follower = self
            .replica
            .led
            .as_ref()
            .map_or_else(|| WalkFollower::new(&identity), |led| led.follower.clone());
        follower.become_walker(&identity)?;
        self.restart();
        self.replica.led = Some(Led {
            identity,
            follower,
            fits: None,
        });
        Ok(())
    }

    /// Emits what was refused since the last frame.
    pub(super) fn emit_refusal(&mut self) {
        if let Some(error) = self.replica.refusal.take() {
            let node = self.base().get_path();
            godot_warn!("{node}: {error}");
            let reason = GString::from(&error.to_string());
            self.signals().replica_refused().emit(&reason);
        }
    }

    /// Seed, phase and variation of the walker that this is a replica of.
    pub(super) fn replica_config(&self) -> Option<GeneratorConfig> {
        let led = self.replica.led.as_ref()?;
        Some(led.identity.config())
    }

    /// Advances the part of the walk that belongs to the network, and takes over another peer's style weights.
    pub(super) fn advance_replica(&mut self, session: &mut WalkSession, dt_secs: f64) {
        if self.replica.led.is_some() && self.leads() {
            // The authority has come to this peer: its walk goes on from here.
            self.replica = Replica::default();
        }
        let weights = match &self.replica.led {
            Some(led) => led.identity.style_weights.as_slice(),
            None => self.style_weights.as_slice(),
        };
        session.generator.set_style_weights(weights);
        self.replica.sender.get_mut().step(dt_secs as f32);
        *self.replica.quiet_secs.get_mut() -= dt_secs as f32;
        self.replica.strange_secs += dt_secs as f32;
        let Some(led) = self.replica.led.as_mut().filter(|led| led.fits.is_none()) else {
            return;
        };
        let checked = led.identity.check(&session.generator);
        led.fits = Some(checked.is_ok());
        if let Err(error) = checked {
            self.replica.refuse(error);
        }
    }
}

impl Replica {
    /// Keeps a problem of what was received or was to be sent; of many in a row, one in a while is reported.
    fn refuse(&self, error: ReplicaError) {
        if self.quiet_secs.get() <= 0.0 {
            self.quiet_secs.set(QUIET_SECS);
            self.refusal.set(Some(error));
        }
    }

    /// Follower of the walk, if another peer leads it.
    pub(super) fn follower(&mut self) -> Option<&mut WalkFollower> {
        let led = self.led.as_mut()?;
        (led.fits == Some(true)).then_some(&mut led.follower)
    }

    /// Returns whether the walk is another peer's.
    pub(super) const fn is_led(&self) -> bool {
        self.led.is_some()
    }
}
