//! What is kept: maneuvers, models, jobs, their logs and their results.
//!
//! The store is all that `http` and `work` share. What it promises:
//!
//! * A job that was accepted is on the disk, and so is an event before anybody is told of it.
//! * A job's status changes in the transaction that appends the event which changes it, and the
//!   result of a job arrives in the transaction of its last event: no reader sees a half of it.
//! * A worker holds a job by a lease. Each claim counts the job's `attempt` up; whoever writes with
//!   the number of an earlier attempt is refused ([`StoreError::LeaseLost`]).
//! * Maneuvers, models, specs, events and results are never changed once written; a maneuver's name and what is said of the
//!   flight may be.
//! * What users ask for is asked of a [`Project`], and no project sees anything of another.
//!
//! Invariant: SQL is here and nowhere else; both engines give the same answers.

mod about;
mod address;
mod answers;
mod audit;
mod backup;
mod boot;
mod clock;
mod columns;
mod database;
mod deliveries;
mod engine;
mod error;
mod flown;
mod job_record;
mod jobs;
mod key;
mod keys;
mod lease;
mod log;
mod look;
mod looked;
mod losses;
mod maneuvers;
mod mappings;
mod migrate;
mod models;
mod neighbours;
mod open;
mod page;
mod project;
mod queue;
mod reactor;
mod readiness;
mod record;
mod results;
mod retention;
mod row;
mod search;
mod signal;
mod tallies;
mod webhooks;
mod writing;

pub use about::{About, ManeuverOfJob, ModelOfJob};
pub use address::{is_missing, without_password};
pub use answers::{KeptAnswer, Once};
pub use audit::AuditRecord;
pub use backup::{Contents, back_up, check, restore};
pub use clock::Clock;
pub use database::Store;
pub use deliveries::{Attempt, Delivery};
pub use error::{StoreError, Trouble};
pub use job_record::JobRecord;
pub use jobs::{CancelReply, JobFilter, NewJob};
pub use key::{Key, KeyCheck, KeyRecord, NewKey, Scope};
pub use lease::{Claim, LEASE};
pub use log::StoredEvent;
pub use losses::{GIVEN_UP_AFTER, SUSPECTED_AFTER};
pub use maneuvers::{ManeuverFilter, ManeuverRecord, NotLoaded, Uploaded};
pub use mappings::MappingRecord;
pub use models::ModelRecord;
pub use page::{BadCursor, Page};
pub use project::{DEFAULT_PROJECT, Project};
pub use queue::Waiting;
pub use results::{Part, ResultParts};
pub use retention::{Deleted, Expired, Rule};
pub use search::Search;
pub use signal::{Listener, Signal};
pub use tallies::{BUCKETS, Census, Histogram};
pub use webhooks::{DeliveryRecord, Webhook};
