//! Linear systems and flying qualities as tables for the terminal.

use super::table::{bordered, modes};
use crate::dynamics::{FlyingQualities, LinearSystem, NamedMatrix, Root};
use crate::estimate::{Measure, five_digits as number};

/// Matrices, modes, transfer functions.
pub(super) fn system(system: &LinearSystem) -> String {
    let mut parts = vec![format!("linear system at the start of {}", system.segment)];
    let matrices = system.matrices().into_iter();
    parts.extend(
        matrices
            .filter(|of| !of.columns.is_empty())
            .map(|of| matrix(&of)),
    );
    if !system.modes.is_empty() {
        parts.push(modes(&system.modes));
    }
    if !system.transfer_functions.is_empty() {
        parts.push(transfer_functions(system));
    }
    parts.extend(system.remarks.iter().cloned());
    parts.join("\n\n")
}

fn matrix(of: &NamedMatrix<'_>) -> String {
    let lines = of.rows.iter().enumerate().map(|(at, row)| {
        std::iter::once((*row).to_string())
            .chain(of.cells(at))
            .collect()
    });
    let titles = std::iter::once(of.name).chain(of.columns.iter().copied());
    bordered(titles, lines, 1..)
}

fn transfer_functions(system: &LinearSystem) -> String {
    let roots = |roots: &[Root]| {
        let words: Vec<String> = roots.iter().map(ToString::to_string).collect();
        words.join("; ")
    };
    let rows = system.transfer_functions.iter().map(|function| {
        vec![
            format!("{} to {}", function.input, function.output),
            function.gain.to_string(),
            roots(&function.zeros),
            roots(&function.poles),
            function.delay.to_string(),
        ]
    });
    bordered(
        [
            "transfer function",
            "gain",
            "zeros, 1/s",
            "poles, 1/s",
            "delay, s",
        ],
        rows,
        0..0,
    )
}

/// Equivalent systems, bandwidths, levels.
pub(super) fn qualities(qualities: &FlyingQualities) -> String {
    let text = |measure: Option<Measure>| measure.map(|m| m.to_string()).unwrap_or_default();
    let mut parts = Vec::new();
    if !qualities.equivalent_systems.is_empty() {
        let rows = qualities.equivalent_systems.iter().map(|system| {
            vec![
                format!("{}/{}", system.output, system.input),
                system.gain.to_string(),
                text(system.numerator_root),
                text(system.natural_frequency),
                text(system.damping_ratio),
                text(system.time_constant),
                system.delay.to_string(),
                number(system.mismatch),
            ]
        });
        let header = [
            "equivalent system",
            "gain",
            "1/T, 1/s",
            "frequency, rad/s",
            "damping",
            "time constant, s",
            "delay, s",
            "mismatch",
        ];
        parts.push(bordered(header, rows, 0..0));
    }
    if let Some(parameter) = qualities.control_anticipation_parameter {
        parts.push(format!(
            "control anticipation parameter: {parameter} rad/s² per g"
        ));
    }
    if !qualities.bandwidths.is_empty() {
        let rows = qualities.bandwidths.iter().map(|row| {
            vec![
                format!("{}/{}", row.output, row.input),
                text(row.bandwidth),
                text(row.phase),
                text(row.gain),
                text(row.phase_delay),
            ]
        });
        let header = [
            "attitude",
            "bandwidth, rad/s",
            "by phase",
            "by gain",
            "phase delay, s",
        ];
        parts.push(bordered(header, rows, 0..0));
    }
    if !qualities.levels.is_empty() {
        parts.push(levels(qualities));
    }
    parts.extend(qualities.remarks.iter().cloned());
    parts.join("\n\n")
}

fn levels(qualities: &FlyingQualities) -> String {
    let level = |level: Option<u8>| level.map_or("none".to_string(), |level| level.to_string());
    let rows = qualities.levels.iter().map(|criterion| {
        let within = criterion.levels_within_2_standard_errors;
        vec![
            criterion.what.clone(),
            level(criterion.level),
            within.map_or(String::new(), |[best, worst]| match best == worst {
                true => level(best),
                false => format!("{} to {}", level(best), level(worst)),
            }),
            criterion.level_1.clone(),
            criterion.source.clone(),
        ]
    });
    let header = [
        "requirement",
        "level",
        "within 2 s.e.",
        "level 1 asks for",
        "source",
    ];
    bordered(header, rows, 0..0)
}
