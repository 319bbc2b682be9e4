//! Messages in the order of their times.

/// The most rows of which each is later than the one before; of several with one time the first.
///
/// A row goes on with the longest run that ends before it; of runs of one length only the one that ends first is of use. So
/// a wrong time costs its own row, and not those behind it.
pub(in super::super) fn longest_in_order<R: Copy>(rows: &[R], time: impl Fn(R) -> f64) -> Vec<R> {
    // each row, and the number of the one before it in its run: its own where it is the first
    let mut links: Vec<(R, u32)> = Vec::with_capacity(rows.len());
    // of runs by their length: the number of the row at their end
    let mut ends: Vec<u32> = Vec::new();
    for (number, &row) in (0..).zip(rows) {
        let this = time(row);
        let time_of = |end: u32| time(links[end as usize].0);
        let length = ends.partition_point(|&end| time_of(end) < this);
        let before = length.checked_sub(1).map_or(number, |at| ends[at]);
        match ends.get_mut(length) {
            None => ends.push(number),
            Some(end) if this < time_of(*end) => *end = number,
            Some(_) => {}
        }
        links.push((row, before));
    }
    let last = ends.last().copied();
    let back = std::iter::successors(last, |&at| {
        let (_, before) = links[at as usize];
        (before != at).then_some(before)
    });
    let mut kept: Vec<R> = back.map(|at| links[at as usize].0).collect();
    kept.reverse();
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_rows_as_possible_are_kept() {
        let kept = |times: &[f64]| {
            let rows: Vec<u32> = (0..times.len() as u32).collect();
            longest_in_order(&rows, |row| times[row as usize])
        };
        assert_eq!(kept(&[]), [0; 0]);
        assert_eq!(kept(&[1.0, 2.0, 1e9, 3.0, 4.0]), [0, 1, 3, 4]);
        assert_eq!(kept(&[1e9, 2.0, 3.0, 0.0, 4.0]), [1, 2, 4]);
        assert_eq!(kept(&[7.0, 8.0, 1.0, 2.0, 3.0]), [2, 3, 4]);
        assert_eq!(kept(&[1.0, 1.0, 2.0, 2.0, 1.0]), [0, 2]);
        // as a comparison of all runs has it
        let times: Vec<f64> = (0..200u32).map(|k| f64::from(k * k * 37 % 101)).collect();
        let mut longest = vec![1; times.len()];
        for k in 0..times.len() {
            let before = (0..k).filter(|&at| times[at] < times[k]);
            longest[k] += before.map(|at| longest[at]).max().unwrap_or(0);
        }
        let found = kept(&times);
        assert_eq!(Some(&found.len()), longest.iter().max());
        let is_later = |a: &u32, b: &u32| a < b && times[*a as usize] < times[*b as usize];
        assert!(found.is_sorted_by(is_later), "{found:?}");
    }
}
