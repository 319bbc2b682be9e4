//! A table that was found becomes a recording.

use super::super::{
    IngestError, Limits, code, encoding,
    fault::{CELLS_LISTED, pointer},
    mapping::Mapping,
    reading::Reading,
    text::quoted,
};
use super::{
    clock,
    column::Column,
    described::Described,
    draft, own_times,
    plan::Plan,
    repeated, report, rows,
    samples::{Samples, Unreadable},
    table::Table,
};
use crate::flight::Fault;

/// Reads a table of text, as its header says or as a mapping does.
///
/// Empty cells and the usual words (nan, na, null, inf in any case) are missing values.
///
/// # Errors
/// What separates the cells, or a decimal mark, is not clear; else every fault of the header; else the first 20 faults
/// of rows and cells.
pub(in super::super) fn read(
    bytes: &[u8],
    charset: Option<&str>,
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    let decoded = encoding::text(bytes, charset)?;
    let table = Table::find(&decoded.text, mapping, limits)?;
    let mut reading = read_table(&table, limits)
        .map_err(|error| with_draft(error, &table.described, mapping, limits))?;
    reading.findings.splice(0..0, decoded.findings);
    Ok(reading)
}

/// The same with the draft of a mapping, where the one that was given does not say all.
pub(super) fn with_draft(
    error: IngestError,
    described: &Described,
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> IngestError {
    let says_all = mapping.is_some_and(|mapping| !mapping.channels.is_empty());
    if says_all {
        return error;
    }
    let repeated = repeated::proposal(error.faults());
    let draft = draft::of(&described.titles, repeated, limits);
    error.with_draft(draft.to_json())
}

fn read_table(table: &Table, limits: &Limits) -> Result<Reading, IngestError> {
    let described = &table.described;
    let plan = Plan::of(&described.titles, &described.mapping, limits)?;
    let capacity = table.check_size(limits)?;
    let written = table.written(&plan);
    let samples = rows::read(table.rows.clone(), &written, &plan, capacity);
    of_samples(described, plan, samples, &written.time, limits)
}

/// What was read becomes a recording; `time` is what the column of time is called.
///
/// # Errors
/// The faults of rows, of times, and of columns that are needed.
pub(super) fn of_samples(
    described: &Described,
    plan: Plan,
    mut samples: Samples,
    time: &str,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    let mut faults = std::mem::take(&mut samples.faults);
    if faults.is_empty() {
        let said = described.mapping.time.repeated;
        faults.extend(
            repeated::resolve(&mut samples, said, time)
                .err()
                .into_iter()
                .flatten(),
        );
    }
    let mut left_out = plan.left_out.clone();
    for (column, unreadable) in plan.columns.iter().zip(&samples.unreadable) {
        let Some(unreadable) = unreadable else {
            continue;
        };
        let fault = not_readable(column, unreadable);
        let is_last_hope = samples.unreadable.iter().all(Option::is_some);
        if column.is_needed || is_last_hope {
            faults.push((unreadable.row, fault));
        } else {
            left_out.push((quoted(&column.name), fault));
        }
    }
    faults.sort_by_key(|(row, _)| *row);
    faults.truncate(CELLS_LISTED);
    IngestError::refuse(faults.into_iter().map(|(_, fault)| fault).collect())?;
    let mut findings = report::findings(described, &plan, &left_out);
    findings.append(&mut samples.findings);
    let origin = samples.origin;
    let maneuver = own_times::maneuver(plan.columns, samples, limits)?;
    Ok(Reading {
        maneuver,
        findings,
        origin,
    })
}

fn not_readable(column: &Column, unreadable: &Unreadable) -> Fault {
    let Unreadable {
        row,
        line,
        cell,
        count,
    } = unreadable;
    let (cell, name) = (quoted(cell), &column.name);
    let more = match count - 1 {
        0 => String::new(),
        more => format!("; and {more} more cell(s) of it"),
    };
    let message = format!(
        "line {line}: {cell} in column '{name}' {}{more}; where it stands for no value, say so in a mapping: missing = [...]",
        clock::NOT_A_NUMBER
    );
    Fault::new(
        pointer(["rows", &row.to_string(), name]),
        code::NOT_A_NUMBER,
        message,
    )
}
