//! Stretches of recordings that are simulated as one: some rows, and what becomes of the gaps among them.

use std::ops::Range;

use indexmap::IndexMap;

use crate::flight::{Dimension, Maneuver};
use crate::job::spec::ManeuverUse;
use crate::model::Recorded;
use crate::simulate::Steps;

/// A member of a maneuver that says which part of it is used, and what is wrong with it.
type WrongPart = (&'static str, String);

/// The rows of a recording that a job uses, from 0: those between its first and last row, or second.
///
/// # Errors
/// They are not in the recording, or fewer than two.
pub(in crate::job) fn rows_in_use(
    usage: &ManeuverUse,
    maneuver: &Maneuver,
) -> Result<Range<usize>, WrongPart> {
    match (usage.rows, usage.seconds) {
        (None, None) => Ok(0..maneuver.len()),
        (Some(rows), None) => rows_from(rows, maneuver).map_err(|why| ("rows", why)),
        (None, Some(seconds)) => rows_between(seconds, maneuver).map_err(|why| ("seconds", why)),
        (Some(_), Some(_)) => {
            let message = "a part is said by \"rows\" or by \"seconds\", not by both";
            Err(("rows", message.to_string()))
        }
    }
}

fn rows_from([first, last]: [usize; 2], maneuver: &Maneuver) -> Result<Range<usize>, String> {
    if first < 1 || last > maneuver.len() || first >= last {
        return Err(format!(
            "rows {first} to {last} of a recording of {} rows; rows count from 1 and at least two are needed",
            maneuver.len()
        ));
    }
    Ok(first - 1..last)
}

fn rows_between([from, to]: [f64; 2], maneuver: &Maneuver) -> Result<Range<usize>, String> {
    let time = maneuver.time();
    // times that were added up from steps are a little beside what is written
    let nothing = 1e-6 * maneuver.sampling().step;
    let start = time.partition_point(|&t| t < from - nothing);
    let end = time.partition_point(|&t| t <= to + nothing);
    if from >= to || end < start + 2 {
        return Err(format!(
            "seconds {from} to {to} of a recording from {} s to {} s; at least two samples are needed",
            time[0],
            time[time.len() - 1]
        ));
    }
    Ok(start..end)
}

/// Some rows of a recording, and what the job makes of them.
pub(super) struct Stretch<'m> {
    pub maneuver: &'m Maneuver,
    /// Of the recording, from 0.
    pub rows: Range<usize>,
    pub label: String,
    /// The maneuver's place in the spec.
    pub index: usize,
    pub steps: Steps,
    /// Whether it is what follows a gap of the rows in use.
    pub is_behind_gap: bool,
    /// Where gaps are integrated through.
    filled: Option<Filled>,
}

/// Rows with samples without values put into their gaps.
struct Filled {
    time: Vec<f64>,
    channels: IndexMap<String, Vec<f64>>,
    /// By sample the row that it is, if any.
    origin: Vec<Option<usize>>,
    /// The samples that were put in.
    inserted: Vec<Range<usize>>,
}

/// A gap that is to be integrated through: the row behind it, and how many samples are put in.
#[derive(Clone, Copy)]
pub(super) struct Bridge {
    pub before: usize,
    pub samples: usize,
}

impl<'m> Stretch<'m> {
    /// Of the maneuver at a place of the spec, at its usual step.
    pub(super) fn new(
        index: usize,
        maneuver: &'m Maneuver,
        rows: Range<usize>,
        label: String,
    ) -> Self {
        Self {
            maneuver,
            rows,
            label,
            index,
            steps: Steps::Even(maneuver.sampling().step),
            is_behind_gap: false,
            filled: None,
        }
    }

    /// With samples put into gaps, evenly between the rows at both sides; gaps stand in their order.
    pub(super) fn through(mut self, bridges: &[Bridge]) -> Self {
        if bridges.is_empty() {
            return self;
        }
        let recorded = self.maneuver.time();
        let (mut time, mut inserted) = (Vec::new(), Vec::new());
        let mut origin: Vec<Option<usize>> = Vec::new();
        let mut bridges = bridges.iter().peekable();
        for row in self.rows.clone() {
            if let Some(bridge) = bridges.next_if(|bridge| bridge.before == row) {
                let (from, to) = (recorded[row - 1], recorded[row]);
                let count = bridge.samples;
                inserted.push(time.len()..time.len() + count);
                time.extend(
                    (1..=count).map(|k| from + (to - from) * k as f64 / (count + 1) as f64),
                );
                origin.extend(std::iter::repeat_n(None, count));
            }
            time.push(recorded[row]);
            origin.push(Some(row));
        }
        let fill = |values: &[f64]| {
            let value = |row: &Option<usize>| row.map_or(f64::NAN, |row| values[row]);
            origin.iter().map(value).collect()
        };
        let channels = self.maneuver.channels().iter();
        let channels = channels.map(|(name, channel)| (name.clone(), fill(&channel.values)));
        self.filled = Some(Filled {
            channels: channels.collect(),
            time,
            origin,
            inserted,
        });
        self
    }

    pub(super) fn label(&self) -> &str {
        &self.label
    }

    pub(super) fn len(&self) -> usize {
        self.time().len()
    }

    /// The samples that no row has.
    pub(super) fn inserted(&self) -> &[Range<usize>] {
        self.filled.as_ref().map_or(&[], |filled| &filled.inserted)
    }

    /// The row of the recording that a sample is, from 0; of one that was put in, the row behind it.
    pub(super) fn row(&self, sample: usize) -> usize {
        let mut onwards = sample..self.len();
        onwards
            .find_map(|sample| self.own_row(sample))
            .unwrap_or(self.rows.end)
    }

    /// The samples that are rows of the recording, with their rows.
    pub(super) fn recorded(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        (0..self.len()).filter_map(|sample| Some((sample, self.own_row(sample)?)))
    }

    fn own_row(&self, sample: usize) -> Option<usize> {
        match &self.filled {
            Some(filled) => filled.origin[sample],
            None => Some(self.rows.start + sample),
        }
    }
}

impl Recorded for Stretch<'_> {
    fn time(&self) -> &[f64] {
        match &self.filled {
            Some(filled) => &filled.time,
            None => &self.maneuver.time()[self.rows.clone()],
        }
    }
    fn channel(&self, name: &str) -> Option<(&[f64], Dimension)> {
        let channel = self.maneuver.channels().get(name)?;
        let values = match &self.filled {
            Some(filled) => filled.channels.get(name)?.as_slice(),
            None => &channel.values[self.rows.clone()],
        };
        Some((values, channel.unit.dimension))
    }
    fn names(&self) -> Vec<String> {
        self.maneuver.channels().keys().cloned().collect()
    }
}
