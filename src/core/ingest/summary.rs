//! What a maneuver is, without its samples.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::flight::{Channel, Finding, Maneuver, Unit, quality};

/// A maneuver in numbers: its length, its sampling, its channels, and what is odd about it.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Summary {
    /// Samples, on every channel the same number.
    #[schema(example = 1502)]
    pub samples: usize,
    /// From the first sample to the last, gaps included, s.
    #[schema(example = 90.12)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub duration: f64,
    /// The usual time between samples, s.
    #[schema(example = 0.04)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub step: f64,
    /// Samples per second, Hz.
    #[schema(example = 25.0)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub rate: f64,
    /// Stretches without a gap.
    #[schema(example = 2)]
    pub segments: usize,
    /// Every channel but time, in the order of the recording.
    pub channels: Vec<ChannelSummary>,
    /// What is odd about the data.
    pub findings: Vec<Finding>,
}

/// One channel; its numbers are SI.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ChannelSummary {
    /// The channel's name.
    #[schema(example = "alpha")]
    pub name: String,
    /// As recorded.
    #[schema(example = "deg")]
    pub unit: String,
    /// The unit of `min`, `max` and `mean`.
    #[schema(example = "rad")]
    pub si_unit: String,
    /// The smallest value; `null` where every value is missing.
    #[schema(example = 0.021)]
    pub min: Option<f64>,
    /// The largest value; `null` where every value is missing.
    #[schema(example = 0.094)]
    pub max: Option<f64>,
    /// Mean of the values there are; `null` where every value is missing.
    #[schema(example = 0.047)]
    pub mean: Option<f64>,
    /// Samples without a value.
    #[schema(example = 0)]
    pub missing: usize,
}

/// Everything about a maneuver that fits on a page, its quality findings included.
pub fn summary(maneuver: &Maneuver) -> Summary {
    let sampling = maneuver.sampling();
    Summary {
        samples: maneuver.len(),
        duration: maneuver.duration(),
        step: sampling.step,
        rate: sampling.step.recip(),
        segments: sampling.segments().len(),
        channels: maneuver
            .channels()
            .iter()
            .map(|(name, channel)| ChannelSummary::of(name, channel))
            .collect(),
        findings: quality(maneuver),
    }
}

impl ChannelSummary {
    fn of(name: &str, channel: &Channel) -> Self {
        let present = channel.values.iter().copied().filter(|v| !v.is_nan());
        let (mut count, mut mean) = (0usize, 0.0);
        for value in present.clone() {
            count += 1;
            // a running mean: the sum of large values could overflow
            mean += (value - mean) / count as f64;
        }
        Self {
            name: name.to_string(),
            unit: channel.recorded_unit.clone(),
            si_unit: Unit::si_name(&channel.recorded_unit),
            min: present.clone().reduce(f64::min),
            max: present.reduce(f64::max),
            mean: (count > 0 && mean.is_finite()).then_some(mean),
            missing: channel.values.len() - count,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Format, Limits, read};
    use super::*;

    #[test]
    fn counts_what_is_there_and_what_is_missing() {
        let text = b"t[s],a[km],empty[deg]\n0,1,\n0.5,,\n1,2,\n";
        let maneuver = read(text, Format::Csv, &Limits::default()).unwrap();
        let summary = summary(&maneuver);
        assert_eq!((summary.samples, summary.duration), (3, 1.0));
        assert_eq!(
            (summary.step, summary.rate, summary.segments),
            (0.5, 2.0, 1)
        );
        let a = &summary.channels[0];
        assert_eq!((a.min, a.max, a.mean), (Some(1e3), Some(2e3), Some(1.5e3)));
        assert_eq!(
            (a.missing, a.unit.as_str(), a.si_unit.as_str()),
            (1, "km", "m")
        );
        let empty = &summary.channels[1];
        assert_eq!((empty.min, empty.mean, empty.missing), (None, None, 3));
        let json = serde_json::to_string(&summary).unwrap();
        assert_eq!(serde_json::from_str::<Summary>(&json).unwrap(), summary);
    }
}
