//! The lines before the rows, and where in them what is said.

use super::super::{name::is_identifier, units::RecordedUnit};
use super::words::{named, unit_of};

/// Of one variable of the rows.
pub(super) struct Variable<'a> {
    pub(super) name: &'a str,
    /// `None` where the header says nothing of it.
    pub(super) unit: Option<&'a str>,
    pub(super) factor: f64,
    /// What stands for no value.
    pub(super) missing: Vec<f64>,
}

/// What the lines before the rows say.
pub(super) struct Header<'a> {
    pub(super) lines: usize,
    /// What is said of time.
    pub(super) time: &'a str,
    /// The unit of time in a row of units.
    pub(super) unit_below: Option<&'a str>,
    pub(super) variables: Vec<Variable<'a>>,
}

/// Why lines are no such header.
pub(super) struct Broken {
    /// From 1.
    pub(super) line: usize,
    pub(super) why: String,
}

/// The line that says how many variables there are, from 0: so it is the number, from 1, of the one that describes time.
pub(super) const COUNT: usize = 9;

/// Cells of a line, with commas or blanks between them.
pub(super) fn cells(line: &str) -> Vec<&str> {
    let cells = line.split(|c: char| c == ',' || c.is_whitespace());
    cells.filter(|cell| !cell.is_empty()).collect()
}

/// Whether the second line has a word, as the names of who made the data are.
pub(super) fn has_words(text: &str) -> bool {
    let line = text.lines().nth(1).unwrap_or_default();
    cells(line).iter().any(|cell| cell.parse::<f64>().is_err())
}

impl<'a> Header<'a> {
    /// # Errors
    /// The lines are not those of such a header: which, and why.
    pub(super) fn of(text: &'a str) -> Result<Self, Broken> {
        let broken = |at: usize, why: &str| Broken {
            line: at + 1,
            why: why.to_string(),
        };
        let first = cells(text.lines().next().unwrap_or_default());
        let count = first.first().and_then(|count| count.parse().ok());
        let count = count.ok_or_else(|| broken(0, "does not say how many lines it has"))?;
        let lines: Vec<&str> = text.lines().take(count).collect();
        if lines.len() < count {
            return Err(broken(0, "says that it has more lines than the file"));
        }
        let variables = lines.get(COUNT).and_then(|line| line.trim().parse().ok());
        let variables: usize = variables
            .ok_or_else(|| broken(COUNT, "does not say there how many variables it has"))?;
        let mut at = COUNT + 1;
        let factors = numbers(&lines, &mut at, variables)
            .ok_or_else(|| broken(at, "does not have there a factor for each variable"))?;
        let missing = numbers(&lines, &mut at, variables).ok_or_else(|| {
            broken(
                at,
                "does not say there for each variable what stands for no value",
            )
        })?;
        let end = at.saturating_add(variables);
        let said = lines
            .get(at..end)
            .ok_or_else(|| broken(at, "ends before the last variable"))?;
        let rest = &lines[end..];
        let flags = flags(rest);
        let variable = |at: usize| {
            let (name, unit) = named(said[at]);
            Variable {
                name,
                unit,
                factor: factors[at],
                missing: [&missing[at..=at], &flags].concat(),
            }
        };
        let mut header = Self {
            lines: count,
            time: lines[COUNT - 1],
            unit_below: None,
            variables: (0..variables).map(variable).collect(),
        };
        header.take_short_names(rest);
        Ok(header)
    }

    /// The last lines may be names as short as those of channels, and below them their units: only by these is such a line
    /// known from a comment.
    fn take_short_names(&mut self, lines: &[&'a str]) {
        let last = &lines[lines.len().saturating_sub(3)..];
        for pair in last.windows(2) {
            let (names, units) = (cells(pair[0]), cells(pair[1]));
            let are_as_many = [&names, &units]
                .iter()
                .all(|cells| cells.len() == self.variables.len() + 1);
            if !are_as_many || !names.iter().all(|name| is_identifier(name)) {
                continue;
            }
            let of_variables = self.variables.iter().zip(&units[1..]);
            let is_of_time = RecordedUnit::parse_time(units[0]).is_ok();
            if !is_of_time || !of_variables.into_iter().all(|(of, unit)| of.may_have(unit)) {
                continue;
            }
            self.unit_below = Some(units[0]);
            for (at, variable) in self.variables.iter_mut().enumerate() {
                variable.name = names[at + 1];
                variable.unit = variable.unit.or(unit_of(units[at + 1]));
            }
        }
    }
}

impl Variable<'_> {
    /// Whether a row of units may have this one for it: the same that the header says, or any where it says none.
    fn may_have(&self, below: &str) -> bool {
        let parsed = |unit: &str| RecordedUnit::parse(unit).ok().map(|unit| unit.unit());
        let below = unit_of(below).unwrap_or_default();
        match self.unit {
            Some(unit) => {
                unit.eq_ignore_ascii_case(below)
                    || (parsed(unit).is_some() && parsed(unit) == parsed(below))
            }
            None => parsed(below).is_some(),
        }
    }
}

/// So many numbers from a line on, in as many lines as they take; `at` becomes the line behind them.
fn numbers(lines: &[&str], at: &mut usize, count: usize) -> Option<Vec<f64>> {
    let mut numbers: Vec<f64> = Vec::new();
    while numbers.len() < count {
        let more = cells(lines.get(*at)?).into_iter().map(str::parse::<f64>);
        numbers.extend(more.collect::<Result<Vec<f64>, _>>().ok()?);
        *at += 1;
    }
    (numbers.len() == count).then_some(numbers)
}

/// What stands for a value beyond the limits of detection, as ICARTT's comments say it: `LLOD_FLAG: -8888`.
fn flags(lines: &[&str]) -> Vec<f64> {
    let flag = |line: &&str| {
        let (word, number) = line.split_once(':')?;
        let is_flag = ["LLOD_FLAG", "ULOD_FLAG"].iter();
        let is_flag = is_flag
            .into_iter()
            .any(|flag| word.trim().eq_ignore_ascii_case(flag));
        number.trim().parse().ok().filter(|_| is_flag)
    };
    lines.iter().filter_map(flag).collect()
}
