//! What was read of a table's rows.

use super::super::Origin;
use crate::flight::{Fault, Finding};

/// The samples of a table, as recorded.
pub(super) struct Samples {
    /// Seconds; not yet in order.
    pub(super) time: Vec<f64>,
    /// For each column of the plan.
    pub(super) values: Vec<Vec<f64>>,
    /// The line of each sample.
    pub(super) lines: Vec<u32>,
    /// The row of each sample, from 1.
    pub(super) rows: Vec<u32>,
    /// For each column of the plan: what in it is neither a number nor a sign for no value.
    pub(super) unreadable: Vec<Option<Unreadable>>,
    pub(super) findings: Vec<Finding>,
    /// What the zero of their times is, where it can be told.
    pub(super) origin: Option<Origin>,
    /// Of rows and times, by row.
    pub(super) faults: Vec<(usize, Fault)>,
}

/// Cells of a column that cannot be read.
#[derive(Clone)]
pub(super) struct Unreadable {
    pub(super) row: usize,
    pub(super) line: usize,
    /// The first of them.
    pub(super) cell: String,
    pub(super) count: usize,
}

impl Samples {
    pub(super) fn drop_last(&mut self) {
        self.time.pop();
        self.lines.pop();
        self.rows.pop();
        for values in &mut self.values {
            values.pop();
        }
    }
}
