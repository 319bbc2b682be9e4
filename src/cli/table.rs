//! Results as tables for the terminal.

use indexmap::IndexMap;

pub(super) use super::bordered::bordered;
use super::intervals::intervals;
use super::notes;
use crate::estimate::{
    Coefficient, Estimate, FilterEstimate, Measure, Mode, OutputFit, ParameterEstimate,
    five_digits as number,
};
use crate::flight::{bounded, decimals, five_digits_beside, two_digits};

/// All tables of an estimate, and what to know beside them.
pub(super) fn result(estimate: &Estimate, truth: Option<&IndexMap<String, f64>>) -> String {
    let mut parts = vec![parameters(estimate, truth), outputs(&estimate.outputs)];
    parts.extend(estimate.confidence_intervals.as_ref().map(intervals));
    parts.extend(estimate.filter.as_ref().map(process_noise));
    if !estimate.modes.is_empty() {
        parts.push(modes(&estimate.modes));
    }
    for prediction in &estimate.prediction {
        let segment = &prediction.segment;
        parts.push(format!(
            "prediction of {segment}: {}\n{}",
            prediction.reason,
            outputs(&prediction.outputs)
        ));
    }
    parts.extend(
        (!estimate.findings.is_empty()).then(|| notes::lines(&estimate.findings).join("\n")),
    );
    parts.join("\n\n")
}

/// The parameter table; beside the truth where that is known. The column `white` has the standard errors that white
/// residuals would give.
fn parameters(estimate: &Estimate, truth: Option<&IndexMap<String, f64>>) -> String {
    let mut header = vec!["parameter", "unit", "estimate", "std. error", "%", "white"];
    if truth.is_some() {
        header.extend(["truth", "off by"]);
    }
    header.push("");
    let rows = estimate.parameters.iter().map(|parameter| {
        let error = parameter.standard_error;
        let mut row = vec![label(parameter), unit_of(parameter)];
        row.extend(bounded(parameter.estimate, error));
        row.push(error.map_or_else(String::new, |error| percent(error, parameter.estimate)));
        let white = parameter.conventional_standard_error;
        row.push(white.map_or_else(String::new, two_digits));
        if let Some(truth) = truth {
            match truth.get(&parameter.name) {
                Some(&truth) => row.extend([number(truth), off_by(parameter, truth)]),
                None => row.extend([String::new(), String::new()]),
            }
        }
        row.push(estimate.remark(parameter).to_string());
        row
    });
    let last = header.len() - 1;
    bordered(header, rows, 2..last)
}

/// How well each output is reproduced.
fn outputs(outputs: &[OutputFit]) -> String {
    let rows = outputs.iter().map(|output| {
        let shares = output.theil_shares;
        vec![
            output.name.clone(),
            output.unit.clone(),
            number(output.rms),
            five_digits_beside(output.bias, output.rms),
            format!("{:.4}", output.r_squared),
            format!("{:.4}", output.theil),
            format!(
                "{:.2}/{:.2}/{:.2}",
                shares.bias, shares.variance, shares.covariance
            ),
            decimals(output.autocorrelation, 2),
            format!("{:.0}", output.effective_samples),
        ]
    });
    let header = [
        "output",
        "unit",
        "rms residual",
        "mean residual",
        "R²",
        "Theil",
        "bias/var/cov",
        "lag 1",
        "eff. samples",
    ];
    bordered(header, rows, 2..)
}

/// The intensity of the process noise of each state.
fn process_noise(filter: &FilterEstimate) -> String {
    let rows = filter.process_noise.iter().map(|noise| {
        let [value, error] = bounded(noise.estimate, noise.standard_error);
        vec![
            noise.state.clone(),
            noise.unit.clone(),
            value,
            error,
            noise.remark().to_string(),
        ]
    });
    let header = ["process noise of", "unit", "intensity", "std. error", ""];
    bordered(header, rows, 2..4)
}

/// Nondimensional coefficients.
pub(super) fn coefficients(coefficients: &[Coefficient]) -> String {
    let rows = coefficients.iter().map(|coefficient| {
        let error = coefficient.standard_error;
        let [value, bound] = bounded(coefficient.value, error);
        vec![
            coefficient.name.clone(),
            value,
            bound,
            error.map_or(String::new(), |error| percent(error, coefficient.value)),
            coefficient.from.join(", "),
        ]
    });
    bordered(
        ["coefficient", "value", "std. error", "%", "from"],
        rows,
        0..0,
    )
}

/// Modes of the motion.
pub(super) fn modes(modes: &[Mode]) -> String {
    let text = |measure: Option<Measure>| measure.map(|m| m.to_string()).unwrap_or_default();
    let rows = modes.iter().map(|mode| {
        vec![
            mode.label(),
            mode.eigenvalue(),
            text(mode.natural_frequency),
            mode.damping(),
            text(mode.period.or(mode.time_constant)),
            text(mode.time_to_half),
            text(mode.time_to_double),
            mode.remark.clone(),
        ]
    });
    let header = [
        "mode",
        "eigenvalue, 1/s",
        "frequency, rad/s",
        "damping",
        "period or time constant, s",
        "to half, s",
        "to double, s",
        "",
    ];
    bordered(header, rows, 0..0)
}

fn label(parameter: &ParameterEstimate) -> String {
    match &parameter.segment {
        Some(segment) => format!("{} [{segment}]", parameter.name),
        None => parameter.name.clone(),
    }
}

fn unit_of(parameter: &ParameterEstimate) -> String {
    if parameter.unit.is_empty() {
        "-".to_string()
    } else {
        parameter.unit.clone()
    }
}

fn off_by(parameter: &ParameterEstimate, truth: f64) -> String {
    match parameter.standard_error {
        Some(error) if error > 0.0 => {
            format!("{:.1} s.e.", (parameter.estimate - truth).abs() / error)
        }
        _ => String::new(),
    }
}

fn percent(error: f64, estimate: f64) -> String {
    let share = 100.0 * error / estimate.abs();
    if share.is_finite() && share < 1000.0 {
        format!("{share:.1}")
    } else {
        String::new()
    }
}
