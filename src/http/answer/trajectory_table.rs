//! Trajectories as CSV.

use super::series_table::{SegmentSeries, Series, series_as_csv};
use crate::estimate::Trajectory;

/// A table of trajectories: a row for each sample, a column for each quantity and its standard error.
pub fn trajectories_as_csv(trajectories: &[Trajectory]) -> String {
    let segments: Vec<SegmentSeries<'_>> = trajectories.iter().map(of_segment).collect();
    series_as_csv(&segments)
}

fn of_segment(trajectory: &Trajectory) -> SegmentSeries<'_> {
    let Trajectory {
        segment: label,
        time,
        quantities,
    } = trajectory;
    let series = quantities.iter().map(|of| Series {
        name: &of.name,
        kind: of.kind,
        unit: &of.unit,
        parts: [&of.values, &of.standard_errors, &[], &[]],
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
    use crate::estimate::{QuantityKind, TrajectorySeries};

    #[test]
    fn an_output_is_told_from_a_state_of_its_name() {
        let series = |kind: QuantityKind, unit: &str, errors: &[f64]| TrajectorySeries {
            name: "q".into(),
            kind,
            unit: unit.into(),
            values: vec![1.0, 2.0],
            standard_errors: errors.to_vec(),
        };
        let trajectory = Trajectory {
            segment: "a".into(),
            time: vec![0.0, 0.1],
            quantities: vec![
                series(QuantityKind::State, "rad/s", &[0.5, 0.25]),
                series(QuantityKind::Output, "-", &[]),
            ],
        };
        let expected = "segment,t[s],q[rad/s],q_standard_error[rad/s],q_model\na,0.0,1.0,0.5,1.0\na,0.1,2.0,0.25,2.0\n";
        assert_eq!(trajectories_as_csv(&[trajectory]), expected);
    }
}
