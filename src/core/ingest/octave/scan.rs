//! One pass over a file: every variable, read where it is a matrix of real numbers, else passed over.

use super::super::{IngestError, Limits, text::quoted};
use super::kind::{Kind, is_complex};
use super::text::{Text, number};
use super::variable::Variable;

pub(super) struct Scan<'t, 'l> {
    text: Text<'t>,
    pub(super) all: Vec<Variable>,
    /// Variables of kinds that are not known, and why they are left out.
    pub(super) left_out: Vec<(String, String)>,
    /// Numbers that were kept.
    values: usize,
    /// Values in values that are being read.
    depth: usize,
    limits: &'l Limits,
}

/// Names on a path that a mapping can name.
const LONGEST_PATH: usize = 8;
/// Values in values.
const DEEPEST: usize = 64;

/// What a value has in it: numbers row by row and how many columns, or what it is called.
type Read = Result<(Vec<f64>, usize), String>;

impl<'t, 'l> Scan<'t, 'l> {
    /// # Errors
    /// The file is damaged, or has more than the limits allow.
    pub(super) fn of(bytes: &'t [u8], limits: &'l Limits) -> Result<Self, IngestError> {
        let mut scan = Self {
            text: Text::of(bytes),
            all: Vec::new(),
            left_out: Vec::new(),
            values: 0,
            depth: 0,
            limits,
        };
        while let Some(name) = scan.text.next_name() {
            scan.variable(Some(vec![name.to_string()]))?;
        }
        Ok(scan)
    }

    /// A value behind its name. One without a path is passed over.
    fn variable(&mut self, path: Option<Vec<String>>) -> Result<(), IngestError> {
        if self.depth == DEEPEST {
            return Err(self.text.damaged("values are nested too deeply"));
        }
        self.depth += 1;
        let done = self.value(path);
        self.depth -= 1;
        done
    }

    fn value(&mut self, path: Option<Vec<String>>) -> Result<(), IngestError> {
        let word = self.text.say("type")?;
        let word = word.strip_prefix("global ").unwrap_or(word);
        let path = path.filter(|path| path.len() <= LONGEST_PATH);
        let is_kept = path.is_some() && !is_complex(word);
        let read = match Kind::of(word) {
            Kind::Scalar => self.scalar(is_kept)?,
            Kind::Matrix => self.matrix(is_kept)?,
            Kind::Sparse => self.sparse(is_kept)?,
            Kind::Diagonal => self.diagonal(is_kept)?,
            Kind::Permutation => self.permutation()?,
            Kind::Range => self.range(is_kept)?,
            Kind::Text => self.characters()?,
            Kind::Cell => self.cell()?,
            Kind::Function => self.function()?,
            Kind::Structs => self.fields(None).map(|()| Err(String::new()))?,
            Kind::Unknown => self.unknown(path.as_deref(), word),
            Kind::Struct => return self.fields(path),
            Kind::Index => {
                self.text.next_name();
                return self.variable(path);
            }
        };
        match path {
            Some(path) => self.push(path, word, read),
            None => Ok(()),
        }
    }

    fn push(&mut self, path: Vec<String>, word: &str, read: Read) -> Result<(), IngestError> {
        let too_many = self.limits.columns(self.all.len() + 1);
        too_many.map_or(Ok(()), Err)?;
        let (values, columns, why) = match read {
            Ok((values, columns)) => (Some(values), columns, String::new()),
            Err(why) => (None, 0, why),
        };
        self.all.push(Variable {
            path,
            kind: format!("{why} {word}").trim().to_string(),
            values,
            columns,
        });
        Ok(())
    }

    /// So many numbers, or none of them where they are not kept.
    fn numbers(&mut self, count: usize, is_kept: bool) -> Result<Option<Vec<f64>>, IngestError> {
        if !is_kept {
            return self.text.words(count, |_| true).map(|()| None);
        }
        self.take(count)?;
        let mut numbers = Vec::new();
        self.text.words(count, |word| {
            let number = number(word);
            numbers.extend(number);
            number.is_some()
        })?;
        Ok(Some(numbers))
    }

    fn has_room(&self, count: usize) -> bool {
        let values = self.values.saturating_add(count);
        self.limits.values(values).is_none()
    }

