//! Results as tables for the terminal.

use comfy_table::presets::UTF8_HORIZONTAL_ONLY;
use comfy_table::{CellAlignment, Table};
use indexmap::IndexMap;

use crate::estimate::{Bound, Estimate, ParameterEstimate};

/// The parameter table; beside the truth where that is known.
pub fn parameters(estimate: &Estimate, truth: Option<&IndexMap<String, f64>>) -> String {
    let mut header = vec!["parameter", "unit", "estimate", "std. error", "%"];
    if truth.is_some() {
        header.extend(["truth", "off by"]);
    }
    header.push("");
    let rows = estimate.parameters.iter().map(|parameter| {
        let mut row = vec![label(parameter), unit_of(parameter), number(parameter.estimate)];
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
        row.push(remark(parameter).to_string());
        row
    });
    let mut table = Table::new();
    table.load_preset(UTF8_HORIZONTAL_ONLY).set_header(header).add_rows(rows);
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
        vec![output.name.clone(), output.unit.clone(), number(output.rms), number(output.bias), share]
    });
    let mut table = Table::new();
    table.load_preset(UTF8_HORIZONTAL_ONLY);
    table.set_header(["output", "unit", "rms residual", "mean residual", "R²"]).add_rows(rows);
    for column in table.column_iter_mut().skip(2) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.to_string()
}

fn label(parameter: &ParameterEstimate) -> String {
    match &parameter.segment {
        Some(segment) => format!("{} [{segment}]", parameter.name),
        None => parameter.name.clone(),
    }
}

fn unit_of(parameter: &ParameterEstimate) -> String {
    if parameter.unit.is_empty() { "-".to_string() } else { parameter.unit.clone() }
}

fn remark(parameter: &ParameterEstimate) -> &'static str {
    match (parameter.fixed, parameter.at_bound, parameter.standard_error) {
        (true, ..) => "fixed",
        (_, Some(Bound::Lower), _) => "at its lower bound",
        (_, Some(Bound::Upper), _) => "at its upper bound",
        (_, _, None) => "not determined by the data",
        _ => "",
    }
}

fn off_by(parameter: &ParameterEstimate, truth: f64) -> String {
    match parameter.standard_error {
        Some(error) if error > 0.0 => format!("{:.1} s.e.", (parameter.estimate - truth).abs() / error),
        _ => String::new(),
    }
}

fn percent(error: f64, estimate: f64) -> String {
    let share = 100.0 * error / estimate.abs();
    if share.is_finite() && share < 1000.0 { format!("{share:.1}") } else { String::new() }
}

/// Five digits, as a decimal where that is readable.
fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".to_string()
    } else if (1e-3..1e5).contains(&size) {
        let digits = (4 - size.log10().floor() as i32).max(0) as usize;
        format!("{value:.digits$}")
    } else {
        format!("{value:.4e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_five_digits() {
        for (value, text) in [(-4.917_632, "-4.9176"), (0.020_015_48, "0.020015"), (130.0, "130.00"), (1.5e-9, "1.5000e-9"), (0.0, "0")] {
            assert_eq!(number(value), text);
        }
    }
}
