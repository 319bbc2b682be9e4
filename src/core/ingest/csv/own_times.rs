//! Channels of a table with a column of times of their own, or a clock that is off: all channels on one time axis.

use indexmap::IndexMap;

use super::super::{
    IngestError, Limits,
    axis::{TimeAxis, code_of},
    fault::{of_file, pointer},
    mapping::{ChannelTime, MappedTime, Mapping},
    union::{Between, Union, fill},
    units::RecordedUnit,
};
use super::{
    column::{Column, OwnTime, Use},
    samples::Samples,
    titles::Titles,
};
use crate::flight::{Channel, Fault, Maneuver};

/// Whether a mapping says the times of all channels, so that the table needs none.
pub(super) fn is_said_of_all(mapping: &Mapping) -> bool {
    let mut channels = mapping.channels.values();
    let has_own = |time: &ChannelTime| time.axis().from.is_some();
    mapping.time == MappedTime::default()
        && !mapping.others
        && !mapping.channels.is_empty()
        && channels.all(|channel| channel.time.as_ref().is_some_and(has_own))
}

/// The unit of a column of times: as a mapping says it, else the title, else as that of the table's time.
///
/// # Errors
/// A code and a message: it is said nowhere, or is not one of time.
pub(super) fn unit(
    titles: &Titles,
    at: usize,
    said: Option<&str>,
    of_table: &str,
) -> Result<RecordedUnit, (&'static str, String)> {
    let of_title = titles.label(at)?.unit;
    let known = [said.unwrap_or_default(), of_title, of_table];
    let unit = known.into_iter().find(|unit| !unit.is_empty());
    RecordedUnit::parse_time(unit.unwrap_or_default())
}

/// One time axis: its times in seconds, and the samples that they are of.
struct Axis {
    own: Option<OwnTime>,
    times: Vec<f64>,
    samples: Vec<usize>,
}

/// What was read, every channel at its own times.
///
/// # Errors
/// Times run back; or there are more of them than the limit of samples.
pub(super) fn maneuver(
    columns: Vec<Column>,
    samples: Samples,
    limits: &Limits,
) -> Result<Maneuver, IngestError> {
    let (mut of, mut axes) = (Vec::new(), Vec::new());
    for column in columns.iter().filter(|column| column.used == Use::Channel) {
        let known = axes.iter().position(|axis: &Axis| axis.own == column.own);
        of.push(known.unwrap_or(axes.len()));
        if known.is_none() {
            axes.push(axis(column, &columns, &samples)?);
        }
    }
    let is_plain = axes.iter().all(|axis| axis.own.is_none());
    let union = match is_plain {
        true => None,
        false => {
            let times: Vec<Vec<f64>> = axes.iter().map(|axis| axis.times.clone()).collect();
            let union = Union::of(&times, limits)?;
            let values = of.len().saturating_mul(union.time.len());
            limits.values(values).map_or(Ok(()), Err)?;
            Some(union)
        }
    };
    let mut channels = IndexMap::with_capacity(columns.len());
    let read = columns.into_iter().zip(samples.values);
    let read = read.zip(samples.unreadable);
    let read = read.filter(|((column, _), _)| column.used == Use::Channel);
    for (((column, values), unreadable), axis) in read.zip(of) {
        if unreadable.is_some() {
            continue;
        }
        let (time, values) = match &union {
            None => (&samples.time, values),
            Some(union) => {
                let own = axes[axis].samples.iter().map(|&sample| values[sample]);
                let own: Vec<f64> = own.collect();
                (&union.time, union.spread(axis, &own))
            }
        };
        let (name, channel) = column.channel(time, values);
        channels.insert(name, channel);
    }
    let time = union.map_or(samples.time, |union| union.time);
    Maneuver::new(time, channels)
        .map_err(|error| of_file(code_of(&error), error.to_string()).into())
}

impl Column {
    /// The name and the channel that it becomes.
    fn channel(self, time: &[f64], mut values: Vec<f64>) -> (String, Channel) {
        if self.between != Between::Missing {
            fill(self.between, time, &mut values);
        }
        (self.name, self.unit.channel(values))
    }
}

/// The axis of a column. A time that stands in several rows, as a logger holds it, is that of the first of them.
fn axis(column: &Column, columns: &[Column], samples: &Samples) -> Result<Axis, Fault> {
    let own = column.own;
    let offset = own.map_or(0.0, |own| own.offset);
    let Some(at) = own.and_then(|own| own.at) else {
        return Ok(Axis {
            own,
            times: samples.time.iter().map(|time| time + offset).collect(),
            samples: (0..samples.time.len()).collect(),
        });
    };
    let place = columns.iter().position(|other| other.at == at);
    let recorded = place.map_or(&[][..], |place| &samples.values[place]);
    let unit = place.map_or(&column.unit, |place| &columns[place].unit);
    let mut axis = TimeAxis::new(unit.unit(), recorded.len());
    let (mut kept, mut before) = (Vec::new(), f64::NAN);
    for (sample, &time) in recorded.iter().enumerate() {
        if time.is_nan() || time == before {
            continue;
        }
        before = time;
        axis.push(time).map_err(|error| {
            let line = samples.lines[sample];
            let place = pointer(["channels", &column.name, "time"]);
            Fault::new(place, code_of(&error), format!("line {line}: {error}"))
        })?;
        kept.push(sample);
    }
    let times = axis.into_seconds().into_iter().map(|time| time + offset);
    Ok(Axis {
        own,
        times: times.collect(),
        samples: kept,
    })
}
