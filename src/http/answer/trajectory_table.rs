//! Trajectories as CSV.

use crate::estimate::{QuantityKind, Trajectory, TrajectorySeries};
use crate::ingest::CsvWriter;

/// A table of trajectories: a row for each sample, a column for each quantity and its standard error.
pub fn trajectories_as_csv(trajectories: &[Trajectory]) -> String {
    let first = trajectories.first();
    let titles = first.iter().flat_map(|trajectory| &trajectory.quantities);
    let titles = titles.flat_map(|series| {
        let error = title(series, "_standard_error");
        [
            Some(title(series, "")),
            (!series.standard_errors.is_empty()).then_some(error),
        ]
    });
    let begin = ["segment", "t[s]"].map(|title| Some(title.to_string()));
    let mut csv = CsvWriter::with_header(begin.into_iter().chain(titles).flatten());
    for trajectory in trajectories {
        for (row, time) in trajectory.time.iter().enumerate() {
            csv.text(&trajectory.segment);
            csv.number(*time);
            for series in &trajectory.quantities {
                csv.number(series.values.get(row).copied());
                if let Some(error) = series.standard_errors.get(row) {
                    csv.number(*error);
                }
            }
            csv.end_row();
        }
    }
    csv.finish()
}

/// `CL`, `q[rad/s]`, and of an output, which may have the name of a state, `q_model[rad/s]`.
fn title(series: &TrajectorySeries, what: &str) -> String {
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
