//! A campaign as CSV.

use crate::ingest::CsvWriter;
use crate::job::Campaign;

/// A row for each parameter, group and job.
pub fn campaign_as_csv(campaign: &Campaign) -> String {
    let first = campaign.curves.first();
    let groups = first.iter().flat_map(|curve| curve.group.keys().cloned());
    let points = first.and_then(|curve| curve.points.first());
    let conditions = points
        .iter()
        .flat_map(|point| point.conditions.keys().cloned());
    let begin = ["parameter", "unit"].map(ToString::to_string);
    let end = [
        "job",
        "name",
        "estimate",
        "standard_error",
        "curve",
        "curve_standard_error",
        "deviation",
        "outlier",
    ];
    let header = begin.into_iter().chain(groups).chain(conditions);
    let mut csv = CsvWriter::with_header(header.chain(end.map(ToString::to_string)));
    for curve in &campaign.curves {
        for point in &curve.points {
            csv.text(&curve.parameter);
            csv.text(&curve.unit);
            curve.group.values().for_each(|value| csv.text(value));
            point
                .conditions
                .values()
                .for_each(|value| csv.number(*value));
            csv.text(&point.job);
            csv.text(&point.name);
            for value in [
                point.estimate,
                point.standard_error,
                point.curve,
                point.curve_standard_error,
                point.deviation,
            ] {
                csv.number(value);
            }
            csv.text(if point.is_outlier { "yes" } else { "no" });
            csv.end_row();
        }
    }
    csv.finish()
}
