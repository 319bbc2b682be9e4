//! The mean of a channel as a condition: `mean(alpha)`.

use std::ops::Range;

use crate::flight::Maneuver;
use crate::job::prepare::rows_in_use;
use crate::job::spec::ManeuverUse;

/// The channel whose mean a condition is; nothing where it is a tag.
pub fn channel_of(condition: &str) -> Option<&str> {
    let channel = condition.trim().strip_prefix("mean(")?.strip_suffix(')')?;
    Some(channel.trim()).filter(|channel| !channel.is_empty())
}

/// The mean of the samples that have a value, over all parts together; nothing where there is none.
pub fn mean_over<'a>(parts: impl IntoIterator<Item = &'a [f64]>) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0_u32);
    for value in parts
        .into_iter()
        .flatten()
        .filter(|value| value.is_finite())
    {
        sum += value;
        count += 1;
    }
    (count > 0).then(|| sum / f64::from(count))
}

/// The rows of a recording that a job uses, from 0; nothing where it does not have them.
pub fn part_in_use(usage: &ManeuverUse, maneuver: &Maneuver) -> Option<Range<usize>> {
    rows_in_use(usage, maneuver).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_is_of_samples_that_have_a_value() {
        assert_eq!(channel_of("mean(alpha)"), Some("alpha"));
        assert_eq!(channel_of(" mean( V ) "), Some("V"));
        for tag in ["alpha", "mean()", "mean(a", "mean"] {
            assert_eq!(channel_of(tag), None, "{tag}");
        }
        let parts: [&[f64]; 2] = [&[1.0, f64::NAN], &[2.0, 6.0]];
        assert_eq!(mean_over(parts), Some(3.0));
        assert_eq!(mean_over([&[f64::NAN][..]]), None);
    }
}
