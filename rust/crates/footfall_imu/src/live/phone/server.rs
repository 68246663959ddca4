//! The server: the page, and the two ways in which it sends samples.

use super::slots::Slots;
use super::{LONGEST, PhoneConfig, certificate};
use crate::live::device::DeviceStatus;
use crate::live::link::{LinkState, LinkWriter, bind_problem};
use crate::live::network::is_local;
use axum::body::Bytes;
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::extract::{ConnectInfo, DefaultBodyLimit, Path, Request, State};
use axum::http::{StatusCode, header};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse as _, Response};
use axum::routing::{get, post};
use axum::{Router, extract::Extension};
use rustls::ServerConfig;
use rustls::pki_types::pem::PemObject as _;
use rustls::pki_types::{CertificateDer, PrivateKeyDer};
use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpListener};
use std::sync::Arc;
use std::time::Duration;

const PAGE: &str = include_str!("page.html");

/// Content policy of the page: it may load itself alone.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// Delay of the answer to a wrong code, against guessing.
const WRONG_CODE_DELAY: Duration = Duration::from_millis(500);

/// Interval of the server's looks at footsteps, and the number of looks after which the page is sent its state.
const LOOK: Duration = Duration::from_millis(25);
const TELL_EVERY: u32 = 20;

/// Number of checks without a message after which a page counts as gone.
const SILENT_LOOKS: u32 = 400;

/// Longest number by which a page calls itself.
const LONGEST_PAGE: usize = 32;

#[derive(Clone)]
struct Shared {
    link: LinkWriter,
    slots: Arc<Slots>,
}

/// Serves until there is a problem. Returns it.
pub(super) async fn serve(
    link: LinkWriter,
    config: PhoneConfig,
    own: IpAddr,
    slots: Arc<Slots>,
) -> String {
    let tls = match tls_config(&config, own) {
        Ok(tls) => tls,
        Err(problem) => return problem,
    };
    let listener = TcpListener::bind((Ipv4Addr::UNSPECIFIED, config.port))
        .and_then(|listener| listener.set_nonblocking(true).map(|()| listener));
    let listener = match listener {
        Ok(listener) => listener,
        Err(error) => return bind_problem("TCP", config.port, &error),
    };
    if let Ok(address) = listener.local_addr() {
        link.set_address(address);
        let waiting = if own.is_loopback() {
            "this machine has no local network address, so no phone can reach it".to_owned()
        } else {
            format!("waiting for a phone on TCP port {}", address.port())
        };
        link.set_state(LinkState::Listening(waiting));
    }
    let router = Router::new()
        .route("/p/{code}", get(page))
        .route("/p/{code}/live/{page}", get(live))
        .route("/p/{code}/samples/{page}", post(samples))
        .fallback(async || (StatusCode::NOT_FOUND, "Scan the code that the game shows."))
        .layer(middleware::from_fn_with_state(Arc::clone(&slots), guard))
        .layer(DefaultBodyLimit::max(LONGEST))
        .with_state(Shared { link, slots });
    let service = router.into_make_service_with_connect_info::<SocketAddr>();
    let server = match axum_server::from_tcp_rustls(listener, tls) {
        Ok(server) => server,
        Err(error) => return format!("TCP port {}: {error}", config.port),
    };
    match server.serve(service).await {
        Ok(()) => String::new(),
        Err(error) => format!("TCP port {}: {error}", config.port),
    }
}

fn tls_config(
    config: &PhoneConfig,
    own: IpAddr,
) -> Result<axum_server::tls_rustls::RustlsConfig, String> {
    let kept = certificate::load_or_make(&config.folder, own)?;
    let broken = |error: &dyn core::fmt::Display| {
        format!(
            "{}: the certificate is damaged ({error}); delete the folder",
            config.folder.display()
        )
    };
    let chain = CertificateDer::pem_slice_iter(kept.certificate.as_bytes());
    let chain: Vec<_> = chain
        .collect::<Result<_, _>>()
        .map_err(|error| broken(&error))?;
    let key = PrivateKeyDer::from_pem_slice(kept.key.as_bytes()).map_err(|error| broken(&error))?;
    let provider = Arc::new(rustls::crypto::ring::default_provider());
    let tls = ServerConfig::builder_with_provider(provider)
        .with_safe_default_protocol_versions()
        .and_then(|builder| builder.with_no_client_auth().with_single_cert(chain, key));
    let mut tls = tls.map_err(|error| broken(&error))?;
    tls.alpn_protocols = vec![b"http/1.1".to_vec()];
    Ok(axum_server::tls_rustls::RustlsConfig::from_config(
        Arc::new(tls),
    ))
}

