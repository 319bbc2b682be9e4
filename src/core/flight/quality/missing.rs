//! Samples without a value.

use crate::flight::{Finding, FindingCode};

pub(super) fn missing(name: &str, values: &[f64]) -> Option<Finding> {
    let rows: Vec<usize> = (0..values.len())
        .filter(|&row| values[row].is_nan())
        .collect();
    if rows.is_empty() {
        return None;
    }
    let (message, remedy) = if rows.len() == values.len() {
        (
            "there is no value at all".to_string(),
            "leave the channel out",
        )
    } else {
        (
            format!("{} of {} values are missing", rows.len(), values.len()),
            "fill or cut these rows where the channel is an input; leave it out of the outputs where too much is missing",
        )
    };
    let missing = Finding::new(FindingCode::MissingValues, message, remedy);
    Some(missing.of_channel(name).at_rows(&rows))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_listed_up_to_a_number_and_counted() {
        let some = missing("q", &[1.0, f64::NAN, 2.0]).unwrap();
        assert_eq!((some.rows.as_slice(), some.count), (&[2][..], 1));
        let all = missing("q", &[f64::NAN; 50]).unwrap();
        assert_eq!((all.rows.len(), all.count), (Finding::ROWS_LISTED, 50));
        assert_eq!(missing("q", &[0.0]), None);
    }
}
