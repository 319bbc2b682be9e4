//! Kinds of records, and what they hold.

use std::collections::HashMap;

use super::super::fault::{CELLS_LISTED, pointer};
use super::super::groups::{Channel, Group, Groups, Samples, Time};
use super::super::lines::{Line, Lines};
use super::super::note::{listed, note};
use super::super::text::quoted;
use super::super::{IngestError, Limits, code};
use super::clock;
use crate::flight::{Fault, Finding, FindingCode};

/// A kind of records: its columns with their units, and the cells by column.
struct Kind<'a> {
    name: &'a str,
    titles: Vec<&'a str>,
    units: Vec<&'a str>,
    cells: Vec<Vec<f64>>,
    /// Columns that hold something else than numbers.
    texts: Vec<bool>,
}

/// Columns of numbers; the first of a group are its times.
pub(super) struct Columns(Vec<Vec<f64>>);

impl Samples for Columns {
    fn values(&mut self, at: usize) -> Result<Vec<f64>, Fault> {
        Ok(self.0.get(at).cloned().unwrap_or_default())
    }
}

/// # Errors
/// Records have not the cells that their kind has: the first of them. Or there is more than the limits allow.
pub(super) fn scan(
    text: &str,
    limits: &Limits,
) -> Result<(Groups<Columns>, Vec<Finding>), IngestError> {
    let mut lines = Lines::of(text);
    let mut scan = Scan {
        limits,
        kinds: Vec::new(),
        by_name: HashMap::new(),
        columns: 0,
        values: 0,
        faults: Vec::new(),
        unknown: Vec::new(),
    };
    for line in lines.by_ref() {
        if line.text.trim() == "$DATA" {
            break;
        }
        scan.head(line)?;
    }
    let is_cut_off = !text.ends_with(['\n', '\r']);
    let mut incomplete = None;
    while let Some(line) = lines.next() {
        let is_last = is_cut_off && lines.rest().is_empty();
        if is_last && !scan.is_whole(line) {
            incomplete = Some(line.number);
            break;
        }
        scan.record(line)?;
        if scan.faults.len() == CELLS_LISTED {
            break;
        }
    }
    IngestError::refuse(std::mem::take(&mut scan.faults))?;
    let (groups, mut findings) = groups(scan.kinds);
    findings.extend(unknown(&scan.unknown));
    findings.extend(incomplete.map(|line| {
        let message = format!("the file ends within line {line}: this line is left out");
        let remedy = "nothing needs to be done where the device was switched off there";
        note(FindingCode::IncompleteLine, message, remedy)
    }));
    Ok((groups, findings))
}

struct Scan<'a, 'l> {
    limits: &'l Limits,
    kinds: Vec<Kind<'a>>,
    /// Where a kind stands among them.
    by_name: HashMap<&'a str, usize>,
    columns: usize,
    values: usize,
    faults: Vec<Fault>,
    /// Records of a kind that no line of the header has.
    unknown: Vec<&'a str>,
}

/// Kinds that are told of at most.
const MOST_UNKNOWN: usize = 100;

