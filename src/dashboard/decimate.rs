//! Fewer rows of long columns, such that a plot of them looks the same.

/// Which rows to keep so that there are about `most`: the first, the last, and in each of a number
/// of equal stretches those where any of the columns has its least and its greatest value. No value
/// is made up, and no peak is lost. There are never fewer than two rows for each column and two
/// more, whatever `most` says.
pub fn rows_to_plot(columns: &[&[f64]], length: usize, most: usize) -> Vec<usize> {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keeps_ends_and_extremes_within_the_number() {
        let wave: Vec<f64> = (0..10_000).map(|k| (f64::from(k) * 0.01).sin()).collect();
        let mut spike = vec![0.0; 10_000];
        spike[4321] = 9.0;
        spike[77] = f64::NAN;
        let kept = rows_to_plot(&[&wave, &spike], 10_000, 400);
        assert!(kept.len() <= 400 && kept.len() > 200, "{}", kept.len());
        assert!(kept.is_sorted());
        assert_eq!((kept[0], kept[kept.len() - 1]), (0, 9999));
        assert!(kept.contains(&4321));
    }

    #[test]
    fn short_or_odd_columns_are_no_trouble() {
        assert_eq!(rows_to_plot(&[&[1.0, 2.0, 3.0]], 3, 10), [0, 1, 2]);
        assert_eq!(rows_to_plot(&[], 5, 3), [0, 4]);
        let missing = [f64::NAN; 9];
        assert_eq!(rows_to_plot(&[&missing], 9, 1), [0, 8]);
    }
}
