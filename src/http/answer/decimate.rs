//! A part of long columns, with no more rows than are wanted.

use crate::dashboard::rows_to_plot;

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
        let kept = rows_to_plot(&columns, end - begin, self.most.unwrap_or(usize::MAX));
        kept.into_iter().map(|row| begin + row).collect()
    }
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
}
