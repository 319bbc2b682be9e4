//! Workers: each claims a job, has it solved on a blocking thread, and records what it is told.
//!
//! A worker knows nothing but the store: those in the next process or on the next machine are the
//! same. A job that has lost workers before runs alone. Solver runs never block the reactor; there are as many workers as cores by default, and so as
//! many solver threads.
//!
//! Invariant: a worker that has lost its lease writes nothing more.

mod clock;
mod company;
mod ending;
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

use company::Company;

use crate::store::{Signal, Store};

/// How often an idle worker looks without being signalled: for jobs of other processes, and for
/// leases that ran out.
const LOOK_AGAIN: Duration = Duration::from_secs(1);

/// How many workers run in this process, and how long a job may take.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Workers {
    pub count: usize,
    /// From when a job begins to be solved; then it is ended with what it has come to. `None`: as long as it takes.
    pub longest_job: Option<Duration>,
}

impl From<usize> for Workers {
    fn from(count: usize) -> Self {
        Self {
            count,
            longest_job: None,
        }
    }
}

/// Runs workers until `shutdown`, and until each has finished its job or given it back.
pub async fn run(store: Store, workers: impl Into<Workers>, shutdown: CancellationToken) {
    let Workers { count, longest_job } = workers.into();
    // unique among all processes: two of one name could take each other's leases for their own
    let process = store.clock().new_id().simple().to_string();
    let company = Company::new(longest_job);
    let mut workers = JoinSet::new();
    for number in 1..=count {
        let name = format!("{}/{number}", &process[20..]);
        workers.spawn(work(store.clone(), name, company.clone(), shutdown.clone()));
    }
    while workers.join_next().await.is_some() {}
}

async fn work(store: Store, name: String, company: Company, shutdown: CancellationToken) {
    while !shutdown.is_cancelled() {
        let seat = tokio::select! {
            seat = company.beside() => seat,
            () = shutdown.cancelled() => return,
        };
        // listen before looking: a job that arrives in between is not overlooked
        let mut signals = store.listen();
        match store.claim(&name).await {
            Ok(Some(claim)) => {
                let job = claim.job;
                tracing::info!(%job, worker = name, attempt = claim.attempt, "job claimed");
                // a defect on one job must not cost the worker
                let given = claim.clone();
                let run = run::run_job(&store, claim, (&company, seat), &shutdown);
                let run = AssertUnwindSafe(run).catch_unwind();
                if run.await.is_err() {
                    tracing::error!(%job, worker = name, "the worker failed on this job");
                    run::give_up(&store, &given).await;
                }
            }
            Ok(None) => {
                drop(seat);
                tokio::select! {
                    () = signals.wait_for(Signal::Work, LOOK_AGAIN) => {}
                    () = shutdown.cancelled() => {}
                }
            }
            Err(error) => {
                drop(seat);
                tracing::error!(%error, worker = name, "cannot look for jobs");
                tokio::select! {
                    () = tokio::time::sleep(LOOK_AGAIN) => {}
                    () = shutdown.cancelled() => {}
                }
            }
        }
    }
}