/// Admits clients on the local network that know a player's code.
async fn guard(
    State(slots): State<Arc<Slots>>,
    ConnectInfo(from): ConnectInfo<SocketAddr>,
    mut request: Request,
    next: Next,
) -> Response {
    if !is_local(from.ip()) {
        return (
            StatusCode::FORBIDDEN,
            "This game accepts phones on its own network only.",
        )
            .into_response();
    }
    let mut parts = request.uri().path().trim_start_matches('/').split('/');
    if parts.next() == Some("p") {
        let Some(player) = slots.player(parts.next().unwrap_or_default()) else {
            tokio::time::sleep(WRONG_CODE_DELAY).await;
            return (
                StatusCode::FORBIDDEN,
                "This code is not valid any more. Scan the code that the game shows now.",
            )
                .into_response();
        };
        request.extensions_mut().insert(player);
    }
    next.run(request).await
}

async fn page() -> Response {
    let headers = [
        (header::CONTENT_TYPE, "text/html; charset=utf-8"),
        (header::CONTENT_SECURITY_POLICY, POLICY),
        (header::CACHE_CONTROL, "no-store"),
        (header::REFERRER_POLICY, "no-referrer"),
    ];
    (headers, PAGE).into_response()
}

/// State that the page shows, as JSON.
fn status_text(status: &DeviceStatus) -> String {
    let fault = serde_json::to_string(&status.fault).unwrap_or_default();
    format!(
        "{{\"samples\":{},\"lost\":{},\"rate\":{:.1},\"fault\":{fault}}}",
        status.samples, status.lost, status.rate_hz
    )
}

async fn samples(
    State(shared): State<Shared>,
    Extension(player): Extension<usize>,
    Path((_, page)): Path<(String, String)>,
    body: Bytes,
) -> Response {
    let page: String = page.chars().take(LONGEST_PAGE).collect();
    match shared.slots.take(&shared.link, player, &page, &body) {
        Ok(status) => status_text(&status).into_response(),
        Err(problem) => (StatusCode::CONFLICT, problem).into_response(),
    }
}

async fn live(
    State(shared): State<Shared>,
    Extension(player): Extension<usize>,
    Path((_, page)): Path<(String, String)>,
    upgrade: WebSocketUpgrade,
) -> Response {
    let page: String = page.chars().take(LONGEST_PAGE).collect();
    upgrade
        .max_message_size(LONGEST)
        .max_frame_size(LONGEST)
        .on_upgrade(move |socket| converse(socket, shared, player, page))
}

/// One page's connection.
async fn converse(mut socket: WebSocket, shared: Shared, player: usize, page: String) {
    let mut looks = tokio::time::interval(LOOK);
    let mut status = None;
    let mut footsteps = shared.slots.footsteps(player);
    let (mut since_told, mut silent) = (0, 0);
    loop {
        tokio::select! {
            message = socket.recv() => {
                let bytes = match message {
                    Some(Ok(Message::Binary(bytes))) => bytes,
                    Some(Ok(Message::Close(_)) | Err(_)) | None => return,
                    Some(Ok(_)) => continue,
                };
                silent = 0;
                match shared.slots.take(&shared.link, player, &page, &bytes) {
                    Ok(known) => status = Some(known),
                    Err(problem) => {
                        let answer = serde_json::json!({ "problem": problem }).to_string();
                        // The page is gone or will go.
                        drop(socket.send(Message::Text(answer.into())).await);
                        return;
                    }
                }
            }
            _ = looks.tick() => {
                silent += 1;
                since_told += 1;
                let now = shared.slots.footsteps(player);
                let mut text = None;
                if now != footsteps {
                    footsteps = now;
                    text = Some("{\"vibrate\":30}".to_owned());
                } else if since_told >= TELL_EVERY {
                    since_told = 0;
                    text = status.as_ref().map(status_text);
                }
                if silent > SILENT_LOOKS {
                    return;
                }
                if let Some(text) = text
                    && socket.send(Message::Text(text.into())).await.is_err()
                {
                    return;
                }
            }
        }
    }
}
