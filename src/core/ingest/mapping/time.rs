//! Where a mapping says that time is: that of the recording, and that of channels and tables with times of their own.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::Titles;

/// Either `from`, or `step` (with `start`, else 0) for even sampling.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(in super::super) struct MappedTime {
    /// May be left out where a table says it, or has time stamps.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub(in super::super) unit: String,
    /// Where the times are in the file; of a time in parts, the finest one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) from: Option<Titles>,
    /// The column of a table that has the date of a time of day.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) date: Option<Titles>,
    /// The column of a table that has the week of the satellites' clock; `from` has its seconds, or in `unit`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) week: Option<Titles>,
    /// Columns of a table that have the time from the year down to the second; `from` has what is finer, or the seconds, in
    /// `unit`. A day without a month is that of the year.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) year: Option<Titles>,
    /// The column that has the month, 1 to 12.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) month: Option<Titles>,
    /// The column that has the day of the month, or of the year.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) day: Option<Titles>,
    /// The column that has the hour.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) hour: Option<Titles>,
    /// The column that has the minute.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) minute: Option<Titles>,
    /// The column that has the second.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) second: Option<Titles>,
    /// The first time of even sampling, in `unit`; absent: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) start: Option<f64>,
    /// From one sample to the next of even sampling, in `unit`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) step: Option<f64>,
    /// What is made of several rows of a table with one time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in super::super) repeated: Option<Repeated>,
}

impl MappedTime {
    pub(super) fn is_silent(&self) -> bool {
        *self == Self::default()
    }

    /// What it says of the parts of a time, by their names.
    pub(in super::super) fn parts(&self) -> [(&'static str, &Option<Titles>); 6] {
        [
            ("year", &self.year),
            ("month", &self.month),
            ("day", &self.day),
            ("hour", &self.hour),
            ("minute", &self.minute),
            ("second", &self.second),
        ]
    }

    pub(in super::super) fn has_parts(&self) -> bool {
        self.parts().iter().any(|(_, titles)| titles.is_some())
    }

    /// The first member that is for tables only.
    pub(super) fn for_tables(&self) -> Option<&'static str> {
        let parts = self.parts().map(|(part, titles)| (part, titles.is_some()));
        let others = [
            ("date", self.date.is_some()),
            ("week", self.week.is_some()),
            ("repeated", self.repeated.is_some()),
        ];
        let mut all = others.into_iter().chain(parts);
        all.find_map(|(member, is_said)| is_said.then_some(member))
    }

    /// Whether it says where time is.
    pub(super) fn is_stated(&self) -> bool {
        self.from.is_some() || self.step.is_some()
    }
}

/// What is made of several rows with one time. Rows that are the same in all cells are kept once in any case.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(in super::super) enum Repeated {
    /// The first is kept.
    First,
    /// The mean of each channel is kept.
    Mean,
    /// All are kept, evenly between this time and the next: the clock is coarser than the rate.
    Spread,
}

/// A time axis of its own.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(in super::super) struct Axis {
    /// Absent: as the file says it, or the recording's.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = "AIR(:,1)")]
    pub(in super::super) from: Option<Titles>,
    /// Absent: that of the recording's time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in super::super) unit: Option<String>,
    /// Seconds that are added to its times.
    #[serde(default)]
    #[schema(example = 0.12)]
    pub(in super::super) offset: f64,
}

/// The source of a time axis, in the unit of the recording's time; or all that is to be said of it.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(untagged)]
pub(in super::super) enum ChannelTime {
    From(Titles),
    Axis(Axis),
}

impl ChannelTime {
    /// All that is said of it.
    pub(in super::super) fn axis(&self) -> Axis {
        match self {
            Self::From(from) => Axis {
                from: Some(from.clone()),
                ..Axis::default()
            },
            Self::Axis(axis) => axis.clone(),
        }
    }
}
