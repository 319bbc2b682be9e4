//! A store to try, with a clock that a test moves.

use crate::common::database::Database;
use trimtab::estimate::Options;
use trimtab::estimate::Outcome;
use trimtab::job::{EventBody, JobSpec, ModelSource, Status};
use trimtab::model::ModelDocument;
use trimtab::store::{Claim, Clock, DEFAULT_PROJECT, NewJob, Project, Store};

pub(crate) struct Bench {
    pub(crate) store: Store,
    pub(crate) clock: Clock,
    pub(crate) database: Database,
}

impl Bench {
    pub(crate) async fn on(database: Database) -> Self {
        let clock = Clock::default();
        let store = open(&database, &clock).await;
        Self {
            store,
            clock,
            database,
        }
    }

    /// Another process on the same database.
    pub(crate) async fn other(&self) -> Store {
        open(&self.database, &self.clock).await
    }

    /// The database as the driver has it.
    pub(crate) fn url(&self) -> String {
        let address = &self.database.address;
        if address.starts_with("postgres:") {
            return address.clone();
        }
        format!("sqlite://{address}")
    }

    pub(crate) fn project(&self) -> Project {
        self.store.project(DEFAULT_PROJECT, "")
    }

    pub(crate) async fn submit(&self, name: &str) -> uuid::Uuid {
        let id = self.clock.new_id();
        self.project().submit(id, &new_job(name)).await.unwrap().id
    }

    pub(crate) async fn claim(&self, worker: &str) -> Claim {
        self.store
            .claim(worker)
            .await
            .unwrap()
            .expect("a job waits")
    }

    pub(crate) async fn event_names(&self, job: uuid::Uuid) -> Vec<String> {
        let events = self.project().events(job, 0, 1000).await.unwrap().entries;
        let numbers: Vec<u64> = events.iter().map(|event| event.seq).collect();
        let expected: Vec<u64> = (1..=events.len() as u64).collect();
        assert_eq!(numbers, expected, "numbers without holes");
        events.into_iter().map(|event| event.name).collect()
    }

    pub(crate) async fn status(&self, job: uuid::Uuid) -> Status {
        self.project().job(job).await.unwrap().unwrap().status
    }
}

pub(crate) async fn open(database: &Database, clock: &Clock) -> Store {
    Store::open_with_clock(&database.address, clock.clone())
        .await
        .unwrap()
}

pub(crate) fn new_job(name: &str) -> NewJob {
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
        structure: None,
        knowledge: Default::default(),
        options: Options::default(),
        strict: Default::default(),
    };
    NewJob {
        kind: "estimate".into(),
        name: name.into(),
        tags: spec.tags.clone(),
        priority: 0,
        maneuvers: Vec::new(),
        spec: serde_json::to_string(&spec).unwrap(),
        model: serde_json::to_string(&ModelDocument::default()).unwrap(),
    }
}

pub(crate) fn succeeded() -> EventBody {
    EventBody::Succeeded {
        outcome: Outcome::Converged,
        reason: "converged".into(),
        findings: Default::default(),
    }
}

pub(crate) fn prepared() -> EventBody {
    EventBody::Prepared(trimtab::job::Prepared {
        segments: vec!["a".into()],
        validation: Vec::new(),
        samples: 1,
        outputs: Vec::new(),
        parameters: Vec::new(),
        findings: Vec::new(),
    })
}

/// Claims the next job and ends it.
pub(crate) async fn finish_next(bench: &Bench) {
    let claim = bench.claim("w").await;
    let done = bench.store.finish(&claim, 0, &[], succeeded(), None);
    done.await.unwrap();
}

/// Each promise is kept on a file, and on a PostgreSQL.
macro_rules! on_both {
    ($($promise:ident,)*) => {
        mod sqlite {
            use crate::bench::Bench;
            use crate::common::database::Database;
            $(#[tokio::test] async fn $promise() {
                super::$promise(Bench::on(Database::file()).await).await;
            })*
        }
        mod postgres {
            use crate::bench::Bench;
            use crate::common::database::Database;
            $(#[tokio::test] async fn $promise() {
                if let Some(database) = Database::postgres(stringify!($promise)).await {
                    super::$promise(Bench::on(database).await).await;
                }
            })*
        }
    };
}
pub(crate) use on_both;
