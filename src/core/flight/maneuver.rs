//! A maneuver: one recording, all channels on one time axis.

use indexmap::IndexMap;
use sha2::{Digest, Sha256};

use super::{Sampling, Unit};

/// One recorded quantity, in SI.
#[derive(Clone, PartialEq, Debug)]
pub struct Channel {
    /// The unit as the recording states it; `values` are already converted from it.
    pub recorded_unit: String,
    /// How recorded values become those of `values`, and their dimension.
    pub unit: Unit,
    /// One value a sample, SI; NaN where the recording has none.
    pub values: Vec<f64>,
}

impl Channel {
    /// Converts recorded values to SI.
    pub fn from_recorded(recorded_unit: &str, unit: Unit, mut values: Vec<f64>) -> Self {
        if unit.scale != 1.0 || unit.offset != 0.0 {
            values.iter_mut().for_each(|v| *v = unit.to_si(*v));
        }
        Self {
            recorded_unit: recorded_unit.trim().to_string(),
            unit,
            values,
        }
    }
}

/// An immutable recording: time in seconds and channels in SI, all of one length.
#[derive(Clone, PartialEq, Debug)]
pub struct Maneuver {
    time: Vec<f64>,
    channels: IndexMap<String, Channel>,
    sampling: Sampling,
}

/// Why samples are no recording. Rows are counted from 1.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum ManeuverError {
    /// Fewer than two.
    #[error("{count} sample(s): a maneuver needs at least 2")]
    TooFewSamples {
        /// Samples there are.
        count: usize,
    },
    /// A channel that is not as long as the time axis.
    #[error("channel '{channel}' has {found} values where the time axis has {expected}")]
    LengthMismatch {
        /// Its name.
        channel: String,
        /// Samples of the time axis.
        expected: usize,
        /// Values of the channel.
        found: usize,
    },
    /// A sample without a time.
    #[error("time is missing or not a number in row {row}; every row needs a time")]
    TimeMissing {
        /// The first row without a time.
        row: usize,
    },
    /// Time that stands still or runs back.
    #[error(
        "time does not increase: {time} s in row {row} follows {before} s in row {}; sort the rows, or upload the parts as separate maneuvers",
        row - 1
    )]
    TimeNotIncreasing {
        /// The first row that is not later than the one before it.
        row: usize,
        /// Time of the row before it, s.
        before: f64,
        /// Its own time, s.
        time: f64,
    },
}

impl Maneuver {
    /// # Errors
    /// Fewer than two samples, channels of different length, or a time axis that is not strictly
    /// increasing. Rows are counted from 1.
    pub fn new(time: Vec<f64>, channels: IndexMap<String, Channel>) -> Result<Self, ManeuverError> {
        if time.len() < 2 {
            return Err(ManeuverError::TooFewSamples { count: time.len() });
        }
        if let Some(at) = time.iter().position(|t| !t.is_finite()) {
            return Err(ManeuverError::TimeMissing { row: at + 1 });
        }
        if let Some(at) = time.windows(2).position(|pair| pair[1] <= pair[0]) {
            return Err(ManeuverError::TimeNotIncreasing {
                row: at + 2,
                before: time[at],
                time: time[at + 1],
            });
        }
        for (name, channel) in &channels {
            if channel.values.len() != time.len() {
                let (channel, found) = (name.clone(), channel.values.len());
                return Err(ManeuverError::LengthMismatch {
                    channel,
                    expected: time.len(),
                    found,
                });
            }
        }
        let values = channels.values().map(|channel| channel.values.as_slice());
        let sampling = Sampling::of(&time, values);
        Ok(Self {
            time,
            channels,
            sampling,
        })
    }

    /// Samples, on every channel the same number.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Never true: a maneuver has at least two samples.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Seconds, strictly increasing.
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// From the first sample to the last, gaps included, s.
    pub fn duration(&self) -> f64 {
        self.time[self.len() - 1] - self.time[0]
    }

    /// The recorded channels by name, in the order of the recording.
    pub fn channels(&self) -> &IndexMap<String, Channel> {
        &self.channels
    }

    /// The step, whether it is even, and the gaps.
    pub fn sampling(&self) -> &Sampling {
        &self.sampling
    }

    /// SHA-256 of the canonical content (time, channel names, recorded units, SI values), as hex.
    ///
    /// Two recordings with the same numbers have the same digest however they were written down.
    pub fn digest(&self) -> String {
        let mut hash = Sha256::new();
        let mut vector = |name: &str, unit: &str, values: &[f64]| {
            for text in [name, unit] {
                hash.update((text.len() as u64).to_le_bytes());
                hash.update(text);
            }
            hash.update((values.len() as u64).to_le_bytes());
            for value in values {
                // one NaN for all, and no negative zero: equal content has equal bytes
                let canonical = if value.is_nan() {
                    f64::NAN
                } else {
                    value + 0.0
                };
                hash.update(canonical.to_bits().to_le_bytes());
            }
        };
        vector("t", "s", &self.time);
        let mut names: Vec<&String> = self.channels.keys().collect();
        names.sort();
        for name in names {
            let channel = &self.channels[name];
            vector(name, &channel.recorded_unit, &channel.values);
        }
        hex::encode(hash.finalize())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channel(values: &[f64]) -> Channel {
        Channel::from_recorded("deg", Unit::parse("deg").unwrap(), values.to_vec())
    }

    fn maneuver(names: [&str; 2]) -> Maneuver {
        let values = |name: &str| {
            channel(if name == "a" {
                &[1.0, 2.0]
            } else {
                &[3.0, f64::NAN]
            })
        };
        let channels = names
            .iter()
            .map(|name| (name.to_string(), values(name)))
            .collect();
        Maneuver::new(vec![0.0, 0.1], channels).unwrap()
    }

    #[test]
    fn digest_is_of_content_not_of_order() {
        assert_eq!(maneuver(["a", "b"]).digest(), maneuver(["b", "a"]).digest());
        assert_eq!(maneuver(["a", "b"]).digest().len(), 64);
        let other = Maneuver::new(vec![0.0, 0.2], maneuver(["a", "b"]).channels().clone()).unwrap();
        assert_ne!(other.digest(), maneuver(["a", "b"]).digest());
    }

    #[test]
    fn time_must_increase_and_lengths_must_agree() {
        let new = |time: &[f64]| Maneuver::new(time.to_vec(), IndexMap::new()).map(|_| ());
        assert_eq!(new(&[0.0]), Err(ManeuverError::TooFewSamples { count: 1 }));
        let backwards = ManeuverError::TimeNotIncreasing {
            row: 3,
            before: 1.0,
            time: 0.5,
        };
        assert_eq!(new(&[0.0, 1.0, 0.5]), Err(backwards));
        assert_eq!(
            new(&[0.0, f64::NAN]),
            Err(ManeuverError::TimeMissing { row: 2 })
        );
        let channels = IndexMap::from([("a".to_string(), channel(&[1.0]))]);
        assert!(matches!(
            Maneuver::new(vec![0.0, 1.0], channels),
            Err(ManeuverError::LengthMismatch {
                expected: 2,
                found: 1,
                ..
            })
        ));
    }
}
