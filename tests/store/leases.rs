//! What a worker may write, and for how long.

use std::time::Duration;

use crate::bench::{Bench, on_both, prepared, succeeded};
use trimtab::job::Status;
use trimtab::store::{LEASE, StoreError};

on_both! {
    a_worker_that_lost_its_lease_cannot_write_any_more,
    the_same_worker_with_an_earlier_claim_is_a_ghost_too,
    heartbeats_keep_a_lease,
    what_is_written_again_is_written_once,
    a_claim_that_was_not_heard_of_is_given_again,
    what_was_told_last_arrives_with_the_end,
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
