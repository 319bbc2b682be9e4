//! Trimtab estimates aircraft parameters from flight-test maneuvers, as a service.
//!
//! What is estimated, and how, is the crate [`trimtab_core`]; its rooms stand here under their own names. Around them:
//! what keeps jobs and recordings ([`store`]), who runs jobs ([`work`]), who is told of their end ([`webhook`]), how
//! they are asked for ([`http`], [`cli`]), how their results look ([`dashboard`]). Arrows go one way: `store → job`,
//! `work → store`, `webhook → store`, `http → store, job, ingest, dashboard, webhook`. `http` and `work` meet only at
//! the store.

pub use trimtab_core::{diagnose, estimate, flight, ingest, job, model, simulate};

pub mod cli;
pub mod dashboard;
pub mod http;
pub mod store;
pub mod webhook;
pub mod work;
