//! A part of long columns, with no more rows than are wanted.

use crate::dashboard::rows_to_plot;
use crate::http::code::Code;
use crate::http::problem::Problem;

/// What is wanted of long columns: a stretch of time, and of it about so many rows.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Wanted {
    /// Seconds of the recording; absent: from the first.
    from: Option<f64>,
    /// Absent: to the last.
    to: Option<f64>,
    /// Absent: all.
    most: Option<usize>,
}

impl Wanted {
    /// As a query asks for it.
    ///
    /// # Errors
    /// `from` or `to` is no number of seconds, or they are the wrong way round.
    pub(crate) fn of(
        from: Option<f64>,
        to: Option<f64>,
        most: Option<usize>,
    ) -> Result<Self, Problem> {
        let refuse = |detail: String| Err(Problem::new(Code::InvalidQuery, detail));
        for (name, seconds) in [("from", from), ("to", to)] {
            if let Some(seconds) = seconds.filter(|seconds| !seconds.is_finite()) {
                return refuse(format!("{name}: {seconds} is no number of seconds"));
            }
        }
        match (from, to) {
            (Some(from), Some(to)) if from > to => {
                refuse(format!("from: {from} s is after to: {to} s"))
            }
            _ => Ok(Self { from, to, most }),
        }
    }

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
        let wanted = |from, to, most| {
            let wanted = Wanted::of(from, to, most).expect("a stretch");
            wanted.rows(&time, &[&values])
        };
        let part = wanted(Some(50.0), Some(60.0), Some(10));
        assert_eq!((part[0], part[part.len() - 1]), (500, 600));
        assert!(part.contains(&550) && part.len() <= 10, "{part:?}");
        assert_eq!(wanted(None, Some(0.35), None), [0, 1, 2, 3]);
        assert_eq!(wanted(Some(99.85), None, None), [999]);
        assert!(wanted(Some(50.04), Some(50.06), None).is_empty());
        assert!(wanted(Some(1e9), None, None).is_empty());
    }

    #[test]
    fn what_is_no_stretch_of_time_is_refused() {
        let refused = |from, to| match Wanted::of(from, to, None) {
            Ok(wanted) => panic!("{wanted:?}"),
            Err(problem) => format!("{problem:?}"),
        };
        for (from, to, said) in [
            (Some(20.0), Some(5.0), "from: 20 s is after to: 5 s"),
            (Some(f64::NAN), Some(5.0), "from: NaN is no number"),
            (None, Some(f64::INFINITY), "to: inf is no number"),
        ] {
            let problem = refused(from, to);
            assert!(problem.contains(said), "{problem}");
        }
        assert!(Wanted::of(Some(5.0), Some(5.0), None).is_ok());
    }
}
