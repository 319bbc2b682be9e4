//! A mapping and a file become a maneuver.

use std::collections::BTreeMap;

use crate::flight::{Fault, Maneuver};

use super::super::{
    IngestError, Limits,
    axis::{TimeAxis, code_of},
    code,
    fault::{CELLS_LISTED, pointer},
    recording::{Channels, Number, RecordedChannel, RecordedTime, Recording},
    union::{Union, fill},
    units::RecordedUnit,
};
use super::axes::{Axes, AxisSource};
use super::taken::{Slot, Taken};
use super::{Archive, Mapping, Part, Source};

impl Mapping {
    /// Takes time and channels out of a file. A channel whose source is a whole matrix of n columns becomes
    /// n channels, `name_1` to `name_n`. Where channels have time axes of their own, all of these are the time axis of the
    /// recording, and a channel has no value at the times of the others.
    ///
    /// # Errors
    /// Every source that is not in the file, by its place in the mapping; else the faults of names, units, lengths
    /// and time, as a JSON recording has them.
    pub(in super::super) fn apply(
        &self,
        archive: &mut impl Archive,
        limits: &Limits,
    ) -> Result<Maneuver, IngestError> {
        limits
            .columns(self.channels.len() + 1)
            .map_or(Ok(()), Err)?;
        let axes = Axes::of(self, archive);
        let mut taken = Taken::new(limits, axes.axes.len(), self.channels.len());
        let unsaid = axes.faults.iter().cloned();
        taken
            .faults
            .extend(unsaid.map(|(at, code, message)| (Slot::Channel(at), code, message)));
        // in the order of paths, so that every variable is unpacked once
        let mut by_path: BTreeMap<Vec<String>, Vec<(Slot, Part)>> = BTreeMap::new();
        for (at, channel) in self.channels.values().enumerate() {
            match channel.from.parse::<Source>() {
                Ok(Source { path, part }) => {
                    by_path
                        .entry(path)
                        .or_default()
                        .push((Slot::Channel(at), part));
                }
                Err(why) => {
                    taken
                        .faults
                        .push((Slot::Channel(at), code::INVALID_MAPPING, why.to_string()))
                }
            }
        }
        for (at, axis) in axes.axes.iter().enumerate() {
            if let Some(Source { path, part }) = axis.source.clone() {
                by_path
                    .entry(path)
                    .or_default()
                    .push((Slot::Axis(at), part));
            }
        }
        for (path, wanted) in by_path {
            match archive.matrix(&path) {
                Ok(matrix) => {
                    for (slot, part) in wanted {
                        taken.take(slot, part, &matrix)?;
                    }
                }
                Err((code, message)) => {
                    let faults = wanted
                        .into_iter()
                        .map(|(slot, _)| (slot, code, message.clone()));
                    taken.faults.extend(faults);
                }
            }
        }
        // what is not there needs no time
        let is_missing = |slot: Slot, faults: &[(Slot, &str, String)]| {
            faults
                .iter()
                .any(|(at, code, _)| *at == slot && *code == code::UNKNOWN_SOURCE)
        };
        let missing: Vec<Slot> = (0..self.channels.len())
            .map(Slot::Channel)
            .filter(|&slot| is_missing(slot, &taken.faults))
            .collect();
        taken
            .faults
            .retain(|(slot, code, _)| *code != code::INVALID_MAPPING || !missing.contains(slot));
        if self.optional {
            taken
                .faults
                .retain(|(_, code, _)| *code != code::UNKNOWN_SOURCE);
        }
        IngestError::refuse(self.faults(&axes.axes, taken.faults))?;
        let only_main = axes.axes.len() == 1 && self.time.is_stated();
        let recording = if only_main {
            self.on_one_axis(taken.axes.pop(), taken.channels)
        } else {
            self.on_all_axes(&axes, taken.axes, taken.channels, limits)?
        };
        recording.into_maneuver(limits).map_err(with_remedy)
    }

