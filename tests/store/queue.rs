//! Who gets which job, and when.

use std::time::Duration;

use crate::bench::{Bench, new_job, on_both, succeeded};
use trimtab::job::{EventBody, Status};
use trimtab::store::{
    CancelReply, DEFAULT_PROJECT, GIVEN_UP_AFTER, LEASE, NewJob, SUSPECTED_AFTER, StoreError,
};

on_both! {
    jobs_are_claimed_once_and_oldest_first,
    many_workers_on_two_processes_never_share_a_job,
    each_key_is_served_in_turn,
    a_higher_priority_goes_first,
    giving_a_job_back_is_no_loss,
    a_job_that_kills_its_workers_is_given_up_once_it_ran_alone,
    what_a_process_takes_anew_it_has_not_lost,
    a_job_is_not_given_up_for_what_befalls_others_too,
    a_worker_that_comes_back_was_not_lost,
    cancelling_a_queued_job_ends_it_at_once,
    the_wish_to_cancel_outlives_the_worker,
}

async fn jobs_are_claimed_once_and_oldest_first(bench: Bench) {
    let (first, second) = (bench.submit("first").await, bench.submit("second").await);
    assert_eq!(bench.claim("w1").await.job, first);
    assert_eq!(bench.claim("w2").await.job, second);
    assert!(bench.store.claim("w3").await.unwrap().is_none());
    assert_eq!(bench.event_names(first).await, ["queued", "claimed"]);
    assert_eq!(bench.status(first).await, Status::Running);
}

async fn many_workers_on_two_processes_never_share_a_job(bench: Bench) {
    let other = bench.other().await;
    let mut submitted = Vec::new();
    for number in 0..24 {
        submitted.push(bench.submit(&format!("{number}")).await);
    }
    let mut workers = tokio::task::JoinSet::new();
    for number in 0..6 {
        let store = if number % 2 == 0 {
            bench.store.clone()
        } else {
            other.clone()
        };
        workers.spawn(async move {
            let mut jobs = Vec::new();
            let worker = |jobs: &Vec<uuid::Uuid>| format!("w{number}/{}", jobs.len());
            while let Some(claim) = store.claim(&worker(&jobs)).await.unwrap() {
                assert_eq!(claim.attempt, 1);
                jobs.push(claim.job);
            }
            jobs
        });
    }
    let mut claimed = workers.join_all().await.concat();
    claimed.sort();
    assert_eq!(claimed, submitted);
}

/// Who is served, by the letters of the keys.
async fn served(bench: &Bench, jobs: usize) -> String {
    let mut order = String::new();
    for _ in 0..jobs {
        let claim = bench.claim("w").await;
        bench
            .store
            .finish(&claim, 0, &[], succeeded(), None)
            .await
            .unwrap();
        order += &claim.spec.name;
    }
    order
}

async fn each_key_is_served_in_turn(bench: Bench) {
    let submit = async |key: &str| {
        let project = bench.store.project(DEFAULT_PROJECT, key);
        let id = bench.clock.new_id();
        project.submit(id, &new_job(key)).await.unwrap();
    };
    for _ in 0..6 {
        submit("a").await;
    }
    for key in ["b", "b", "c"] {
        submit(key).await;
    }
    assert_eq!(served(&bench, 3).await, "abc");
    // having been away earns nothing
    for key in ["d", "d", "d"] {
        submit(key).await;
    }
    assert_eq!(served(&bench, 9).await, "abdadadaa");
    submit("a").await;
    submit("b").await;
    assert_eq!(served(&bench, 2).await, "ab");
}

async fn a_higher_priority_goes_first(bench: Bench) {
    for (name, priority) in [("a", 0), ("b", -3), ("c", 0), ("d", 5)] {
        let job = NewJob {
            priority,
            ..new_job(name)
        };
        let id = bench.clock.new_id();
        bench.project().submit(id, &job).await.unwrap();
    }
    assert_eq!(served(&bench, 4).await, "dacb");
}

async fn giving_a_job_back_is_no_loss(bench: Bench) {
    let job = bench.submit("job").await;
    for _ in 0..3 * SUSPECTED_AFTER {
        let claim = bench.claim("w").await;
        bench.store.release(&claim, "shutdown").await.unwrap();
        assert_eq!(bench.status(job).await, Status::Queued);
    }
    assert_eq!(bench.claim("w").await.job, job);
}

