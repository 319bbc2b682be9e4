//! Mapping documents: which values of a file without names and units, or with others, are time and channels, and in which
//! units.
//!
//! A mapping has the shape of a JSON recording, with `from` where that has `values`. In TOML:
//!
//! ```toml
//! time = {from = "fdata(:,1)", unit = "s"}
//! [channels]
//! alpha = {from = "fdata(:,4)", unit = "deg"}
//! ```
//!
//! A channel of a table with a time axis of its own names that, too: `alpha = {from = "AIR(:,2)", time = "AIR(:,1)", unit =
//! "deg"}`; or the table does, for all channels that come from it: `[tables] AIR = {from = "AIR(:,1)", offset = 0.12}`.

mod apply;
mod archive;
mod axes;
mod source;
mod taken;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

pub(super) use archive::{Archive, OwnTime};
pub(super) use source::{Part, Source, element};

use super::{
    code,
    fault::{of_file, pointer},
    text::short_message,
    union::Between,
};
use crate::flight::Fault;

/// Says where time and channels are in a MAT file or an ASCII matrix, or which columns of a CSV file they are.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Mapping {
    /// For people: which recordings it is for.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    about: String,
    /// May be left out where every channel has a time axis of its own, or the file says which it is (ULog, DataFlash).
    #[serde(default, skip_serializing_if = "MappedTime::is_unstated")]
    pub(super) time: MappedTime,
    /// Time axes of tables of the file, by what the sources of their channels begin with: `AIR`, `log.AIR`, `IMU[1]`.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub(super) tables: IndexMap<String, Axis>,
    /// Whether channels that a file does not have are left out.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(super) optional: bool,
    /// By name, in the order of the document.
    pub(super) channels: IndexMap<String, MappedChannel>,
}

/// Either `from`, or `step` (with `start`, else 0) for even sampling.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct MappedTime {
    pub(super) unit: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) from: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) start: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) step: Option<f64>,
}

impl MappedTime {
    fn is_stated(&self) -> bool {
        self.from.is_some() || self.step.is_some()
    }

    fn is_unstated(&self) -> bool {
        !self.is_stated()
    }
}

/// A time axis of its own.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Axis {
    /// Absent: as the file says it, or the recording's.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = "AIR(:,1)")]
    pub(super) from: Option<String>,
    /// Absent: that of the recording's time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) unit: Option<String>,
    /// Seconds that are added to its times.
    #[serde(default)]
    #[schema(example = 0.12)]
    pub(super) offset: f64,
}

/// The source of a time axis, in the unit of the recording's time; or all that is to be said of it.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(untagged)]
pub(super) enum ChannelTime {
    From(String),
    Axis(Axis),
}

#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct MappedChannel {
    pub(super) from: String,
    /// `-` for a pure number; it must be said.
    pub(super) unit: String,
    /// Where its values have times of their own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) time: Option<ChannelTime>,
    /// What it has at the times of the other channels: `missing`, `held` or `straight`.
    #[serde(default, skip_serializing_if = "Between::is_missing")]
    pub(super) between: Between,
}

/// The mappings that come with Trimtab.
const BUNDLED: [(&str, &str); 5] = [
    ("ardupilot", include_str!("ardupilot.toml")),
    ("fvsysid-attas", include_str!("fvsysid-attas.toml")),
    ("fvsysid-hfb320", include_str!("fvsysid-hfb320.toml")),
    ("px4", include_str!("px4.toml")),
    ("sidpac", include_str!("sidpac.toml")),
];

