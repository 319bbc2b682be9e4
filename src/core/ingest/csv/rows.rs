//! The rows of a table: one a sample, each cell a number, a time stamp, or nothing.

use super::super::{
    cell::{Decimal, number, unquote},
    fault::CELLS_LISTED,
    lines::{Line, Lines},
    mapping::NoValue,
    quick::quick_number,
    stamp::PARTS,
};
use super::{
    clock::{Clock, NOT_A_NUMBER},
    column::Column,
    delimiter::Delimiter,
    ending,
    plan::Plan,
    samples::{Samples, Unreadable},
    time::Time,
    trouble::{Trouble, Written},
};

/// What is to be done with a cell.
#[derive(Clone, Copy)]
enum Cell {
    Skip,
    Time,
    /// Beside the time: the date, the week, or parts of it. Which of them it is.
    Beside(usize),
    /// A channel's; which of the plan's columns it is.
    Channel(usize),
}

/// Reads all rows; `capacity` is about how many there are.
pub(super) fn read(mut rows: Lines, written: &Written, plan: &Plan, capacity: usize) -> Samples {
    let text = rows.rest();
    let mut reader = Reader::new(written, plan, capacity);
    for line in rows.by_ref() {
        reader.push(line);
        if reader.has_seen_enough() {
            break;
        }
    }
    if rows.rest().is_empty() {
        reader.leave_out_the_end(text);
    }
    reader.samples()
}

