//! Predictions as CSV.

use super::series_table::{SegmentSeries, Series, series_as_csv};
use crate::job::PredictedSegment;

/// A row for each sample; of each quantity its value, standard error and, with draws, its range.
pub fn predictions_as_csv(segments: &[PredictedSegment]) -> String {
    let segments: Vec<SegmentSeries<'_>> = segments.iter().map(of_segment).collect();
    series_as_csv(&segments)
}

fn of_segment(segment: &PredictedSegment) -> SegmentSeries<'_> {
    let PredictedSegment {
        segment: label,
        time,
        quantities,
        ..
    } = segment;
    let series = quantities.iter().map(|of| Series {
        name: &of.name,
        kind: of.kind,
        unit: &of.unit,
        parts: [&of.values, &of.standard_errors, &of.lower, &of.upper],
    });
    SegmentSeries {
        label,
        time,
        series: series.collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::{QuantityKind, SimulatedQuantity};

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