    /// Takes room for so many numbers more.
    fn take(&mut self, count: usize) -> Result<(), IngestError> {
        self.values = self.values.saturating_add(count);
        self.limits.values(self.values).map_or(Ok(()), Err)?;
        Ok(())
    }

    fn scalar(&mut self, is_kept: bool) -> Result<Read, IngestError> {
        let numbers = self.numbers(1, is_kept)?;
        Ok(numbers.map(|numbers| (numbers, 1)).ok_or(String::new()))
    }

    /// Row by row behind `# rows:`; column by column behind `# ndims:`.
    fn matrix(&mut self, is_kept: bool) -> Result<Read, IngestError> {
        let Some(sizes) = self.text.sizes()? else {
            let (rows, columns) = (self.text.count("rows")?, self.text.count("columns")?);
            let numbers = self.numbers(rows.saturating_mul(columns), is_kept)?;
            return Ok(numbers.map(|values| (values, columns)).ok_or(String::new()));
        };
        let product = |product: usize, size: &usize| product.saturating_mul(*size);
        let shape = shape(&sizes);
        let count = sizes.iter().fold(1, product);
        let numbers = self.numbers(count, is_kept && shape.is_some())?;
        Ok(match (shape, numbers) {
            (Some([rows, columns]), Some(values)) => Ok((transposed(&values, rows), columns)),
            _ => Err(sizes_of(&sizes)),
        })
    }

    /// A row, a column and a value in each line; where none stands is zero.
    fn sparse(&mut self, is_kept: bool) -> Result<Read, IngestError> {
        let count = self.text.count("nnz")?;
        let (rows, columns) = (self.text.count("rows")?, self.text.count("columns")?);
        let size = rows.saturating_mul(columns);
        let is_too_large = !self.has_room(size);
        if !is_kept || is_too_large {
            self.numbers(count.saturating_mul(3), false)?;
            return Ok(Err(sizes_of(&[rows, columns])));
        }
        let triples = self.numbers(count.saturating_mul(3), true)?;
        self.take(size)?;
        let mut values = vec![0.0; size];
        for triple in triples.unwrap_or_default().chunks_exact(3) {
            // a place that is none is beyond all
            let (row, column) = (triple[0] as usize, triple[1] as usize);
            let is_within = (1..=rows).contains(&row) && (1..=columns).contains(&column);
            let place = is_within.then(|| (row - 1) * columns + column - 1);
            match place.and_then(|place| values.get_mut(place)) {
                Some(value) => *value = triple[2],
                None => return Err(self.text.damaged("a value is outside of its sparse matrix")),
            }
        }
        Ok(Ok((values, columns)))
    }

    fn diagonal(&mut self, is_kept: bool) -> Result<Read, IngestError> {
        let (rows, columns) = (self.text.count("rows")?, self.text.count("columns")?);
        let size = rows.saturating_mul(columns);
        let is_too_large = !self.has_room(size);
        let diagonal = self.numbers(rows.min(columns), is_kept && !is_too_large)?;
        let Some(diagonal) = diagonal else {
            return Ok(Err(sizes_of(&[rows, columns])));
        };
        self.take(size)?;
        let mut values = vec![0.0; size];
        for (at, value) in diagonal.into_iter().enumerate() {
            values[at * columns + at] = value;
        }
        Ok(Ok((values, columns)))
    }

    fn permutation(&mut self) -> Result<Read, IngestError> {
        let count = self.text.count("size")?;
        self.text.say("orient")?;
        self.numbers(count, false)?;
        Ok(Err(sizes_of(&[count, count])))
    }

    /// All numbers of a range; of one whose increment is 0 the second number is how many there are.
    fn range(&mut self, is_kept: bool) -> Result<Read, IngestError> {
        self.text.line();
        let said = self.text.line().unwrap_or_default();
        let said: Option<Vec<f64>> = said.split_whitespace().map(number).collect();
        let [base, limit, step, ..] = said.unwrap_or_default()[..] else {
            return Err(self
                .text
                .damaged("a range has no base, limit and increment"));
        };
        let count = match step == 0.0 {
            true => limit,
            false => ((limit - base) / step * (1.0 + 3.0 * f64::EPSILON)).floor() + 1.0,
        };
        if !count.is_finite() {
            return Err(self.text.damaged("a range has no end"));
        }
        if !is_kept {
            return Ok(Err(String::new()));
        }
        self.take(count as usize)?;
        let at = |at: usize| {
            let value = base + step * at as f64;
            match step {
                step if step > 0.0 => value.min(limit),
                step if step < 0.0 => value.max(limit),
                _ => base,
            }
        };
        Ok(Ok(((0..count as usize).map(at).collect(), 1)))
    }

