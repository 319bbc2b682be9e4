//! What was accepted is there, is listed, heard of and counted.

use std::time::Duration;

use crate::bench::{Bench, finish_next, on_both, prepared};
use crate::common::database::Database;
use trimtab::job::{EventBody, Fault};
use trimtab::store::{DEFAULT_PROJECT, JobFilter, Signal, Waiting};

on_both! {
    what_was_accepted_is_there_after_reopening,
    lists_page_through_everything_once,
    who_listens_before_looking_misses_nothing,
    what_goes_on_is_counted_over_all_processes,
}

async fn what_was_accepted_is_there_after_reopening(bench: Bench) {
    let job = bench.submit("job").await;
    let claim = bench.claim("w").await;
    let faults = vec![Fault::new("/model", "some_code", "a message")];
    bench
        .store
        .finish(&claim, 0, &[], EventBody::Failed { faults }, None)
        .await
        .unwrap();
    let before = bench.project().job(job).await.unwrap();
    bench.store.close().await;
    let reopened = bench.other().await;
    assert_eq!(
        reopened
            .project(DEFAULT_PROJECT, "")
            .job(job)
            .await
            .unwrap(),
        before
    );
    assert!(
        reopened
            .project(DEFAULT_PROJECT, "")
            .job_spec(job)
            .await
            .unwrap()
            .unwrap()
            .contains("\"job\"")
    );
}

async fn lists_page_through_everything_once(bench: Bench) {
    let mut submitted = Vec::new();
    for number in 0..7 {
        submitted.push(bench.submit(&format!("{number}")).await);
    }
    submitted.reverse();
    let filter = JobFilter {
        tag: Some("tag".into()),
        ..Default::default()
    };
    let (mut seen, mut cursor) = (Vec::new(), None);
    loop {
        let page = bench
            .project()
            .jobs(&filter, cursor.as_deref(), 3)
            .await
            .unwrap()
            .unwrap();
        seen.extend(page.entries.into_iter().map(|job| job.id));
        // what is added meanwhile is newer than the list's begin
        bench.submit("meanwhile").await;
        cursor = page.next_cursor;
        if cursor.is_none() {
            break;
        }
    }
    assert_eq!(seen, submitted);
    assert!(
        bench
            .project()
            .jobs(&filter, Some("no cursor"), 3)
            .await
            .unwrap()
            .is_err()
    );
    let none = JobFilter {
        tag: Some("' OR 1=1 --".into()),
        ..Default::default()
    };
    assert!(
        bench
            .project()
            .jobs(&none, None, 3)
            .await
            .unwrap()
            .unwrap()
            .entries
            .is_empty()
    );
}

async fn who_listens_before_looking_misses_nothing(bench: Bench) {
    let job = bench.submit("job").await;
    let claim = bench.claim("w").await;
    let mut listener = bench.store.listen();
    bench.store.record(&claim, 0, &[prepared()]).await.unwrap();
    let forever = Duration::from_secs(3600);
    let heard = listener.wait_for(Signal::Log(job), forever);
    tokio::time::timeout(Duration::from_secs(5), heard)
        .await
        .expect("was signalled");
}

/// On a file, another process looks after a while; a PostgreSQL tells it.
#[tokio::test]
async fn a_signal_reaches_other_processes() {
    let Some(database) = Database::postgres("a_signal_reaches_other_processes").await else {
        return;
    };
    let bench = Bench::on(database).await;
    let other = bench.other().await;
    let forever = Duration::from_secs(3600);
    let within = Duration::from_secs(5);
    let mut listener = other.listen();
    let job = bench.submit("job").await;
    let heard = listener.wait_for(Signal::Work, forever);
    tokio::time::timeout(within, heard)
        .await
        .expect("of the job");
    bench.claim("w").await;
    let heard = listener.wait_for(Signal::Log(job), forever);
    tokio::time::timeout(within, heard)
        .await
        .expect("of its log");
    bench.project().cancel(job).await.unwrap();
    let heard = listener.wait_for(Signal::Cancel(job), forever);
    tokio::time::timeout(within, heard)
        .await
        .expect("of the wish");
}

async fn what_goes_on_is_counted_over_all_processes(bench: Bench) {
    for _ in 0..3 {
        bench.submit("job").await;
    }
    bench.clock.advance(Duration::from_secs(2));
    let waiting = bench.store.census().await.unwrap();
    assert_eq!(waiting.jobs, [("queued".to_string(), 3)]);
    assert!((2.0..10.0).contains(&waiting.oldest_wait), "{waiting:?}");
    finish_next(&bench).await;
    let claim = bench.claim("w").await;
    let faults = vec![Fault::new("", "out_of_luck", "no")];
    let failed = EventBody::Failed { faults };
    bench
        .store
        .finish(&claim, 0, &[], failed, None)
        .await
        .unwrap();
    let census = bench.other().await.census().await.unwrap();
    let count = |name: &str, number| (name.to_string(), number);
    assert_eq!(
        census.ended,
        [count("out_of_luck", 1), count("succeeded", 1)]
    );
    assert_eq!(
        census.jobs,
        [
            count("failed", 1),
            count("queued", 1),
            count("succeeded", 1)
        ]
    );
    // 2 s and a little more: behind 1 s, before 3 s
    assert_eq!(census.waited.counts[5], 2, "{census:?}");
    assert!((4.0..6.0).contains(&census.waited.sum), "{census:?}");
    assert_eq!(census.ran.counts.iter().sum::<u64>(), 2);
    let (most, own) = (
        bench.project(),
        bench.store.project(DEFAULT_PROJECT, "another key"),
    );
    assert_eq!(most.waiting(10).await.unwrap(), Waiting { all: 1, own: 1 });
    assert_eq!(own.waiting(10).await.unwrap(), Waiting { all: 1, own: 0 });
}
