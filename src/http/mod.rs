//! The API: JSON and CSV over HTTP.
//!
//! A request comes in by `routes`, through what stands around every handler (`middleware`), to the handler of its
//! resource (`handlers`) or page (`pages`). A handler reads it (`request`), asks the store or the core, and answers
//! (`answer`). It never waits for a job and never runs long itself: reading recordings and checking models happens on
//! blocking threads, as many at a time as there are cores (`compute`). What goes wrong is a [`problem::Problem`] with a
//! [`code::Code`].
//!
//! Invariant: every failure is a problem document, and every route but a few open ones needs a scope once there are keys.

mod answer;
mod caller;
pub mod code;
mod compute;
mod config;
mod handlers;
mod metrics;
mod middleware;
mod openapi;
mod origin;
mod pages;
pub mod problem;
mod rates;
mod request;
mod room;
mod routes;
mod seats;
mod serve;
mod service;

pub use answer::campaign_table::campaign_as_csv;
pub use answer::comparison_table::comparison_as_csv;
pub use answer::prediction_table::predictions_as_csv;
pub use answer::response_table::responses_as_csv;
pub use answer::trajectory_table::trajectories_as_csv;
pub use config::Config;
pub use handlers::keys::{a_day, days};
pub use openapi::document;
pub use origin::Origin;
pub use serve::{BindError, bind, is_loopback, run};
