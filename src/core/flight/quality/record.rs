//! A recording as the checks see it: borrowed, so that what a job makes of channels can be looked at as well as a file.

use std::borrow::Cow;
use std::ops::Range;

use crate::flight::{Dimension, Maneuver, Sampling, Unit};

/// Time and series of one recording, SI.
pub struct Record<'a> {
    /// Of each sample, s.
    pub time: Cow<'a, [f64]>,
    /// Of `time`.
    pub sampling: Cow<'a, Sampling>,
    /// All of one length.
    pub series: Vec<Series<'a>>,
}

/// One series of a record.
pub struct Series<'a> {
    /// By which it is known in findings.
    pub name: &'a str,
    /// SI; NaN where there is none.
    pub values: Cow<'a, [f64]>,
    /// In which it was recorded.
    pub unit: Unit,
    /// Whether it is an angle, and not some other pure number.
    pub is_angle: bool,
    /// Whether it is looked at; others are there to be compared with.
    pub is_used: bool,
}

impl<'a> Record<'a> {
    /// All of a maneuver.
    pub fn of(maneuver: &'a Maneuver) -> Self {
        let series = maneuver.channels().iter().map(|(name, channel)| Series {
            name,
            values: Cow::Borrowed(&channel.values),
            unit: channel.unit,
            is_angle: Unit::si_name(&channel.recorded_unit) == "rad",
            is_used: true,
        });
        Self {
            time: Cow::Borrowed(maneuver.time()),
            sampling: Cow::Borrowed(maneuver.sampling()),
            series: series.collect(),
        }
    }

    /// The stretches between gaps.
    pub(super) fn segments(&self) -> Vec<Range<usize>> {
        self.sampling.segments()
    }

    /// The series of one of these names and this kind. A name in lower case is that of any case; `V` is not `v`.
    pub(super) fn find(&self, names: &[&str], kind: Kind) -> Option<&Series<'a>> {
        let is_one = |series: &&Series<'_>| {
            let name = series.name.to_ascii_lowercase();
            let is_named = names.contains(&name.as_str()) || names.contains(&series.name);
            is_named && kind.is_of(series)
        };
        self.series.iter().find(is_one)
    }
}

/// What a series measures.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Angle,
    Rate,
    Speed,
    Acceleration,
    Pressure,
    Density,
    Number,
}

impl Kind {
    fn is_of(self, series: &Series<'_>) -> bool {
        let per_second = Dimension::NONE.over(Dimension::SECOND);
        let speed = Dimension::METRE.times(per_second);
        let (dimension, is_angle) = (series.unit.dimension, series.is_angle);
        match self {
            Self::Angle => is_angle,
            Self::Number => !is_angle && dimension == Dimension::NONE,
            Self::Rate => dimension == per_second,
            Self::Speed => dimension == speed,
            Self::Acceleration => dimension == speed.times(per_second),
            Self::Pressure => Unit::parse("Pa").is_ok_and(|unit| unit.dimension == dimension),
            Self::Density => Unit::parse("kg/m^3").is_ok_and(|unit| unit.dimension == dimension),
        }
    }
}
