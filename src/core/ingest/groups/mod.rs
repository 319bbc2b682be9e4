//! Groups of channels that say their names and units themselves, each group with times of its own.

mod archive;
mod group;
mod plan;
mod read;

pub(super) use group::{Channel, Group, Groups, Samples, Time};
pub(super) use read::read;

#[cfg(test)]
mod tests;