    fn faults(
        &self,
        axes: &[AxisSource],
        mut faults: Vec<(Slot, &'static str, String)>,
    ) -> Vec<Fault> {
        faults.sort_by_key(|&(slot, ..)| slot);
        let fault = |(slot, code, message): (Slot, &'static str, String)| {
            let place = match slot {
                Slot::Axis(at) => match axes[at].place.as_slice() {
                    [time] if time == "time" => pointer(["time", "from"]),
                    place => pointer(place),
                },
                Slot::Channel(at) => {
                    let name = self.channels.get_index(at).map_or("", |(name, _)| name);
                    pointer(["channels", name, "from"])
                }
            };
            Fault::new(place, code, message)
        };
        faults.into_iter().map(fault).collect()
    }

    /// The recording of channels that all have the time axis that the mapping says.
    fn on_one_axis(&self, time: Option<Vec<f64>>, channels: Vec<Vec<Vec<f64>>>) -> Recording {
        let time = time.filter(|_| self.time.from.is_some());
        let channels = channels.into_iter().zip(self.channels.values());
        let filled = channels.map(|(mut columns, channel)| {
            for values in &mut columns {
                let steps: Vec<f64>;
                let time = match &time {
                    Some(time) if time.len() == values.len() => time,
                    Some(_) => continue,
                    None => {
                        steps = (0..values.len()).map(|k| k as f64).collect();
                        &steps
                    }
                };
                fill(channel.between, time, values);
            }
            columns
        });
        let channels = filled.collect();
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
    fn on_all_axes(
        &self,
        axes: &Axes,
        mut times: Vec<Vec<f64>>,
        channels: Vec<Vec<Vec<f64>>>,
        limits: &Limits,
    ) -> Result<Recording, IngestError> {
        let mut faults = Vec::new();
        for (at, (axis, times)) in axes.axes.iter().zip(&mut times).enumerate() {
            let mut on_it = axes.of.iter().zip(&channels).filter(|(of, _)| **of == at);
            if on_it.all(|(_, columns)| columns.is_empty()) {
                times.clear();
                continue;
            }
            if axis.source.is_none() {
                let on_it = axes.of.iter().zip(&channels).find(|(of, _)| **of == at);
                let length = on_it
                    .and_then(|(_, columns)| columns.first())
                    .map_or(0, Vec::len);
                let (start, step) = (
                    self.time.start.unwrap_or(0.0),
                    self.time.step.unwrap_or(1.0),
                );
                *times = (0..length).map(|k| start + k as f64 * step).collect();
            }
            seconds(axis, times, &mut faults);
        }
        for ((name, columns), &axis) in self.channels.keys().zip(&channels).zip(&axes.of) {
            let expected = times.get(axis).map_or(0, Vec::len);
            if let Some(found) = columns
                .iter()
                .map(Vec::len)
                .find(|&found| found != expected)
            {
                let message = format!(
                    "channel '{name}' has {found} values where its time axis has {expected}"
                );
                let place = pointer(["channels", name, "from"]);
                faults.push(Fault::new(place, code::LENGTH_MISMATCH, message));
            }
        }
        IngestError::refuse(faults)?;
        let union = Union::of(&times, limits)?;
        let columns: usize = channels.iter().map(Vec::len).sum();
        let values = columns.saturating_mul(union.time.len());
        limits.values(values).map_or(Ok(()), Err)?;
        let spread = channels
            .into_iter()
            .zip(&axes.of)
            .zip(self.channels.values());
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

    /// The recording of what was taken; channels of which nothing was are left out.
    fn recording(&self, time: RecordedTime, taken: Vec<Vec<Vec<f64>>>) -> Recording {
        let mut channels = Vec::new();
        for ((name, channel), columns) in self.channels.iter().zip(taken) {
            let is_one = columns.len() == 1;
            for (at, values) in columns.into_iter().enumerate() {
                let name = if is_one {
                    name.clone()
                } else {
                    format!("{name}_{}", at + 1)
                };
                let (unit, values) = (channel.unit.clone(), numbers(values));
                let time = None;
                channels.push((name, RecordedChannel { unit, values, time }));
            }
        }
        Recording {
            time,
            channels: Channels(channels),
        }
    }
}

fn numbers(values: Vec<f64>) -> Vec<Number> {
    values.into_iter().map(Number).collect()
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

/// A channel that is not as long as the time axis may have one of its own.
fn with_remedy(error: IngestError) -> IngestError {
    const REMEDY: &str = "; where it has a time axis of its own, say so in the mapping, as \"time\": \"AIR(:,1)\" beside its \"from\"";
    let with_remedy = |mut fault: Fault| {
        if fault.code == code::LENGTH_MISMATCH {
            fault.message.push_str(REMEDY);
        }
        fault
    };
    error.map(with_remedy)
}

#[cfg(test)]
mod tests;
