//! A table whose cells are numbers already: its titles mean the same as those of a table of text.

use std::borrow::Cow;

use super::super::{
    IngestError, Limits, Origin,
    cell::{Marks, number, unquote},
    code,
    columns::{Cells, Columns, NONE},
    fault::{CELLS_LISTED, pointer},
    lines::Line,
    mapping::{Mapping, NoValue},
    reading::Reading,
    stamp::ClockKind,
    text::quoted,
};
use super::{
    clock::Clock,
    column::Column,
    delimiter::Delimiter,
    described::Described,
    draft, ending,
    inspection::{self, Inspection},
    plan::Plan,
    read::{of_samples, with_draft},
    samples::{Samples, Unreadable},
    time::Time,
    titles::Titles,
    trouble::{Trouble, Written},
};
use crate::flight::Fault;

/// The first rows, by which columns are judged.
const FIRST_ROWS: usize = 100;

/// Reads a table, as its titles say or as a mapping does.
///
/// # Errors
/// As those of a table of text.
pub(in super::super) fn read_columns(
    columns: &mut Columns,
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    limits.columns(columns.list.len()).map_or(Ok(()), Err)?;
    let head = Head::of(columns);
    let described = Described::of(head.titles(), mapping);
    read_described(&described, columns, limits)
        .map_err(|error| with_draft(error, &described, mapping, limits))
}

/// Looks at a table of the format `name`.
///
/// # Errors
/// It has too many columns.
pub(in super::super) fn inspect_columns(
    name: &str,
    columns: &mut Columns,
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Inspection, IngestError> {
    limits.columns(columns.list.len()).map_or(Ok(()), Err)?;
    let head = Head::of(columns);
    let described = Described::of(head.titles(), mapping);
    let mut written = vec![("format", name.to_string())];
    if let Some(name) = described.recognised {
        written.push(("recognised as", name.to_string()));
    }
    Ok(Inspection {
        written,
        columns: inspection::columns(&described.titles),
        reading: read_columns(columns, mapping, limits),
        draft: draft::of(&described.titles, None, limits),
    })
}

/// What stands over the columns, and in the first rows of them.
struct Head {
    names: Vec<String>,
    units: Vec<&'static str>,
    first: Vec<Vec<String>>,
}

impl Head {
    fn of(columns: &Columns) -> Self {
        let list = &columns.list;
        let row = |at| {
            list.iter()
                .map(move |column| column.cells.text(at).into_owned())
        };
        Self {
            names: list.iter().map(|column| column.title.clone()).collect(),
            units: list.iter().map(|column| column.unit).collect(),
            first: (0..columns.rows.min(FIRST_ROWS))
                .map(|at| row(at).collect())
                .collect(),
        }
    }

    fn titles(&self) -> Titles<'_> {
        let line = Line {
            number: 0,
            text: "",
        };
        Titles {
            names: Some((line, cells(&self.names))),
            units: Some((line, self.units.clone())),
            first: self.first.iter().map(|row| cells(row)).collect(),
            width: self.names.len(),
            stated: None,
        }
    }
}

fn cells(row: &[String]) -> Vec<&str> {
    row.iter().map(String::as_str).collect()
}

fn read_described(
    described: &Described,
    columns: &mut Columns,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    let mut plan = Plan::of(&described.titles, &described.mapping, limits)?;
    for (title, why) in &columns.left_out {
        let place = pointer(["columns", title]);
        let fault = Fault::new(place, code::NOT_A_NUMBER, format!("column: {why}"));
        plan.left_out.push((quoted(title), fault));
    }
    let name = described.name_of_time(&plan);
    let times = times(&plan, columns, &name);
    let samples = samples(&plan, columns, times);
    of_samples(described, plan, samples, &name, limits)
}

/// The times of the rows that have one.
#[derive(Default)]
struct Times {
    seconds: Vec<f64>,
    /// From 1.
    rows: Vec<u32>,
    /// Rows before the first that has a time.
    before: usize,
    origin: Option<Origin>,
    faults: Vec<(usize, Fault)>,
}

