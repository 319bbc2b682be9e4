//! One claimed job, from its data to one of its ends.

use std::sync::Arc;
use std::time::Duration;

use tokio::sync::mpsc;
use tokio::time::{MissedTickBehavior, interval, sleep, timeout};
use tokio_util::sync::CancellationToken;

use super::persist::persist;
use super::solve::{Answer, Unanswered, solve};
use super::stop::{Reason, Stop};
use crate::estimate::Outcome;
use crate::flight::Maneuver;
use crate::job::{EventBody, Fault, Status};
use crate::store::{Claim, LEASE, NotLoaded, ResultParts, Signal, Store, StoreError};

/// How long a solver may take to notice that the process ends; the job is released in any case.
const SHUTDOWN_GRACE: Duration = Duration::from_secs(2);

/// How long what is told waits for what is told next: a transaction waits for the disk, and a short job is told of in one.
const MOMENT: Duration = Duration::from_millis(20);

/// How many events may wait to be written before the solver waits for them.
const LOG_CAPACITY: usize = 256;

/// Runs a job. However this ends, the job is over, back in the queue, or another worker's.
pub(super) async fn run_job(store: &Store, claim: Claim, shutdown: &CancellationToken) {
    let claim = Arc::new(claim);
    let written = match work_on(store, &claim, shutdown).await {
        Settled::Ended(ending) => tokio::select! {
            written = end(store, &claim, ending) => written,
            () = last_chance(shutdown) => Err(StoreError::Database(sqlx::Error::PoolTimedOut)),
        },
        Settled::Released => {
            let release = || store.release(&claim, "the server is shutting down");
            persist("release", release).await
        }
        Settled::Abandoned => Err(StoreError::LeaseLost),
    };
    match written {
        Ok(()) => {}
        Err(StoreError::LeaseLost) => {
            tracing::warn!(job = %claim.job, "the job was taken over by another worker");
        }
        // the lease runs out, and the next worker starts the job anew
        Err(error) => tracing::error!(job = %claim.job, %error, "the job's end was not written"),
    }
}

/// A process that is to end does not wait as long for its database as another.
async fn last_chance(shutdown: &CancellationToken) {
    shutdown.cancelled().await;
    sleep(LEASE).await;
}

enum Settled {
    Ended(JobEnd),
    Released,
    Abandoned,
}

struct JobEnd {
    /// What was told last and is not written yet: it is, together with the end.
    told: Told,
    event: EventBody,
    result: Option<ResultParts>,
}

impl JobEnd {
    fn without_result(event: EventBody) -> Self {
        Self {
            told: Told::default(),
            event,
            result: None,
        }
    }
}

/// What the solver told, behind what is written.
#[derive(Default)]
struct Told {
    /// How many events are written.
    before: usize,
    events: Vec<EventBody>,
}

async fn work_on(store: &Store, claim: &Arc<Claim>, shutdown: &CancellationToken) -> Settled {
    if claim.cancelling {
        let event = EventBody::cancelled_without_result();
        return Settled::Ended(JobEnd::without_result(event));
    }
    let stop = Stop::default();
    let run = async {
        let loaded = tokio::select! {
            loaded = load(store, claim) => loaded,
            () = stop.overdue() => Err(Unanswered::Interrupted),
        };
        let maneuvers = match loaded {
            Ok(maneuvers) => maneuvers,
            Err(unanswered) => return (Err(unanswered), Told::default()),
        };
        let (log, events) = mpsc::channel(LOG_CAPACITY);
        let solver = tokio::task::spawn_blocking({
            let (claim, stop) = (claim.clone(), stop.clone());
            move || solve(&claim.spec, &claim.model, &maneuvers, &stop, &log)
        });
        let told = record(store, claim, events, &stop).await;
        let answered = tokio::select! {
            answered = solver => answered.unwrap_or_else(|error| Err(error.into())),
            () = stop.overdue() => Err(Unanswered::Interrupted),
        };
        (answered, told)
    };
    tokio::select! {
        (answered, told) = run => settle(answered, told, stop.asked()),
        settled = watch_over(store, claim, &stop, shutdown) => settled,
        never = stop.press() => match never {},
    }
}

/// The maneuvers of the spec, in its order.
async fn load(store: &Store, claim: &Claim) -> Result<Vec<Arc<Maneuver>>, Unanswered> {
    let uses = claim.spec.maneuvers.iter();
    let ids: Vec<&str> = uses.map(|used| used.id.as_str()).collect();
    let project = store.project(&claim.project, "");
    let loaded = persist("load", || project.load(&ids, usize::MAX)).await?;
    loaded.map_err(|missing| Unanswered::Refused(missing.into_iter().map(not_there).collect()))
}

fn not_there(why: NotLoaded) -> Fault {
    // they are as much as was accepted
    let (NotLoaded::Unknown(place) | NotLoaded::TooMuch(place)) = why;
    Fault::new(
        format!("/maneuvers/{place}/id"),
        "unknown_maneuver",
        "there is no longer a maneuver of this id; upload it again",
    )
}

