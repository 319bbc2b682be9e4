//! A wish to stop that reaches into the longest loops.
//!
//! Work that [`StopFlag::heed`] runs asks the flag in every loop that may be long: along samples, terms, frequencies. Where it
//! is to end, the loop unwinds, as a panic does but without its message, to the place that can go on without what the
//! loop was about: a descent to its best iterate, [`StopFlag::heed`] to no result at all. No loop has a way back of its own,
//! and nothing that is asked changes a number.
//!
//! How long work of each kind goes on between two asks, in CPU time, is held by `tests/numbers/stops.rs`: it listens to
//! each ask ([`StopFlag::heard_by`]), and says where the ask came that was longest waited for.
//!
//! The flag belongs to the thread that heeds it. Work that is shared out to other threads takes it along ([`shared`]).

mod flag;
mod heeded;

pub use flag::{Interrupted, Moment, StopFlag};
pub(crate) use heeded::{caught, check, check_sometimes, droppable, shared};
