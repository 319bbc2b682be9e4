//! What every channel of a file is called, and in which unit it is.

use super::super::Limits;
use super::super::name::{Names, is_identifier};
use super::super::note;
use super::super::text::quoted;
use super::super::units::RecordedUnit;
use super::group::{Channel, Group, Time};
use crate::flight::Finding;

/// Channels that are read, and what is told about them.
#[derive(Default)]
pub(super) struct Plan {
    /// By group, in its order: the name and the unit of a channel, and what the file knows it by.
    pub(super) channels: Vec<Planned>,
    left_out: Vec<(String, String)>,
    renamed: Vec<(String, String)>,
    without_unit: Vec<String>,
}

pub(super) struct Planned {
    pub(super) group: usize,
    pub(super) name: String,
    pub(super) unit: RecordedUnit,
    pub(super) at: usize,
}

impl Plan {
    /// Of all channels of groups with a time.
    pub(super) fn of(groups: &[Group], limits: &Limits) -> Self {
        let mut plan = Self::default();
        let mut names = Names::new(limits);
        let first = groups.first().map(|group| &group.name);
        let is_one = groups.iter().all(|group| Some(&group.name) == first);
        for (at, group) in groups.iter().enumerate() {
            for channel in &group.channels {
                let title = title(is_one, group, channel);
                match plan.channel(&mut names, group, channel, &title) {
                    Ok((name, unit)) => plan.channels.push(Planned {
                        group: at,
                        name,
                        unit,
                        at: channel.at,
                    }),
                    Err(why) => plan.left_out.push((quoted(&title), why)),
                }
            }
        }
        plan
    }

    /// The name and the unit of a channel.
    fn channel(
        &mut self,
        names: &mut Names,
        group: &Group,
        channel: &Channel,
        title: &str,
    ) -> Result<(String, RecordedUnit), String> {
        if group.time == Time::Unknown {
            return Err("the file says no times of it".to_string());
        }
        let (name, unit) = channel.label();
        let parsed = RecordedUnit::parse(unit).map_err(|(_, message)| message)?;
        let taken = match is_identifier(name) {
            true => names.take(name).is_ok(),
            false => false,
        };
        let named = match taken {
            true => name.to_string(),
            false => {
                let is_double = is_identifier(name);
                let named = names.take_like(if is_double { title } else { name });
                self.renamed.push((title.to_string(), named.clone()));
                named
            }
        };
        if unit.is_empty() {
            self.without_unit.push(named.clone());
        }
        Ok((named, parsed))
    }

    /// What is told; `left_out` are those that the file itself does not give.
    pub(super) fn findings(&self, left_out: &[(String, String)]) -> Vec<Finding> {
        let left_out = left_out
            .iter()
            .map(|(title, why)| (quoted(title), why.clone()));
        let left_out: Vec<_> = left_out.chain(self.left_out.iter().cloned()).collect();
        let findings = [
            note::left_out(
                &left_out,
                "a mapping can say units and times of what has numbers",
            ),
            note::renamed(&self.renamed),
            note::without_unit(&self.without_unit),
        ];
        findings.into_iter().flatten().collect()
    }
}

/// A channel's name, behind that of its group where there are several.
fn title(is_one: bool, group: &Group, channel: &Channel) -> String {
    match is_one {
        true => channel.name.clone(),
        false => format!("{}/{}", group.name, channel.name),
    }
}
