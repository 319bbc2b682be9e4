//! What a worker may write, and for how long.

use std::time::Duration;

use jiff::SignedDuration;

use crate::bench::{Bench, new_job, on_both, open, prepared, succeeded};
use crate::common::database::Database;
use trimtab::job::Status;
use trimtab::store::{Clock, DEFAULT_PROJECT, JobFilter, LEASE, StoreError};

on_both! {
    a_worker_that_lost_its_lease_cannot_write_any_more,
    the_same_worker_with_an_earlier_claim_is_a_ghost_too,
    heartbeats_keep_a_lease,
    what_is_written_again_is_written_once,
    a_claim_that_was_not_heard_of_is_given_again,
    what_was_told_last_arrives_with_the_end,
    a_dead_workers_job_is_taken_over_though_the_clock_goes_back,
    events_and_jobs_stay_in_order_though_the_clock_goes_back,
}

async fn a_worker_that_lost_its_lease_cannot_write_any_more(bench: Bench) {
    let job = bench.submit("job").await;
    let ghost = bench.claim("ghost").await;
    bench.clock.advance(LEASE + Duration::from_secs(1));
    let successor = bench.claim("successor").await;
    assert_eq!((successor.job, successor.attempt), (job, 2));

    let lost = |result| assert!(matches!(result, Err(StoreError::LeaseLost)));
    lost(bench.store.heartbeat(&ghost).await.map(drop));
    lost(bench.store.record(&ghost, 0, &[prepared()]).await);
    lost(bench.store.finish(&ghost, 0, &[], succeeded(), None).await);
    lost(bench.store.release(&ghost, "late").await);

    bench
        .store
        .record(&successor, 0, &[prepared()])
        .await
        .unwrap();
    bench
        .store
        .finish(&successor, 0, &[], succeeded(), None)
        .await
        .unwrap();
    lost(bench.store.record(&successor, 1, &[prepared()]).await);
    lost(bench.store.finish(&ghost, 0, &[], succeeded(), None).await);
    let log = ["queued", "claimed", "claimed", "prepared", "succeeded"];
    assert_eq!(bench.event_names(job).await, log);
}

async fn the_same_worker_with_an_earlier_claim_is_a_ghost_too(bench: Bench) {
    bench.submit("job").await;
    let before = bench.claim("w").await;
    bench.clock.advance(LEASE + Duration::from_secs(1));
    bench.claim("w").await;
    let result = bench.store.finish(&before, 0, &[], succeeded(), None).await;
    assert!(matches!(result, Err(StoreError::LeaseLost)));
}

async fn heartbeats_keep_a_lease(bench: Bench) {
    bench.submit("job").await;
    let claim = bench.claim("w").await;
    for _ in 0..5 {
        bench.clock.advance(LEASE / 2);
        assert_eq!(
            bench.store.heartbeat(&claim).await.unwrap(),
            Status::Running
        );
        assert!(bench.store.claim("thief").await.unwrap().is_none());
    }
}

/// The answer of a write may be lost when the write is not.
async fn what_is_written_again_is_written_once(bench: Bench) {
    let job = bench.submit("job").await;
    let claim = bench.claim("w").await;
    let events = [prepared(), prepared(), prepared()];
    bench.store.record(&claim, 0, &events[..2]).await.unwrap();
    bench.store.record(&claim, 0, &events[..2]).await.unwrap();
    bench.store.heartbeat(&claim).await.unwrap();
    bench.store.record(&claim, 0, &events).await.unwrap();
    bench
        .store
        .finish(&claim, 0, &[], succeeded(), None)
        .await
        .unwrap();
    bench
        .store
        .finish(&claim, 0, &[], succeeded(), None)
        .await
        .unwrap();
    let log = [
        "queued",
        "claimed",
        "prepared",
        "prepared",
        "prepared",
        "succeeded",
    ];
    assert_eq!(bench.event_names(job).await, log);
}

/// A claim that the worker did not hear of is its own when it asks again, and not after a lease.
async fn a_claim_that_was_not_heard_of_is_given_again(bench: Bench) {
    let job = bench.submit("job").await;
    bench.submit("behind").await;
    bench.claim("w").await;
    let again = bench.claim("w").await;
    assert_eq!((again.job, again.attempt), (job, 2));
}

