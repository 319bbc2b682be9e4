//! The time axis of a recording, checked sample by sample so that every fault is found, not the first.

use crate::flight::{ManeuverError, Unit};

use super::code;

/// Times in seconds, as they are read.
pub(super) struct TimeAxis {
    unit: Unit,
    seconds: Vec<f64>,
}

impl TimeAxis {
    pub(super) fn new(unit: Unit, capacity: usize) -> Self {
        Self {
            unit,
            seconds: Vec::with_capacity(capacity),
        }
    }

    /// Adds the next sample's time.
    ///
    /// # Errors
    /// The time is missing, or not later than the one before. The sample keeps its place, so that the
    /// rows behind it keep their numbers.
    pub(super) fn push(&mut self, recorded: f64) -> Result<(), ManeuverError> {
        let time = self.unit.to_si(recorded);
        let before = self.seconds.last().copied().unwrap_or(f64::NEG_INFINITY);
        self.seconds.push(time);
        let row = self.seconds.len();
        if !time.is_finite() {
            return Err(ManeuverError::TimeMissing { row });
        }
        if time <= before {
            return Err(ManeuverError::TimeNotIncreasing { row, before, time });
        }
        Ok(())
    }

    pub(super) fn into_seconds(self) -> Vec<f64> {
        self.seconds
    }
}

pub(super) fn code_of(error: &ManeuverError) -> &'static str {
    match error {
        ManeuverError::TooFewSamples { .. } => code::TOO_FEW_SAMPLES,
        ManeuverError::LengthMismatch { .. } => code::LENGTH_MISMATCH,
        ManeuverError::TimeMissing { .. } => code::TIME_MISSING,
        ManeuverError::TimeNotIncreasing { .. } => code::TIME_NOT_INCREASING,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_name_their_row_and_the_next_rows_keep_theirs() {
        let mut axis = TimeAxis::new(Unit::parse("ms").unwrap(), 0);
        assert_eq!(axis.push(0.0), Ok(()));
        assert_eq!(
            axis.push(f64::NAN),
            Err(ManeuverError::TimeMissing { row: 2 })
        );
        assert_eq!(axis.push(1000.0), Ok(()));
        let backwards = ManeuverError::TimeNotIncreasing {
            row: 4,
            before: 1.0,
            time: 0.5,
        };
        assert_eq!(axis.push(500.0), Err(backwards));
        assert_eq!(axis.into_seconds().len(), 4);
    }
}
