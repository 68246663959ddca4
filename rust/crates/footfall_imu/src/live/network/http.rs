//! Sensor Logger's "HTTP push": batches of readings that an app posts.

use super::is_local;
use crate::live::device::now_secs;
use crate::live::json;
use crate::live::link::{Link, LinkState, LinkWriter, Senders, bind_problem};
use crate::live::phone::until_stopped;
use axum::Router;
use axum::body::Bytes;
use axum::extract::{ConnectInfo, DefaultBodyLimit, State};
use axum::http::StatusCode;
use axum::routing::post;
use serde::Deserialize;
use std::borrow::Cow;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// The port that is proposed to users.
pub const DEFAULT_PORT: u16 = 8080;

/// Longest batch, bytes: a second of eight sensors at 200 Hz is shorter.
const LONGEST: usize = 512 * 1024;

/// Time after which a port in use is tried again.
const RETRY: Duration = Duration::from_secs(2);

type Batches = Arc<Mutex<Senders<(IpAddr, String)>>>;

/// Listens at a port (0 for any that is free) until the link is dropped. Batches are posted to `/data`.
pub fn listen(port: u16) -> Link {
    Link::keep("http", RETRY, move |link| {
        until_stopped(link, serve(link.clone(), port))
    })
}

async fn serve(link: LinkWriter, port: u16) -> String {
    let listener = match tokio::net::TcpListener::bind((Ipv4Addr::UNSPECIFIED, port)).await {
        Ok(listener) => listener,
        Err(error) => return bind_problem("TCP", port, &error),
    };
    if let Ok(address) = listener.local_addr() {
        link.set_address(address);
        link.set_state(LinkState::Listening(format!(
            "waiting for Sensor Logger on TCP port {}",
            address.port()
        )));
    }
    let batches: Batches = Arc::new(Mutex::new(Senders::new(link.clone())));
    let router = Router::new()
        .route("/data", post(batch))
        .layer(DefaultBodyLimit::max(LONGEST))
        .with_state((link, batches));
    let service = router.into_make_service_with_connect_info::<SocketAddr>();
    match axum::serve(listener, service).await {
        Ok(()) => String::new(),
        Err(error) => format!("TCP port {port}: {error}"),
    }
}

#[derive(Deserialize)]
struct Head<'a> {
    #[serde(borrow, rename = "deviceId")]
    device_id: Option<Cow<'a, str>>,
}

async fn batch(
    State((link, batches)): State<(LinkWriter, Batches)>,
    ConnectInfo(from): ConnectInfo<SocketAddr>,
    body: Bytes,
) -> StatusCode {
    if !is_local(from.ip()) {
        return StatusCode::FORBIDDEN;
    }
    let now = now_secs();
    let id = serde_json::from_slice::<Head<'_>>(&body)
        .ok()
        .and_then(|head| head.device_id);
    let id = id.unwrap_or_default().into_owned();
    let mut readings = Vec::new();
    if !json::parse(&body, |reading| readings.push(reading)) {
        link.count_garbage(1);
        return StatusCode::BAD_REQUEST;
    }
    let mut senders = batches.lock().unwrap_or_else(PoisonError::into_inner);
    let name = || {
        format!(
            "{} at {}",
            if id.is_empty() { "Sensor Logger" } else { &id },
            from.ip()
        )
    };
    let sender = (from.ip(), id.clone());
    let Some(device) = senders.device(sender, |_| false, name, "sensor_logger") else {
        return StatusCode::TOO_MANY_REQUESTS;
    };
    // A batch holds one sensor after the other; samples need the order of their times.
    readings.sort_by(|a, b| {
        a.time_secs
            .unwrap_or(0.0)
            .total_cmp(&b.time_secs.unwrap_or(0.0))
    });
    for reading in readings {
        device.push(reading, now);
    }
    StatusCode::OK
}