async fn what_was_told_last_arrives_with_the_end(bench: Bench) {
    let job = bench.submit("job").await;
    let claim = bench.claim("w").await;
    let told = [prepared(), prepared()];
    // the first arrived, and who wrote it was not told so
    bench.store.record(&claim, 0, &told[..1]).await.unwrap();
    for _ in 0..2 {
        let end = bench.store.finish(&claim, 0, &told, succeeded(), None);
        end.await.unwrap();
        let names = bench.event_names(job).await;
        assert_eq!(
            names,
            ["queued", "claimed", "prepared", "prepared", "succeeded"]
        );
    }
}

/// The clock went back an hour: for an hour, nobody took over what a dead worker had left behind.
async fn a_dead_workers_job_is_taken_over_though_the_clock_goes_back(bench: Bench) {
    let job = bench.submit("job").await;
    bench.claim("dead/1").await;
    bench.clock.turn(SignedDuration::from_hours(-1));
    assert!(bench.store.claim("w/1").await.unwrap().is_none());
    bench.clock.advance(LEASE + Duration::from_secs(1));
    assert_eq!(bench.claim("w/1").await.job, job);
    // nor is a living one robbed where it goes forward
    bench.clock.turn(SignedDuration::from_hours(2));
    assert!(bench.store.claim("thief/1").await.unwrap().is_none());
}

async fn events_and_jobs_stay_in_order_though_the_clock_goes_back(bench: Bench) {
    let mut jobs = vec![bench.submit("before").await];
    let claim = bench.claim("w/1").await;
    bench.clock.turn(SignedDuration::from_hours(-1));
    bench.store.record(&claim, 0, &[prepared()]).await.unwrap();
    let end = bench.store.finish(&claim, 1, &[], succeeded(), None);
    end.await.unwrap();
    let events = bench.project().events(jobs[0], 0, 10).await.unwrap();
    let times: Vec<String> = events.entries.into_iter().map(|event| event.at).collect();
    assert!(times.len() == 4 && times.is_sorted(), "{times:?}");
    let job = bench.project().job(jobs[0]).await.unwrap().unwrap();
    assert!(job.created <= job.started.clone().unwrap() && job.started <= job.finished);

    jobs.push(bench.submit("behind").await);
    // and for a process that is started with the clock as it is now, too
    let clock = Clock::default();
    clock.turn(SignedDuration::from_hours(-1));
    let other = open(&bench.database, &clock).await;
    let project = other.project(DEFAULT_PROJECT, "");
    let last = project.submit(clock.new_id(), &new_job("last")).await;
    jobs.push(last.unwrap().id);
    let all = project.jobs(&JobFilter::default(), None, 10).await.unwrap();
    let listed: Vec<uuid::Uuid> = all.unwrap().entries.iter().map(|job| job.id).collect();
    jobs.reverse();
    assert_eq!(listed, jobs);
    // or with the clock as it was when somebody had set it to 2100
    let far = "03bb2cc3-d800-7000-8000-000000000000".parse().unwrap();
    project.submit(far, &new_job("far")).await.unwrap();
    let clock = Clock::default();
    let another = open(&bench.database, &clock).await;
    let id = clock.new_id();
    assert!(id > far, "{id}");
    drop(another);
    // the one that was submitted first is taken first
    assert_eq!(bench.claim("w/1").await.job, jobs[1]);
}

/// A lease of before the machine was started is over, however long the machine has been up since.
#[tokio::test]
async fn a_lease_does_not_outlive_the_machine() {
    let bench = Bench::on(Database::file()).await;
    let pool = sqlx::AnyPool::connect(&bench.url()).await.unwrap();
    let job = bench.submit("job").await;
    for (round, lease) in [
        "boot 00000000-0000-0000-0000-000000000000 999999999999999",
        // as it was written before
        "2120-01-01T00:00:00.000Z",
    ]
    .into_iter()
    .enumerate()
    {
        bench.claim(&format!("dead{round}/1")).await;
        let written = sqlx::query("UPDATE jobs SET lease_until = $1")
            .bind(lease)
            .execute(&pool);
        written.await.unwrap();
        let taken = bench.claim(&format!("w{round}/1")).await;
        assert_eq!(taken.job, job);
        bench.store.release(&taken, "shutdown").await.unwrap();
    }
}
