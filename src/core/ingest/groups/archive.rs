//! Groups as a mapping sees them: `Group.channel`, or `channel` where one group has it.

use super::super::mapping::{Archive, OwnTime};
use super::super::matrix::Matrix;
use super::super::name::identifier_like;
use super::super::text::{listed, quoted};
use super::super::{Limits, code};
use super::group::{Channel, Group, Groups, Samples, Time};

pub(super) struct Source<S> {
    groups: Groups<S>,
    /// What was asked for last.
    values: Vec<f64>,
    limits: Limits,
}

/// The times of a group that are no channel of it: no name in a mapping is like this.
const TIMES: &str = "(times)";
/// Channels are listed up to this many.
const LISTED: usize = 60;

impl<S> Source<S> {
    pub(super) fn of(groups: Groups<S>, limits: &Limits) -> Self {
        Self {
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
        let is_same =
            |found: &str, wanted: &str| found == wanted || identifier_like(found) == wanted;
        let groups = self.groups.groups.iter().enumerate();
        let groups = groups.filter(|(_, of)| group.is_none_or(|group| is_same(&of.name, group)));
        let mut found = groups.flat_map(|(at, group)| {
            let channels = group.channels.iter();
            let channels = channels.filter(|channel| is_same(&channel.name, name));
            channels.map(move |channel| (at, group, channel))
        });
        found
            .next()
            .filter(|_| group.is_some() || found.next().is_none())
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
        let (group, at) = match times.and_then(|group| self.groups.groups.get(group)) {
            Some(group) => match group.time {
                Time::Recorded(at) => (group, Some(at)),
                Time::Even { .. } => (group, None),
                Time::Unknown => {
                    return Err((code::UNKNOWN_SOURCE, "there are no times".to_string()));
                }
            },
            None => match self.find(path) {
                Some((_, group, channel)) => (group, Some(channel.at)),
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
        Ok(Matrix::of_rows(&self.values, 1))
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
