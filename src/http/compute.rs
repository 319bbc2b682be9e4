//! Work that would hold up the reactor: reading recordings, compiling models, writing long answers.

use std::sync::Arc;

use tokio::sync::Semaphore;

use super::problem::Problem;

/// A gate to the blocking threads: as many at a time as there are cores, so that a burst of requests
/// waits in line instead of taking memory and time from each other and from the solver.
#[derive(Clone)]
pub(super) struct Compute(Arc<Semaphore>);

impl Compute {
    pub(super) fn new() -> Self {
        let cores = std::thread::available_parallelism().map_or(2, usize::from);
        Self(Arc::new(Semaphore::new(cores.max(2))))
    }

    pub(super) async fn run<T: Send + 'static>(
        &self,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T, Problem> {
        let gate = self.0.clone();
        let permit = gate
            .acquire_owned()
            .await
            .map_err(|_| Problem::internal())?;
        let done = tokio::task::spawn_blocking(move || {
            // goes with the work: a client that hangs up does not open the gate
            let _permit = permit;
            work()
        });
        done.await.map_err(|error| {
            tracing::error!(%error, "a request's work failed");
            Problem::internal()
        })
    }
}
