//! Listening, and ending in good order.

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::server::graceful::GracefulShutdown;
use hyper_util::service::TowerToHyperService;
use tokio::net::{TcpListener, TcpStream, lookup_host};
use tokio::sync::Semaphore;
use tokio_util::sync::CancellationToken;

use super::compute::Compute;
use super::{Config, Service, routes};
use crate::store::Store;

/// A client that sends the head of a request more slowly than this is hung up on, and so is one that
/// keeps a connection open this long without a request.
const HEAD_TIMEOUT: Duration = Duration::from_secs(30);

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
        "refusing to listen on {0}: other machines could reach it, and there is no authentication yet; listen on 127.0.0.1 or [::1], and let a proxy that authenticates stand before it"
    )]
    NotLoopback(SocketAddr),
}

/// Listens on `address`, `host:port`, if it can be reached from this machine only.
///
/// # Errors
/// The address is none, is in use, or is not a loopback address.
pub async fn bind(address: &str) -> Result<TcpListener, BindError> {
    let fault = |source| BindError::Listen {
        address: address.to_string(),
        source,
    };
    let addresses: Vec<SocketAddr> = lookup_host(address).await.map_err(fault)?.collect();
    if let Some(open) = addresses.iter().find(|address| !address.ip().is_loopback()) {
        return Err(BindError::NotLoopback(*open));
    }
    TcpListener::bind(addresses.as_slice()).await.map_err(fault)
}

/// Serves the API on `listener` until `shutdown`, and then at most a few seconds longer. Tests and
/// production run this same function.
pub async fn run(config: Config, listener: TcpListener, store: Store, shutdown: CancellationToken) {
    let connections = Arc::new(Semaphore::new(config.max_connections));
    let service = Service {
        store,
        config: Arc::new(config),
        compute: Compute::new(),
        shutdown: shutdown.clone(),
    };
    let router = routes::router(service);
    let open = GracefulShutdown::new();
    let accept = async {
        loop {
            let Ok(permit) = connections.clone().acquire_owned().await else {
                return;
            };
            match listener.accept().await {
                Ok((stream, _)) => {
                    let serve = serve(&open, stream, router.clone());
                    tokio::spawn(async move {
                        let _permit = permit;
                        serve.await;
                    });
                }
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

/// One connection. Axum's own loop has no timeout for the head of a request.
fn serve(
    open: &GracefulShutdown,
    stream: TcpStream,
    router: Router,
) -> impl Future<Output = ()> + use<> {
    // answers are written whole: waiting for more to fill a packet only delays events
    let _ = stream.set_nodelay(true);
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(HEAD_TIMEOUT)
        .serve_connection(TokioIo::new(stream), TowerToHyperService::new(router));
    let connection = open.watch(connection);
    async move {
        if let Err(error) = connection.await {
            tracing::debug!(%error, "connection");
        }
    }
}
