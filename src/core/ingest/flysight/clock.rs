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

/// A time that is so many usual times of a record from the next has a gap behind it.
const GAP: f64 = 2.0;

/// Records of one time are spread evenly up to the next time; before a gap, and behind the last, as far apart as usual. Those
/// that run back are left out, as few as possible.
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
    let usual = usual(&kept, stamps);
    for (at, run) in kept.iter().enumerate() {
        let (first, count) = *run;
        let next = kept.get(at + 1).map(|next| stamp(next) - stamp(run));
        let step = next.map(|length| length / f64::from(count));
        let step = step.filter(|step| *step <= GAP * usual).unwrap_or(usual);
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

/// How far records are usually apart: the median of runs. One stamp alone says nothing of it: 0.
fn usual(runs: &[(u32, u32)], stamps: &[f64]) -> f64 {
    let pairs = runs.windows(2);
    let mut steps: Vec<f64> = pairs
        .map(|pair| {
            let [from, to] = [pair[0], pair[1]].map(|(first, _)| stamps[first as usize]);
            (to - from) / f64::from(pair[0].1)
        })
        .collect();
    if steps.is_empty() {
        return 0.0;
    }
    // of two the smaller, which is none over a gap
    let middle = (steps.len() - 1) / 2;
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1
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
        // the device was off between 1.75 and 100: no record is of that time
        assert_eq!(
            of(&[0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 1.5, 1.5, 100.0, 100.0, 100.5]).0,
            [
                0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 100.0, 100.25, 100.5
            ]
        );
        assert_eq!(
            of(&[0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 50.0, 50.0]).0,
            [0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 50.0, 50.25]
        );
        assert_eq!(of(&[5.0, 5.0]), (vec![5.0], vec![0], 0, 1));
        assert_eq!(of(&[f64::NAN, 1.0]), (vec![1.0], vec![1], 0, 1));
        assert_eq!(of(&[]), (vec![], vec![], 0, 0));
    }
}
