//! Results as tables for the terminal.

use comfy_table::presets::UTF8_BORDERS_ONLY;
use comfy_table::{CellAlignment, Table};
use indexmap::IndexMap;

use crate::estimate::{
    Coefficient, Estimate, Measure, Mode, ParameterEstimate, five_digits as number,
};

/// The parameter table; beside the truth where that is known.
pub fn parameters(estimate: &Estimate, truth: Option<&IndexMap<String, f64>>) -> String {
    let mut header = vec!["parameter", "unit", "estimate", "std. error", "%"];
    if truth.is_some() {
        header.extend(["truth", "off by"]);
    }
    header.push("");
    let rows = estimate.parameters.iter().map(|parameter| {
        let mut row = vec![
            label(parameter),
            unit_of(parameter),
            number(parameter.estimate),
        ];
        match parameter.standard_error {
            Some(error) => {
                row.push(number(error));
                row.push(percent(error, parameter.estimate));
            }
            None => row.extend([String::new(), String::new()]),
        }
        if let Some(truth) = truth {
            match truth.get(&parameter.name) {
                Some(&truth) => row.extend([number(truth), off_by(parameter, truth)]),
                None => row.extend([String::new(), String::new()]),
            }
        }
        row.push(parameter.remark().to_string());
        row
    });
    let mut table = Table::new();
    table
        .load_style(UTF8_BORDERS_ONLY)
        .set_header(header)
        .add_rows(rows);
    let last = table.column_count() - 1;
    for column in table.column_iter_mut().take(last).skip(2) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.to_string()
}

/// How well each output is reproduced.
pub fn outputs(estimate: &Estimate) -> String {
    let rows = estimate.outputs.iter().map(|output| {
        let share = format!("{:.4}", output.r_squared);
        vec![
            output.name.clone(),
            output.unit.clone(),
            number(output.rms),
            number(output.bias),
            share,
        ]
    });
    let mut table = Table::new();
    table.load_style(UTF8_BORDERS_ONLY);
    table
        .set_header(["output", "unit", "rms residual", "mean residual", "R²"])
        .add_rows(rows);
    for column in table.column_iter_mut().skip(2) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.to_string()
}

/// Nondimensional coefficients.
pub fn coefficients(coefficients: &[Coefficient]) -> String {
    let rows = coefficients.iter().map(|coefficient| {
        let error = coefficient.standard_error;
        vec![
            coefficient.name.clone(),
            number(coefficient.value),
            error.map(number).unwrap_or_default(),
            error.map_or(String::new(), |error| percent(error, coefficient.value)),
            coefficient.from.join(", "),
        ]
    });
    let mut table = Table::new();
    table
        .load_style(UTF8_BORDERS_ONLY)
        .set_header(["coefficient", "value", "std. error", "%", "from"])
        .add_rows(rows);
    table.to_string()
}

/// Modes of the motion.
pub fn modes(modes: &[Mode]) -> String {
    let text = |measure: Option<Measure>| measure.map(|m| m.to_string()).unwrap_or_default();
    let rows = modes.iter().map(|mode| {
        vec![
            mode.label(),
            mode.eigenvalue(),
            text(mode.natural_frequency),
            text(mode.damping_ratio),
            text(mode.period.or(mode.time_constant)),
            text(mode.time_to_half),
            text(mode.time_to_double),
            mode.remark.clone(),
        ]
    });
    let mut table = Table::new();
    table
        .load_style(UTF8_BORDERS_ONLY)
        .set_header([
            "mode",
            "eigenvalue, 1/s",
            "frequency, rad/s",
            "damping",
            "period or time constant, s",
            "to half, s",
            "to double, s",
            "",
        ])
        .add_rows(rows);
    table.to_string()
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
