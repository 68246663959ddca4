//! SensorServer: an app that makes of a phone a server of its sensors.

use super::is_local;
use crate::live::device::{DeviceWriter, now_secs};
use crate::live::json;
use crate::live::link::{LOOK_EVERY, Link, LinkState, LinkWriter};
use std::io;
use std::net::{TcpStream, ToSocketAddrs as _};
use std::time::Duration;
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Error, Message, WebSocket};

/// Time in which the phone has to answer, and time after which it is asked again.
const ANSWER: Duration = Duration::from_secs(3);
const RETRY: Duration = Duration::from_secs(1);

/// Longest message, bytes.
const LONGEST: usize = 16 * 1024;

/// Request to the phone: its path and the sensors.
const SENSORS: &str =
    "/sensors/connect?types=[%22android.sensor.accelerometer%22,%22android.sensor.gyroscope%22]";

/// Follows the SensorServer at `host:port` until the link is dropped. Only addresses of the local network are asked.
pub fn follow(server: &str) -> Link {
    let server = server.trim().trim_start_matches("ws://");
    let server = server.split('/').next().unwrap_or_default().to_owned();
    let mut device = None;
    Link::keep("websocket", RETRY, move |link| {
        link.set_state(LinkState::Opening(format!("asking {server}")));
        match connect(&server) {
            Ok(mut socket) => receive(link, &mut socket, &server, &mut device),
            Err(problem) => problem,
        }
    })
}

fn connect(server: &str) -> Result<WebSocket<TcpStream>, String> {
    let refused = |error: &dyn core::fmt::Display| {
        format!("{server} does not answer like SensorServer: {error}")
    };
    let mut addresses = server.to_socket_addrs().map_err(|error| {
        format!(
            "{server} is not an address ({error}); give the address that SensorServer shows, such as 192.168.1.5:8080"
        )
    })?;
    let address = addresses.find(|address| is_local(address.ip()));
    let address = address.ok_or_else(|| format!("{server} is not on the local network"))?;
    let stream = TcpStream::connect_timeout(&address, ANSWER).map_err(|error| refused(&error))?;
    let timeouts = |stream: &TcpStream, time| stream.set_read_timeout(Some(time));
    timeouts(&stream, ANSWER).map_err(|error| refused(&error))?;
    let config = WebSocketConfig::default()
        .max_message_size(Some(LONGEST))
        .max_frame_size(Some(LONGEST));
    let url = format!("ws://{server}{SENSORS}");
    let (socket, _) = tungstenite::client::client_with_config(url, stream, Some(config))
        .map_err(|error| refused(&error))?;
    timeouts(socket.get_ref(), LOOK_EVERY).map_err(|error| refused(&error))?;
    Ok(socket)
}

fn receive(
    link: &LinkWriter,
    socket: &mut WebSocket<TcpStream>,
    server: &str,
    device: &mut Option<DeviceWriter>,
) -> String {
    if device.is_some() {
        link.set_state(LinkState::Receiving);
    }
    while !link.stopped() {
        let message = match socket.read() {
            Ok(message) => message,
            Err(Error::Io(error))
                if matches!(
                    error.kind(),
                    io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut
                ) =>
            {
                continue;
            }
            Err(error) => return format!("the connection to {server} was lost: {error}"),
        };
        let Message::Text(text) = message else {
            continue;
        };
        let now = now_secs();
        let Some(device) = device.as_mut() else {
            *device = link.add(server, "sensorserver");
            continue;
        };
        if !json::parse(text.as_bytes(), |reading| device.push(reading, now)) {
            link.count_garbage(1);
        }
    }
    // Who is not refused finds out by itself.
    drop(socket.close(None));
    String::new()
}
