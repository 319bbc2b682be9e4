//! What is taken out of a file, within the limits.

use super::super::{Limits, code, matrix::Matrix};
use super::Part;
use crate::flight::Fault;

/// What values are for.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Slot {
    /// A time axis, by its number.
    Axis(usize),
    /// A channel, by its number.
    Channel(usize),
}

/// What was taken out of a file, and what could not be.
pub(super) struct Taken<'a> {
    limits: &'a Limits,
    /// Of every axis: its times. Of one that has none, nothing was taken.
    pub(super) axes: Vec<Vec<f64>>,
    /// Of every channel: its columns.
    pub(super) channels: Vec<Vec<Vec<f64>>>,
    pub(super) faults: Vec<(Slot, &'static str, String)>,
    count: usize,
    values: usize,
}

impl<'a> Taken<'a> {
    pub(super) fn new(limits: &'a Limits, axes: usize, channels: usize) -> Self {
        Self {
            limits,
            axes: vec![Vec::new(); axes],
            channels: vec![Vec::new(); channels],
            faults: Vec::new(),
            count: 0,
            values: 0,
        }
    }

    /// That a slot has nothing, and why.
    pub(super) fn refuse(&mut self, slot: Slot, code: &'static str, message: String) {
        self.faults.push((slot, code, message));
    }

    /// Takes a part of a matrix, within the limits.
    ///
    /// # Errors
    /// A limit is exceeded. What the matrix does not have becomes one of the faults.
    pub(super) fn take(&mut self, slot: Slot, part: Part, matrix: &Matrix) -> Result<(), Fault> {
        let Matrix { rows, columns, .. } = *matrix;
        let is_time = matches!(slot, Slot::Axis(_));
        let (count, length) = match part {
            Part::Row(_) => (1, columns),
            Part::Whole if matrix.is_vector() => (1, rows.max(columns)),
            Part::Whole if !is_time => (columns, rows),
            Part::Column(_) | Part::Whole => (1, rows),
        };
        self.count = self.count.saturating_add(count);
        self.values = self.values.saturating_add(count.saturating_mul(length));
        let limits = self.limits;
        let too_much = [
            limits.columns(self.count),
            limits.samples(length),
            limits.values(self.values),
        ];
        if let Some(fault) = too_much.into_iter().flatten().next() {
            return Err(fault);
        }
        let missing = match part {
            Part::Column(at) if at > columns => Some(format!("there is no column {at}")),
            Part::Row(at) if at > rows => Some(format!("there is no row {at}")),
            Part::Whole if is_time && !matrix.is_vector() => {
                Some("time is one column, as (:,1); say which".to_string())
            }
            _ => None,
        };
        if let Some(why) = missing {
            let message = format!("{why}: the matrix has {rows} row(s) and {columns} column(s)");
            self.refuse(slot, code::UNKNOWN_SOURCE, message);
            return Ok(());
        }
        let taken: Vec<Vec<f64>> = match part {
            Part::Column(at) => vec![matrix.column(at - 1)],
            Part::Row(at) => vec![matrix.row(at - 1)],
            Part::Whole if rows == 1 => vec![matrix.row(0)],
            Part::Whole => (0..columns).map(|at| matrix.column(at)).collect(),
        };
        match slot {
            Slot::Axis(axis) => self.axes[axis] = taken.into_iter().next().unwrap_or_default(),
            Slot::Channel(channel) => self.channels[channel] = taken,
        }
        Ok(())
    }
}