impl Mapping {
    /// The names of the bundled mappings.
    pub fn names() -> impl Iterator<Item = &'static str> {
        BUNDLED.iter().map(|&(name, _)| name)
    }

    /// # Errors
    /// What is wrong with the document, and where in it.
    pub fn from_json(text: &str) -> Result<Self, Fault> {
        let mapping: Self =
            serde_json::from_str(text).map_err(|error| invalid(&error.to_string()))?;
        mapping.checked()
    }

    /// # Errors
    /// What is wrong with the document, and where in it.
    pub fn from_toml(text: &str) -> Result<Self, Fault> {
        let mapping: Self = toml::from_str(text).map_err(|error| invalid(&error.to_string()))?;
        mapping.checked()
    }

    /// A JSON document, or the name of a bundled mapping.
    ///
    /// # Errors
    /// There is no mapping of this name; or what is wrong with the document.
    pub fn named_or_json(text: &str) -> Result<Self, Fault> {
        if text.trim_start().starts_with('{') {
            return Self::from_json(text);
        }
        match BUNDLED.iter().find(|(name, _)| *name == text.trim()) {
            Some((_, document)) => Self::from_toml(document),
            None => {
                let name = short_message(text);
                let known: Vec<&str> = Self::names().collect();
                let message = format!(
                    "there is no mapping '{name}'; those that come with Trimtab are {}; or give a document {{\"time\": {{\"from\", \"unit\"}}, \"channels\": {{name: {{\"from\", \"unit\"}}}}}}",
                    known.join(", ")
                );
                Err(of_file(code::INVALID_MAPPING, message))
            }
        }
    }

    /// For people: which recordings it is for.
    pub fn about(&self) -> &str {
        &self.about
    }

    /// Every source of it can be read, and time has one.
    fn checked(self) -> Result<Self, Fault> {
        let time = &self.time;
        let says_half = time.is_unstated() && (time.start.is_some() || !time.unit.is_empty());
        if says_half || time.from.is_some() && time.step.is_some() {
            let message = "mapping: time has either \"from\", or \"step\" and perhaps \"start\"";
            return Err(Fault::new("/time", code::INVALID_MAPPING, message));
        }
        let of_time = self.time.from.as_deref();
        let of_time = of_time.map(|from| (pointer(["time", "from"]), from));
        let of_tables = self.tables.iter().filter_map(|(name, axis)| {
            let from = axis.from.as_deref()?;
            Some((pointer(["tables", name, "from"]), from))
        });
        let of_axes = self.channels.iter().filter_map(|(name, channel)| {
            let from = match channel.time.as_ref()? {
                ChannelTime::From(from) => from,
                ChannelTime::Axis(axis) => axis.from.as_ref()?,
            };
            Some((pointer(["channels", name, "time"]), from.as_str()))
        });
        let of_channels = self.channels.iter();
        let of_channels = of_channels
            .map(|(name, channel)| (pointer(["channels", name, "from"]), &*channel.from));
        let of_axes = of_tables.chain(of_axes);
        for (place, from) in of_time.into_iter().chain(of_channels).chain(of_axes) {
            from.parse::<Source>().map_err(|why| {
                let from = short_message(from);
                let message = format!(
                    "mapping: '{from}' is not a source such as fdata(:,4), rec.alpha or (:,4): {why}"
                );
                Fault::new(place, code::INVALID_MAPPING, message)
            })?;
        }
        Ok(self)
    }
}

fn invalid(error: &str) -> Fault {
    let error = short_message(error);
    let message = format!(
        "the mapping cannot be read: {error}; it is {{\"time\": {{\"from\", \"unit\"}}, \"channels\": {{name: {{\"from\", \"unit\"}}}}}}"
    );
    of_file(code::INVALID_MAPPING, message)
}

#[cfg(test)]
mod tests {
    use super::super::units::RecordedUnit;
    use super::*;

    #[test]
    fn bundled_mappings_have_sources_and_units_that_are_known() {
        for name in Mapping::names() {
            let mapping =
                Mapping::named_or_json(name).unwrap_or_else(|fault| panic!("{name}: {fault}"));
            assert!(!mapping.about().is_empty(), "{name}");
            let time = &mapping.time;
            let has_unit = RecordedUnit::parse_time(&time.unit).is_ok();
            assert!(has_unit || time.is_unstated(), "{name}");
            let mut sources: Vec<&str> = time.from.as_deref().into_iter().collect();
            for (channel, mapped) in &mapping.channels {
                assert!(
                    RecordedUnit::parse(&mapped.unit).is_ok(),
                    "{name} {channel}"
                );
                sources.push(&mapped.from);
            }
            let count = sources.len();
            sources.sort_unstable();
            sources.dedup();
            assert_eq!(sources.len(), count, "{name}: no column is two channels");
        }
    }

    #[test]
    fn faults_name_the_place_and_the_shape() {
        let refused = |text: &str, place: &str, expected: &str| {
            let fault = Mapping::named_or_json(text).unwrap_err();
            assert_eq!(
                (fault.code.as_ref(), fault.pointer.as_str()),
                (code::INVALID_MAPPING, place)
            );
            assert!(fault.message.contains(expected), "{fault}");
        };
        refused("sidpack", "", "Trimtab are ardupilot, fvsysid-attas");
        refused("{", "", "EOF");
        refused(r#"{"time": {"unit": "s"}}"#, "", "channels");
        refused(
            r#"{"time": {"unit": "s", "from": "t"}, "channels": {"a": {"from": "a"}}}"#,
            "",
            "unit",
        );
        let document = |time: &str, a: &str| {
            format!(
                r#"{{"time": {{"unit": "s", "from": "{time}"}}, "channels": {{"a": {{"unit": "-", "from": "{a}"}}}}}}"#
            )
        };
        refused(&document("t(1)", "a"), "/time/from", "one column");
        refused(&document("t", "a b"), "/channels/a/from", "letters");
        assert!(Mapping::named_or_json(&document("t", "a(:,2)")).is_ok());
        let toml =
            "time = {step = 0.04, unit = \"s\"}\n[channels]\na = {from = \"a\", unit = \"deg\"}\n";
        assert_eq!(Mapping::from_toml(toml).unwrap().time.step, Some(0.04));
        assert!(Mapping::from_toml("x").is_err());
    }
}