impl<'a> Scan<'a, '_> {
    /// A line of the header.
    fn head(&mut self, line: Line<'a>) -> Result<(), Fault> {
        let mut cells = line.text.split(',').map(str::trim);
        let word = cells.next().unwrap_or_default();
        let Some(name) = cells.next() else {
            return Ok(());
        };
        match word {
            "$COL" => {
                let titles: Vec<&str> = cells.collect();
                // a kind without columns counts, too
                self.columns = self.columns.saturating_add(titles.len().max(1));
                self.limits.columns(self.columns).map_or(Ok(()), Err)?;
                if self.by_name.insert(name, self.kinds.len()).is_some() {
                    return Err(twice(name, line.number));
                }
                self.kinds.push(Kind {
                    name,
                    units: vec![""; titles.len()],
                    cells: vec![Vec::new(); titles.len()],
                    texts: vec![false; titles.len()],
                    titles,
                });
            }
            "$UNIT" => {
                if let Some(&at) = self.by_name.get(name) {
                    self.kinds[at]
                        .units
                        .iter_mut()
                        .zip(cells)
                        .for_each(|(unit, said)| *unit = said);
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// Whether a record has all of its cells.
    fn is_whole(&self, line: Line) -> bool {
        let mut cells = line.text.split(',');
        let name = cells.next().and_then(|word| word.strip_prefix('$'));
        let at = name.and_then(|name| self.by_name.get(name));
        at.is_some_and(|&at| cells.count() == self.kinds[at].titles.len())
    }

    fn record(&mut self, line: Line<'a>) -> Result<(), Fault> {
        let (word, cells) = line.text.split_once(',').unwrap_or((line.text, ""));
        let name = word.trim().strip_prefix('$');
        let Some(&at) = name.and_then(|name| self.by_name.get(name)) else {
            if self.unknown.len() < MOST_UNKNOWN && !self.unknown.contains(&word) {
                self.unknown.push(word);
            }
            return Ok(());
        };
        let kind = &mut self.kinds[at];
        let count = cells.split(',').count();
        if count != kind.titles.len() {
            let message = format!(
                "line {}: this record has {count} cell(s) behind its kind, and {} are named in $COL,{}; write it anew, or leave it out",
                line.number,
                kind.titles.len(),
                kind.name
            );
            let place = pointer(["rows", &line.number.to_string()]);
            self.faults
                .push(Fault::new(place, code::ROW_LENGTH, message));
            return Ok(());
        }
        let rows = kind.cells.first().map_or(0, Vec::len) + 1;
        self.values = self.values.saturating_add(count);
        let too_much = [self.limits.samples(rows), self.limits.values(self.values)];
        if let Some(fault) = too_much.into_iter().flatten().next() {
            return Err(fault);
        }
        for ((values, is_text), cell) in kind
            .cells
            .iter_mut()
            .zip(&mut kind.texts)
            .zip(cells.split(','))
        {
            let cell = cell.trim();
            let value = cell.parse::<f64>().ok().filter(|value| value.is_finite());
            *is_text |= value.is_none() && !cell.is_empty();
            values.push(value.unwrap_or(f64::NAN));
        }
        Ok(())
    }
}

fn twice(name: &str, line: usize) -> Fault {
    let message = format!(
        "line {line}: the columns of {} are named a second time; take one of the two lines away",
        quoted(name)
    );
    Fault::new(
        pointer(["rows", &line.to_string()]),
        code::DUPLICATE_CHANNEL,
        message,
    )
}

fn groups(kinds: Vec<Kind>) -> (Groups<Columns>, Vec<Finding>) {
    let mut groups = Groups {
        groups: Vec::new(),
        samples: Columns(Vec::new()),
        left_out: Vec::new(),
    };
    let (mut spread, mut back) = (Vec::new(), Vec::new());
    for kind in kinds {
        let is_time = |title: &str| title.eq_ignore_ascii_case("time");
        let of_time = kind.titles.iter().position(|title| is_time(title));
        let of_time = of_time.filter(|&at| !kind.texts[at] && kind.units[at] == "s");
        let stamps = of_time
            .map(|at| kind.cells[at].as_slice())
            .unwrap_or_default();
        let times = clock::times(stamps);
        if times.spread > 0 {
            spread.push(format!("{} of {}", times.spread, kind.name));
        }
        if times.left_out > 0 {
            back.push(format!("{} of {}", times.left_out, kind.name));
        }
        let columns = &mut groups.samples.0;
        let mut group = Group {
            name: kind.name.to_string(),
            rows: times.records.len(),
            said: times.records.len(),
            time: match of_time {
                Some(_) => Time::Recorded(columns.len()),
                None => Time::Unknown,
            },
            channels: Vec::new(),
        };
        columns.push(times.seconds);
        for (at, cells) in kind.cells.into_iter().enumerate() {
            let title = kind.titles[at];
            if Some(at) == of_time || is_time(title) {
                continue;
            }
            if kind.texts[at] {
                let why = "it does not hold numbers".to_string();
                groups
                    .left_out
                    .push((format!("{}/{title}", kind.name), why));
                continue;
            }
            let unit = kind.units[at].to_string();
            let name = title.to_string();
            group.channels.push(Channel {
                name,
                unit,
                at: columns.len(),
            });
            let kept = times.records.iter().map(|&record| cells[record as usize]);
            columns.push(kept.collect());
        }
        if group.rows > 0 || of_time.is_none() {
            groups.groups.push(group);
        }
    }
    let spread = (!spread.is_empty()).then(|| {
        let message = format!(
            "records have the time of the one before them ({}): they are spread evenly up to the next time, and before a gap as far apart as usual",
            listed(spread.into_iter())
        );
        let remedy = "nothing needs to be done where the clock is coarser than the rate";
        note(FindingCode::RepeatedTime, message, remedy)
    });
    let back = (!back.is_empty()).then(|| {
        let message = format!(
            "records are not in the order of their times, or have none ({}): they are left out",
            listed(back.into_iter())
        );
        note(
            FindingCode::OutOfOrder,
            message,
            "look for a reset of the device's clock",
        )
    });
    (groups, spread.into_iter().chain(back).collect())
}

fn unknown(words: &[&str]) -> Option<Finding> {
    let message = format!(
        "records of kinds that the header does not have are left out: {}",
        listed(words.iter().map(|word| quoted(word)))
    );
    let remedy = "nothing needs to be done where they hold no channel that is wanted";
    (!words.is_empty()).then(|| note(FindingCode::LeftOut, message, remedy))
}
