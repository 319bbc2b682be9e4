//! The times of one kind of records.

use super::super::messages::longest_in_order;

/// Times in the order of the records, and which records have them.
pub(super) struct Times {
    pub(super) seconds: Vec<f64>,
    pub(super) records: Vec<u32>,
    /// Records that had the time of the one before them, and those that are left out since they run back.
    pub(super) spread: usize,
    pub(super) left_out: usize,
}

/// Records of one time are spread evenly up to the next time; behind the last as far as before it. Those that run back are left
/// out, as few as possible.
pub(super) fn times(stamps: &[f64]) -> Times {
    let with_stamp = (0u32..).zip(stamps).filter(|(_, stamp)| stamp.is_finite());
    // the first record of each run of one stamp, and how many are in it
    let mut runs: Vec<(u32, u32)> = Vec::new();
    for (at, stamp) in with_stamp {
        match runs.last_mut() {
            Some((first, count)) if stamps[*first as usize] == *stamp && *first + *count == at => {
                *count += 1
            }
            _ => runs.push((at, 1)),
        }
    }
    let kept = longest_in_order(&runs, |(first, _)| stamps[first as usize]);
    let stamp = |run: &(u32, u32)| stamps[run.0 as usize];
    let mut times = Times {
        seconds: Vec::with_capacity(stamps.len()),
        records: Vec::with_capacity(stamps.len()),
        spread: 0,
        left_out: 0,
    };
    for (at, run) in kept.iter().enumerate() {
        let (first, count) = *run;
        let before = at.checked_sub(1).map(|at| kept[at]);
        let step = match (kept.get(at + 1), before) {
            (Some(next), _) => (stamp(next) - stamp(run)) / f64::from(count),
            (None, Some(before)) => (stamp(run) - stamp(&before)) / f64::from(before.1),
            // one stamp alone says nothing of the rate
            (None, None) => 0.0,
        };
        let count = if step > 0.0 { count } else { 1 };
        for k in 0..count {
            times.seconds.push(stamp(run) + f64::from(k) * step);
            times.records.push(first + k);
        }
        times.spread += count as usize - 1;
    }
    times.left_out = stamps.len() - times.records.len();
    times
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_of_one_stamp_are_spread() {
        let of = |stamps: &[f64]| {
            let times = times(stamps);
            (times.seconds, times.records, times.spread, times.left_out)
        };
        assert_eq!(
            of(&[0.0, 0.0, 1.0, 3.0]),
            (vec![0.0, 0.5, 1.0, 3.0], vec![0, 1, 2, 3], 1, 0)
        );
        assert_eq!(
            of(&[0.0, 1.0, 1.0]),
            (vec![0.0, 1.0, 2.0], vec![0, 1, 2], 1, 0)
        );
        assert_eq!(of(&[0.0, 2.0, 1.0, 3.0]).3, 1);
        assert_eq!(of(&[5.0, 5.0]), (vec![5.0], vec![0], 0, 1));
        assert_eq!(of(&[f64::NAN, 1.0]), (vec![1.0], vec![1], 0, 1));
        assert_eq!(of(&[]), (vec![], vec![], 0, 0));
    }
}