fn times(plan: &Plan, columns: &Columns, name: &str) -> Times {
    let mut clock = Clock::new(plan.time, Marks::POINT);
    let cells = |at: usize| columns.list.get(at).map(|column| &column.cells);
    let time = plan.time.column().and_then(cells);
    let beside: Vec<_> = plan.time.beside().map(cells).collect();
    let mut times = Times {
        seconds: Vec::with_capacity(columns.rows),
        rows: Vec::with_capacity(columns.rows),
        ..Times::default()
    };
    let mut first = None;
    for row in 0..columns.rows {
        let read = match (plan.time, time) {
            (Time::Even { start, step }, _) => Ok(start + times.seconds.len() as f64 * step),
            (Time::Numbers { .. }, Some(Cells::Doubles(values))) => {
                let known = values.get(row).filter(|value| value.is_finite());
                known.map(|&value| clock.of_number(value)).ok_or(None)
            }
            (Time::Numbers { .. }, Some(Cells::Integers(values))) => {
                let known = values.get(row).filter(|&&value| value != NONE);
                known
                    .map(|&value| clock.of_number(value as f64))
                    .ok_or(None)
            }
            (Time::Stamps { .. }, Some(Cells::Instants(values))) => {
                let known = values.get(row).filter(|&&value| value != NONE);
                let mut since = |value: i64| {
                    let first = *first.get_or_insert(value);
                    (i128::from(value) - i128::from(first)) as f64 / 1e9
                };
                known.map(|&value| since(value)).ok_or(None)
            }
            _ => {
                let beside: Vec<Cow<str>> =
                    beside.iter().map(|&cells| text_of(cells, row)).collect();
                let beside: Vec<&str> = beside.iter().map(Cow::as_ref).collect();
                clock.read(&text_of(time, row), &beside)
            }
        };
        match read {
            Ok(time) => {
                times.seconds.push(time);
                times.rows.push(row as u32 + 1);
            }
            Err(None) if times.seconds.is_empty() && times.faults.is_empty() => times.before += 1,
            Err(why) => {
                let trouble = why.map_or(Trouble::NoTime, |why| {
                    Trouble::Time(text_of(time, row).into_owned(), why)
                });
                times.faults.push((row + 1, fault(&trouble, row + 1, name)));
                if times.faults.len() == CELLS_LISTED {
                    break;
                }
            }
        }
    }
    times.origin = match first {
        Some(first) => Some(Origin::at(ClockKind::Instant, first.into())),
        None => clock.origin(),
    };
    times
}

fn text_of(cells: Option<&Cells>, row: usize) -> Cow<'_, str> {
    cells.map_or(Cow::Borrowed(""), |cells| cells.text(row))
}

fn fault(trouble: &Trouble, row: usize, time: &str) -> Fault {
    let written = Written {
        delimiter: Delimiter::Byte(b','),
        marks: Marks::POINT,
        width: 0,
        header: Vec::new(),
        time: time.to_string(),
        is_cut_off: false,
    };
    let line = Line {
        number: row,
        text: "",
    };
    trouble.fault(row, &line, &written)
}

fn samples(plan: &Plan, columns: &mut Columns, times: Times) -> Samples {
    let has_all = times.rows.len() == columns.rows;
    let mut samples = Samples {
        time: times.seconds,
        values: Vec::with_capacity(plan.columns.len()),
        lines: times.rows.clone(),
        rows: times.rows,
        unreadable: Vec::with_capacity(plan.columns.len()),
        findings: ending::no_time_yet(times.before).into_iter().collect(),
        origin: times.origin,
        faults: times.faults,
    };
    for column in &plan.columns {
        let (mut values, unreadable) = match columns.list.get_mut(column.at) {
            Some(found) => column.numbers(&mut found.cells),
            None => (Vec::new(), None),
        };
        if !has_all {
            let kept = samples.rows.iter();
            let kept = kept.map(|&row| values.get(row as usize - 1).copied());
            values = kept.map(|value| value.unwrap_or(f64::NAN)).collect();
        }
        column.apply(&mut values);
        samples.values.push(values);
        samples.unreadable.push(unreadable);
    }
    samples
}

impl Column {
    /// The numbers of its cells, which are taken out, and what in them is none.
    fn numbers(&self, cells: &mut Cells) -> (Vec<f64>, Option<Unreadable>) {
        match cells {
            Cells::Doubles(values) => (std::mem::take(values), None),
            Cells::Integers(values) => {
                let number = |&value: &i64| match value {
                    NONE => f64::NAN,
                    value => value as f64,
                };
                (values.iter().map(number).collect(), None)
            }
            Cells::Instants(_) | Cells::Texts(_) => self.numbers_of_texts(cells),
        }
    }

    fn numbers_of_texts(&self, cells: &Cells) -> (Vec<f64>, Option<Unreadable>) {
        let mut unreadable: Option<Unreadable> = None;
        let mut values = Vec::with_capacity(cells.len());
        for row in 0..cells.len() {
            let cell = cells.text(row);
            let said = unquote(&cell);
            let is_no_value =
                |no_value: &NoValue| matches!(no_value, NoValue::Word(word) if word.trim() == said);
            let value = match self.no_values.iter().any(is_no_value) {
                true => Some(f64::NAN),
                false => number(&cell, Marks::POINT),
            };
            values.push(value.unwrap_or(f64::NAN));
            if value.is_none() {
                let unreadable = unreadable.get_or_insert_with(|| Unreadable {
                    row: row + 1,
                    line: row + 1,
                    cell: said.to_string(),
                    count: 0,
                });
                unreadable.count += 1;
            }
        }
        (values, unreadable)
    }
}
