//! How far a signal goes within a window that slides over it.

use std::collections::VecDeque;

/// For each sample the greatest value less the least of those within half a `width` of its time.
pub(super) fn ranges(time: &[f64], values: &[f64], width: f64) -> Vec<f64> {
    let mut greatest: VecDeque<usize> = VecDeque::new();
    let mut least: VecDeque<usize> = VecDeque::new();
    let mut ahead = 0;
    let mut ranges = Vec::with_capacity(time.len());
    for &now in time {
        while ahead < time.len() && time[ahead] <= now + width / 2.0 {
            while greatest
                .back()
                .is_some_and(|&last| values[last] <= values[ahead])
            {
                greatest.pop_back();
            }
            while least
                .back()
                .is_some_and(|&last| values[last] >= values[ahead])
            {
                least.pop_back();
            }
            greatest.push_back(ahead);
            least.push_back(ahead);
            ahead += 1;
        }
        let is_past = |first: &usize| time[*first] < now - width / 2.0;
        while greatest.front().is_some_and(is_past) {
            greatest.pop_front();
        }
        while least.front().is_some_and(is_past) {
            least.pop_front();
        }
        let ends = greatest.front().zip(least.front());
        ranges.push(ends.map_or(0.0, |(&top, &bottom)| values[top] - values[bottom]));
    }
    ranges
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_slides() {
        let values: Vec<f64> = (0..200u32).map(|k| f64::from(k * k * 37 % 101)).collect();
        let time: Vec<f64> = (0..200)
            .map(|k| 0.1 * f64::from(k) + 0.01 * f64::from(k % 3))
            .collect();
        let found = ranges(&time, &values, 0.7);
        for (at, now) in time.iter().enumerate() {
            let within = (0..200).filter(|&k| (time[k] - now).abs() <= 0.35 + 1e-12);
            let (least, greatest) = within.fold((f64::MAX, f64::MIN), |(least, greatest), k| {
                (least.min(values[k]), greatest.max(values[k]))
            });
            assert_eq!(found[at], greatest - least, "{at}");
        }
    }
}
