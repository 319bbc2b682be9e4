//! What the store promises to those on both sides of it: `tests/postgres cargo test --test store`.

#[path = "../common"]
mod common {
    pub(crate) mod database;
    pub(crate) mod recordings;
}

mod audit;
mod bench;
mod flown;
mod in_use;
mod leases;
mod projects;
mod queue;
mod records;
mod schema;
mod trouble;
mod webhooks;
