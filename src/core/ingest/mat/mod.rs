//! MAT files of version 5, which MATLAB writes with `save -v6` and `save -v7`: matrices and structs of them.
//!
//! The format is described in MathWorks' "MAT-File Format" (R2019b). Only what a mapping asks for is unpacked; numbers
//! are read from where they stand. A file cannot ask for more memory than [`Limits`] allow.

mod array;
mod element;
mod variables;

use std::borrow::Cow;

use crate::flight::{Fault, Maneuver};

use super::{
    IngestError, Limits, code,
    fault::of_file,
    mapping::{Archive, Mapping},
    matrix::Matrix,
    text::{quoted, short_message},
};
use array::{Fields, Head};
use element::{Damage, Elements, Order, damaged};
use variables::Variables;

const HEADER: usize = 128;
const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";

/// Reads a MAT file as the mapping says.
///
/// # Errors
/// It is no MAT file of version 5, is damaged, or does not have what the mapping names; or there is no mapping: then the
/// message lists what the file has.
pub(super) fn read(
    bytes: &[u8],
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Maneuver, IngestError> {
    let order = byte_order(bytes)?;
    let variables = Variables::of(&bytes[HEADER..], order, limits)?;
    let mut file = File {
        order,
        variables,
        unpacked: None,
    };
    let Some(mapping) = mapping else {
        let message = format!(
            "a MAT file has no units; say with a mapping where time and channels are. This one has {}",
            file.contents()
        );
        return Err(of_file(code::MAPPING_NEEDED, message).into());
    };
    mapping.apply(&mut file, limits)
}

/// # Errors
/// It is another file; what to do about it.
fn byte_order(bytes: &[u8]) -> Result<Order, Fault> {
    if bytes.is_empty() {
        return Err(of_file(
            code::EMPTY_BODY,
            "the file is empty; send a MAT file",
        ));
    }
    let starts_at =
        |at: usize, what: &[u8]| bytes.get(at..).is_some_and(|rest| rest.starts_with(what));
    if starts_at(0, HDF5) || starts_at(512, HDF5) || starts_at(0, b"MATLAB 7.3") {
        let message =
            "a MAT file of version 7.3 (HDF5) is not read; save it with: save('file.mat', '-v7')";
        return Err(of_file(code::MAT_VERSION, message));
    }
    match bytes.get(124..HEADER) {
        Some([0x00, 0x01, b'I', b'M']) => Ok(Order::Little),
        Some([0x01, 0x00, b'M', b'I']) => Ok(Order::Big),
        _ if bytes.starts_with(b"MATLAB 5.0") => Err(damaged("its header is incomplete")),
        // version 4 begins with a number, later ones with text
        _ if bytes.len() >= 20 && bytes[..4].contains(&0) => {
            let message = "this may be a MAT file of version 4, which is not read; save it with: save('file.mat', '-v7')";
            Err(of_file(code::MAT_VERSION, message))
        }
        _ => {
            let message = "this is not a MAT file; send a matrix of numbers as text/plain, and other recordings as CSV or JSON";
            Err(of_file(code::NOT_A_MAT_FILE, message))
        }
    }
}

struct File<'a> {
    order: Order,
    variables: Variables<'a>,
    /// The variable that was unpacked last, and its elements.
    unpacked: Option<(usize, Cow<'a, [u8]>)>,
}

/// Variables are listed up to this many.
const LISTED: usize = 20;

impl File<'_> {
    fn contents(&self) -> String {
        let variables = self.variables.list().iter();
        let name = |head: &Head| format!("{} ({})", quoted(&head.name), head.description());
        listed(variables.map(|variable| name(&variable.head)))
    }

    /// Which variable is meant.
    fn find(&self, path: &[String]) -> Result<usize, (&'static str, String)> {
        let list = self.variables.list();
        let unknown = |why: String| Err((code::UNKNOWN_SOURCE, why));
        let Some(name) = path.first() else {
            let mut matrices = (0..list.len()).filter(|&at| list[at].head.is_numeric());
            return match (matrices.next(), matrices.next()) {
                (Some(at), None) => Ok(at),
                _ => unknown(format!(
                    "the file does not have exactly one matrix; name the variable; it has {}",
                    self.contents()
                )),
            };
        };
        let found = list.iter().position(|variable| variable.head.name == *name);
        found.map_or_else(
            || {
                unknown(format!(
                    "there is no variable '{name}'; the file has {}",
                    self.contents()
                ))
            },
            Ok,
        )
    }
}

impl Archive for File<'_> {
    fn matrix(&mut self, path: &[String]) -> Result<Matrix<'_>, (&'static str, String)> {
        let at = self.find(path)?;
        let of_fault = |fault: Fault| (code_of(&fault), fault.message);
        let of_damage = |why: Damage| of_fault(damaged(why));
        if self
            .unpacked
            .as_ref()
            .is_none_or(|&(unpacked, _)| unpacked != at)
        {
            // the one before goes first
            self.unpacked = None;
            let bytes = self.variables.unpack(at).map_err(of_fault)?;
            self.unpacked = Some((at, bytes));
        }
        let bytes = self.unpacked.as_ref().map_or(&[][..], |(_, bytes)| bytes);
        let order = self.order;
        let mut elements = Elements { rest: bytes, order };
        let mut head = Head::read(&mut elements).map_err(of_damage)?;
        let mut here = path.first().map_or(head.name.clone(), Clone::clone);
        for field in path.iter().skip(1) {
            if !head.is_struct() || head.count() != Some(1) {
                let message = format!(
                    "'{here}' is not a single struct but {}; '{field}' cannot be taken from it",
                    head.description()
                );
                return Err((code::UNREADABLE_SOURCE, message));
            }
            let fields = Fields::read(&mut elements).map_err(of_damage)?;
            let names = listed(fields.names.iter().map(|name| quoted(name)));
            let Some(value) = fields.value(field).map_err(of_damage)? else {
                return Err((
                    code::UNKNOWN_SOURCE,
                    format!("'{here}' has no field '{field}'; it has {names}"),
                ));
            };
            let rest = value.bytes;
            elements = Elements { rest, order };
            here = format!("{here}.{field}");
            if rest.is_empty() {
                return Err((
                    code::UNREADABLE_SOURCE,
                    format!("'{here}' is empty; map another source"),
                ));
            }
            head = Head::read(&mut elements).map_err(of_damage)?;
        }
        head.matrix(&mut elements).map_err(of_damage)?.map_err(|found| {
            let message = format!(
                "'{here}' is not a matrix of real numbers but {found}; save numbers, or name a field of a struct with a dot"
            );
            (code::UNREADABLE_SOURCE, message)
        })
    }
}

fn code_of(fault: &Fault) -> &'static str {
    if fault.code == code::TOO_MANY_VALUES {
        code::TOO_MANY_VALUES
    } else {
        code::DAMAGED_FILE
    }
}

fn listed(names: impl Iterator<Item = String>) -> String {
    let mut names = names.peekable();
    let mut list: Vec<String> = names.by_ref().take(LISTED).collect();
    if list.is_empty() {
        return "nothing".to_string();
    }
    if names.peek().is_some() {
        list.push("more".to_string());
    }
    short_message(&list.join(", "))
}
