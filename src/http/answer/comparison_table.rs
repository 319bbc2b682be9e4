//! A comparison as CSV.

use crate::ingest::CsvWriter;
use crate::job::Comparison;

/// A row for each parameter and job that has it.
pub fn comparison_as_csv(comparison: &Comparison) -> String {
    let mut csv = CsvWriter::with_header([
        "parameter",
        "unit",
        "job",
        "name",
        "estimate",
        "standard_error",
        "remark",
        "difference",
        "deviation",
        "independent",
    ]);
    for row in &comparison.parameters {
        for (job, value) in comparison.jobs.iter().zip(&row.values) {
            let Some(value) = value else { continue };
            csv.text(&row.parameter);
            csv.text(&row.unit);
            csv.text(&job.job);
            csv.text(&job.name);
            csv.number(value.estimate);
            csv.number(value.standard_error);
            csv.text(&value.remark);
            csv.number(value.difference);
            csv.number(value.deviation);
            csv.text(match value.is_independent {
                Some(true) => "yes",
                Some(false) => "no",
                None => "",
            });
            csv.end_row();
        }
    }
    csv.finish()
}
