//! What the store promises to those on both sides of it.

use std::time::Duration;

use tempfile::TempDir;
use trimtab::estimate::Options;
use trimtab::estimate::Outcome;
use trimtab::job::{EventBody, Fault, JobSpec, ModelSource, Status};
use trimtab::model::ModelDocument;
use trimtab::store::{
    CancelReply, Claim, Clock, JobFilter, LEASE, MOST_LOST_WORKERS, NewJob, Signal, Store,
    StoreError,
};

struct Bench {
    store: Store,
    clock: Clock,
    directory: TempDir,
}

impl Bench {
    async fn new() -> Self {
        let directory = TempDir::new().unwrap();
        let clock = Clock::default();
        let store = open(&directory, &clock).await;
        Self {
            store,
            clock,
            directory,
        }
    }

    /// Another process on the same file.
    async fn other(&self) -> Store {
        open(&self.directory, &self.clock).await
    }

    async fn submit(&self, name: &str) -> uuid::Uuid {
        self.store.submit(&new_job(name)).await.unwrap().id
    }

    async fn claim(&self, worker: &str) -> Claim {
        self.store
            .claim(worker)
            .await
            .unwrap()
            .expect("a job waits")
    }

    async fn event_names(&self, job: uuid::Uuid) -> Vec<String> {
        let events = self.store.events(job, 0, 1000).await.unwrap().entries;
        let numbers: Vec<u64> = events.iter().map(|event| event.seq).collect();
        let expected: Vec<u64> = (1..=events.len() as u64).collect();
        assert_eq!(numbers, expected, "numbers without holes");
        events.into_iter().map(|event| event.name).collect()
    }

    async fn status(&self, job: uuid::Uuid) -> Status {
        self.store.job(job).await.unwrap().unwrap().status
    }
}

async fn open(directory: &TempDir, clock: &Clock) -> Store {
    let path = directory.path().join("store.db");
    Store::open_with_clock(path.to_str().unwrap(), clock.clone())
        .await
        .unwrap()
}

fn new_job(name: &str) -> NewJob {
    let spec = JobSpec {
        kind: Default::default(),
        name: name.into(),
        tags: vec!["tag".into()],
        model: ModelSource::Reference("short-period".into()),
        edits: Vec::new(),
        maneuvers: Vec::new(),
        channels: Default::default(),
        parameters: Default::default(),
        constants: Default::default(),
        candidates: Vec::new(),
        options: Options::default(),
    };
    NewJob {
        kind: "estimate".into(),
        name: name.into(),
        tags: spec.tags.clone(),
        spec: serde_json::to_string(&spec).unwrap(),
        model: serde_json::to_string(&ModelDocument::default()).unwrap(),
    }
}

fn succeeded() -> EventBody {
    EventBody::Succeeded {
        outcome: Outcome::Converged,
        reason: "converged".into(),
    }
}

fn prepared() -> EventBody {
    EventBody::Prepared(trimtab::job::Prepared {
        segments: vec!["a".into()],
        validation: Vec::new(),
        samples: 1,
        outputs: Vec::new(),
        parameters: Vec::new(),
        findings: Vec::new(),
    })
}

#[tokio::test]
async fn jobs_are_claimed_once_and_oldest_first() {
    let bench = Bench::new().await;
    let (first, second) = (bench.submit("first").await, bench.submit("second").await);
    assert_eq!(bench.claim("w1").await.job, first);
    assert_eq!(bench.claim("w2").await.job, second);
    assert!(bench.store.claim("w3").await.unwrap().is_none());
    assert_eq!(bench.event_names(first).await, ["queued", "claimed"]);
    assert_eq!(bench.status(first).await, Status::Running);
}

