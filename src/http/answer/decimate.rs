//! Fewer rows of long columns, such that a plot of them looks the same.

/// What is wanted of long columns: a stretch of time, and of it about so many rows.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Wanted {
    /// Seconds of the recording; absent: from the first.
    pub from: Option<f64>,
    /// Absent: to the last.
    pub to: Option<f64>,
    /// Absent: all.
    pub most: Option<usize>,
}

impl Wanted {
    /// The rows to answer with, of columns over a time that grows.
    pub(crate) fn rows(&self, time: &[f64], columns: &[&[f64]]) -> Vec<usize> {
        let begin = self
            .from
            .map_or(0, |from| time.partition_point(|&t| t < from));
        let end = self
            .to
            .map_or(time.len(), |to| time.partition_point(|&t| t <= to));
        let end = end.max(begin);
        let columns: Vec<&[f64]> = columns.iter().map(|column| &column[begin..end]).collect();
        let kept = rows(&columns, end - begin, self.most.unwrap_or(usize::MAX));
        kept.into_iter().map(|row| begin + row).collect()
    }
}

/// Which rows to keep so that there are about `most`: the first, the last, and in each of a number
/// of equal stretches those where any of the columns has its least and its greatest value. No value
/// is made up, and no peak is lost. There are never fewer than two rows for each column and two
/// more, whatever `most` says.
fn rows(columns: &[&[f64]], length: usize, most: usize) -> Vec<usize> {
    if length <= most || length <= 2 {
        return (0..length).collect();
    }
    let each = 2 * columns.len().max(1);
    let stretches = (most.saturating_sub(2) / each).max(1);
    let inner = length - 2;
    let mut kept = vec![0, length - 1];
    for stretch in 0..stretches.min(inner) {
        let begin = 1 + stretch * inner / stretches;
        let end = 1 + (stretch + 1) * inner / stretches;
        for column in columns {
            let mut present = (begin..end).filter(|&row| !column[row].is_nan());
            let Some(first) = present.next() else {
                continue;
            };
            let (mut least, mut greatest) = (first, first);
            for row in present {
                if column[row] < column[least] {
                    least = row;
                }
                if column[row] > column[greatest] {
                    greatest = row;
                }
            }
            kept.extend([least, greatest]);
        }
    }
    kept.sort_unstable();
    kept.dedup();
    kept
}

/// The values in those rows.
pub(crate) fn pick(values: &[f64], rows: &[usize]) -> Vec<f64> {
    rows.iter().map(|&row| values[row]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stretch_of_time_has_its_own_extremes() {
        let time: Vec<f64> = (0..1000).map(|k| f64::from(k) * 0.1).collect();
        let mut values = vec![0.0; 1000];
        (values[100], values[550], values[900]) = (5.0, -1.0, 7.0);
        let wanted = |from, to, most| Wanted { from, to, most }.rows(&time, &[&values]);
        let part = wanted(Some(50.0), Some(60.0), Some(10));
        assert_eq!((part[0], part[part.len() - 1]), (500, 600));
        assert!(part.contains(&550) && part.len() <= 10, "{part:?}");
        assert_eq!(wanted(None, Some(0.35), None), [0, 1, 2, 3]);
        assert_eq!(wanted(Some(99.85), None, None), [999]);
        assert!(wanted(Some(60.0), Some(50.0), None).is_empty());
        assert!(wanted(Some(1e9), Some(f64::NAN), None).is_empty());
    }

    #[test]
    fn keeps_ends_and_extremes_within_the_number() {
        let wave: Vec<f64> = (0..10_000).map(|k| (f64::from(k) * 0.01).sin()).collect();
        let mut spike = vec![0.0; 10_000];
        spike[4321] = 9.0;
        spike[77] = f64::NAN;
        let kept = rows(&[&wave, &spike], 10_000, 400);
        assert!(kept.len() <= 400 && kept.len() > 200, "{}", kept.len());
        assert!(kept.is_sorted());
        assert_eq!((kept[0], kept[kept.len() - 1]), (0, 9999));
        assert!(kept.contains(&4321));
    }

    #[test]
    fn short_or_odd_columns_are_no_trouble() {
        assert_eq!(rows(&[&[1.0, 2.0, 3.0]], 3, 10), [0, 1, 2]);
        assert_eq!(rows(&[], 5, 3), [0, 4]);
        let missing = [f64::NAN; 9];
        assert_eq!(rows(&[&missing], 9, 1), [0, 8]);
        assert_eq!(pick(&[1.0, 2.0, 3.0], &[0, 2]), [1.0, 3.0]);
    }
}
