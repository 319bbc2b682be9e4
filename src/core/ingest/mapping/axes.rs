//! Which time axis each channel of a mapping has: that of the recording, or that of its own table.

use super::super::{IngestError, code, fault::pointer};
use super::check::{EITHER, refused};
use super::taken::Slot;
use super::{Archive, Axis, Mapping, Source};
use crate::flight::Fault;

/// Where an axis is, and what is made of it.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct AxisSource {
    /// `None` for one of equal steps.
    pub(super) source: Option<Source>,
    pub(super) unit: String,
    /// Added to its times, s.
    pub(super) offset: f64,
    /// Its place in the mapping.
    pub(super) place: Vec<String>,
}

/// The axes of a mapping, and which of them each channel has.
pub(super) struct Axes {
    pub(super) axes: Vec<AxisSource>,
    /// By channel.
    pub(super) of: Vec<usize>,
    /// What cannot be said of a channel's.
    pub(super) faults: Vec<(Slot, Fault)>,
}

impl Axes {
    /// Of the channels with these sources, `None` where a source cannot be read.
    ///
    /// # Errors
    /// What the mapping says of the recording's time is none.
    pub(super) fn of(
        mapping: &Mapping,
        sources: &[Option<Source>],
        archive: &mut impl Archive,
    ) -> Result<Self, IngestError> {
        let main = main(mapping, archive)?;
        let mut axes: Vec<AxisSource> = main.iter().cloned().collect();
        let (mut of, mut faults) = (Vec::new(), Vec::new());
        for (at, (name, source)) in mapping.channels.keys().zip(sources).enumerate() {
            let path = source.as_ref().map_or(&[][..], |source| &source.path);
            let said = Said::of(mapping, name, path);
            let axis = match said.axis(archive, path, main.as_ref()) {
                Ok(axis) => axis,
                Err((place, message)) => {
                    let fault = Fault::new(pointer(place), code::INVALID_MAPPING, message);
                    faults.push((Slot::Channel(at), fault));
                    of.push(0);
                    continue;
                }
            };
            let is_same = |other: &AxisSource| {
                (&other.source, &other.unit, other.offset)
                    == (&axis.source, &axis.unit, axis.offset)
            };
            let known = axes.iter().position(is_same);
            of.push(known.unwrap_or(axes.len()));
            if known.is_none() {
                axes.push(axis);
            }
        }
        Ok(Self { axes, of, faults })
    }
}

/// The axis of the recording, where the mapping says one.
fn main(mapping: &Mapping, archive: &mut impl Archive) -> Result<Option<AxisSource>, IngestError> {
    let time = &mapping.time;
    if let Some(member) = time.for_tables() {
        let message = "this is for tables of text, and this file is none";
        return Err(refused(&pointer(["time", member]), message).into());
    }
    if !time.is_stated() {
        return match time.unit.is_empty() {
            true => Ok(None),
            false => Err(refused("/time", EITHER).into()),
        };
    }
    let source = time.from.as_ref().map(|from| Source::meant(from, archive));
    let refuse = |message: String| {
        let place = pointer(["time", "from"]);
        IngestError::from(Fault::new(place, code::INVALID_MAPPING, message))
    };
    Ok(Some(AxisSource {
        source: source.transpose().map_err(refuse)?,
        unit: time.unit.clone(),
        offset: 0.0,
        place: vec!["time".to_string()],
    }))
}

/// What a mapping says of the axis of a channel, and where it does.
struct Said {
    axis: Axis,
    place: Vec<String>,
}

/// The place of a fault, and a message.
type Why = (Vec<String>, String);

impl Said {
    /// Of a channel whose values are at `path`.
    fn of(mapping: &Mapping, name: &str, path: &[String]) -> Self {
        let of_channel =
            |member: &str| vec!["channels".to_string(), name.to_string(), member.to_string()];
        match (&mapping.channels[name].time, table_of(mapping, path)) {
            (Some(time), _) => Self {
                axis: time.axis(),
                place: of_channel("time"),
            },
            (None, Some((table, axis))) => Self {
                axis: axis.clone(),
                place: vec!["tables".to_string(), table.clone()],
            },
            (None, None) => Self {
                axis: Axis::default(),
                place: of_channel("from"),
            },
        }
    }

    fn axis(
        self,
        archive: &mut impl Archive,
        path: &[String],
        main: Option<&AxisSource>,
    ) -> Result<AxisSource, Why> {
        let Some(from) = &self.axis.from else {
            return self.of_table(archive, path, main);
        };
        let source = Source::meant(from, archive).map_err(|why| (self.place.clone(), why))?;
        let of_main = main.map(|main| main.unit.clone());
        let of_main = of_main.filter(|unit| !unit.is_empty());
        let own = archive
            .own_time(&source.path)
            .map(|own| own.unit.to_string());
        let Some(unit) = self.axis.unit.or(of_main).or(own) else {
            return Err((self.place, "say the \"unit\" of its time".to_string()));
        };
        Ok(AxisSource {
            source: Some(source),
            unit,
            offset: self.axis.offset,
            place: self.place,
        })
    }

    /// That of the table that a path leads into, as the file says it; else that of the recording.
    fn of_table(
        self,
        archive: &impl Archive,
        path: &[String],
        main: Option<&AxisSource>,
    ) -> Result<AxisSource, Why> {
        let own = archive.own_time(path);
        // a column of time that the mapping names holds for the whole table that it is in
        let table_of_main = main
            .and_then(|main| main.source.as_ref())
            .and_then(|source| archive.own_time(&source.path));
        let is_in_table_of_main = table_of_main.is_some_and(|of_main| {
            own.as_ref()
                .is_some_and(|own| own.path.first() == of_main.path.first())
        });
        let has_steps = main.is_some_and(|main| main.source.is_none());
        let offset = self.axis.offset;
        match (own, main) {
            (own, Some(main)) if own.is_none() || is_in_table_of_main || has_steps => {
                Ok(AxisSource {
                    offset,
                    ..main.clone()
                })
            }
            (Some(own), _) => Ok(AxisSource {
                source: Some(Source::whole(own.path)),
                unit: self.axis.unit.unwrap_or_else(|| own.unit.to_string()),
                offset,
                place: self.place,
            }),
            (None, _) => Err((
                self.place,
                "the mapping says no time; add \"time\": {\"from\": \"<its source>\", \"unit\": \"s\"}"
                    .to_string(),
            )),
        }
    }
}

/// The table of the mapping that a path leads into: the one with the longest name that it begins with, as `log.AIR`.
fn table_of<'m>(mapping: &'m Mapping, path: &[String]) -> Option<(&'m String, &'m Axis)> {
    let path = path.join(".");
    let leads_into = |table: &str| {
        let rest = path.strip_prefix(table);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    let tables = mapping.tables.iter().filter(|(table, _)| leads_into(table));
    tables.max_by_key(|(table, _)| table.len())
}
