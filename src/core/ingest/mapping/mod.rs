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
mod bundled;
mod channel;
mod check;
mod draft;
mod source;
mod spread;
mod taken;
mod time;
mod titles;

use std::sync::LazyLock;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

pub(super) use archive::{Archive, OwnTime};
use bundled::BUNDLED;
pub(super) use channel::MappedChannel;
pub(super) use draft::Draft;
pub(super) use source::{Part, Source, element};
pub(super) use time::{Axis, ChannelTime, MappedTime, Repeated};
pub(super) use titles::{NoValue, Titles};

use super::{code, fault::of_file, text::short_message};
use crate::flight::Fault;

/// Says where time and channels are in a MAT file, a log or an ASCII matrix, or which columns of a table of text they are,
/// and how that is written. What it does not say of a table is as the file says.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Mapping {
    /// For people: which recordings it is for.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    about: String,
    /// Titles of a table of text. Where a file has all of them and nothing else is said, this mapping is used.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    recognise: Vec<Titles>,
    /// Lines of a text before its table.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) skip: Option<usize>,
    /// The number of the line that has the names, from 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) header: Option<usize>,
    /// What separates cells: `,`, `;`, `tab`, `|` or `blanks`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) delimiter: Option<String>,
    /// What separates a number's whole from its fraction: `.` or `,`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) decimal: Option<String>,
    /// Numbers and words that stand for no value, on every channel.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) missing: Vec<NoValue>,
    /// May be left out where the file says which it is, or every channel has a time axis of its own.
    #[serde(default, skip_serializing_if = "MappedTime::is_silent")]
    pub(super) time: MappedTime,
    /// Time axes of tables of the file, by what the sources of their channels begin with: `AIR`, `log.AIR`, `IMU[1]`.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub(super) tables: IndexMap<String, Axis>,
    /// By name, in the order of the document.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub(super) channels: IndexMap<String, MappedChannel>,
    /// Columns of a table that are not named here become channels, too, as the file says. So they do where `channels` is
    /// empty.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(super) others: bool,
    /// Channels that a file does not have are left out.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(super) optional: bool,
}

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

    /// The bundled mapping that names titles all of which a table has.
    pub(super) fn recognised(
        has: impl Fn(&Titles) -> bool,
    ) -> Option<(&'static str, &'static Self)> {
        static ALL: LazyLock<Vec<(&str, Mapping)>> = LazyLock::new(|| {
            let read = |(name, document): &(&'static str, &str)| {
                Some((*name, Mapping::from_toml(document).ok()?))
            };
            BUNDLED.iter().filter_map(read).collect()
        });
        let is_of =
            |mapping: &Self| !mapping.recognise.is_empty() && mapping.recognise.iter().all(&has);
        let found = ALL.iter().find(|(_, mapping)| is_of(mapping));
        found.map(|(name, mapping)| (*name, mapping))
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
            let has_stamps = time.unit.is_empty() || time.unit == "hhmmss";
            assert!(
                has_stamps || RecordedUnit::parse_time(&time.unit).is_ok(),
                "{name}"
            );
            let mut sources: Vec<&Titles> = time.from.iter().collect();
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
        refused("sidpack", "", "Trimtab are ardupilot, betaflight");
        refused("{", "", "EOF");
        refused(r#"{"tim": {"unit": "s"}}"#, "", "channels");
        refused(
            r#"{"time": {"unit": "s", "from": "t"}, "channels": {"a": {"unit": "-"}}}"#,
            "",
            "from",
        );
        refused(r#"{"time": {"from": "t", "step": 1}}"#, "/time", "either");
        refused(r#"{"time": {"start": 1}}"#, "/time", "either");
        refused(r#"{"decimal": ";"}"#, "/decimal", "decimal is");
        let a = |members: &str| format!(r#"{{"channels": {{"a": {{"from": "a", {members}}}}}}}"#);
        refused(&a(r#""sign": 2"#), "/channels/a/sign", "1 or -1");
        refused(&a(r#""scale": 0"#), "/channels/a/scale", "other than 0");
        let document = |time: &str, a: &str| {
            format!(
                r#"{{"time": {{"unit": "s", "from": "{time}"}}, "channels": {{"a": {{"unit": "-", "from": "{a}"}}}}}}"#
            )
        };
        refused(&document("", "a"), "/time/from", "empty");
        refused(&document("t", " "), "/channels/a/from", "empty");
        assert!(Mapping::named_or_json(&document("t", "a(:,2)")).is_ok());
        let toml =
            "time = {step = 0.04, unit = \"s\"}\n[channels]\na = {from = \"a\", unit = \"deg\"}\n";
        assert_eq!(Mapping::from_toml(toml).unwrap().time.step, Some(0.04));
        assert!(Mapping::from_toml("x").is_err());
    }
}
