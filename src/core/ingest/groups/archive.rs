//! Groups as a mapping sees them: `Group.channel`, or `channel` where one group has it.

use super::super::mapping::{Archive, OwnTime};
use super::super::matrix::Matrix;
use super::super::name::identifier_like;
use super::super::text::{listed, quoted};
use super::super::{Limits, code};
use super::group::{Channel, Group, Groups, Samples, Time};

pub(super) struct Source<S> {
    groups: Groups<S>,
    names: Vec<Named>,
    /// What was asked for last.
    values: Vec<f64>,
    limits: Limits,
}

/// A channel by its place, and what a mapping may call it and its group where they have other signs in their names.
struct Named {
    group: usize,
    channel: usize,
    of_group: String,
    of_channel: String,
}

/// The times of a group that are no channel of it: no name in a mapping is like this.
const TIMES: &str = "(times)";
/// Channels are listed up to this many.
const LISTED: usize = 60;

impl<S> Source<S> {
    pub(super) fn of(groups: Groups<S>, limits: &Limits) -> Self {
        let all = groups.groups.iter().enumerate();
        let names = all.flat_map(|(at, group)| {
            let of_group = identifier_like(&group.name);
            let channels = group.channels.iter().enumerate();
            channels.map(move |(channel, of)| Named {
                group: at,
                channel,
                of_group: of_group.clone(),
                of_channel: identifier_like(&of.name),
            })
        });
        Self {
            names: names.collect(),
            groups,
            values: Vec::new(),
            limits: *limits,
        }
    }

    /// The group and the channel that a path means.
    fn find(&self, path: &[String]) -> Option<(usize, &Group, &Channel)> {
        let (group, name) = match path {
            [group, name] => (Some(group), name),
            [name] => (None, name),
            _ => return None,
        };
        let all = self.names.iter().map(|named| {
            let group = &self.groups.groups[named.group];
            (named, group, &group.channels[named.channel])
        });
        let mut found = all.filter(|(named, of, channel)| {
            let is_in = |group: &String| named.of_group == *group || of.name == *group;
            (named.of_channel == *name || channel.name == *name) && group.is_none_or(is_in)
        });
        let (named, of, channel) = found.next()?;
        let is_one = group.is_some() || found.next().is_none();
        is_one.then_some((named.group, of, channel))
    }

    /// The groups, with as many rows as were found of those that were asked for.
    pub(super) fn groups(&self) -> &[Group] {
        &self.groups.groups
    }

    fn contents(&self) -> String {
        contents(&self.groups.groups)
    }
}

/// What there is, for a message.
pub(super) fn contents(groups: &[Group]) -> String {
    let channels = groups.iter().flat_map(|group| {
        group.channels.iter().map(|channel| {
            let name = format!(
                "{}.{}",
                identifier_like(&group.name),
                identifier_like(&channel.name)
            );
            match channel.unit.as_str() {
                "" => name,
                unit => format!("{name} [{unit}]"),
            }
        })
    });
    listed(channels, LISTED)
}

impl<S: Samples> Archive for Source<S> {
    fn matrix(&mut self, path: &[String]) -> Result<Matrix<'_>, (&'static str, String)> {
        let times = match path {
            [group, name] if name == TIMES => group.parse::<usize>().ok(),
            _ => None,
        };
        let times = times.and_then(|at| Some((at, self.groups.groups.get(at)?)));
        let (number, at) = match times {
            Some((number, group)) => match group.time {
                Time::Recorded(at) => (number, Some(at)),
                Time::Even { .. } => (number, None),
                Time::Unknown => {
                    return Err((code::UNKNOWN_SOURCE, "there are no times".to_string()));
                }
            },
            None => match self.find(path) {
                Some((number, _, channel)) => (number, Some(channel.at)),
                None => {
                    let message = format!(
                        "there is no one channel {}; the file has {}",
                        quoted(&path.join(".")),
                        self.contents()
                    );
                    return Err((code::UNKNOWN_SOURCE, message));
                }
            },
        };
        let group = &mut self.groups.groups[number];
        if let Some(fault) = self.limits.samples(group.rows) {
            return Err((code::TOO_MANY_SAMPLES, fault.message));
        }
        let Some(at) = at else {
            if let Time::Even { start, step } = group.time {
                self.values = even(group.rows, start, step);
            }
            return Ok(Matrix::of_rows(&self.values, 1));
        };
        let values = self.groups.samples.values(at);
        self.values = values.map_err(|fault| (code::DAMAGED_FILE, fault.message))?;
        // in some files only reading tells how many there are
        group.rows = group.rows.min(self.values.len());
        Ok(Matrix::of_rows(&self.values, 1))
    }

    fn unit(&self, path: &[String]) -> Option<String> {
        let (_, _, channel) = self.find(path)?;
        Some(channel.label().1.to_string()).filter(|unit| !unit.is_empty())
    }

    fn own_time(&self, path: &[String]) -> Option<OwnTime> {
        let (at, group, _) = self.find(path)?;
        (group.time != Time::Unknown).then(|| OwnTime {
            path: vec![at.to_string(), TIMES.to_string()],
            unit: "s",
        })
    }
}

pub(super) fn even(rows: usize, start: f64, step: f64) -> Vec<f64> {
    (0..rows).map(|row| start + row as f64 * step).collect()
}
