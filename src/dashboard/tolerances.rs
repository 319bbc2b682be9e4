//! How a model compares with what simulators are qualified by, where such a tolerance applies.
//!
//! Tolerances: 14 CFR Part 60, Appendix A, Table A2A (objective tests of dynamics).

use maud::{Markup, html};

use crate::estimate::{OutputSeries, Role, TimeHistory, five_digits as number};
use crate::flight::{Shown, shown_in};

/// What a response may deviate by.
struct Tolerance {
    /// Names that the output goes by.
    names: &'static [&'static str],
    /// SI unit that it has.
    unit: &'static str,
    /// SI.
    absolute: f64,
    /// Share of the measured value, whichever of the two is larger; 0: none.
    relative: f64,
    text: &'static str,
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;

const TOLERANCES: [Tolerance; 5] = [
    Tolerance {
        names: &["q"],
        unit: "rad/s",
        absolute: 2.0 * DEGREE,
        relative: 0.0,
        text: "short-period dynamics: pitch rate ±2 deg/s",
    },
    Tolerance {
        names: &["theta"],
        unit: "rad",
        absolute: 1.5 * DEGREE,
        relative: 0.0,
        text: "short-period dynamics: pitch angle ±1.5 deg",
    },
    Tolerance {
        names: &["az", "a_z", "nz"],
        unit: "m/s^2",
        absolute: 0.1 * 9.806_65,
        relative: 0.0,
        text: "short-period dynamics: normal acceleration ±0.1 g",
    },
    Tolerance {
        names: &["p"],
        unit: "rad/s",
        absolute: 2.0 * DEGREE,
        relative: 0.1,
        text: "roll response: roll rate ±2 deg/s or ±10 %",
    },
    Tolerance {
        names: &["r"],
        unit: "rad/s",
        absolute: 2.0 * DEGREE,
        relative: 0.1,
        text: "rudder response: yaw rate ±2 deg/s or ±10 %",
    },
];

/// A table of the outputs that a tolerance applies to; nothing where there is none.
pub(super) fn tolerances(histories: &[TimeHistory]) -> Markup {
    let mut rows = Vec::new();
    for history in histories {
        for output in &history.outputs {
            let applies = |tolerance: &&Tolerance| {
                tolerance.names.contains(&output.name.as_str()) && tolerance.unit == output.unit
            };
            if let Some(tolerance) = TOLERANCES.iter().find(applies) {
                rows.push((history, output, tolerance, held(output, tolerance)));
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
                        @for (history, output, tolerance, held) in &rows {
                            @let Shown { scale, unit } = shown_in(&output.unit);
                            tr {
                                td { (history.segment) @if history.role != Role::Estimation { span.soft { " (not fitted)" } } }
                                th scope="row" { (output.name) } td.soft { (unit) }
                                td.number { (number(held.largest * scale)) } td.number { (format!("{:.1} %", 100.0 * held.share)) }
                                td.soft { (tolerance.text) }
                            }
                        }
                    }
                }
            }
        }
    }
}

struct Held {
    /// SI
    largest: f64,
    /// Of the samples that are there.
    share: f64,
}

fn held(output: &OutputSeries, tolerance: &Tolerance) -> Held {
    let (mut largest, mut within, mut samples) = (0.0_f64, 0, 0);
    let present = output.residual.iter().zip(&output.measured);
    for (residual, measured) in present.filter(|(residual, _)| residual.is_finite()) {
        let bound = tolerance.absolute.max(tolerance.relative * measured.abs());
        largest = largest.max(residual.abs());
        within += usize::from(residual.abs() <= bound);
        samples += 1;
    }
    Held {
        largest,
        share: within as f64 / f64::from(samples.max(1)),
    }
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
        let held = held(&output, &TOLERANCES[3]);
        assert_eq!(held.largest, 0.2);
        assert!((held.share - 2.0 / 3.0).abs() < 1e-12);
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