#[tokio::test]
async fn many_workers_on_two_processes_never_share_a_job() {
    let bench = Bench::new().await;
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
            while let Some(claim) = store.claim(&format!("w{number}")).await.unwrap() {
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

#[tokio::test]
async fn a_worker_that_lost_its_lease_cannot_write_any_more() {
    let bench = Bench::new().await;
    let job = bench.submit("job").await;
    let ghost = bench.claim("ghost").await;
    bench.clock.advance(LEASE + Duration::from_secs(1));
    let successor = bench.claim("successor").await;
    assert_eq!((successor.job, successor.attempt), (job, 2));

    let lost = |result| assert!(matches!(result, Err(StoreError::LeaseLost)));
    lost(bench.store.heartbeat(&ghost).await.map(drop));
    lost(bench.store.record(&ghost, &[prepared()]).await);
    lost(bench.store.finish(&ghost, succeeded(), None).await);
    lost(bench.store.release(&ghost, "late").await);

    bench.store.record(&successor, &[prepared()]).await.unwrap();
    bench
        .store
        .finish(&successor, succeeded(), None)
        .await
        .unwrap();
    lost(bench.store.finish(&successor, succeeded(), None).await);
    let log = ["queued", "claimed", "claimed", "prepared", "succeeded"];
    assert_eq!(bench.event_names(job).await, log);
}

#[tokio::test]
async fn the_same_worker_with_an_earlier_claim_is_a_ghost_too() {
    let bench = Bench::new().await;
    bench.submit("job").await;
    let before = bench.claim("w").await;
    bench.clock.advance(LEASE + Duration::from_secs(1));
    bench.claim("w").await;
    let result = bench.store.finish(&before, succeeded(), None).await;
    assert!(matches!(result, Err(StoreError::LeaseLost)));
}

#[tokio::test]
async fn heartbeats_keep_a_lease() {
    let bench = Bench::new().await;
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

#[tokio::test]
async fn a_job_that_kills_its_workers_is_given_up() {
    let bench = Bench::new().await;
    let job = bench.submit("killer").await;
    for _ in 0..MOST_LOST_WORKERS {
        bench.claim("victim").await;
        bench.clock.advance(LEASE + Duration::from_secs(1));
    }
    let innocent = bench.submit("innocent").await;
    assert_eq!(bench.claim("w").await.job, innocent);
    let job = bench.store.job(job).await.unwrap().unwrap();
    assert_eq!(job.status, Status::Failed);
    let Some(EventBody::Failed { faults }) = job.ending else {
        panic!("{:?}", job.ending)
    };
    assert_eq!(faults[0].code, "workers_lost");
}

#[tokio::test]
async fn giving_a_job_back_is_no_loss() {
    let bench = Bench::new().await;
    let job = bench.submit("job").await;
    for _ in 0..=2 * MOST_LOST_WORKERS {
        let claim = bench.claim("w").await;
        bench.store.release(&claim, "shutdown").await.unwrap();
        assert_eq!(bench.status(job).await, Status::Queued);
    }
    assert_eq!(bench.claim("w").await.job, job);
}

#[tokio::test]
async fn cancelling_a_queued_job_ends_it_at_once() {
    let bench = Bench::new().await;
    let job = bench.submit("job").await;
    let CancelReply::Asked(record) = bench.store.cancel(job).await.unwrap() else {
        panic!()
    };
    assert_eq!(record.status, Status::Cancelled);
    assert!(record.finished.is_some());
    assert!(matches!(
        bench.store.cancel(job).await.unwrap(),
        CancelReply::AlreadyOver(_)
    ));
    assert!(bench.store.claim("w").await.unwrap().is_none());
    assert_eq!(
        bench.event_names(job).await,
        ["queued", "cancel_requested", "cancelled"]
    );
    let unknown = bench.store.cancel(uuid::Uuid::nil()).await.unwrap();
    assert_eq!(unknown, CancelReply::Unknown);
}

#[tokio::test]
async fn the_wish_to_cancel_outlives_the_worker() {
    let bench = Bench::new().await;
    let job = bench.submit("job").await;
    let claim = bench.claim("w1").await;
    bench.store.cancel(job).await.unwrap();
    bench.store.cancel(job).await.unwrap();
    assert_eq!(
        bench.store.heartbeat(&claim).await.unwrap(),
        Status::Cancelling
    );
    bench.store.release(&claim, "shutdown").await.unwrap();
    assert_eq!(bench.status(job).await, Status::Cancelling);
    let claim = bench.claim("w2").await;
    assert!(claim.cancelling);
    let ending = EventBody::Cancelled { has_result: false };
    bench.store.finish(&claim, ending, None).await.unwrap();
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

#[tokio::test]
async fn what_was_accepted_is_there_after_reopening() {
    let bench = Bench::new().await;
    let job = bench.submit("job").await;
    let claim = bench.claim("w").await;
    let faults = vec![Fault::new("/model", "some_code", "a message")];
    bench
        .store
        .finish(&claim, EventBody::Failed { faults }, None)
        .await
        .unwrap();
    let before = bench.store.job(job).await.unwrap();
    bench.store.close().await;
    let reopened = bench.other().await;
    assert_eq!(reopened.job(job).await.unwrap(), before);
    assert!(
        reopened
            .job_spec(job)
            .await
            .unwrap()
            .unwrap()
            .contains("\"job\"")
    );
}

#[tokio::test]
async fn lists_page_through_everything_once() {
    let bench = Bench::new().await;
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
            .store
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
            .store
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
            .store
            .jobs(&none, None, 3)
            .await
            .unwrap()
            .unwrap()
            .entries
            .is_empty()
    );
}

#[tokio::test]
async fn who_listens_before_looking_misses_nothing() {
    let bench = Bench::new().await;
    let job = bench.submit("job").await;
    let claim = bench.claim("w").await;
    let mut listener = bench.store.listen();
    bench.store.record(&claim, &[prepared()]).await.unwrap();
    let forever = Duration::from_secs(3600);
    let heard = listener.wait_for(Signal::Log(job), forever);
    tokio::time::timeout(Duration::from_secs(5), heard)
        .await
        .expect("was signalled");
}

#[tokio::test]
async fn a_later_schema_is_refused_not_damaged() {
    let bench = Bench::new().await;
    let path = bench.directory.path().join("store.db");
    let url = format!("sqlite://{}", path.display());
    let pool = sqlx::AnyPool::connect(&url).await.unwrap();
    sqlx::query("INSERT INTO schema_steps (version, applied) VALUES (999, 'later')")
        .execute(&pool)
        .await
        .unwrap();
    let refused = Store::open(path.to_str().unwrap())
        .await
        .err()
        .expect("refused");
    assert!(refused.to_string().contains("later version"), "{refused}");
}
