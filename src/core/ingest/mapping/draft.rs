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

    /// A channel whose numbers are multiplied, of which some stand for no value.
    pub(in super::super) fn scaled(
        &mut self,
        name: &str,
        from: &str,
        unit: &str,
        scale: f64,
        missing: &[f64],
    ) {
        let channel = MappedChannel {
            from: Titles::One(from.to_string()),
            unit: unit.to_string(),
            scale: (scale != 1.0).then_some(scale),
            missing: missing.iter().copied().map(NoValue::Number).collect(),
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

    /// The document as TOML, a channel a line.
    pub fn to_toml(&self) -> String {
        let mut text = String::new();
        if let Ok(toml::Value::Table(all)) = toml::Value::try_from(self) {
            for (member, value) in &all {
                if !["time", "channels"].contains(&member.as_str()) {
                    text += &format!("{member} = {value}\n");
                }
            }
        }
        text += &format!("time = {}\n\n[channels]\n", inline(&self.time));
        for (name, channel) in &self.channels {
            text += &format!("{name} = {}\n", inline(channel));
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_draft_is_all_in_its_document() {
        let mut draft = Draft::default();
        draft.skipped(20);
        draft.time("(:,1)", "s", None);
        draft.scaled("alpha", "(:,2)", "deg", 0.1, &[-9999.0, -8888.0]);
        draft.channel("q", "(:,3)", "deg/s");
        let mapping = draft.mapping();
        let text = mapping.to_toml();
        assert!(text.starts_with("skip = 20\ntime = "), "{text}");
        assert_eq!(Mapping::from_toml(&text).as_ref(), Ok(&mapping), "{text}");
        assert_eq!(Mapping::from_json(&mapping.to_json()), Ok(mapping));
    }
}