struct Reader<'a> {
    written: &'a Written<'a>,
    cells: Vec<Cell>,
    columns: &'a [Column],
    time: Time,
    clock: Clock,
    samples: Samples,
    /// The values of the row that is being read, and what in it is no value.
    row: Vec<f64>,
    unreadable: Vec<(usize, &'a str)>,
    row_number: usize,
    repeated_headers: Vec<usize>,
    without_time: usize,
    /// Rows that are no samples.
    troubles: Vec<(usize, Line<'a>, Trouble)>,
}

impl<'a> Reader<'a> {
    fn new(written: &'a Written<'a>, plan: &'a Plan, capacity: usize) -> Self {
        let mut cells = vec![Cell::Skip; written.width];
        for (which, column) in plan.time.beside().enumerate() {
            cells[column] = Cell::Beside(which);
        }
        if let Some(column) = plan.time.column() {
            cells[column] = Cell::Time;
        }
        for (at, column) in plan.columns.iter().enumerate() {
            cells[column.at] = Cell::Channel(at);
        }
        Self {
            written,
            cells,
            columns: &plan.columns,
            time: plan.time,
            clock: Clock::new(plan.time, written.marks),
            samples: Samples {
                time: Vec::with_capacity(capacity),
                values: plan
                    .columns
                    .iter()
                    .map(|_| Vec::with_capacity(capacity))
                    .collect(),
                lines: Vec::with_capacity(capacity),
                rows: Vec::with_capacity(capacity),
                unreadable: vec![None; plan.columns.len()],
                findings: Vec::new(),
                origin: None,
                faults: Vec::new(),
            },
            row: vec![f64::NAN; plan.columns.len()],
            unreadable: Vec::new(),
            row_number: 0,
            repeated_headers: Vec::new(),
            without_time: 0,
            troubles: Vec::new(),
        }
    }

    /// Whether there is more wrong than is told, and not at the end only.
    fn has_seen_enough(&self) -> bool {
        let last = self.samples.rows.last().map_or(0, |&row| row as usize);
        let told = self.troubles.get(CELLS_LISTED - 1);
        told.is_some_and(|(row, ..)| *row < last || self.troubles.len() > ending::LONGEST_FOOTER)
    }

    fn push(&mut self, line: Line<'a>) {
        self.row_number += 1;
        self.unreadable.clear();
        let time = self.sample(line);
        let is_odd = time.is_err() || !self.unreadable.is_empty();
        if is_odd && self.written.header.contains(&line.text.trim()) {
            self.row_number -= 1;
            self.repeated_headers.push(line.number);
            return;
        }
        match time {
            Ok(time) => self.keep(time, line),
            Err(Trouble::Empty) => self.row_number -= 1,
            Err(Trouble::NoTime) if self.samples.time.is_empty() && self.troubles.is_empty() => {
                self.without_time += 1;
            }
            Err(trouble) => self.troubles.push((self.row_number, line, trouble)),
        }
    }

    fn keep(&mut self, time: f64, line: Line) {
        let samples = &mut self.samples;
        for &(at, cell) in &self.unreadable {
            let unreadable = samples.unreadable[at].get_or_insert_with(|| Unreadable {
                row: self.row_number,
                line: line.number,
                cell: cell.trim().to_string(),
                count: 0,
            });
            unreadable.count += 1;
        }
        samples.time.push(time);
        samples.lines.push(line.number as u32);
        samples.rows.push(self.row_number as u32);
        for (values, value) in samples.values.iter_mut().zip(&self.row) {
            values.push(*value);
        }
    }

    /// Reads a line into [`Self::row`]; its time.
    fn sample(&mut self, line: Line<'a>) -> Result<f64, Trouble> {
        let &Written {
            delimiter,
            marks,
            width,
            ..
        } = self.written;
        let text = delimiter.without_ends(line.text);
        let bytes = text.as_bytes();
        // blanks part cells before they are read: a number ends with its cell
        let (end_of_number, is_parted) = match delimiter {
            Delimiter::Byte(delimiter) => (delimiter, false),
            Delimiter::Bars => (b'|', false),
            Delimiter::Blanks => (0, true),
        };
        let point = if marks.decimal == Decimal::Comma {
            b','
        } else {
            b'.'
        };
        let (mut time, mut time_cell, mut beside) = (None, "", [""; PARTS.len()]);
        let (mut from, mut count) = (0, 0);
        loop {
            let cell = self.cells.get(count).copied().unwrap_or(Cell::Skip);
            let mut rest = &bytes[from..];
            if is_parted {
                rest = &rest[..delimiter.cell_end(rest)];
            }
            let is_number = match cell {
                Cell::Channel(_) => !marks.has_thousands,
                Cell::Time => !marks.has_thousands && self.clock.takes_numbers(),
                Cell::Beside(_) | Cell::Skip => false,
            };
            let quick = if is_number {
                quick_number(rest, end_of_number, point)
            } else {
                None
            };
            let length = match (quick, cell) {
                (Some((value, length)), Cell::Channel(at)) => {
                    self.row[at] = value;
                    length
                }
                (Some((value, length)), _) => {
                    time = Some(self.clock.of_number(value));
                    length
                }
                (None, _) => {
                    let length = if is_parted {
                        rest.len()
                    } else {
                        delimiter.cell_end(rest)
                    };
                    let said = &text[from..from + length];
                    match cell {
                        Cell::Channel(at) => self.read_cell(at, said),
                        Cell::Time => time_cell = said,
                        Cell::Beside(which) => beside[which] = said,
                        Cell::Skip => {}
                    }
                    length
                }
            };
            count += 1;
            let end = from + length;
            if end >= bytes.len() {
                // a remark to a row may stand behind it
                let last = text[from..].trim();
                let is_nothing = last.is_empty() || last.starts_with('#');
                let is_behind_last = count == width + 1 && is_nothing;
                if count != width && !is_behind_last {
                    return Err(if ending::is_empty(text, delimiter) {
                        Trouble::Empty
                    } else {
                        Trouble::Length(count)
                    });
                }
                break;
            }
            let blanks = |byte: &&u8| byte.is_ascii_whitespace();
            from = if is_parted {
                end + bytes[end..].iter().take_while(blanks).count()
            } else {
                end + 1
            };
        }
        if self.time.column().is_none() && self.unreadable.len() == self.columns.len() {
            return Err(if ending::is_empty(text, delimiter) {
                Trouble::Empty
            } else {
                Trouble::Time(String::new(), NOT_A_NUMBER.to_string())
            });
        }
        match time {
            Some(time) => Ok(time),
            None => self
                .clock
                .read(time_cell, &beside)
                .map_err(|why| match why {
                    None if ending::is_empty(text, delimiter) => Trouble::Empty,
                    None => Trouble::NoTime,
                    Some(why) => Trouble::Time(time_cell.trim().to_string(), why),
                }),
        }
    }

    /// A cell that the quick way did not read.
    fn read_cell(&mut self, at: usize, cell: &'a str) {
        let said = unquote(cell);
        let is_no_value =
            |no_value: &NoValue| matches!(no_value, NoValue::Word(word) if word.trim() == said);
        let value = if self.columns[at].no_values.iter().any(is_no_value) {
            Some(f64::NAN)
        } else {
            number(cell, self.written.marks)
        };
        self.row[at] = value.unwrap_or(f64::NAN);
        if value.is_none() {
            self.unreadable.push((at, cell));
        }
    }

    /// Leaves out an incomplete last line, and what stands behind the last sample.
    fn leave_out_the_end(&mut self, text: &str) {
        let width = self.written.width;
        let last = self.samples.rows.last().map_or(0, |&row| row as usize);
        if self.written.is_cut_off {
            let is_short = |trouble: &(usize, Line, Trouble)| matches!(trouble.2, Trouble::Length(found) if found < width);
            if self
                .troubles
                .last()
                .is_some_and(|trouble| trouble.0 == self.row_number && is_short(trouble))
            {
                if let Some((_, line, _)) = self.troubles.pop() {
                    self.samples.findings.push(ending::incomplete(line.number));
                }
            } else if last == self.row_number
                && ending::has_fewer_digits(text, self.written.delimiter)
            {
                self.samples.findings.push(ending::incomplete(
                    self.samples.lines.last().map_or(0, |&line| line as usize),
                ));
                self.samples.drop_last();
            }
        }
        let last = self.samples.rows.last().map_or(0, |&row| row as usize);
        let begin = self
            .troubles
            .iter()
            .position(|(row, ..)| *row > last)
            .unwrap_or(self.troubles.len());
        let is_footer = last > 0
            && self.troubles[begin..]
                .iter()
                .all(|(_, line, trouble)| self.is_footer(line, trouble));
        let footer: Vec<_> = if is_footer {
            self.troubles.drain(begin..).collect()
        } else {
            Vec::new()
        };
        let footer: Vec<Line> = footer.into_iter().map(|(_, line, _)| line).collect();
        self.samples.findings.extend(ending::footer(&footer));
    }

    /// Whether a line that is no sample says something else: a word stands where time should be.
    fn is_footer(&self, line: &Line, trouble: &Trouble) -> bool {
        let cells = self.written.delimiter.cells(line.text);
        let cell = cells.get(self.time.column().unwrap_or(0)).or(cells.first());
        matches!(trouble, Trouble::Length(_) | Trouble::Time(..))
            && cell.is_some_and(|cell| ending::begins_with_word(cell))
    }

    fn samples(self) -> Samples {
        let mut samples = self.samples;
        samples.origin = self.clock.origin();
        let told = self.troubles.iter().take(CELLS_LISTED);
        let fault = |(row, line, trouble): &(usize, Line, Trouble)| {
            (*row, trouble.fault(*row, line, self.written))
        };
        samples.faults = told.map(fault).collect();
        samples
            .findings
            .extend(ending::repeated_header(&self.repeated_headers));
        samples
            .findings
            .extend(ending::no_time_yet(self.without_time));
        if let Time::Even { start, step } = self.time {
            for (k, time) in samples.time.iter_mut().enumerate() {
                *time = start + k as f64 * step;
            }
        }
        for (column, values) in self.columns.iter().zip(&mut samples.values) {
            column.apply(values);
        }
        samples
    }
}
