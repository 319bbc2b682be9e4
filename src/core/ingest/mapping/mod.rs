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

mod apply;
mod bundled;
mod draft;
mod source;
mod titles;

use std::sync::LazyLock;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

pub(super) use apply::Archive;
use bundled::BUNDLED;
pub(super) use draft::Draft;
pub(super) use source::{Part, Source};
pub(super) use titles::{NoValue, Titles};

use super::{
    code,
    fault::{of_file, pointer},
    text::short_message,
};
use crate::flight::Fault;

/// Says where time and channels are in a MAT file or an ASCII matrix, or which columns of a table of text they are, and how
/// that is written. What it does not say of a table is as the file says.
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
    #[serde(default, skip_serializing_if = "MappedTime::is_silent")]
    pub(super) time: MappedTime,
    /// By name, in the order of the document.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub(super) channels: IndexMap<String, MappedChannel>,
    /// Columns of a table that are not named here become channels, too, as the file says. So they do where `channels` is
    /// empty.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(super) others: bool,
    /// Channels that a table does not have are left out.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(super) optional: bool,
}

/// Either `from`, or `step` (with `start`, else 0) for even sampling.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct MappedTime {
    /// May be left out where a table says it, or has time stamps.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub(super) unit: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) from: Option<Titles>,
    /// The column of a table that has the date of a time of day.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) date: Option<Titles>,
    /// The column of a table that has the week of the satellites' clock; `from` has its seconds, or in `unit`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) week: Option<Titles>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) start: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) step: Option<f64>,
    /// What is made of several rows of a table with one time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) repeated: Option<Repeated>,
}

impl MappedTime {
    fn is_silent(&self) -> bool {
        *self == Self::default()
    }
}

/// What is made of several rows with one time. Rows that are the same in all cells are kept once in any case.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum Repeated {
    /// The first is kept.
    First,
    /// The mean of each channel is kept.
    Mean,
    /// All are kept, evenly between this time and the next: the clock is coarser than the rate.
    Spread,
}

#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct MappedChannel {
    pub(super) from: Titles,
    /// `-` for a pure number; it must be said where the file does not say it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub(super) unit: String,
    /// What recorded numbers are multiplied by before the unit is applied.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) scale: Option<f64>,
    /// 1 or -1: another sense than the recorded one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) sign: Option<i8>,
    /// Numbers and words that stand for no value on this channel.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) missing: Vec<NoValue>,
}

impl MappedChannel {
    /// What recorded numbers are multiplied by.
    pub(super) fn factor(&self) -> f64 {
        self.scale.unwrap_or(1.0) * f64::from(self.sign.unwrap_or(1))
    }
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

    /// What it says does not contradict itself.
    fn checked(self) -> Result<Self, Fault> {
        let refuse = |place: String, message: &str| {
            Err(Fault::new(
                place,
                code::INVALID_MAPPING,
                format!("mapping: {message}"),
            ))
        };
        if self.time.from.is_some() && self.time.step.is_some() {
            return refuse(
                "/time".to_string(),
                "time has either \"from\", or \"step\" and perhaps \"start\"",
            );
        }
        let time = &self.time;
        let of_time = [
            ("from", &time.from),
            ("date", &time.date),
            ("week", &time.week),
        ];
        for (member, titles) in of_time {
            if titles.as_ref().is_some_and(Titles::is_empty) {
                return refuse(pointer(["time", member]), "this title is empty");
            }
        }
        if !matches!(self.decimal.as_deref(), None | Some("." | ",")) {
            return refuse("/decimal".to_string(), "decimal is \".\" or \",\"");
        }
        for (name, channel) in &self.channels {
            if channel.from.is_empty() {
                return refuse(pointer(["channels", name, "from"]), "this source is empty");
            }
            if !matches!(channel.sign, None | Some(1 | -1)) {
                return refuse(pointer(["channels", name, "sign"]), "sign is 1 or -1");
            }
            if !channel.factor().is_normal() {
                return refuse(
                    pointer(["channels", name, "scale"]),
                    "scale is a number other than 0",
                );
            }
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
            let has_stamps = time.unit.is_empty();
            assert!(
                has_stamps || RecordedUnit::parse_time(&time.unit).is_ok(),
                "{name}"
            );
            let mut sources: Vec<&Titles> = vec![time.from.as_ref().unwrap()];
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
        refused("sidpack", "", "Trimtab are fvsysid-attas");
        refused("{", "", "EOF");
        refused(r#"{"tim": {"unit": "s"}}"#, "", "channels");
        refused(
            r#"{"time": {"unit": "s", "from": "t"}, "channels": {"a": {"unit": "-"}}}"#,
            "",
            "from",
        );
        refused(r#"{"time": {"from": "t", "step": 1}}"#, "/time", "either");
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
