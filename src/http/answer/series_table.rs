//! Quantities along segments as CSV: a row for each sample, and of each quantity a column for each part that any segment has.

use crate::estimate::QuantityKind;
use crate::ingest::CsvWriter;

/// What there may be of a quantity, as the end of its title, in the order of the columns.
const PARTS: [&str; 4] = ["", "_standard_error", "_lower", "_upper"];

/// A quantity along a segment.
pub(super) struct Series<'a> {
    pub name: &'a str,
    pub kind: QuantityKind,
    pub unit: &'a str,
    /// Values, standard errors, lower and upper end of the range; empty where there are none.
    pub parts: [&'a [f64]; PARTS.len()],
}

/// The quantities of a model along one segment, in the order of the model.
pub(super) struct SegmentSeries<'a> {
    pub label: &'a str,
    pub time: &'a [f64],
    pub series: Vec<Series<'a>>,
}

/// A column: of which quantity, and which part.
struct Column {
    series: usize,
    part: usize,
    title: String,
}

/// Segments of the same model as a table. A segment without a part that another has leaves its cells empty.
pub(super) fn series_as_csv(segments: &[SegmentSeries<'_>]) -> String {
    let columns = columns(segments);
    let begin = ["segment", "t[s]"].into_iter();
    let titles = columns.iter().map(|column| column.title.as_str());
    let mut csv = CsvWriter::with_header(begin.chain(titles));
    for segment in segments {
        for (row, time) in segment.time.iter().enumerate() {
            csv.text(segment.label);
            csv.number(*time);
            for column in &columns {
                let series = segment.series.get(column.series);
                let value = series.and_then(|series| series.parts[column.part].get(row));
                csv.number(value.copied());
            }
            csv.end_row();
        }
    }
    csv.finish()
}

fn columns(segments: &[SegmentSeries<'_>]) -> Vec<Column> {
    let count = segments.iter().map(|segment| segment.series.len()).max();
    let all = (0..count.unwrap_or_default())
        .flat_map(|series| (0..PARTS.len()).map(move |part| (series, part)));
    let column = |(series, part): (usize, usize)| {
        let mut of = segments
            .iter()
            .filter_map(|segment| segment.series.get(series));
        let first = of.find(|series| !series.parts[part].is_empty())?;
        Some(Column {
            series,
            part,
            title: title(first, PARTS[part]),
        })
    };
    all.filter_map(column).collect()
}

/// `CL`, `q[rad/s]`, and of an output, which may have the name of a state, `q_model[rad/s]`.
fn title(series: &Series<'_>, part: &str) -> String {
    let model = match series.kind {
        QuantityKind::Output => "_model",
        QuantityKind::State | QuantityKind::Definition => "",
    };
    let name = format!("{}{model}{part}", series.name);
    match series.unit {
        "" | "-" => name,
        unit => format!("{name}[{unit}]"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(kind: QuantityKind, parts: [&'static [f64]; 4]) -> Series<'static> {
        Series {
            name: "q",
            kind,
            unit: "rad/s",
            parts,
        }
    }

    /// The first segment lacks the standard errors of the state, the second the range of the output.
    #[test]
    fn a_part_that_a_segment_lacks_leaves_its_cells_empty() {
        let segment =
            |label, state: [&'static [f64]; 4], output: [&'static [f64]; 4]| SegmentSeries {
                label,
                time: &[0.5],
                series: vec![
                    series(QuantityKind::State, state),
                    series(QuantityKind::Output, output),
                ],
            };
        let segments = [
            segment(
                "a",
                [&[1.0], &[], &[], &[]],
                [&[2.0], &[3.0], &[4.0], &[5.0]],
            ),
            segment("b", [&[6.0], &[7.0], &[], &[]], [&[8.0], &[9.0], &[], &[]]),
        ];
        let expected = [
            "segment,t[s],q[rad/s],q_standard_error[rad/s],q_model[rad/s],q_model_standard_error[rad/s],q_model_lower[rad/s],q_model_upper[rad/s]",
            "a,0.5,1.0,,2.0,3.0,4.0,5.0",
            "b,0.5,6.0,7.0,8.0,9.0,,",
            "",
        ];
        assert_eq!(series_as_csv(&segments), expected.join("\n"));
    }
}
