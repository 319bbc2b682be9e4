//! What the store promises to those on both sides of it.

#[path = "../common"]
mod common {
    pub(crate) mod database;
    pub(crate) mod recordings;
}

use std::time::Duration;

use crate::common::database::Database;
use crate::common::recordings::{elevator, maneuver};
use trimtab::estimate::Options;
use trimtab::estimate::Outcome;
use trimtab::job::{EventBody, Fault, JobSpec, ModelSource, Status};
use trimtab::model::ModelDocument;
use trimtab::store::{
    Attempt, CancelReply, Claim, Clock, DEFAULT_PROJECT, JobFilter, Key, KeyCheck, LEASE,
    MOST_LOST_WORKERS, NewJob, NewKey, Once, Project, Rule, Scope, Signal, Store, StoreError,
    Uploaded, Waiting,
};

struct Bench {
    store: Store,
    clock: Clock,
    database: Database,
}

impl Bench {
    async fn on(database: Database) -> Self {
        let clock = Clock::default();
        let store = open(&database, &clock).await;
        Self {
            store,
            clock,
            database,
        }
    }

    /// Another process on the same database.
    async fn other(&self) -> Store {
        open(&self.database, &self.clock).await
    }

    /// The database as the driver has it.
    fn url(&self) -> String {
        let address = &self.database.address;
        if address.starts_with("postgres:") {
            return address.clone();
        }
        format!("sqlite://{address}")
    }

    fn project(&self) -> Project {
        self.store.project(DEFAULT_PROJECT, "")
    }

    async fn submit(&self, name: &str) -> uuid::Uuid {
        let id = self.clock.new_id();
        self.project().submit(id, &new_job(name)).await.unwrap().id
    }

    async fn claim(&self, worker: &str) -> Claim {
        self.store
            .claim(worker)
            .await
            .unwrap()
            .expect("a job waits")
    }

    async fn event_names(&self, job: uuid::Uuid) -> Vec<String> {
        let events = self.project().events(job, 0, 1000).await.unwrap().entries;
        let numbers: Vec<u64> = events.iter().map(|event| event.seq).collect();
        let expected: Vec<u64> = (1..=events.len() as u64).collect();
        assert_eq!(numbers, expected, "numbers without holes");
        events.into_iter().map(|event| event.name).collect()
    }

    async fn status(&self, job: uuid::Uuid) -> Status {
        self.project().job(job).await.unwrap().unwrap().status
    }
}

async fn open(database: &Database, clock: &Clock) -> Store {
    Store::open_with_clock(&database.address, clock.clone())
        .await
        .unwrap()
}

fn new_job(name: &str) -> NewJob {
    let spec = JobSpec {
        kind: Default::default(),
        name: name.into(),
        tags: vec!["tag".into()],
        priority: 0,
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
        priority: 0,
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

/// Each promise is kept on a file, and on a PostgreSQL.
macro_rules! on_both {
    ($($promise:ident,)*) => {
        mod sqlite {
            use super::*;
            $(#[tokio::test] async fn $promise() {
                super::$promise(Bench::on(Database::file()).await).await;
            })*
        }
        mod postgres {
            use super::*;
            $(#[tokio::test] async fn $promise() {
                if let Some(database) = Database::postgres(stringify!($promise)).await {
                    super::$promise(Bench::on(database).await).await;
                }
            })*
        }
    };
}

