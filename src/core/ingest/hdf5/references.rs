//! Elements of arrays of structs, and cells, as MATLAB stores them: references to what they hold.

use super::super::code;
use super::super::mapping::element;
use super::super::text::quoted;
use super::attribute;
use super::damage::damaged;
use super::dataset::Dataset;
use super::datatype::Type;
use super::file::File;
use super::group;
use super::header::{self, Header};
use super::objects::Object;
use crate::flight::Fault;

/// What a path leads to.
pub(super) enum Followed<'a> {
    Object(Box<Object<'a>>),
    /// One field of all structs of an array, a row for each; and the columns of a row.
    Gathered(Vec<f64>, usize),
}

/// A code and a message.
type Why = (&'static str, String);

/// Members of a group that are looked at.
const MOST_MEMBERS: usize = 100_000;

fn of_fault(fault: Fault) -> Why {
    (code::DAMAGED_FILE, fault.message)
}

struct Following<'f, 'a> {
    file: &'f File<'a>,
    /// Bytes of headers, and of values, that may still be read.
    of_headers: usize,
    of_values: &'f mut usize,
}

/// Follows a path of MATLAB's, as `rec(2).alpha`, `c[2]` for the third cell, or `rec.alpha` for the field of every struct.
///
/// # Errors
/// It leads nowhere, or the file is damaged.
pub(super) fn follow<'a>(
    file: &File<'a>,
    path: &[String],
    room: &mut usize,
) -> Result<Followed<'a>, Why> {
    let mut following = Following {
        file,
        of_headers: header::room(file),
        of_values: room,
    };
    let mut here = following.object(Vec::new(), file.root).map_err(of_fault)?;
    // of an array of structs the element is said before the field, and stands behind it
    let mut said = None;
    for (at, name) in path.iter().enumerate() {
        let (field, next) = element(name);
        let member = following.member(&here, field)?;
        let Some(dataset) = member.references() else {
            if said.is_some_and(|which| which > 0) {
                let message = format!("{} is one struct, not several", quoted(&here.name()));
                return Err((code::UNKNOWN_SOURCE, message));
            }
            (here, said) = (member, next);
            continue;
        };
        let references = dataset.bytes(file, following.of_values).map_err(of_fault)?;
        let references = addresses(file, &references, dataset.kind.width());
        let (which, rest) = match said {
            Some(which) => (Some(which), next),
            None => (next, None),
        };
        let is_last = at + 1 == path.len();
        let which = match which {
            Some(which) if which < references.len() => which,
            None if references.len() == 1 => 0,
            None if is_last => return following.gather(&member, &references),
            _ => return Err(say_which(&member, references.len())),
        };
        let Some(address) = references[which] else {
            return Err(is_nothing(&member, which));
        };
        let named = path[..=at].to_vec();
        here = following.object(named, address).map_err(of_fault)?;
        said = rest;
    }
    match said {
        None | Some(0) => Ok(Followed::Object(Box::new(here))),
        Some(_) => Err(say_which(&here, 1)),
    }
}

fn say_which(object: &Object, count: usize) -> Why {
    let name = object.name();
    let message = format!(
        "{} is an array of {count}: say which, from rec(1).alpha to rec({count}).alpha of structs, from c[0] to c[{}] of cells",
        quoted(&name),
        count.saturating_sub(1)
    );
    (code::UNKNOWN_SOURCE, message)
}

fn is_nothing(object: &Object, which: usize) -> Why {
    let name = object.name();
    let message = format!(
        "{} has nothing at its element {}; map another source",
        quoted(&name),
        which + 1
    );
    (code::UNREADABLE_SOURCE, message)
}

/// The addresses in the bytes of references; `None` of one to nothing, which keeps its place.
fn addresses(file: &File, bytes: &[u8], width: usize) -> Vec<Option<u64>> {
    let all = bytes.chunks_exact(width.max(1));
    all.map(|bytes| {
        let bytes = bytes.iter().rev();
        let address = bytes.fold(0, |sum: u64, &byte| sum << 8 | u64::from(byte));
        (address != 0 && !file.is_undefined(address)).then_some(address)
    })
    .collect()
}

impl<'a> Object<'a> {
    /// The dataset of an object that has references to others.
    pub(super) fn references(&self) -> Option<&Dataset<'a>> {
        let dataset = self.dataset.as_ref();
        dataset.filter(|dataset| matches!(dataset.kind, Type::Reference(_)))
    }
}

impl<'a> Following<'_, 'a> {
    fn object(&mut self, path: Vec<String>, address: u64) -> Result<Object<'a>, Fault> {
        let header = Header::read(self.file, address, &mut self.of_headers)?;
        Ok(Object {
            path,
            dataset: Dataset::read(self.file, &header)?,
            class: attribute::text(self.file, &header, "MATLAB_class"),
            header,
        })
    }

    fn member(&mut self, of: &Object<'a>, name: &str) -> Result<Object<'a>, Why> {
        let path: Vec<String> = of.path.iter().cloned().chain([name.to_string()]).collect();
        if of.dataset.is_some() {
            let message = format!(
                "{} is not a struct; '{name}' cannot be taken from it",
                quoted(&of.name())
            );
            return Err((code::UNREADABLE_SOURCE, message));
        }
        let members = group::members(self.file, &of.header, MOST_MEMBERS).map_err(of_fault)?;
        match members.iter().find(|(member, _)| member == name) {
            Some((_, address)) => self.object(path, *address).map_err(of_fault),
            None => {
                let message = format!("there is no {}", quoted(&path.join("/")));
                Err((code::UNKNOWN_SOURCE, message))
            }
        }
    }

    /// One number, or a row of as many, of each.
    fn gather(&mut self, of: &Object<'a>, references: &[Option<u64>]) -> Result<Followed<'a>, Why> {
        let not_one = || {
            let message = format!(
                "{} is not numbers of one size in each of {} structs; name one of them, as rec(1).alpha",
                quoted(&of.name()),
                references.len()
            );
            (code::UNREADABLE_SOURCE, message)
        };
        let (mut values, mut columns) = (Vec::new(), None);
        for address in references {
            let address = address.ok_or_else(not_one)?;
            let object = self.object(of.path.clone(), address).map_err(of_fault)?;
            let dataset = object.dataset.as_ref().ok_or_else(not_one)?;
            let number = dataset.kind.number().ok_or_else(not_one)?;
            let is_text = object.class.as_deref() == Some("char");
            let is_empty = attribute::is_there(self.file, &object.header, "MATLAB_empty");
            let longer = dataset.dimensions.iter().filter(|size| **size != 1).count();
            if is_text || is_empty || longer > 1 {
                return Err(not_one());
            }
            let bytes = dataset.bytes(self.file, self.of_values).map_err(of_fault)?;
            let row: Vec<f64> = bytes.chunks_exact(number.width).map(number.read).collect();
            if *columns.get_or_insert(row.len()) != row.len() {
                return Err(not_one());
            }
            values.extend(row);
        }
        match columns {
            Some(columns) if columns > 0 => Ok(Followed::Gathered(values, columns)),
            _ => Err(of_fault(damaged("an array of structs is empty"))),
        }
    }
}
