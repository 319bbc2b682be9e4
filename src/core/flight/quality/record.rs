//! A recording as the checks see it: borrowed, so that what a job makes of channels can be looked at as well as a file.

use std::borrow::Cow;
use std::ops::Range;

use crate::flight::{Dimension, Family, Maneuver, PhysicalQuantity, Sampling, Unit, by_name};

/// Time and series of one recording, SI.
pub struct Record<'a> {
    /// Of each sample, s.
    pub time: Cow<'a, [f64]>,
    /// Of `time`.
    pub sampling: Cow<'a, Sampling>,
    /// The row of the recording that its first sample is, from 0.
    pub first_row: usize,
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
            first_row: 0,
            series: series.collect(),
        }
    }

    /// The stretches between gaps.
    pub(super) fn segments(&self) -> Vec<Range<usize>> {
        self.sampling.segments()
    }

    /// The series of a quantity, by its name and unit; of several that with the shortest name, which has no qualifier.
    pub(super) fn of_quantity(&self, quantity: PhysicalQuantity) -> Option<&Series<'a>> {
        let is_angle = quantity.is_flow_angle() || quantity.family() == Family::Attitude;
        let is_one = |series: &&Series<'_>| {
            let dimension = series.unit.dimension;
            // a load factor is no acceleration in m/s²
            let is_pure = dimension.is_none() && quantity.family() == Family::Accelerometer;
            by_name(series.name, dimension) == Some(quantity)
                && is_angle == series.is_angle
                && !is_pure
        };
        let those = self.series.iter().filter(is_one);
        those.min_by_key(|series| series.name.len())
    }

    /// The speed that has one of these names, in upper or lower case.
    pub(super) fn speed_named(&self, names: &[&str]) -> Option<&Series<'a>> {
        let speed = Dimension::METRE.over(Dimension::SECOND);
        self.series.iter().find(|series| {
            let name = series.name.to_ascii_lowercase();
            names.contains(&name.as_str()) && series.unit.dimension == speed
        })
    }
}
