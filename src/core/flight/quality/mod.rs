//! What is odd about recorded data. Nothing is repaired: each finding says what can be done.
//!
//! The tests are conservative. A control step, a quantised signal and a steady stretch before the
//! maneuver are ordinary, and an alarm that is usually false is not read.

mod accelerations;
mod air_data;
mod held;
mod kinematics;
mod missing;
mod record;
mod repeats;
mod rows;
mod sentinel;
mod spikes;
mod statistics;
mod time;
mod wraps;

pub use record::{Record, Series};

use std::borrow::Cow;

use super::{Finding, Maneuver};
use crate::stop;

/// Everything odd about a maneuver: first the time axis, then channel by channel, then channels against each other.
pub fn quality(maneuver: &Maneuver) -> Vec<Finding> {
    quality_of(&Record::of(maneuver))
}

/// Everything odd about a record, as [`quality`] has it.
pub fn quality_of(record: &Record<'_>) -> Vec<Finding> {
    let sampling = &record.sampling;
    let segments = record.segments();
    let mut findings: Vec<Finding> = (time::gaps(sampling).into_iter())
        .chain(time::uneven(&record.time, sampling))
        .chain(time::coarse(sampling))
        .chain(time::implausible(&record.time, sampling))
        .collect();
    let repeated = rows::RepeatedRows::of(record, &segments);
    findings.extend(repeated.finding());
    findings.extend(rows::blocks(record));
    for series in record.series.iter().filter(|series| series.is_used) {
        stop::check();
        let (name, values) = (series.name, &series.values);
        findings.extend(missing::missing(name, values));
        if let Some(constant) = repeats::constant(name, values) {
            findings.push(constant);
            continue;
        }
        let mut values = Cow::Borrowed(&**values);
        if let Some((rows, number)) = sentinel::sentinel(series) {
            findings.push(sentinel::finding(name, &rows, number));
            // what stands for no value is judged once
            rows.into_iter()
                .for_each(|row| values.to_mut()[row] = f64::NAN);
        }
        let held = held::held(series, &segments, sampling.step);
        match held.filter(|_| !repeated.explain(&values)) {
            Some(held) => findings.push(held),
            None => findings.extend(repeats::stuck(name, &values, &segments, &repeated)),
        }
        findings.extend(spikes::spikes(name, &values, &segments));
        if series.is_angle {
            findings.extend(wraps::wraps(name, &values));
        }
    }
    findings.extend(kinematics::disagreements(record));
    findings.extend(air_data::disagreements(record));
    findings.extend(accelerations::disagreements(record));
    let timed = findings
        .into_iter()
        .map(|finding| finding.timed(&record.time));
    timed.collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use indexmap::IndexMap;

    use crate::flight::{Channel, Severity, Unit};

    /// A maneuver at 25 Hz of channels in degrees.
    pub(super) fn maneuver(channels: &[(&str, Vec<f64>)]) -> Maneuver {
        let count = channels[0].1.len();
        let time = (0..count).map(|k| k as f64 * 0.04).collect();
        let degree = Unit::parse("deg").unwrap();
        let channels = channels.iter().map(|(name, values)| {
            let channel = Channel::from_recorded("deg", degree, values.clone());
            (name.to_string(), channel)
        });
        Maneuver::new(time, channels.collect::<IndexMap<_, _>>()).unwrap()
    }

    /// Noise without a generator: uniform in -1..1.
    pub(super) fn noise(k: usize) -> f64 {
        let mixed = (k as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mixed = (mixed ^ (mixed >> 31)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        (mixed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    #[test]
    fn a_clean_response_to_a_3211_has_no_finding() {
        // pulses of 3, 2, 1 and 1 steps of 0.8 s, the response of a first-order lag, both noise-free
        let elevator: Vec<f64> = (0..500)
            .map(|k| match k {
                50..110 => 2.0,
                110..150 => -2.0,
                150..170 => 2.0,
                170..190 => -2.0,
                _ => 0.0,
            })
            .collect();
        let mut state = 0.0;
        let response: Vec<f64> = elevator
            .iter()
            .map(|input| {
                state += 0.1 * (input - state);
                state
            })
            .collect();
        let noisy: Vec<f64> = response
            .iter()
            .enumerate()
            .map(|(k, v)| v + 0.01 * noise(k))
            .collect();
        let noisy_elevator: Vec<f64> = elevator
            .iter()
            .enumerate()
            .map(|(k, v)| v + 0.02 * noise(k + 7777))
            .collect();
        let warnings: Vec<_> = quality(&maneuver(&[
            ("de", elevator),
            ("de_noisy", noisy_elevator),
            ("q", response),
            ("alpha", noisy),
        ]))
        .into_iter()
        .filter(|finding| finding.severity == Severity::Warning)
        .collect();
        assert_eq!(warnings, []);
    }
}
