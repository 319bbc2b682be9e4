//! A column of a table, and what is to be read from it.

use super::super::{mapping::NoValue, union::Between, units::RecordedUnit};

/// A column that is read.
pub(super) struct Column {
    /// Which of the table it is, from 0.
    pub(super) at: usize,
    pub(super) name: String,
    pub(super) unit: RecordedUnit,
    /// What recorded numbers are multiplied by.
    pub(super) factor: f64,
    pub(super) no_values: Vec<NoValue>,
    /// A mapping names it: what cannot be read in it is a fault.
    pub(super) is_needed: bool,
    pub(super) used: Use,
    /// Its time axis, where that is not the table's.
    pub(super) own: Option<OwnTime>,
    pub(super) between: Between,
}

/// What becomes of a column that is read.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Use {
    Channel,
    /// The times of channels with an axis of their own.
    Times,
}

impl Column {
    /// Applies signs for no value and the factor to recorded numbers.
    pub(super) fn apply(&self, values: &mut [f64]) {
        for no_value in &self.no_values {
            if let NoValue::Number(number) = no_value {
                let without = values.iter_mut().filter(|value| *value == number);
                without.for_each(|value| *value = f64::NAN);
            }
        }
        if self.factor != 1.0 {
            values.iter_mut().for_each(|value| *value *= self.factor);
        }
    }
}

/// A time axis that is not the table's.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct OwnTime {
    /// The column that has its times; `None`: those of the table.
    pub(super) at: Option<usize>,
    /// Added to its times, s.
    pub(super) offset: f64,
}
