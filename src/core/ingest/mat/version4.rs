//! MAT files of version 4, which MATLAB writes with `save -v4`, and Scilab, Octave and older loggers too: matrices.

use super::super::{
    Limits, code,
    fault::of_file,
    mapping::Archive,
    matrix::Matrix,
    stored::{Order, Stored, stored},
    text::{LISTED, listed},
};
use crate::flight::Fault;

/// The matrices of a file.
pub(super) struct Version4<'a> {
    variables: Vec<Variable<'a>>,
}

struct Variable<'a> {
    name: String,
    rows: usize,
    columns: usize,
    bytes: &'a [u8],
    number: Stored,
    /// Why it is no matrix of real numbers, as `text`.
    other: Option<&'static str>,
}

const HEAD: usize = 20;

/// A header: how its numbers are stored, and what follows.
struct Head {
    order: Order,
    precision: u32,
    kind: u32,
    rows: usize,
    columns: usize,
    is_complex: bool,
    name: usize,
}

impl Head {
    /// `None` where the bytes are no header.
    fn read(bytes: &[u8]) -> Option<Self> {
        let bytes = bytes.get(..HEAD)?;
        let word = |at: usize, order: Order| order.u32(bytes.get(4 * at..)?);
        // thousands: 0 of little-endian numbers, 1 of big-endian ones
        let order = match (word(0, Order::Little)?, word(0, Order::Big)?) {
            (0..=52, _) => Order::Little,
            (_, 1000..=1052) => Order::Big,
            _ => return None,
        };
        let of = |at: usize| word(at, order);
        let kind = of(0)? % 1000;
        let (precision, kind) = (kind / 10, kind % 10);
        let size = |at| {
            of(at)
                .filter(|&size| size <= i32::MAX as u32)
                .map(|size| size as usize)
        };
        let is_known = precision <= 5 && kind <= 2 && of(3)? <= 1;
        is_known.then_some(Self {
            order,
            precision,
            kind,
            rows: size(1)?,
            columns: size(2)?,
            is_complex: of(3)? == 1,
            name: size(4).filter(|name| (2..=256).contains(name))?,
        })
    }

    fn number(&self) -> Stored {
        match self.precision {
            0 => stored!(f64, self.order),
            1 => stored!(f32, self.order),
            2 => stored!(i32, self.order),
            3 => stored!(i16, self.order),
            4 => stored!(u16, self.order),
            _ => stored!(u8, self.order),
        }
    }
}

/// Whether a file begins with a matrix of version 4 that has a name.
pub(in super::super) fn is_version_4(bytes: &[u8]) -> bool {
    Head::read(bytes).is_some_and(|head| name(bytes, &head).is_some())
}

/// The name behind a header.
fn name(bytes: &[u8], head: &Head) -> Option<String> {
    let name = bytes.get(HEAD..HEAD + head.name)?.strip_suffix(b"\0")?;
    let is_of_name = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
    (name.iter().all(is_of_name)).then(|| String::from_utf8_lossy(name).into_owned())
}

fn damaged(name: &str) -> Fault {
    let after = if name.is_empty() {
        String::new()
    } else {
        format!(" behind '{name}'")
    };
    let message = format!(
        "the MAT file (version 4) is damaged or cut off{after}; save it or upload it again"
    );
    of_file(code::DAMAGED_FILE, message)
}

impl<'a> Version4<'a> {
    /// # Errors
    /// It is damaged, or has more variables than the limit of columns.
    pub(super) fn of(bytes: &'a [u8], limits: &Limits) -> Result<Self, Fault> {
        let mut variables: Vec<Variable> = Vec::new();
        let mut rest = bytes;
        while !rest.is_empty() {
            let before = variables.last().map_or("", |variable| &variable.name);
            let head = Head::read(rest).ok_or_else(|| damaged(before))?;
            let name = name(rest, &head).ok_or_else(|| damaged(before))?;
            let number = head.number();
            let parts = if head.is_complex { 2 } else { 1 };
            let length = head.rows.checked_mul(head.columns);
            let length = length.and_then(|count| count.checked_mul(number.width * parts));
            let start = HEAD + head.name;
            let content = length.and_then(|length| rest.get(start..start.checked_add(length)?));
            let content = content.ok_or_else(|| damaged(&name))?;
            rest = &rest[start + content.len()..];
            let other = match head.kind {
                1 => Some("text"),
                2 => Some("a sparse matrix"),
                _ if head.is_complex => Some("complex"),
                _ => None,
            };
            variables.push(Variable {
                name,
                rows: head.rows,
                columns: head.columns,
                bytes: content,
                number,
                other,
            });
            limits.columns(variables.len()).map_or(Ok(()), Err)?;
        }
        Ok(Self { variables })
    }

    /// What there is, for a message.
    pub(super) fn contents(&self) -> String {
        let of = |variable: &Variable| {
            let Variable {
                name,
                rows,
                columns,
                ..
            } = variable;
            format!(
                "'{name}' ({rows}x{columns} {})",
                variable.other.unwrap_or("numbers")
            )
        };
        listed(self.variables.iter().map(of), LISTED)
    }
}

