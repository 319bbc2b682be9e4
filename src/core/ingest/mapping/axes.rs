//! Which time axis each channel of a mapping has: that of the recording, or that of its own table.

use super::super::code;
use super::{Archive, Axis, ChannelTime, Mapping, Source};

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
    /// What cannot be said: the channel, a code and a message.
    pub(super) faults: Vec<(usize, &'static str, String)>,
}

impl Axes {
    pub(super) fn of(mapping: &Mapping, archive: &impl Archive) -> Self {
        let time = &mapping.time;
        let main = time.is_stated().then(|| AxisSource {
            source: time.from.as_deref().and_then(|from| from.parse().ok()),
            unit: time.unit.clone(),
            offset: 0.0,
            place: vec!["time".to_string()],
        });
        let mut axes: Vec<AxisSource> = main.iter().cloned().collect();
        let (mut of, mut faults) = (Vec::new(), Vec::new());
        for (at, (name, channel)) in mapping.channels.iter().enumerate() {
            let source: Option<Source> = channel.from.parse().ok();
            let path = source.map(|source| source.path).unwrap_or_default();
            let axis = match of_channel(mapping, archive, name, &path, main.as_ref()) {
                Ok(axis) => axis,
                Err(message) => {
                    faults.push((at, code::INVALID_MAPPING, message));
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
        Self { axes, of, faults }
    }
}

/// The axis of a channel whose values are at `path`.
fn of_channel(
    mapping: &Mapping,
    archive: &impl Archive,
    name: &str,
    path: &[String],
    main: Option<&AxisSource>,
) -> Result<AxisSource, String> {
    let of_table = table_of(mapping, path);
    let own = archive.own_time(path);
    let (said, place) = match (&mapping.channels[name].time, of_table) {
        (Some(ChannelTime::From(from)), _) => {
            let axis = Axis {
                from: Some(from.clone()),
                ..Axis::default()
            };
            (
                axis,
                vec!["channels".to_string(), name.to_string(), "time".to_string()],
            )
        }
        (Some(ChannelTime::Axis(axis)), _) => (
            axis.clone(),
            vec!["channels".to_string(), name.to_string(), "time".to_string()],
        ),
        (None, Some((table, axis))) => (axis.clone(), vec!["tables".to_string(), table.clone()]),
        (None, None) => (
            Axis::default(),
            vec!["channels".to_string(), name.to_string(), "from".to_string()],
        ),
    };
    let from: Option<Source> = said.from.as_deref().and_then(|from| from.parse().ok());
    if let Some(source) = from {
        let unit = said.unit.or_else(|| main.map(|main| main.unit.clone()));
        let own = archive
            .own_time(&source.path)
            .map(|own| own.unit.to_string());
        let unit = unit.or(own).ok_or("say the \"unit\" of its time")?;
        return Ok(AxisSource {
            source: Some(source),
            unit,
            offset: said.offset,
            place,
        });
    }
    // a column of time that the mapping names holds for the whole table that it is in
    let table_of_main = main
        .and_then(|main| main.source.as_ref())
        .and_then(|source| archive.own_time(&source.path));
    let is_in_table_of_main = table_of_main.is_some_and(|of_main| {
        own.as_ref()
            .is_some_and(|own| own.path.first() == of_main.path.first())
    });
    let has_steps = main.is_some_and(|main| main.source.is_none());
    match (own, main) {
        (_, Some(main)) if is_in_table_of_main || has_steps => Ok(AxisSource {
            offset: said.offset,
            ..main.clone()
        }),
        (Some(own), _) => Ok(AxisSource {
            source: Some(Source::whole(own.path)),
            unit: said.unit.unwrap_or_else(|| own.unit.to_string()),
            offset: said.offset,
            place,
        }),
        (None, Some(main)) => Ok(AxisSource {
            offset: said.offset,
            ..main.clone()
        }),
        (None, None) => Err(
            "the mapping says no time; add \"time\": {\"from\": \"<its source>\", \"unit\": \"s\"}"
                .to_string(),
        ),
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
