//! What was taken out of a file, brought onto one time axis.

use super::super::{
    IngestError, Limits,
    axis::{TimeAxis, code_of},
    code,
    fault::{CELLS_LISTED, pointer},
    recording::{RecordedTime, Recording},
    union::{Union, fill},
    units::RecordedUnit,
};
use super::Mapping;
use super::apply::numbers;
use super::axes::{Axes, AxisSource};
use crate::flight::Fault;

impl Mapping {
    /// The recording of channels that all have the time axis that the mapping says.
    pub(super) fn on_one_axis(
        &self,
        time: Option<Vec<f64>>,
        mut channels: Vec<Vec<Vec<f64>>>,
    ) -> Recording {
        let time = time.filter(|_| self.time.from.is_some());
        for (columns, channel) in channels.iter_mut().zip(self.channels.values()) {
            for values in columns {
                match &time {
                    Some(time) if time.len() == values.len() => {
                        fill(channel.between, time, values);
                    }
                    Some(_) => {}
                    None => fill(channel.between, &even(values.len(), 0.0, 1.0), values),
                }
            }
        }
        let time = RecordedTime {
            unit: self.time.unit.clone(),
            values: time.map(numbers),
            start: self.time.start,
            step: self.time.step,
        };
        self.recording(time, channels)
    }

    /// The recording of channels with time axes of their own.
    ///
    /// # Errors
    /// An axis does not increase, or is not as long as a channel on it; or all together are too long.
    pub(super) fn on_all_axes(
        &self,
        axes: &Axes,
        mut times: Vec<Vec<f64>>,
        channels: Vec<Vec<Vec<f64>>>,
        limits: &Limits,
    ) -> Result<Recording, IngestError> {
        let mut faults = Vec::new();
        for (at, (axis, times)) in axes.axes.iter().zip(&mut times).enumerate() {
            self.complete(axis, axes.length(at, &channels), times, &mut faults);
        }
        faults.extend(self.of_other_length(axes, &times, &channels));
        IngestError::refuse(faults)?;
        let union = Union::of(&times, limits)?;
        let columns: usize = channels.iter().map(Vec::len).sum();
        let values = columns.saturating_mul(union.time.len());
        limits.values(values).map_or(Ok(()), Err)?;
        let own = channels.into_iter().zip(&axes.of);
        let spread = own.zip(self.channels.values());
        let spread = spread.map(|((columns, &axis), channel)| {
            let spread = columns.into_iter().map(|values| {
                let mut spread = union.spread(axis, &values);
                fill(channel.between, &union.time, &mut spread);
                spread
            });
            spread.collect()
        });
        let channels = spread.collect();
        let time = RecordedTime {
            unit: "s".to_string(),
            values: Some(numbers(union.time)),
            start: None,
            step: None,
        };
        Ok(self.recording(time, channels))
    }

    /// Times in seconds, of steps where the file has none; none at all where no channel has this axis.
    fn complete(
        &self,
        axis: &AxisSource,
        length: Option<usize>,
        times: &mut Vec<f64>,
        faults: &mut Vec<Fault>,
    ) {
        let Some(length) = length else {
            times.clear();
            return;
        };
        if axis.source.is_none() {
            let start = self.time.start.unwrap_or(0.0);
            *times = even(length, start, self.time.step.unwrap_or(1.0));
        }
        seconds(axis, times, faults);
    }

    /// A fault for every channel that is not as long as its time axis.
    fn of_other_length(
        &self,
        axes: &Axes,
        times: &[Vec<f64>],
        channels: &[Vec<Vec<f64>>],
    ) -> Vec<Fault> {
        let mut faults = Vec::new();
        for ((name, columns), &axis) in self.channels.keys().zip(channels).zip(&axes.of) {
            let expected = times.get(axis).map_or(0, Vec::len);
            let mut lengths = columns.iter().map(Vec::len);
            if let Some(found) = lengths.find(|&found| found != expected) {
                let message = format!(
                    "channel '{name}' has {found} values where its time axis has {expected}"
                );
                let place = pointer(["channels", name, "from"]);
                faults.push(Fault::new(place, code::LENGTH_MISMATCH, message));
            }
        }
        faults
    }
}

impl Axes {
    /// How long the first channel on an axis is; `None` where there is no channel on it.
    fn length(&self, axis: usize, channels: &[Vec<Vec<f64>>]) -> Option<usize> {
        let mut on_it = self
            .of
            .iter()
            .zip(channels)
            .filter(|(of, columns)| **of == axis && !columns.is_empty());
        let (_, columns) = on_it.next()?;
        columns.first().map(Vec::len)
    }
}

fn even(length: usize, start: f64, step: f64) -> Vec<f64> {
    (0..length).map(|k| start + k as f64 * step).collect()
}

/// An axis in seconds, with what is wrong about it.
fn seconds(axis: &AxisSource, times: &mut Vec<f64>, faults: &mut Vec<Fault>) {
    let place = || pointer(&axis.place);
    let unit = match RecordedUnit::parse_time(&axis.unit) {
        Ok(unit) => unit.unit(),
        Err((code, message)) => {
            faults.push(Fault::new(place(), code, message));
            return;
        }
    };
    let mut checked = TimeAxis::new(unit, times.len());
    let mut found = 0;
    for &time in times.iter() {
        if let Err(error) = checked.push(time) {
            faults.push(Fault::new(place(), code_of(&error), error.to_string()));
            found += 1;
            if found == CELLS_LISTED {
                return;
            }
        }
    }
    *times = checked.into_seconds();
    times.iter_mut().for_each(|time| *time += axis.offset);
}
