//! Keeping the reactor free.

use super::error::StoreError;

/// Runs what takes long (encoding and decoding of long columns) where it does not hold up the reactor.
pub(super) async fn off_reactor<T: Send + 'static>(
    what: &str,
    work: impl FnOnce() -> Result<T, StoreError> + Send + 'static,
) -> Result<T, StoreError> {
    match tokio::task::spawn_blocking(work).await {
        Ok(result) => result,
        Err(error) => Err(StoreError::corrupt(what, error)),
    }
}
