//! A mapping and a file that has matrices by name become a maneuver.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::super::{
    IngestError, Limits, Origin, code,
    fault::pointer,
    note,
    reading::Reading,
    recording::{Channels, Number, RecordedChannel, RecordedTime, Recording},
};
use super::axes::Axes;
use super::taken::{Slot, Taken};
use super::{Archive, MappedChannel, Mapping, NoValue, Part, Source, Titles};
use crate::flight::Fault;

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
    ) -> Result<Reading, IngestError> {
        limits
            .columns(self.channels.len() + 1)
            .map_or(Ok(()), Err)?;
        let of_channels = self.channels.values();
        let sources: Vec<Result<Source, String>> = of_channels
            .map(|channel| Source::meant(&channel.from, archive))
            .collect();
        let with_units = self.with_units_of(&sources, archive);
        with_units.taken_from(sources, archive, limits)
    }

    /// With the units that the file says of the sources that are read, where the mapping says none.
    fn with_units_of(
        &self,
        sources: &[Result<Source, String>],
        archive: &impl Archive,
    ) -> Cow<'_, Self> {
        if self
            .channels
            .values()
            .all(|channel| !channel.unit.is_empty())
        {
            return Cow::Borrowed(self);
        }
        let mut mapping = self.clone();
        for (channel, source) in mapping.channels.values_mut().zip(sources) {
            if let (true, Ok(source)) = (channel.unit.is_empty(), source) {
                channel.unit = archive.unit(&source.path).unwrap_or_default();
            }
        }
        Cow::Owned(mapping)
    }

    fn taken_from(
        &self,
        sources: Vec<Result<Source, String>>,
        archive: &mut impl Archive,
        limits: &Limits,
    ) -> Result<Reading, IngestError> {
        let readable: Vec<Option<Source>> =
            sources.iter().map(|source| source.clone().ok()).collect();
        let axes = Axes::of(self, &readable, archive)?;
        let mut taken = Taken::new(limits, axes.axes.len(), self.channels.len());
        for (at, source) in sources.into_iter().enumerate() {
            if let Err(why) = source {
                taken.refuse(Slot::Channel(at), code::INVALID_MAPPING, why);
            }
        }
        self.take(archive, &readable, &axes, &mut taken)?;
        let absent = self.check(&axes, &taken)?;
        for (channel, columns) in self.channels.values().zip(&mut taken.channels) {
            columns
                .iter_mut()
                .flatten()
                .for_each(|value| *value = self.meant(channel, *value));
        }
        let only_main = axes.axes.len() == 1 && self.time.is_stated();
        let recording = if only_main {
            self.on_one_axis(taken.axes.pop(), taken.channels)
        } else {
            self.on_all_axes(&axes, taken.axes, taken.channels, limits)?
        };
        let maneuver = recording.into_maneuver(limits).map_err(with_remedy)?;
        Ok(Reading {
            maneuver,
            findings: note::absent(&absent).into_iter().collect(),
            origin: Some(Origin::OWN),
        })
    }

    /// Takes channels and axes, all of one path together.
    fn take(
        &self,
        archive: &mut impl Archive,
        sources: &[Option<Source>],
        axes: &Axes,
        taken: &mut Taken,
    ) -> Result<(), IngestError> {
        let of_channels = sources.iter().enumerate();
        let of_channels = of_channels.map(|(at, source)| (Slot::Channel(at), source));
        let of_axes = axes.axes.iter().enumerate();
        let of_axes = of_axes.map(|(at, axis)| (Slot::Axis(at), &axis.source));
        let mut by_path: BTreeMap<&[String], Vec<(Slot, Part)>> = BTreeMap::new();
        for (slot, source) in of_channels.chain(of_axes) {
            if let Some(Source { path, part }) = source {
                by_path.entry(path).or_default().push((slot, *part));
            }
        }
        for (path, wanted) in by_path {
            match archive.matrix(path) {
                Ok(matrix) => {
                    for (slot, part) in wanted {
                        taken.take(slot, part, &matrix)?;
                    }
                }
                Err((code, message)) => {
                    for (slot, _) in wanted {
                        taken.refuse(slot, code, message.clone());
                    }
                }
            }
        }
        Ok(())
    }

    /// The channels that the file does not have, where it need not have them.
    ///
    /// # Errors
    /// What it has to have and does not, and what the mapping does not say.
    fn check(&self, axes: &Axes, taken: &Taken) -> Result<Vec<String>, IngestError> {
        let is_absent = |slot: &Slot| {
            let mut faults = taken.faults.iter();
            faults.any(|(at, code, _)| at == slot && *code == code::UNKNOWN_SOURCE)
        };
        let mut faults: Vec<(Slot, Fault)> = taken
            .faults
            .iter()
            .filter(|(_, code, _)| !self.optional || *code != code::UNKNOWN_SOURCE)
            .map(|(slot, code, message)| {
                let place = self.place(axes, *slot);
                (*slot, Fault::new(place, code, message.clone()))
            })
            .collect();
        faults.extend(axes.faults.iter().cloned());
        for (at, (name, channel)) in self.channels.iter().enumerate() {
            if channel.unit.is_empty() {
                let place = pointer(["channels", name, "unit"]);
                let message = "the file says no unit of it: say it here, - for a pure number";
                let fault = Fault::new(place, code::INVALID_MAPPING, message);
                faults.push((Slot::Channel(at), fault));
            }
        }
        // what is not there needs neither time nor unit
        faults.retain(|(slot, fault)| fault.code != code::INVALID_MAPPING || !is_absent(slot));
        faults.sort_by_key(|(slot, _)| *slot);
        IngestError::refuse(faults.into_iter().map(|(_, fault)| fault).collect())?;
        let names = self.channels.keys().enumerate();
        let absent = names.filter(|(at, _)| is_absent(&Slot::Channel(*at)));
        Ok(absent.map(|(_, name)| name.clone()).collect())
    }

    /// The place of a slot in the mapping.
    fn place(&self, axes: &Axes, slot: Slot) -> String {
        match slot {
            Slot::Axis(at) => match axes.axes[at].place.as_slice() {
                [time] if time == "time" => pointer(["time", "from"]),
                place => pointer(place),
            },
            Slot::Channel(at) => {
                let name = self.channels.get_index(at).map_or("", |(name, _)| name);
                pointer(["channels", name, "from"])
            }
        }
    }

    /// What a recorded number means: nothing, or its multiple.
    fn meant(&self, channel: &MappedChannel, value: f64) -> f64 {
        let mut no_values = self.missing.iter().chain(&channel.missing);
        if no_values.any(|no_value| *no_value == NoValue::Number(value)) {
            return f64::NAN;
        }
        value * channel.factor()
    }

    /// The recording of what was taken; channels of which nothing was are left out.
    pub(super) fn recording(&self, time: RecordedTime, taken: Vec<Vec<Vec<f64>>>) -> Recording {
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

    /// Whether all that it takes are rows or columns of a matrix, and nothing else of it is for tables.
    pub(in super::super) fn names_parts_of_one_matrix(&self) -> bool {
        let time = &self.time;
        let of_channels = self.channels.values().map(|channel| &channel.from);
        let is_part = |from: &Titles| {
            let mut sources = from.iter().map(str::parse::<Source>);
            sources.all(|source| source.is_ok_and(|source| source.part != Part::Whole))
        };
        let is_for_tables = self.others
            || self.optional
            || self.skip.is_some()
            || self.header.is_some()
            || time.for_tables().is_some();
        !is_for_tables
            && !self.channels.is_empty()
            && time.from.iter().chain(of_channels).all(is_part)
    }
}

pub(super) fn numbers(values: Vec<f64>) -> Vec<Number> {
    values.into_iter().map(Number).collect()
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
