//! How a model compares with what simulators are qualified by, where such a tolerance applies.
//!
//! Tolerances: 14 CFR Part 60, Appendix A, Table A2A (objective tests of dynamics).

use maud::{Markup, html};

use crate::estimate::{OutputSeries, Role, TimeHistory, five_digits as number};
use crate::flight::{Shown, Unit, by_name, shown_in};
use crate::job::Tolerance;

/// A table of the outputs that a tolerance applies to; nothing where there is none.
pub(super) fn tolerances(histories: &[TimeHistory]) -> Markup {
    let mut rows = Vec::new();
    for history in histories {
        for output in &history.outputs {
            if let Some(tolerance) = tolerance(output) {
                let held = tolerance.held(&output.measured, &output.residual);
                rows.push((history, output, held));
            }
        }
    }
    html! {
        @if !rows.is_empty() {
            h2 id="tolerances" { "Against simulator tolerances" }
            p.soft { "14 CFR Part 60, Appendix A, Table A2A, sample by sample; noise of the measurement counts against the model." }
            div.scroll tabindex="0" role="region" aria-labelledby="tolerances" {
                table {
                    thead { tr {
                        th scope="col" { "flight" } th scope="col" { "output" } th scope="col" { "unit" }
                        th.number scope="col" { "largest deviation" } th.number scope="col" { "samples within" } th scope="col" { "tolerance" }
                    } }
                    tbody {
                        @for (history, output, held) in &rows {
                            @let Shown { scale, unit } = shown_in(&output.unit);
                            tr {
                                td { (history.segment) @if history.role != Role::Estimation { span.soft { " (not fitted)" } } }
                                th scope="row" { (output.name) } td.soft { (unit) }
                                td.number { (number(held.largest_deviation * scale)) } td.number { (format!("{:.1} %", 100.0 * held.share_within)) }
                                td.soft { (held.entry) ", " (held.tolerance) }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// By the output's name and unit, as reports know no more of it.
fn tolerance(output: &OutputSeries) -> Option<Tolerance> {
    let dimension = Unit::parse(&output.unit).ok()?.dimension;
    Tolerance::of(by_name(&output.name, dimension)?, &output.unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_beyond_the_tolerance_counts_against_the_model() {
        let output = OutputSeries {
            name: "p".into(),
            unit: "rad/s".into(),
            measured: vec![0.0, 1.0, 1.0, f64::NAN],
            model: vec![0.0; 4],
            declared: Vec::new(),
            // within by size, within by share, beyond, missing
            residual: vec![0.03, 0.09, -0.2, f64::NAN],
        };
        let history = TimeHistory {
            segment: "roll <1>".into(),
            role: Role::Validation,
            time: vec![0.0, 1.0, 2.0, 3.0],
            inputs: Vec::new(),
            outputs: vec![output.clone()],
        };
        let html = tolerances(std::slice::from_ref(&history)).into_string();
        assert!(
            html.contains("66.7 %") && html.contains("roll &lt;1&gt;"),
            "{html}"
        );
        // an output of another unit is another quantity
        let mut other = history;
        other.outputs[0].unit = "m".into();
        assert_eq!(tolerances(&[other]).into_string(), "");
    }
}
