//! The lines of a file of Octave, one after the other.

use super::super::{IngestError, code, fault::of_file, text::quoted};

/// What is still to be read.
#[derive(Clone)]
pub(super) struct Text<'t> {
    rest: &'t [u8],
    /// Of the line that was read last, from 1.
    number: usize,
}

impl<'t> Text<'t> {
    pub(super) fn of(bytes: &'t [u8]) -> Self {
        Self {
            rest: bytes,
            number: 0,
        }
    }

    /// The next line; none of its words is a number where it is no text.
    pub(super) fn line(&mut self) -> Option<&'t str> {
        if self.rest.is_empty() {
            return None;
        }
        let end = memchr::memchr(b'\n', self.rest).unwrap_or(self.rest.len());
        let line = &self.rest[..end];
        self.rest = self.rest.get(end + 1..).unwrap_or_default();
        self.number += 1;
        Some(std::str::from_utf8(line).map_or("\u{fffd}", str::trim_end))
    }

    /// The next line, which stays the next.
    pub(super) fn peek(&self) -> Option<&'t str> {
        self.clone().line()
    }

    /// The name in the next line that has one.
    pub(super) fn next_name(&mut self) -> Option<&'t str> {
        loop {
            if let Some(name) = said(self.line()?, "name") {
                return Some(name);
            }
        }
    }

    pub(super) fn damaged(&self, why: &str) -> IngestError {
        let message = format!(
            "line {}: the file of Octave is damaged: {why}; save it again",
            self.number
        );
        of_file(code::DAMAGED_FILE, message).into()
    }

    /// What the next line says by this word.
    pub(super) fn say(&mut self, word: &str) -> Result<&'t str, IngestError> {
        let line = self.line().and_then(|line| said(line, word));
        line.ok_or_else(|| self.damaged(&format!("'# {word}:' is missing")))
    }

    pub(super) fn count(&mut self, word: &str) -> Result<usize, IngestError> {
        let text = self.say(word)?;
        text.parse()
            .map_err(|_| self.damaged(&format!("{} is no number of {word}", quoted(text))))
    }

    /// Whether the next line says something by this word.
    pub(super) fn says(&self, word: &str) -> bool {
        self.peek().is_some_and(|line| said(line, word).is_some())
    }

    /// The sizes behind `# ndims:`, where they are next.
    pub(super) fn sizes(&mut self) -> Result<Option<Vec<usize>>, IngestError> {
        if !self.says("ndims") {
            return Ok(None);
        }
        let count = self.count("ndims")?;
        let line = self.line().unwrap_or_default();
        let sizes = line.split_whitespace().map(str::parse);
        let sizes: Option<Vec<usize>> = sizes.collect::<Result<_, _>>().ok();
        let sizes = sizes.filter(|sizes| sizes.len() == count && count > 1);
        sizes.map(Some).ok_or_else(|| {
            let why = format!("{} are no {count} sizes", quoted(line));
            self.damaged(&why)
        })
    }

    /// So many words, in as many lines as they take.
    pub(super) fn words(
        &mut self,
        count: usize,
        mut each: impl FnMut(&str) -> bool,
    ) -> Result<(), IngestError> {
        let mut found = 0;
        while found < count {
            let Some(line) = self.line() else {
                return Err(self.damaged("it ends within a variable"));
            };
            for word in line.split_whitespace() {
                found += 1;
                if !each(word) {
                    return Err(self.damaged(&format!("{} is no number", quoted(word))));
                }
            }
        }
        match found == count {
            true => Ok(()),
            false => Err(self.damaged("a line has more numbers than the variable")),
        }
    }

    /// Passes over so many bytes, and to the end of their line.
    pub(super) fn pass(&mut self, bytes: usize) -> Result<(), IngestError> {
        if bytes > self.rest.len() {
            return Err(self.damaged("it ends within a text"));
        }
        self.number += memchr::memchr_iter(b'\n', &self.rest[..bytes]).count();
        self.rest = &self.rest[bytes..];
        self.line();
        Ok(())
    }
}

/// What a line says by a word: `# name: alpha`.
fn said<'t>(line: &'t str, word: &str) -> Option<&'t str> {
    let rest = line.strip_prefix("# ")?.strip_prefix(word)?;
    Some(rest.strip_prefix(':')?.trim())
}

/// A number as Octave writes it.
pub(super) fn number(word: &str) -> Option<f64> {
    match word {
        "NA" => Some(f64::NAN),
        word => word.parse().ok(),
    }
}
