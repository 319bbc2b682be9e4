//! Memory for bodies.

use std::sync::Arc;
use std::time::Duration;

use axum::http::{HeaderValue, header};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::time::timeout;

use super::code::Code;
use super::problem::Problem;

/// What bodies take that are on their way in or being worked on, all together.
#[derive(Clone)]
pub(super) struct Room(Arc<Semaphore>);

/// What one body takes of it, given back when this goes away.
#[derive(Default)]
pub(super) struct Occupied(Option<OwnedSemaphorePermit>);

/// Room is given out by so many bytes.
const STEP: usize = 65_536;

/// How long a body waits for room.
const PATIENCE: Duration = Duration::from_secs(5);

impl Room {
    pub(super) fn new(bytes: usize) -> Self {
        Self(Arc::new(Semaphore::new(
            (bytes / STEP).clamp(1, Semaphore::MAX_PERMITS),
        )))
    }

    /// Takes more, if need be, so that there is room for a body of so many bytes.
    pub(super) async fn extend(&self, taken: &mut Occupied, bytes: usize) -> Result<(), Problem> {
        let has = taken
            .0
            .as_ref()
            .map_or(0, OwnedSemaphorePermit::num_permits)
            * STEP;
        if bytes > has {
            let more = self.take(bytes - has).await?;
            match &mut taken.0 {
                Some(taken) => taken.merge(more),
                None => taken.0 = Some(more),
            }
        }
        Ok(())
    }

    async fn take(&self, bytes: usize) -> Result<OwnedSemaphorePermit, Problem> {
        let steps = u32::try_from(bytes.div_ceil(STEP)).unwrap_or(u32::MAX);
        let taken = timeout(PATIENCE, self.0.clone().acquire_many_owned(steps)).await;
        taken.ok().and_then(Result::ok).ok_or_else(|| {
            let detail = "other bodies on their way take all the room that there is (--max-body-memory); send it again in a while";
            let seconds = HeaderValue::from_static("5");
            Problem::new(Code::Busy, detail).with_header(header::RETRY_AFTER, seconds)
        })
    }
}
