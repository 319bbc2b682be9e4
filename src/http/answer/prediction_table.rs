//! Predictions as CSV.

use crate::estimate::{QuantityKind, SimulatedQuantity};
use crate::ingest::CsvWriter;
use crate::job::PredictedSegment;

/// A row for each sample; of each quantity its value, standard error and, with draws, its range.
pub fn predictions_as_csv(segments: &[PredictedSegment]) -> String {
    let first = segments.first();
    let titles = first.iter().flat_map(|segment| &segment.quantities);
    let titles = titles.flat_map(|series| {
        let parts = parts(series);
        parts.into_iter().map(move |(what, _)| title(series, what))
    });
    let begin = ["segment", "t[s]"].map(ToString::to_string);
    let mut csv = CsvWriter::with_header(begin.into_iter().chain(titles));
    for segment in segments {
        for (row, time) in segment.time.iter().enumerate() {
            csv.text(&segment.segment);
            csv.number(*time);
            for series in &segment.quantities {
                for (_, values) in parts(series) {
                    csv.number(values.get(row).copied());
                }
            }
            csv.end_row();
        }
    }
    csv.finish()
}

/// What there is of a series, with the end of its title.
fn parts(series: &SimulatedQuantity) -> Vec<(&'static str, &[f64])> {
    let all: [(&'static str, &[f64]); 4] = [
        ("", &series.values),
        ("_standard_error", &series.standard_errors),
        ("_lower", &series.lower),
        ("_upper", &series.upper),
    ];
    all.into_iter()
        .filter(|(_, values)| !values.is_empty())
        .collect()
}

/// `CL`, and of an output, which may have the name of a state, `q_model[rad/s]`.
fn title(series: &SimulatedQuantity, what: &str) -> String {
    let model = match series.kind {
        QuantityKind::Output => "_model",
        QuantityKind::State | QuantityKind::Definition => "",
    };
    let name = format!("{}{model}{what}", series.name);
    match series.unit.as_str() {
        "" | "-" => name,
        unit => format!("{name}[{unit}]"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_has_columns_of_its_own() {
        let series = SimulatedQuantity {
            name: "q".into(),
            kind: QuantityKind::Output,
            unit: "rad/s".into(),
            values: vec![1.0],
            standard_errors: vec![0.5],
            lower: vec![0.0],
            upper: vec![2.0],
        };
        let segment = PredictedSegment {
            segment: "a".into(),
            time: vec![0.0],
            quantities: vec![series],
            outputs: Vec::new(),
            draws_lost: Some(0),
        };
        let expected = "segment,t[s],q_model[rad/s],q_model_standard_error[rad/s],q_model_lower[rad/s],q_model_upper[rad/s]\na,0.0,1.0,0.5,0.0,2.0\n";
        assert_eq!(predictions_as_csv(&[segment]), expected);
    }
}
