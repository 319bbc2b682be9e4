//! What a derivative study found, as tables for the terminal.

use super::table::bordered;
use crate::estimate::Scaling;
use crate::estimate::study::{DerivativeStudy, FormulaOperations};

/// Techniques, best steps, costs and descents.
pub fn tables(study: &DerivativeStudy) -> String {
    format!(
        "{}\n\n{}\n\nbest steps\n{}\n\none gradient by the number of free unknowns\n{}\n{}\n\n\
         to within 0.01 standard errors of the minimum\n{}",
        size(study),
        techniques(study),
        best_steps(study),
        costs(study),
        by_formula(&study.formula),
        descents(study),
    )
}

fn size(study: &DerivativeStudy) -> String {
    let size = &study.size;
    format!(
        "{} samples, {} states, {} outputs, {} unknowns, {} stages",
        size.samples, size.states, size.outputs, size.unknowns, size.stages
    )
}

fn techniques(study: &DerivativeStudy) -> String {
    let header = [
        "technique",
        "error",
        "operations",
        "sims",
        "CPU ms",
        "wall ms",
        "kB",
        "iterations",
        "outcome",
        "estimation ms",
    ];
    let rows = study.techniques.iter().map(|row| {
        let error = row.gradient_error;
        vec![
            row.technique.clone(),
            error.map_or("reference".to_string(), |error| format!("{error:.1e}")),
            format!("{:.2e}", row.operations as f64),
            row.simulations.to_string(),
            milliseconds(row.cpu_seconds),
            milliseconds(row.wall_seconds),
            format!("{:.0}", row.bytes as f64 / 1e3),
            row.iterations.to_string(),
            row.outcome.clone(),
            format!("{:.1}", row.estimation_wall_seconds * 1e3),
        ]
    });
    bordered(header, rows, 1..)
}

fn best_steps(study: &DerivativeStudy) -> String {
    let rows = study.error_curves.iter().filter_map(|curve| {
        let (step, error) = curve.best()?;
        Some(vec![
            curve.technique.clone(),
            format!("{step:.0e}"),
            format!("{error:.1e}"),
        ])
    });
    bordered(["technique", "step", "error"], rows, 1..)
}

fn costs(study: &DerivativeStudy) -> String {
    let header = [
        "unknowns",
        "direct op.",
        "adjoint op.",
        "direct ms",
        "adjoint ms",
    ];
    let rows = study.costs.iter().map(|cost| {
        vec![
            cost.unknowns.to_string(),
            format!("{:.2e}", cost.direct_operations as f64),
            format!("{:.2e}", cost.adjoint_operations as f64),
            milliseconds(cost.direct_wall_seconds),
            milliseconds(cost.adjoint_wall_seconds),
        ]
    });
    bordered(header, rows, 1..)
}

fn by_formula(formula: &FormulaOperations) -> String {
    format!(
        "by formula (Euler, full matrices): direct {:.3e}, reverse {:.3e} operations",
        (formula.direct_multiplications + formula.direct_additions) as f64,
        (formula.reverse_multiplications + formula.reverse_additions) as f64
    )
}

fn descents(study: &DerivativeStudy) -> String {
    let header = [
        "optimiser",
        "Hessian at start",
        "iterations",
        "gradients",
        "above minimum",
        "",
    ];
    let rows = study.descents.iter().map(|row| {
        let scaling = match row.scaling {
            None => "information, every step",
            Some(Scaling::Information) => "information",
            Some(Scaling::Sizes) => "sizes",
            Some(Scaling::None) => "none",
        };
        vec![
            row.optimiser.clone(),
            scaling.to_string(),
            row.iterations.to_string(),
            row.gradients.to_string(),
            format!("{:.1e}", row.cost_excess),
            if row.reached { "" } else { "not there" }.to_string(),
        ]
    });
    bordered(header, rows, 1..)
}

fn milliseconds(seconds: f64) -> String {
    format!("{:.3}", seconds * 1e3)
}
