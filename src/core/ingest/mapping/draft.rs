//! Mappings that are proposed for a file.

use super::{MappedChannel, MappedTime, Mapping, NoValue, Repeated, Titles};

/// A mapping in the making.
#[derive(Default)]
pub(in super::super) struct Draft(Mapping);

impl Draft {
    pub(in super::super) fn time(&mut self, from: &str, unit: &str, repeated: Option<Repeated>) {
        self.0.time = MappedTime {
            unit: unit.to_string(),
            from: Some(Titles::One(from.to_string())),
            repeated,
            ..MappedTime::default()
        };
    }

    /// Time in several columns: from the year down to the second where there are such, and the finest in a unit.
    pub(in super::super) fn time_in_parts(
        &mut self,
        parts: [Option<String>; 6],
        from: &str,
        unit: &str,
    ) {
        let [year, month, day, hour, minute, second] = parts.map(|part| part.map(Titles::One));
        self.0.time = MappedTime {
            unit: unit.to_string(),
            from: Some(Titles::One(from.to_string())),
            year,
            month,
            day,
            hour,
            minute,
            second,
            ..MappedTime::default()
        };
    }

    /// Time that no column has: its step is to be said.
    pub(in super::super) fn even_time(&mut self) {
        self.0.time = MappedTime {
            unit: "?".to_string(),
            step: Some(1.0),
            ..MappedTime::default()
        };
    }

    pub(in super::super) fn channel(&mut self, name: &str, from: &str, unit: &str) {
        let channel = MappedChannel {
            from: Titles::One(from.to_string()),
            unit: unit.to_string(),
            ..MappedChannel::default()
        };
        self.0.channels.insert(name.to_string(), channel);
    }

    /// A channel whose numbers are multiplied, of which one stands for no value.
    pub(in super::super) fn scaled(
        &mut self,
        name: &str,
        from: &str,
        unit: &str,
        scale: f64,
        missing: f64,
    ) {
        let channel = MappedChannel {
            from: Titles::One(from.to_string()),
            unit: unit.to_string(),
            scale: (scale != 1.0).then_some(scale),
            missing: vec![NoValue::Number(missing)],
            ..MappedChannel::default()
        };
        self.0.channels.insert(name.to_string(), channel);
    }

    /// So many lines are before the rows.
    pub(in super::super) fn skipped(&mut self, lines: usize) {
        self.0.skip = Some(lines);
    }

    pub(in super::super) fn mapping(self) -> Mapping {
        self.0
    }
}

/// A part of a document on one line.
fn inline(part: &impl serde::Serialize) -> String {
    toml::Value::try_from(part).map_or(String::new(), |value| value.to_string())
}

impl Mapping {
    /// The document as JSON.
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }

    /// What the document says of time and channels as TOML, a channel a line.
    pub fn to_toml(&self) -> String {
        let mut text = format!("time = {}\n\n[channels]\n", inline(&self.time));
        for (name, channel) in &self.channels {
            text += &format!("{name} = {}\n", inline(channel));
        }
        text
    }
}
