//! Listening, and ending in good order.

use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::server::graceful::GracefulShutdown;
use hyper_util::service::TowerToHyperService;
use tokio::net::{TcpListener, TcpStream, lookup_host};
use tokio_io_timeout::TimeoutStream;
use tokio_util::sync::CancellationToken;

use super::compute::Compute;
use super::config::Config;
use super::metrics::Metrics;
use super::rates::Rates;
use super::room::Room;
use super::routes;
use super::seats::{Seat, Seats};
use super::service::Server;
use crate::store::{Store, StoreError};

/// A client that sends the head of a request more slowly than this is hung up on, and so is one that
/// keeps a connection open this long without a request.
const HEAD_TIMEOUT: Duration = Duration::from_secs(30);

/// A connection on reserve has so long for its one request.
const RESERVE_TIMEOUT: Duration = Duration::from_secs(5);

/// A client that does not read its answer is hung up on: when nothing more of it could be sent for this long. A stream of
/// events with nothing to send is not meant.
const UNREAD_TIMEOUT: Duration = Duration::from_secs(30);

/// How long requests under way have to end when the service ends.
const DRAIN: Duration = Duration::from_secs(3);

#[derive(Debug, thiserror::Error)]
pub enum BindError {
    #[error("cannot listen on {address}: {source}")]
    Listen {
        address: String,
        source: std::io::Error,
    },
    #[error(
        "refusing to listen on {0}: other machines could reach it, and the database has no keys, so that anybody there could do everything; make a key first (trimtab key new --scope admin, with the same --database), or listen on 127.0.0.1 or [::1]"
    )]
    Open(String),
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// Whether `address`, `host:port`, can be reached from this machine only.
///
/// # Errors
/// The address is none.
pub async fn is_loopback(address: &str) -> Result<bool, BindError> {
    let addresses = lookup_host(address).await.map_err(fault(address))?;
    Ok(addresses
        .into_iter()
        .all(|address| address.ip().is_loopback()))
}

/// Listens on `address`, `host:port`: one that others can reach only if `store` has keys.
///
/// # Errors
/// The address is none, is in use, or would be open to everybody.
pub async fn bind(address: &str, store: &Store) -> Result<TcpListener, BindError> {
    if !is_loopback(address).await? && !store.has_keys().await? {
        return Err(BindError::Open(address.to_string()));
    }
    TcpListener::bind(address).await.map_err(fault(address))
}

fn fault(address: &str) -> impl Fn(std::io::Error) -> BindError {
    move |source| BindError::Listen {
        address: address.to_string(),
        source,
    }
}

/// Serves the API on `listener` until `shutdown`, and then at most a few seconds longer. Tests and
/// production run this same function.
pub async fn run(config: Config, listener: TcpListener, store: Store, shutdown: CancellationToken) {
    let seats = Seats::new(config.max_connections, config.max_connections_per_peer);
    // one body of each kind must fit in any case
    let least = config.max_maneuver_body + config.max_json_body;
    let room = Room::new(config.max_body_memory.max(2 * least));
    let rates = Rates::new(config.max_requests_per_second);
    let server = Server {
        store,
        config: Arc::new(config),
        compute: Compute::new(),
        metrics: Metrics::new(),
        room,
        rates,
        shutdown: shutdown.clone(),
    };
    let on_reserve = routes::reserve(server.clone());
    let router = routes::router(server);
    let open = GracefulShutdown::new();
    let accept = async {
        loop {
            match listener.accept().await {
                Ok((stream, peer)) => match seats.take(peer.ip()) {
                    Some(seat @ Seat::Whole { .. }) => {
                        spawn(
                            serve(&open, stream, router.clone(), HEAD_TIMEOUT, true),
                            seat,
                        );
                    }
                    Some(seat @ Seat::Reserve { .. }) => {
                        let router = on_reserve.clone();
                        spawn(serve(&open, stream, router, RESERVE_TIMEOUT, false), seat);
                    }
                    None => tracing::warn!(%peer, "hung up: there are too many connections"),
                },
                // out of file descriptors, most likely: some will be closed
                Err(error) => {
                    tracing::warn!(%error, "cannot accept a connection");
                    tokio::time::sleep(Duration::from_millis(200)).await;
                }
            }
        }
    };
    tokio::select! {
        () = accept => {}
        () = shutdown.cancelled() => {}
    }
    drop(listener);
    if tokio::time::timeout(DRAIN, open.shutdown()).await.is_err() {
        tracing::warn!("some requests did not end in time and were cut off");
    }
}

fn spawn(connection: impl Future<Output = ()> + Send + 'static, seat: Seat) {
    tokio::spawn(async move {
        let _seat = seat;
        connection.await;
    });
}

/// One connection. Axum's own loop has no timeout for the head of a request.
fn serve(
    open: &GracefulShutdown,
    stream: TcpStream,
    router: Router,
    head_timeout: Duration,
    keeps_alive: bool,
) -> impl Future<Output = ()> + use<> {
    // answers are written whole: waiting for more to fill a packet only delays events
    let _ = stream.set_nodelay(true);
    let mut stream = TimeoutStream::new(stream);
    stream.set_write_timeout(Some(UNREAD_TIMEOUT));
    let stream = Box::pin(stream);
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(head_timeout)
        .keep_alive(keeps_alive)
        .serve_connection(TokioIo::new(stream), TowerToHyperService::new(router));
    let connection = open.watch(connection);
    async move {
        if let Err(error) = connection.await {
            tracing::debug!(%error, "connection");
        }
    }
}
