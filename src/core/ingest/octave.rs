//! Variables as Octave writes them as text (`save -text`, its usual format): scalars, matrices, ranges and structs of them.
//!
//! The format is that of Octave's `libinterp/corefcn/ls-oct-text.cc`, as its manual (Simple File I/O) shows it.

use std::str::Lines;

use super::{
    IngestError, Limits, code,
    fault::of_file,
    mapping::{Archive, Mapping},
    matrix::Matrix,
    reading::Reading,
    text::{LISTED, listed, quoted},
};

/// Whether a file begins as Octave's do.
pub(super) fn is_octave(bytes: &[u8]) -> bool {
    bytes.starts_with(b"# Created by Octave")
}

/// Reads variables as the mapping says.
///
/// # Errors
/// It is damaged, or does not have what the mapping names; or there is no mapping: then the message lists what the file has.
pub(super) fn read(
    bytes: &[u8],
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    let text = String::from_utf8_lossy(bytes);
    let mut variables = Variables::of(&text, limits)?;
    let Some(mapping) = mapping else {
        let message = format!(
            "a file of Octave has no units; say with a mapping where time and channels are. This one has {}",
            variables.contents()
        );
        return Err(of_file(code::MAPPING_NEEDED, message).into());
    };
    mapping.apply(&mut variables, limits)
}

struct Variable {
    /// The fields on the way to it, from the name of the variable on.
    path: Vec<String>,
    /// What Octave calls it.
    kind: String,
    /// Row by row; none where it is not of numbers.
    values: Option<Vec<f64>>,
    columns: usize,
}

struct Variables {
    all: Vec<Variable>,
}

/// Structs in structs.
const DEEPEST: usize = 8;

impl Variables {
    fn of(text: &str, limits: &Limits) -> Result<Self, IngestError> {
        let mut reading = Text {
            lines: text.lines(),
            number: 0,
            all: Vec::new(),
            values: 0,
            limits,
        };
        while let Some(name) = reading.next_name() {
            reading.variable(vec![name])?;
        }
        Ok(Self { all: reading.all })
    }

    fn contents(&self) -> String {
        let all = self.all.iter().map(|variable| {
            let name = quoted(&variable.path.join("."));
            match &variable.values {
                Some(values) => {
                    let columns = variable.columns.max(1);
                    format!("{name} ({}x{columns})", values.len() / columns)
                }
                None => format!("{name} ({})", variable.kind),
            }
        });
        listed(all, LISTED)
    }
}

impl Archive for Variables {
    fn matrix(&mut self, path: &[String]) -> Result<Matrix<'_>, (&'static str, String)> {
        let mut fitting = self.all.iter().filter(|variable| match path {
            [] => variable
                .values
                .as_ref()
                .is_some_and(|values| values.len() > 1),
            path => variable.path == path,
        });
        let (Some(found), None) = (fitting.next(), fitting.next()) else {
            let message = format!(
                "there is no one variable {}; the file has {}",
                quoted(&path.join(".")),
                self.contents()
            );
            return Err((code::UNKNOWN_SOURCE, message));
        };
        match &found.values {
            Some(values) => Ok(Matrix::of_rows(values, found.columns)),
            None => {
                let message = format!(
                    "{} is not real numbers but {}; save numbers",
                    quoted(&found.path.join(".")),
                    found.kind
                );
                Err((code::UNREADABLE_SOURCE, message))
            }
        }
    }
}

/// The lines of a file from one variable to the next.
struct Text<'t, 'l> {
    lines: Lines<'t>,
    number: usize,
    all: Vec<Variable>,
    /// Numbers that were read.
    values: usize,
    limits: &'l Limits,
}

