//! One claimed job, from its data to one of its ends.

use std::convert::Infallible;
use std::future::pending;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use tokio::sync::mpsc;
use tokio::time::{MissedTickBehavior, interval, sleep, timeout};
use tokio_util::sync::CancellationToken;

use super::company::{Company, Seat};
use super::ending::{JobEnd, Settled, Told, failed, settle};
use super::persist::persist;
use super::solve::{Unanswered, solve};
use super::stop::{Reason, Stop};
use crate::flight::Maneuver;
use crate::job::{EventBody, Fault, Status};
use crate::store::{Claim, LEASE, NotLoaded, Signal, Store, StoreError};

/// How long a solver may take to notice that the process ends; the job is released in any case.
const SHUTDOWN_GRACE: Duration = Duration::from_secs(2);

/// How long what is told waits for what is told next: a transaction waits for the disk, and a short job is told of in one.
const MOMENT: Duration = Duration::from_millis(20);

/// How many events may wait to be written before the solver waits for them.
const LOG_CAPACITY: usize = 256;

/// Runs a job, with the seat that its worker has. However this ends, the job is over, back in the queue, or another worker's.
pub(super) async fn run_job(
    store: &Store,
    claim: Claim,
    (company, seat): (&Company, Seat),
    shutdown: &CancellationToken,
) {
    let claim = Arc::new(claim);
    let (began, samples) = (Instant::now(), AtomicUsize::new(0));
    // kept until the end is written
    let mut seat = Some(seat);
    let settled = work_on(store, &claim, (company, &mut seat), &samples, shutdown).await;
    let how = settled.how();
    let written = match settled {
        Settled::Ended(ending) => end(store, &claim, ending).await,
        Settled::Released => {
            let release = || store.release(&claim, "the server is shutting down");
            persist("release", release).await
        }
        Settled::Abandoned => Err(StoreError::LeaseLost),
    };
    match written {
        Ok(()) => tracing::info!(
            job = %claim.job,
            project = claim.project,
            worker = claim.worker,
            attempt = claim.attempt,
            seconds = began.elapsed().as_secs_f64(),
            samples = samples.into_inner(),
            how,
            "job left"
        ),
        Err(StoreError::LeaseLost) => {
            tracing::warn!(job = %claim.job, "the job was taken over by another worker");
            if let Err(error) = store.was_not_lost(&claim).await {
                tracing::warn!(job = %claim.job, %error, "this worker counts as lost, and is not");
            }
        }
        // the lease runs out, and the next worker starts the job anew
        Err(error) => tracing::error!(job = %claim.job, %error, "the job's end was not written"),
    }
}

/// Ends a job on which the worker itself failed: it would do so again.
pub(super) async fn give_up(store: &Store, claim: &Claim) {
    let ending = failed("worker", &"its log tells more").event;
    if let Err(error) = store.finish(claim, 0, &[], ending, None).await {
        tracing::error!(job = %claim.job, %error, "the job's end was not written");
    }
}

async fn work_on(
    store: &Store,
    claim: &Arc<Claim>,
    (company, seat): (&Company, &mut Option<Seat>),
    samples: &AtomicUsize,
    shutdown: &CancellationToken,
) -> Settled {
    if claim.cancelling {
        let event = EventBody::cancelled_without_result();
        return Settled::Ended(JobEnd::without_result(event));
    }
    let stop = Stop::default();
    let run = async {
        let ready = async {
            if claim.is_suspect {
                be_alone(store, claim, company, seat).await?;
            }
            load(store, claim).await
        };
        let ready = tokio::select! {
            biased;
            ready = ready => ready,
            () = stop.overdue() => Err(Unanswered::Interrupted),
        };
        let maneuvers = match ready {
            Ok(maneuvers) => maneuvers,
            Err(unanswered) => return (Err(unanswered), Told::default()),
        };
        let all = maneuvers.iter().map(|maneuver| maneuver.len()).sum();
        samples.store(all, Ordering::Relaxed);
        let (log, events) = mpsc::channel(LOG_CAPACITY);
        let solver = tokio::task::spawn_blocking({
            let (claim, stop) = (claim.clone(), stop.clone());
            move || solve(&claim.spec, &claim.model, &maneuvers, &stop, &log)
        });
        let told = tokio::select! {
            told = record(store, claim, events, &stop) => told,
            never = end_in_time(company, &stop) => match never {},
        };
        // finished is finished, however late
        let answered = tokio::select! {
            biased;
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

/// Asks to stop when the job has taken as long as one may.
async fn end_in_time(company: &Company, stop: &Stop) -> Infallible {
    company.time_is_up().await;
    stop.ask(Reason::Budget);
    pending().await
}

/// A job under suspicion waits until nothing runs beside it.
async fn be_alone(
    store: &Store,
    claim: &Claim,
    company: &Company,
    seat: &mut Option<Seat>,
) -> Result<(), StoreError> {
    // nobody could be alone who waits with one
    seat.take();
    *seat = Some(company.alone().await);
    tracing::info!(job = %claim.job, "it has lost workers before, and runs alone");
    persist("run alone", || store.run_alone(claim)).await
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