/// Writes what the solver tells, all that comes within a moment in one transaction; what came last is left for the
/// transaction that ends the job.
async fn record(
    store: &Store,
    claim: &Claim,
    mut events: mpsc::Receiver<EventBody>,
    stop: &Stop,
) -> Told {
    let mut told = Told::default();
    let mut next = async || {
        tokio::select! {
            event = events.recv() => event,
            () = stop.overdue() => None,
        }
    };
    while let Some(event) = next().await {
        told.events.push(event);
        let gathered = async {
            while told.events.len() < LOG_CAPACITY {
                match next().await {
                    Some(event) => told.events.push(event),
                    None => return true,
                }
            }
            false
        };
        if timeout(MOMENT, gathered).await.unwrap_or(false) {
            return told;
        }
        let batch = &told.events;
        let recorded = persist("record", || store.record(claim, told.before, batch)).await;
        if let Err(error) = recorded {
            tracing::warn!(job = %claim.job, %error, "the job is given up: its events cannot be written");
            stop.ask(Reason::LeaseLost);
            return Told::default();
        }
        told.before += told.events.len();
        told.events.clear();
    }
    told
}

/// Keeps the lease, passes on the wish to stop. Returns only when the solver is not to be waited for.
async fn watch_over(
    store: &Store,
    claim: &Claim,
    stop: &Stop,
    shutdown: &CancellationToken,
) -> Settled {
    let mut beat = interval(LEASE / 3);
    beat.set_missed_tick_behavior(MissedTickBehavior::Delay);
    // before the first heartbeat reads the status
    let mut signals = store.listen();
    loop {
        tokio::select! {
            _ = beat.tick() => match store.heartbeat(claim).await {
                Ok(Status::Cancelling) => stop.ask(Reason::Cancel),
                Ok(_) => {}
                Err(StoreError::LeaseLost) => {
                    stop.ask(Reason::LeaseLost);
                    return Settled::Abandoned;
                }
                Err(error) => tracing::warn!(job = %claim.job, %error, "heartbeat"),
            },
            () = signals.wait_for(Signal::Cancel(claim.job), LEASE) => beat.reset_immediately(),
            () = shutdown.cancelled() => {
                stop.ask(Reason::Shutdown);
                sleep(SHUTDOWN_GRACE).await;
                return Settled::Released;
            }
        }
    }
}

/// What the run's end means for the job.
fn settle(answered: Result<Answer, Unanswered>, told: Told, asked: Option<Reason>) -> Settled {
    if asked == Some(Reason::LeaseLost) {
        return Settled::Abandoned;
    }
    let stopped = |answer: &Answer| answer.outcome == Outcome::Cancelled;
    let ending = match answered {
        Ok(answer) if stopped(&answer) && asked == Some(Reason::Shutdown) => {
            return Settled::Released;
        }
        Ok(answer) if stopped(&answer) => JobEnd {
            told,
            event: EventBody::Cancelled {
                has_result: true,
                findings: answer.findings,
            },
            result: Some(answer.parts),
        },
        // asked to stop or not: it finished before it noticed, and finished is finished
        Ok(Answer {
            outcome,
            reason,
            findings,
            parts,
        }) => JobEnd {
            told,
            event: EventBody::Succeeded {
                outcome,
                reason,
                findings,
            },
            result: Some(parts),
        },
        Err(Unanswered::Refused(faults)) => JobEnd {
            told,
            ..JobEnd::without_result(EventBody::Failed {
                faults: faults.into(),
            })
        },
        Err(Unanswered::Store(error)) => failed("store", &error),
        Err(Unanswered::Panicked(text)) => JobEnd {
            told,
            ..failed("solver", &text)
        },
        Err(Unanswered::Dropped) => return Settled::Released,
        Err(Unanswered::Interrupted) if asked == Some(Reason::Shutdown) => {
            return Settled::Released;
        }
        Err(Unanswered::Interrupted) => JobEnd {
            told,
            ..JobEnd::without_result(EventBody::cancelled_without_result())
        },
    };
    Settled::Ended(ending)
}

fn failed(where_: &str, error: &dyn std::fmt::Display) -> JobEnd {
    tracing::error!(%error, "the {where_} failed");
    let message = format!(
        "the {where_} failed, which is a defect of the service and not of the job: {error}"
    );
    let faults = vec![Fault::new("", "internal", message)];
    JobEnd::without_result(EventBody::Failed { faults })
}

/// Writes the end of a job. A result that cannot be kept fails the job rather than being computed
/// again and again.
async fn end(store: &Store, claim: &Claim, ending: JobEnd) -> Result<(), StoreError> {
    let JobEnd {
        told: Told { before, events },
        event,
        result,
    } = ending;
    let finish = || store.finish(claim, before, &events, event.clone(), result.as_ref());
    match persist("finish", finish).await {
        // trouble that did not pass says nothing against the result: the lease runs out, and the job is run again
        Err(error) if error.is_passing() => Err(error),
        Err(error) if result.is_some() && !matches!(error, StoreError::LeaseLost) => {
            let event = failed("store of the result", &error).event;
            (store.finish(claim, before, &events, event, None)).await
        }
        written => written,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn a_panic_of_the_solver_is_an_end_of_the_job() {
        let solver = tokio::task::spawn_blocking(|| panic!("matrix of {} rows", 3));
        let answered = solver.await.map_err(Unanswered::from);
        let Settled::Ended(ending) = settle(answered, Told::default(), None) else {
            panic!("the job must be over");
        };
        let EventBody::Failed { faults } = ending.event else {
            panic!("{:?}", ending.event)
        };
        assert_eq!(faults[0].code, "internal");
        assert!(
            faults[0].message.contains("matrix of 3 rows"),
            "{}",
            faults[0].message
        );
    }
}