impl Archive for Version4<'_> {
    fn matrix(&mut self, path: &[String]) -> Result<Matrix<'_>, (&'static str, String)> {
        let all = &self.variables;
        let unknown = |why: &str| {
            (
                code::UNKNOWN_SOURCE,
                format!("{why}; the file has {}", self.contents()),
            )
        };
        let variable = match path {
            [] => {
                let mut matrices = all.iter().filter(|variable| variable.other.is_none());
                match (matrices.next(), matrices.next()) {
                    (Some(only), None) => only,
                    _ => {
                        return Err(unknown(
                            "the file does not have exactly one matrix; name the variable",
                        ));
                    }
                }
            }
            [name] => {
                let found = all.iter().find(|variable| variable.name == *name);
                found.ok_or_else(|| unknown(&format!("there is no variable '{name}'")))?
            }
            [name, ..] => {
                return Err(unknown(&format!(
                    "there are no structs in version 4: '{name}' has no fields"
                )));
            }
        };
        let Variable {
            name,
            rows,
            columns,
            bytes,
            number,
            other,
        } = variable;
        if let Some(other) = other {
            let message =
                format!("'{name}' is not a matrix of real numbers but {other}; save numbers");
            return Err((code::UNREADABLE_SOURCE, message));
        }
        let matrix = Matrix::of_bytes([*rows, *columns], bytes, *number);
        matrix.ok_or_else(|| (code::DAMAGED_FILE, damaged(name).message))
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::{Format, Mapping, fault::places, read_mapped};
    use super::*;
    use crate::flight::Maneuver;
    use crate::ingest::IngestError;

    fn matrix(order: u32, name: &str, columns: u32, values: &[f64]) -> Vec<u8> {
        let is_big = order == 1000;
        let rows = values.len() as u32 / columns;
        let words = [order, rows, columns, 0, name.len() as u32 + 1];
        let word = |word: u32| {
            if is_big {
                word.to_be_bytes()
            } else {
                word.to_le_bytes()
            }
        };
        let number = |value: &f64| {
            if is_big {
                value.to_be_bytes()
            } else {
                value.to_le_bytes()
            }
        };
        let mut bytes: Vec<u8> = words.into_iter().flat_map(word).collect();
        bytes.extend(name.as_bytes());
        bytes.push(0);
        bytes.extend(values.iter().flat_map(number));
        bytes
    }

    fn file(order: u32) -> Vec<u8> {
        let mut text = matrix(order, "note", 1, &[1.0]);
        let kind = if order == 0 { 0 } else { 3 };
        text[kind] += 1;
        let data = [1.0, 2.0, 3.0, -1.0, -2.0, -3.0];
        [
            matrix(order, "t", 1, &[0.0, 0.1, 0.2]),
            text,
            matrix(order, "data", 2, &data),
        ]
        .concat()
    }

    fn read(bytes: &[u8], from: &str) -> Result<Maneuver, IngestError> {
        let text = format!(
            r#"{{"time": {{"from": "t", "unit": "s"}}, "channels": {{"a": {{"from": "{from}", "unit": "-"}}}}}}"#
        );
        let mapping = Mapping::from_json(&text).unwrap();
        read_mapped(bytes, Format::Unstated, Some(&mapping), &Limits::default())
    }

    #[test]
    fn matrices_are_read_in_both_orders_of_bytes() {
        for order in [0, 1000] {
            let maneuver = read(&file(order), "data(:,2)").unwrap();
            assert_eq!(maneuver.channels()["a"].values, [-1.0, -2.0, -3.0]);
            assert_eq!(maneuver.time(), [0.0, 0.1, 0.2]);
        }
    }

    #[test]
    fn what_is_not_there_is_said_with_what_is() {
        let refused = |from: &str, expected: &str| {
            let error = read(&file(0), from).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        };
        refused(
            "x",
            "no variable 'x'; the file has 't' (3x1 numbers), 'note' (1x1 text), 'data' (3x2 numbers)",
        );
        refused("note", "but text");
        refused("data.x", "no structs in version 4");
        refused("(:,1)", "exactly one matrix");
        let unmapped = read_mapped(&file(0), Format::Mat, None, &Limits::default());
        assert_eq!(places(unmapped), ["mapping_needed "]);
    }

    #[test]
    fn damage_is_answered() {
        let good = file(0);
        for at in 1..good.len() {
            let cut = read_mapped(&good[..at], Format::Mat, None, &Limits::default());
            assert_eq!(places(cut).len(), 1);
            for with in [0, 0x7f, 0xff, good[at] ^ 1] {
                let mut damaged = good.clone();
                damaged[at] = with;
                let _ = read(&damaged, "data(:,2)");
            }
        }
        assert!(!is_version_4(b"0 0 0 0 0 0 0 0 0 0 0 0 0 0 0"));
    }
}