on_both! {
    projects_see_nothing_of_each_other,
    a_key_opens_until_it_is_revoked_or_expires,
    each_key_is_served_in_turn,
    a_higher_priority_goes_first,
    what_a_webhook_is_owed_is_taken_by_one_and_sent_until_it_arrives,
    what_is_old_goes_from_one_project_or_from_all,
    what_goes_on_is_counted_over_all_processes,
    a_mapping_is_kept_under_its_name,
    jobs_are_claimed_once_and_oldest_first,
    many_workers_on_two_processes_never_share_a_job,
    a_worker_that_lost_its_lease_cannot_write_any_more,
    the_same_worker_with_an_earlier_claim_is_a_ghost_too,
    heartbeats_keep_a_lease,
    a_job_that_kills_its_workers_is_given_up,
    giving_a_job_back_is_no_loss,
    cancelling_a_queued_job_ends_it_at_once,
    the_wish_to_cancel_outlives_the_worker,
    what_was_accepted_is_there_after_reopening,
    lists_page_through_everything_once,
    who_listens_before_looking_misses_nothing,
    a_later_schema_is_refused_not_damaged,
    what_is_written_again_is_written_once,
    what_was_told_last_arrives_with_the_end,
    a_claim_that_was_not_heard_of_is_given_again,
    processes_that_start_at_once_do_not_disturb_each_other,
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

async fn a_job_that_kills_its_workers_is_given_up(bench: Bench) {
    let job = bench.submit("killer").await;
    let mut claims = Vec::new();
    for _ in 0..MOST_LOST_WORKERS {
        claims.push(bench.claim("victim").await);
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
    assert_eq!(job.attempt, MOST_LOST_WORKERS, "giving up is no attempt");
    // the last of them was only slow, and must not take the end for its own
    let late = bench
        .store
        .finish(&claims[2], 0, &[], succeeded(), None)
        .await;
    assert!(matches!(late, Err(StoreError::LeaseLost)));
}

async fn giving_a_job_back_is_no_loss(bench: Bench) {
    let job = bench.submit("job").await;
    for _ in 0..=2 * MOST_LOST_WORKERS {
        let claim = bench.claim("w").await;
        bench.store.release(&claim, "shutdown").await.unwrap();
        assert_eq!(bench.status(job).await, Status::Queued);
    }
    assert_eq!(bench.claim("w").await.job, job);
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
    let ending = EventBody::Cancelled { has_result: false };
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

async fn a_later_schema_is_refused_not_damaged(bench: Bench) {
    let pool = sqlx::AnyPool::connect(&bench.url()).await.unwrap();
    sqlx::query("INSERT INTO schema_steps (version, applied) VALUES (999, 'later')")
        .execute(&pool)
        .await
        .unwrap();
    let refused = Store::open(&bench.database.address)
        .await
        .err()
        .expect("refused");
    assert!(refused.to_string().contains("later version"), "{refused}");
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

async fn processes_that_start_at_once_do_not_disturb_each_other(bench: Bench) {
    let stores = futures_util::future::join_all((0..4).map(|_| bench.other())).await;
    bench.submit("job").await;
    assert!(stores[3].claim("w").await.unwrap().is_some());
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

async fn projects_see_nothing_of_each_other(bench: Bench) {
    let job = bench.submit("job").await;
    let claim = bench.claim("w").await;
    assert_eq!(claim.project, DEFAULT_PROJECT);
    bench
        .store
        .finish(&claim, 0, &[], succeeded(), None)
        .await
        .unwrap();
    let other = bench.store.project("other", "");
    assert_eq!(other.job(job).await.unwrap(), None);
    assert_eq!(other.job_spec(job).await.unwrap(), None);
    assert_eq!(other.events(job, 0, 10).await.unwrap().entries, []);
    assert_eq!(other.iterations(job).await.unwrap(), []);
    assert_eq!(other.cancel(job).await.unwrap(), CancelReply::Unknown);
    let all = other.jobs(&JobFilter::default(), None, 10).await.unwrap();
    assert_eq!(all.unwrap().entries, []);
    // the id of another's job is no way in, either
    let again = other.submit(job, &new_job("mine")).await;
    assert!(again.is_err());
    let ours = bench.project();
    let ids = [ours.clone(), other].map(|project| async move {
        let same = maneuver(elevator().as_bytes());
        let kept = project.add_maneuver("same", same, "{}".into()).await;
        match kept.unwrap() {
            Uploaded::New(record) => record.id,
            Uploaded::Known(_) => panic!("another has it"),
        }
    });
    let [ours_has, theirs_has] = ids;
    assert_eq!(ours_has.await, theirs_has.await, "it is the same content");
    let third = bench.store.project("third", "");
    assert_eq!(
        third.maneuvers(None, 10).await.unwrap().unwrap().entries,
        []
    );
    let mine = ours.take_in_hand("key", "request").await.unwrap();
    assert!(matches!(mine, Once::Do(_)));
    let another_key = bench.store.project(DEFAULT_PROJECT, "another key");
    let theirs = another_key.take_in_hand("key", "other").await.unwrap();
    assert!(matches!(theirs, Once::Do(_)), "{theirs:?}");
}

fn new_key(project: &str) -> NewKey {
    NewKey {
        project: project.into(),
        name: "a key".into(),
        scopes: [Scope::Read].into(),
        max_priority: 0,
        lifetime: None,
    }
}

async fn a_key_opens_until_it_is_revoked_or_expires(bench: Bench) {
    let store = &bench.store;
    assert!(!store.has_keys().await.unwrap());
    let short = NewKey {
        lifetime: Some(Duration::from_secs(60)),
        ..new_key("p")
    };
    let (short, of_short) = store.add_key(&short).await.unwrap();
    let (long, of_long) = store.add_key(&new_key("p")).await.unwrap();
    let shown = async |key: &Key| store.look_up_key(key.reveal()).await.unwrap();
    assert_eq!(long.lifetime, None);
    let good = |shown: KeyCheck| match shown {
        KeyCheck::Good(key) => key.id,
        bad => panic!("{bad:?}"),
    };
    assert_eq!(good(shown(&of_short).await), short.id);
    assert_eq!(good(shown(&of_long).await), long.id);
    let nobody = format!("{}0", of_long.reveal());
    assert_eq!(store.look_up_key(&nobody).await.unwrap(), KeyCheck::Unknown);
    // what is listed is not what opens
    let listed = store.keys(Some("p")).await.unwrap();
    assert_eq!(listed.len(), 2);
    assert!(listed.iter().all(|key| key.used.is_some()));
    assert!(!format!("{listed:?} {of_long:?}").contains(of_long.reveal()));
    assert_eq!(store.keys(Some("other")).await.unwrap(), []);

    bench.clock.advance(Duration::from_secs(61));
    assert_eq!(shown(&of_short).await, KeyCheck::Expired);
    let none = store.rotate_key(None, short.id, Duration::ZERO).await;
    assert!(none.unwrap().is_none(), "what is expired is not prolonged");
    let foreign = store.rotate_key(Some("other"), long.id, Duration::ZERO);
    assert!(foreign.await.unwrap().is_none());
    let hour = Duration::from_secs(3600);
    let (next, of_next) = store
        .rotate_key(Some("p"), long.id, hour)
        .await
        .unwrap()
        .unwrap();
    assert_eq!(
        (good(shown(&of_long).await), good(shown(&of_next).await)),
        (long.id, next.id)
    );
    bench.clock.advance(hour);
    assert_eq!(shown(&of_long).await, KeyCheck::Expired);

    assert_eq!(
        store.revoke_key(Some("other"), next.id).await.unwrap(),
        None
    );
    assert_eq!(good(shown(&of_next).await), next.id);
    let revoked = store.revoke_key(Some("p"), next.id).await.unwrap().unwrap();
    assert_eq!(shown(&of_next).await, KeyCheck::Revoked);
    let again = store.revoke_key(Some("p"), next.id).await.unwrap().unwrap();
    assert_eq!(again.revoked, revoked.revoked);
    assert!(
        store.has_keys().await.unwrap(),
        "revoking all opens nothing"
    );
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

/// Claims the next job and ends it.
async fn finish_next(bench: &Bench) {
    let claim = bench.claim("w").await;
    let done = bench.store.finish(&claim, 0, &[], succeeded(), None);
    done.await.unwrap();
}

async fn what_a_webhook_is_owed_is_taken_by_one_and_sent_until_it_arrives(bench: Bench) {
    let project = bench.project();
    let events = ["job.succeeded".to_string()];
    let id = bench.clock.new_id();
    let hook = project.add_webhook(id, "https://lab.example/", &events, "whsec_a");
    assert_eq!(project.webhook(id).await.unwrap(), None);
    let hook = hook.await.unwrap();
    assert_eq!(
        project.webhooks().await.unwrap(),
        std::slice::from_ref(&hook)
    );
    let other = bench.store.project("other", "");
    assert_eq!(other.webhooks().await.unwrap(), []);
    assert!(!other.rotate_webhook(id, "mine", LEASE).await.unwrap());
    assert!(!other.delete_webhook(id).await.unwrap());

    let job = bench.submit("job").await;
    assert_eq!(bench.store.take_delivery().await.unwrap(), None);
    finish_next(&bench).await;
    let taken = bench
        .store
        .take_delivery()
        .await
        .unwrap()
        .expect("a delivery");
    assert_eq!(
        (taken.job.clone(), taken.event.as_str()),
        (job.to_string(), "job.succeeded")
    );
    assert_eq!(
        (taken.attempts, &taken.secrets),
        (1, &vec!["whsec_a".to_string()])
    );
    let second = bench.other().await;
    assert_eq!(second.take_delivery().await.unwrap(), None, "it is in hand");
    // who took it died
    bench.clock.advance(Duration::from_secs(61));
    let again = second.take_delivery().await.unwrap().expect("a delivery");
    assert_eq!((again.id, again.attempts), (taken.id, 2));
    let failed = Attempt::Failed {
        status: Some(500),
        fault: "it answers 500".into(),
        again: Some(Duration::from_secs(5)),
    };
    second.settle_delivery(&again, &failed).await.unwrap();
    let hour = Duration::from_secs(3600);
    assert!(project.rotate_webhook(id, "whsec_b", hour).await.unwrap());
    bench.clock.advance(Duration::from_secs(6));
    let third = bench
        .store
        .take_delivery()
        .await
        .unwrap()
        .expect("a delivery");
    assert_eq!(third.secrets, ["whsec_b", "whsec_a"]);
    bench
        .store
        .settle_delivery(&third, &Attempt::Arrived(204))
        .await
        .unwrap();
    bench.clock.advance(hour * 100);
    assert_eq!(bench.store.take_delivery().await.unwrap(), None);
    let log = project.deliveries(id, 10).await.unwrap();
    assert_eq!(
        (log.len(), log[0].attempts, log[0].status),
        (1, 3, Some(204))
    );
    assert!(log[0].done.is_some() && log[0].next.is_none() && log[0].fault.is_none());
    assert_eq!(other.deliveries(id, 10).await.unwrap(), []);

    // two are owed when the receiver says that it is gone: neither is sent again
    for _ in 0..2 {
        project.try_webhook(id).await.unwrap();
    }
    let one = bench
        .store
        .take_delivery()
        .await
        .unwrap()
        .expect("a delivery");
    assert_eq!(
        one.secrets,
        ["whsec_b"],
        "the former secret has had its time"
    );
    bench
        .store
        .settle_delivery(&one, &Attempt::Gone(410))
        .await
        .unwrap();
    assert_eq!(bench.store.take_delivery().await.unwrap(), None);
    assert!(
        project
            .webhook(id)
            .await
            .unwrap()
            .unwrap()
            .disabled
            .is_some()
    );
    assert!(project.delete_webhook(id).await.unwrap());
    assert_eq!(project.webhooks().await.unwrap(), []);
}

async fn what_is_old_goes_from_one_project_or_from_all(bench: Bench) {
    let projects = ["a", "b"].map(|name| bench.store.project(name, ""));
    for project in &projects {
        let recording = maneuver(elevator().as_bytes());
        let kept = project.add_maneuver("x", recording, "{}".into()).await;
        assert!(matches!(kept.unwrap(), Uploaded::New(_)));
        let id = bench.clock.new_id();
        project.submit(id, &new_job(project.name())).await.unwrap();
        finish_next(&bench).await;
    }
    bench.clock.advance(Duration::from_secs(100));
    let rule = |project: Option<&str>, keep_tag: &str| Rule {
        project: project.map(str::to_string),
        before: bench.clock.text_before(Duration::from_secs(50)),
        keep_tag: keep_tag.into(),
    };
    let expire = async |rule: Rule, dry_run: bool| {
        let expired = bench.store.expire(&rule, dry_run).await.unwrap();
        (expired.jobs, expired.maneuvers)
    };
    assert_eq!(expire(rule(None, "keep"), true).await, (2, 2));
    assert_eq!(
        expire(rule(None, "tag"), true).await,
        (0, 2),
        "the jobs have that tag"
    );
    assert_eq!(expire(rule(Some("nobody"), "keep"), false).await, (0, 0));
    assert_eq!(expire(rule(Some("a"), "keep"), false).await, (1, 1));
    assert_eq!(expire(rule(None, "keep"), false).await, (1, 1));
    assert_eq!(expire(rule(None, "keep"), false).await, (0, 0));
    assert_eq!(projects[1].stored_bytes().await.unwrap(), 0);
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

async fn a_mapping_is_kept_under_its_name(bench: Bench) {
    let project = bench.project();
    assert!(project.add_mapping("logger", "{}").await.unwrap());
    assert!(
        project.add_mapping("logger", "{}").await.unwrap(),
        "it is the same"
    );
    assert!(!project.add_mapping("logger", "{\"x\": 1}").await.unwrap());
    let other = bench.store.project("other", "");
    assert!(other.add_mapping("logger", "{\"x\": 1}").await.unwrap());
    let kept = project
        .mapping("logger")
        .await
        .unwrap()
        .expect("the mapping");
    assert_eq!(kept.document, "{}");
    assert_eq!(project.mappings().await.unwrap(), [kept]);
    assert!(project.delete_mapping("logger").await.unwrap());
    assert!(!project.delete_mapping("logger").await.unwrap());
    assert_eq!(other.mappings().await.unwrap().len(), 1);
}

/// A database as the first `version` steps have made it, in a file.
async fn database_of(version: usize, file: &str) -> sqlx::AnyPool {
    const STEPS: [&str; 7] = [
        include_str!("../../src/store/migrations/0001_first.sql"),
        include_str!("../../src/store/migrations/0002_many_machines.sql"),
        include_str!("../../src/store/migrations/0003_answers.sql"),
        include_str!("../../src/store/migrations/0004_projects.sql"),
        include_str!("../../src/store/migrations/0005_tallies.sql"),
        include_str!("../../src/store/migrations/0006_webhooks.sql"),
        include_str!("../../src/store/migrations/0007_mappings.sql"),
    ];
    sqlx::any::install_default_drivers();
    let url = format!("sqlite://{file}?mode=rwc");
    let pool = sqlx::AnyPool::connect(&url).await.unwrap();
    let table =
        "CREATE TABLE schema_steps (version BIGINT PRIMARY KEY NOT NULL, applied TEXT NOT NULL)";
    sqlx::raw_sql(table).execute(&pool).await.unwrap();
    for (number, step) in (1..).zip(&STEPS[..version]) {
        sqlx::raw_sql(*step).execute(&pool).await.unwrap();
        sqlx::query("INSERT INTO schema_steps VALUES ($1, '')")
            .bind(number)
            .execute(&pool)
            .await
            .unwrap();
    }
    pool
}

/// A key that was to expire is not replaced by one that never does, though nobody had written down for how long it was meant.
#[tokio::test]
async fn a_key_from_before_lifetimes_were_kept_has_the_one_it_had() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("old.db");
    let file = file.to_str().unwrap();
    let pool = database_of(7, file).await;
    let [ending, lasting] = [1, 2].map(|n| format!("01950000-0000-7000-8000-00000000000{n}"));
    for (id, expires) in [
        (&ending, Some("2120-01-01T00:00:00.000Z")),
        (&lasting, None),
    ] {
        sqlx::query(
            "INSERT INTO keys (id, project, name, digest, scopes, max_priority, created, expires) \
             VALUES ($1, 'default', 'n', $1, '[\"read\"]', 0, '2020-01-01T00:00:00.000Z', $2)",
        )
        .bind(id)
        .bind(expires)
        .execute(&pool)
        .await
        .unwrap();
    }
    pool.close().await;

    let store = Store::open(file).await.unwrap();
    for (id, expires) in [(ending, true), (lasting, false)] {
        let id = id.parse().unwrap();
        let rotated = store.rotate_key(None, id, Duration::from_secs(3600)).await;
        let (key, _) = rotated.unwrap().expect("a good key");
        assert_eq!(key.expires.is_some(), expires, "{key:?}");
    }
}

/// What a database of an earlier version has is the default project's, whole.
#[tokio::test]
async fn a_database_from_before_there_were_projects_is_carried_over() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("old.db");
    let address = file.to_str().unwrap();
    let pool = database_of(3, address).await;
    let rows = "INSERT INTO maneuvers VALUES ('m', 'run 1', '2026-11-21T12:00:00.000Z', '{}', X'0102'); \
         INSERT INTO models VALUES ('01950000-0000-7000-8000-000000000001', 'n', 't', '2026-11-21T12:00:00.000Z', '{\"name\": \"n\"}'); \
         INSERT INTO answers VALUES ('k', 'r', '01950000-0000-7000-8000-000000000002', '9999', NULL, NULL)";
    sqlx::raw_sql(rows).execute(&pool).await.unwrap();
    let spec = r#"{"model": "short-period", "maneuvers": [{"id": "m"}]}"#;
    let model = serde_json::to_string(&ModelDocument::default()).unwrap();
    sqlx::query(
        "INSERT INTO jobs (id, kind, name, tags, status, created, last_seq, attempt, lost, spec, model) \
         VALUES ('01950000-0000-7000-8000-000000000003', 'estimate', 'old', '[]', 'queued', '2026-11-21T12:00:00.000Z', 0, 0, 0, $1, $2)",
    )
    .bind(spec)
    .bind(model)
    .execute(&pool)
    .await
    .unwrap();
    pool.close().await;

    let store = Store::open(address).await.unwrap();
    let project = store.project(DEFAULT_PROJECT, "");
    assert_eq!(project.maneuver("m").await.unwrap().unwrap().name, "run 1");
    assert_eq!(project.stored_bytes().await.unwrap(), 2);
    let model = "01950000-0000-7000-8000-000000000001".parse().unwrap();
    assert!(project.model(model).await.unwrap().is_some());
    let once = project.take_in_hand("k", "r").await.unwrap();
    assert_eq!(once, Once::InHand);
    let claim = store.claim("w").await.unwrap().expect("the old job");
    assert_eq!(
        (claim.project.as_str(), claim.spec.maneuvers[0].id.as_str()),
        (DEFAULT_PROJECT, "m")
    );
}