async fn a_job_that_kills_its_workers_is_given_up_once_it_ran_alone(bench: Bench) {
    let job = bench.submit("killer").await;
    let mut claims = Vec::new();
    let all = SUSPECTED_AFTER + GIVEN_UP_AFTER;
    for number in 0..all {
        let claim = bench.claim(&format!("victim{number}/1")).await;
        assert_eq!(claim.is_suspect, number >= SUSPECTED_AFTER);
        if claim.is_suspect {
            bench.store.run_alone(&claim).await.unwrap();
        }
        claims.push(claim);
        bench.clock.advance(LEASE + Duration::from_secs(1));
    }
    let innocent = bench.submit("innocent").await;
    assert_eq!(bench.claim("w").await.job, innocent);
    let job = bench.project().job(job).await.unwrap().unwrap();
    assert_eq!(job.status, Status::Failed);
    let Some(EventBody::Failed { faults }) = job.ending else {
        panic!("{:?}", job.ending)
    };
    assert_eq!(faults[0].code, "workers_lost");
    let told = format!("{all} workers were lost while they ran this job, {GIVEN_UP_AFTER} of them");
    assert!(
        faults[0].message.starts_with(&told),
        "{}",
        faults[0].message
    );
    assert_eq!(job.attempt, all, "giving up is no attempt");
    // the last of them was only slow, and must not take the end for its own
    let late = claims.last().unwrap();
    let late = bench.store.finish(late, 0, &[], succeeded(), None).await;
    assert!(matches!(late, Err(StoreError::LeaseLost)));
}

/// Outages of the database under one living process gave its jobs up.
async fn what_a_process_takes_anew_it_has_not_lost(bench: Bench) {
    let job = bench.submit("job").await;
    for round in 0..3 * SUSPECTED_AFTER {
        let claim = bench.claim(&format!("process/{}", round % 2)).await;
        assert!(claim.job == job && !claim.is_suspect);
        bench.clock.advance(LEASE + Duration::from_secs(5));
    }
}

/// So did processes that were killed with all that they ran: it is under suspicion from then on, and no more.
async fn a_job_is_not_given_up_for_what_befalls_others_too(bench: Bench) {
    let job = bench.submit("job").await;
    for round in 0..10 {
        let claim = bench.claim(&format!("process{round}/1")).await;
        assert_eq!((claim.job, claim.attempt), (job, round + 1));
        assert_eq!(claim.is_suspect, round >= SUSPECTED_AFTER);
        bench.clock.advance(LEASE + Duration::from_secs(1));
    }
}

async fn a_worker_that_comes_back_was_not_lost(bench: Bench) {
    bench.submit("job").await;
    for round in 0..3 * SUSPECTED_AFTER {
        let away = bench.claim(&format!("a{round}/1")).await;
        bench.clock.advance(LEASE + Duration::from_secs(1));
        let taken = bench.claim(&format!("b{round}/1")).await;
        assert!(!taken.is_suspect, "round {round}");
        // what it says twice counts once
        bench.store.was_not_lost(&away).await.unwrap();
        bench.store.was_not_lost(&away).await.unwrap();
        bench.store.release(&taken, "shutdown").await.unwrap();
    }
    // and one that does not is
    for number in 0..=SUSPECTED_AFTER {
        let claim = bench.claim(&format!("c{number}/1")).await;
        assert_eq!(claim.is_suspect, number == SUSPECTED_AFTER);
        bench.clock.advance(LEASE + Duration::from_secs(1));
    }
}

async fn cancelling_a_queued_job_ends_it_at_once(bench: Bench) {
    let job = bench.submit("job").await;
    let CancelReply::Asked(record) = bench.project().cancel(job).await.unwrap() else {
        panic!()
    };
    assert_eq!(record.status, Status::Cancelled);
    assert!(record.finished.is_some());
    assert!(matches!(
        bench.project().cancel(job).await.unwrap(),
        CancelReply::AlreadyOver(_)
    ));
    assert!(bench.store.claim("w").await.unwrap().is_none());
    assert_eq!(
        bench.event_names(job).await,
        ["queued", "cancel_requested", "cancelled"]
    );
    let unknown = bench.project().cancel(uuid::Uuid::nil()).await.unwrap();
    assert_eq!(unknown, CancelReply::Unknown);
}

async fn the_wish_to_cancel_outlives_the_worker(bench: Bench) {
    let job = bench.submit("job").await;
    let claim = bench.claim("w1").await;
    bench.project().cancel(job).await.unwrap();
    bench.project().cancel(job).await.unwrap();
    assert_eq!(
        bench.store.heartbeat(&claim).await.unwrap(),
        Status::Cancelling
    );
    bench.store.release(&claim, "shutdown").await.unwrap();
    assert_eq!(bench.status(job).await, Status::Cancelling);
    let claim = bench.claim("w2").await;
    assert!(claim.cancelling);
    let ending = EventBody::cancelled_without_result();
    bench
        .store
        .finish(&claim, 0, &[], ending, None)
        .await
        .unwrap();
    let log = [
        "queued",
        "claimed",
        "cancel_requested",
        "released",
        "claimed",
        "cancelled",
    ];
    assert_eq!(
        bench.event_names(job).await,
        log,
        "asked twice is asked once"
    );
}