impl<'t> Text<'t, '_> {
    fn line(&mut self) -> Option<&'t str> {
        self.number += 1;
        self.lines.next()
    }

    /// The name in the next line that has one.
    fn next_name(&mut self) -> Option<String> {
        loop {
            if let Some(name) = said(self.line()?, "name") {
                return Some(name.to_string());
            }
        }
    }

    fn damaged(&self, why: &str) -> IngestError {
        let message = format!(
            "line {}: the file of Octave is damaged: {why}; save it again",
            self.number
        );
        of_file(code::DAMAGED_FILE, message).into()
    }

    /// What the next line says by this word.
    fn say(&mut self, word: &str) -> Result<&'t str, IngestError> {
        let line = self.line().and_then(|line| said(line, word));
        line.ok_or_else(|| self.damaged(&format!("'# {word}:' is missing")))
    }

    fn count(&mut self, word: &str) -> Result<usize, IngestError> {
        let text = self.say(word)?;
        text.parse()
            .map_err(|_| self.damaged(&format!("{} is no number of {word}", quoted(text))))
    }

    fn variable(&mut self, path: Vec<String>) -> Result<(), IngestError> {
        let kind = self.say("type")?.to_string();
        self.limits
            .columns(self.all.len() + 1)
            .map_or(Ok(()), Err)?;
        let (values, columns) = match kind.as_str() {
            "bool" => (Some(self.numbers(1)?), 1),
            kind if kind.ends_with("scalar") && !kind.contains("complex") => {
                (Some(self.numbers(1)?), 1)
            }
            "matrix" | "float matrix" => {
                let (rows, columns) = (self.count("rows")?, self.count("columns")?);
                (Some(self.numbers(rows.saturating_mul(columns))?), columns)
            }
            "range" | "double_range" => {
                self.line();
                let range = self.numbers(3)?;
                (Some(self.range(range[0], range[1], range[2])?), 1)
            }
            "scalar struct" => return self.fields(path),
            kind if kind.ends_with(" matrix") && !kind.starts_with("complex") => {
                self.count("ndims")?;
                let sizes = self.numbers(2)?;
                let (rows, columns) = (sizes[0] as usize, sizes[1] as usize);
                let values = self.numbers(rows.saturating_mul(columns))?;
                (Some(transposed(&values, rows)), columns)
            }
            _ => (None, 0),
        };
        self.all.push(Variable {
            path,
            kind,
            values,
            columns,
        });
        Ok(())
    }

    fn fields(&mut self, path: Vec<String>) -> Result<(), IngestError> {
        if path.len() == DEEPEST {
            return Err(self.damaged("structs are nested too deeply"));
        }
        self.count("ndims")?;
        self.numbers(2)?;
        for _ in 0..self.count("length")? {
            let name = self.next_name();
            let name = name.ok_or_else(|| self.damaged("a struct ends before its last field"))?;
            self.variable(path.iter().cloned().chain([name]).collect())?;
        }
        Ok(())
    }

    /// So many numbers, in as many lines as they take.
    fn numbers(&mut self, count: usize) -> Result<Vec<f64>, IngestError> {
        self.values = self.values.saturating_add(count);
        self.limits.values(self.values).map_or(Ok(()), Err)?;
        let mut numbers = Vec::new();
        while numbers.len() < count {
            let Some(line) = self.line() else {
                return Err(self.damaged("it ends within a variable"));
            };
            for word in line.split_whitespace() {
                let number = number(word);
                numbers.push(
                    number
                        .ok_or_else(|| self.damaged(&format!("{} is no number", quoted(word))))?,
                );
            }
        }
        match numbers.len() == count {
            true => Ok(numbers),
            false => Err(self.damaged("a line has more numbers than the variable")),
        }
    }

    /// All numbers of a range.
    fn range(&mut self, base: f64, limit: f64, step: f64) -> Result<Vec<f64>, IngestError> {
        let count = ((limit - base) / step * (1.0 + 3.0 * f64::EPSILON)).floor() + 1.0;
        if !count.is_finite() || count < 0.0 {
            return Err(self.damaged("a range has no end"));
        }
        self.values = self.values.saturating_add(count as usize);
        self.limits.values(self.values).map_or(Ok(()), Err)?;
        Ok((0..count as usize)
            .map(|at| base + step * at as f64)
            .collect())
    }
}

/// What a line says by a word: `# name: alpha`.
fn said<'t>(line: &'t str, word: &str) -> Option<&'t str> {
    let rest = line.strip_prefix("# ")?.strip_prefix(word)?;
    Some(rest.strip_prefix(':')?.trim())
}

fn number(word: &str) -> Option<f64> {
    match word {
        "NA" => Some(f64::NAN),
        word => word.parse().ok(),
    }
}

/// Column by column to row by row.
fn transposed(values: &[f64], rows: usize) -> Vec<f64> {
    let columns = values.len().checked_div(rows).unwrap_or(0);
    let places = 0..columns * rows;
    places
        .map(|at| values[at % columns * rows + at / columns])
        .collect()
}
