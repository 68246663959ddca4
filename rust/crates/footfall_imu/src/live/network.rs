//! Sensors that come over the network: apps on phones, and trackers of SlimeVR's kind.
//!
//! [`udp`] listens for datagrams and finds out of each which form it has: [`slimevr`], [`osc`], [JSON](super::json) or [lines of
//! numbers](super::serial::TextFormat). [`http`] takes what Sensor Logger posts, [`websocket`] asks SensorServer on a phone.

pub mod http;
pub mod osc;
pub mod slimevr;
pub mod udp;
pub mod websocket;

use std::net::IpAddr;

/// Returns true for an address of this machine or of the network that it is in; others are not answered.
pub(super) fn is_local(address: IpAddr) -> bool {
    match address.to_canonical() {
        IpAddr::V4(v4) => v4.is_loopback() || v4.is_private() || v4.is_link_local(),
        IpAddr::V6(v6) => v6.is_loopback() || v6.is_unique_local() || v6.is_unicast_link_local(),
    }
}