    /// Rows of text, each of so many bytes, whatever these are.
    fn characters(&mut self) -> Result<Read, IngestError> {
        if let Some(sizes) = self.text.sizes()? {
            let bytes = sizes
                .iter()
                .try_fold(1usize, |all, &size| all.checked_mul(size));
            self.text.pass(bytes.unwrap_or(usize::MAX))?;
            return Ok(Err(String::new()));
        }
        let rows = match self.text.says("elements") {
            true => self.text.count("elements")?,
            false => 1,
        };
        for _ in 0..rows {
            let length = self.text.count("length")?;
            self.text.pass(length)?;
        }
        Ok(Err(String::new()))
    }

    fn cell(&mut self) -> Result<Read, IngestError> {
        let sizes = match self.text.sizes()? {
            Some(sizes) => sizes,
            None => vec![self.text.count("rows")?, self.text.count("columns")?],
        };
        let count = sizes
            .iter()
            .try_fold(1usize, |all, &size| all.checked_mul(size));
        for _ in 0..count.unwrap_or(usize::MAX) {
            if self.text.next_name().is_none() {
                return Err(self
                    .text
                    .damaged("a cell array ends before its last element"));
            }
            self.variable(None)?;
        }
        Ok(Err(sizes_of(&sizes)))
    }

    /// Of a struct with a path the fields have paths, too.
    fn fields(&mut self, path: Option<Vec<String>>) -> Result<(), IngestError> {
        if self.text.says("classname") {
            self.text.line();
        }
        self.text.sizes()?;
        for _ in 0..self.text.count("length")? {
            let Some(name) = self.text.next_name() else {
                return Err(self.text.damaged("a struct ends before its last field"));
            };
            let path = path.as_ref();
            let path = path.map(|path| [&path[..], &[name.to_string()]].concat());
            self.variable(path)?;
        }
        Ok(())
    }

    /// Its text, and the variables that it has taken along.
    fn function(&mut self) -> Result<Read, IngestError> {
        while let Some(line) = self.text.peek() {
            if self.text.says("length") {
                for _ in 0..self.text.count("length")? {
                    self.text.next_name();
                    self.variable(None)?;
                }
                break;
            }
            if line.is_empty() || self.text.says("name") {
                break;
            }
            self.text.line();
        }
        Ok(Err(String::new()))
    }

    /// All up to the next name.
    fn unknown(&mut self, path: Option<&[String]>, word: &str) -> Read {
        while self.text.peek().is_some() && !self.text.says("name") {
            self.text.line();
        }
        let name = path.map_or("a value in another".to_string(), |path| {
            quoted(&path.join("."))
        });
        let why = format!("{} is a kind that is not known", quoted(word));
        self.left_out.push((name, why));
        Err(String::new())
    }
}

/// Rows and columns. Sides of length 1 of an array of more dimensions are left out, as `squeeze` does it.
fn shape(sizes: &[usize]) -> Option<[usize; 2]> {
    if let [rows, columns] = *sizes {
        return Some([rows, columns]);
    }
    let long: Vec<usize> = sizes.iter().copied().filter(|size| *size != 1).collect();
    match long[..] {
        [] => Some([1, 1]),
        [length] => Some([length, 1]),
        [rows, columns] => Some([rows, columns]),
        _ => None,
    }
}

/// `2x3x4`
fn sizes_of(sizes: &[usize]) -> String {
    let sizes: Vec<String> = sizes.iter().map(ToString::to_string).collect();
    sizes.join("x")
}

/// Column by column to row by row.
fn transposed(values: &[f64], rows: usize) -> Vec<f64> {
    let columns = values.len().checked_div(rows).unwrap_or(0);
    let places = 0..columns * rows;
    places
        .map(|at| values[at % columns * rows + at / columns])
        .collect()
}
