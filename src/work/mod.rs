//! Workers: each claims a job, has it solved on a blocking thread, and records what it is told.
//!
//! A worker knows nothing but the store: those in the next process or on the next machine are the
//! same. Solver runs never block the reactor; there are as many workers as cores by default, and so as
//! many solver threads.
//!
//! Invariant: a worker that has lost its lease writes nothing more.

mod clock;
mod maker;
mod persist;
mod run;
mod solve;
mod stop;

pub use clock::ThreadClock;

use std::panic::AssertUnwindSafe;
use std::time::Duration;

use futures_util::FutureExt;
use tokio::task::JoinSet;
use tokio_util::sync::CancellationToken;

use crate::store::{Signal, Store};

/// How often an idle worker looks without being signalled: for jobs of other processes, and for
/// leases that ran out.
const LOOK_AGAIN: Duration = Duration::from_secs(1);

/// Runs `count` workers until `shutdown`, and until each has finished its job or given it back.
pub async fn run(store: Store, count: usize, shutdown: CancellationToken) {
    // unique among all processes: two of one name could take each other's leases for their own
    let process = store.clock().new_id().simple().to_string();
    let mut workers = JoinSet::new();
    for number in 1..=count {
        let name = format!("{}/{number}", &process[20..]);
        workers.spawn(work(store.clone(), name, shutdown.clone()));
    }
    while workers.join_next().await.is_some() {}
}

async fn work(store: Store, name: String, shutdown: CancellationToken) {
    while !shutdown.is_cancelled() {
        // listen before looking: a job that arrives in between is not overlooked
        let mut signals = store.listen();
        match store.claim(&name).await {
            Ok(Some(claim)) => {
                let job = claim.job;
                tracing::info!(%job, worker = name, attempt = claim.attempt, "job claimed");
                // a defect on one job must not cost the worker; the job's lease runs out
                let run = AssertUnwindSafe(run::run_job(&store, claim, &shutdown)).catch_unwind();
                if run.await.is_err() {
                    tracing::error!(%job, worker = name, "the worker failed on this job");
                }
            }
            Ok(None) => {
                tokio::select! {
                    () = signals.wait_for(Signal::Work, LOOK_AGAIN) => {}
                    () = shutdown.cancelled() => {}
                }
            }
            Err(error) => {
                tracing::error!(%error, worker = name, "cannot look for jobs");
                tokio::select! {
                    () = tokio::time::sleep(LOOK_AGAIN) => {}
                    () = shutdown.cancelled() => {}
                }
            }
        }
    }
}
