//! Reading on behind a request that was answered before its body was read.
//!
//! A server that just stops reading has to close the connection, and a client that was still sending, or sends its next
//! request over it, takes that for a fault of the network.

use std::pin::Pin;
use std::task::{Context, Poll};
use std::time::Duration;

use axum::body::{Body, Bytes};
use axum::http::{Request, header};
use http_body_util::BodyExt;
use hyper::body::{Body as HttpBody, Frame, SizeHint};

/// As much of what was not read is let in and dropped; behind more the connection is closed.
const MOST: usize = 256 * 1024;
const LONGEST: Duration = Duration::from_secs(2);

/// Sees to the rest of the request's body. A client that waits for leave to send need not be let send.
pub(crate) async fn drain(request: Request<Body>) -> Request<Body> {
    if request.headers().contains_key(header::EXPECT) {
        return request;
    }
    request.map(|body| Body::new(Drained(body)))
}

/// A body that is read to its end by whoever drops it.
struct Drained(Body);

impl HttpBody for Drained {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        Pin::new(&mut self.0).poll_frame(context)
    }

    fn is_end_stream(&self) -> bool {
        self.0.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.0.size_hint()
    }
}

impl Drop for Drained {
    fn drop(&mut self) {
        if self.0.is_end_stream() {
            return;
        }
        let Ok(runtime) = tokio::runtime::Handle::try_current() else {
            return;
        };
        let mut rest = std::mem::take(&mut self.0);
        runtime.spawn(tokio::time::timeout(LONGEST, async move {
            let mut length = 0;
            while let Some(Ok(frame)) = rest.frame().await {
                length += frame.data_ref().map_or(0, Bytes::len);
                if length > MOST {
                    break;
                }
            }
        }));
    }
}
