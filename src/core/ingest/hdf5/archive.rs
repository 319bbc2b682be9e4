//! A file as a mapping sees it: datasets by path, read when they are asked for.

use std::collections::BTreeSet;

use super::super::mapping::Archive;
use super::super::matrix::Matrix;
use super::super::name::identifier_like;
use super::super::stored::Stored;
use super::super::text::{LISTED, listed, quoted};
use super::super::{Limits, code, note};
use super::attribute;
use super::dataset::Dataset;
use super::datatype::{Field, Type};
use super::file::File;
use super::objects::Object;
use super::packing::Packing;
use super::references::{self, Followed};
use super::room;
use crate::flight::{Fault, Finding, FindingCode};

pub(in super::super) struct Datasets<'a> {
    file: File<'a>,
    /// Those of the file, and behind them those that references led to.
    objects: Vec<Object<'a>>,
    /// How many are of the file.
    listed: usize,
    /// Bytes that may still be read.
    room: usize,
    /// What was asked for last: as it is stored, or row by row.
    bytes: Vec<u8>,
    values: Vec<f64>,
    /// Columns of the values that were gathered from an array of structs.
    columns: usize,
    /// The table that was read last, and its bytes: all of its fields are in them.
    table: Option<(usize, Vec<u8>)>,
    /// Names of datasets whose numbers were packed.
    packed: BTreeSet<String>,
}

/// A code and a message.
type Why = (&'static str, String);

/// What MATLAB calls numbers.
const NUMERIC: [&str; 11] = [
    "double", "single", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64",
    "logical",
];

impl<'a> Datasets<'a> {
    pub(super) fn of(file: File<'a>, objects: Vec<Object<'a>>, limits: &Limits) -> Self {
        Self {
            file,
            listed: objects.len(),
            objects,
            room: room::of(limits),
            bytes: Vec::new(),
            values: Vec::new(),
            columns: 1,
            table: None,
            packed: BTreeSet::new(),
        }
    }

    /// That numbers were packed, and are read as they are meant.
    pub(super) fn unpacked(&self) -> Option<Finding> {
        let names = note::listed(self.packed.iter().map(|name| quoted(name)));
        let message = format!(
            "the file says factors, offsets or missing values of {names} (scale_factor, add_offset, _FillValue, missing_value): they were applied"
        );
        let remedy = "leave them out of the mapping";
        (!self.packed.is_empty()).then(|| note::note(FindingCode::Recognised, message, remedy))
    }

    /// What there is, for a message.
    pub(super) fn contents(&self) -> String {
        let datasets = self.objects[..self.listed]
            .iter()
            .filter(|object| object.dataset.is_some());
        let name =
            |object: &Object| format!("{} ({})", quoted(&object.name()), object.description());
        listed(datasets.map(name), LISTED)
    }

    /// The object at a path, and the field of a table that the last name on it may mean.
    fn find<'p>(&self, path: &'p [String]) -> Result<(usize, Option<&'p String>), Why> {
        let unknown = |why: String| (code::UNKNOWN_SOURCE, why);
        let Some((last, before)) = path.split_last() else {
            let is_matrix = |object: &Object| {
                let dataset = object.dataset.as_ref();
                dataset.is_some_and(|dataset| {
                    dataset.kind.number().is_some()
                        && dataset.count().is_some_and(|count| count > 1)
                })
            };
            let mut matrices = (0..self.listed).filter(|&at| is_matrix(&self.objects[at]));
            return match (matrices.next(), matrices.next()) {
                (Some(at), None) => Ok((at, None)),
                _ => Err(unknown(format!(
                    "the file does not have exactly one dataset of numbers; name it; the file has {}",
                    self.contents()
                ))),
            };
        };
        let at = |path: &[String]| self.objects.iter().position(|object| object.is_at(path));
        if let Some(at) = at(path) {
            return Ok((at, None));
        }
        let is_table = |at: &usize| {
            let dataset = self.objects[*at].dataset.as_ref();
            dataset.is_some_and(|dataset| matches!(dataset.kind, Type::Compound(..)))
        };
        match at(before).filter(is_table) {
            Some(at) => Ok((at, Some(last))),
            None => Err(unknown(format!(
                "there is no dataset {}; the file has {}",
                quoted(&path.join(".")),
                self.contents()
            ))),
        }
    }
}

impl Datasets<'_> {
    /// The object that a path leads to along references, or nothing where it leads to the field of all structs of an array:
    /// then the values are those. `why` the path leads to nothing else.
    fn follow(&mut self, path: &[String], why: Option<Why>) -> Result<Option<usize>, Why> {
        match references::follow(&self.file, path, &mut self.room) {
            Ok(Followed::Object(object)) => {
                self.objects.push(Object {
                    path: path.to_vec(),
                    ..*object
                });
                Ok(Some(self.objects.len() - 1))
            }
            Ok(Followed::Gathered(values, columns)) => {
                (self.values, self.columns) = (values, columns);
                Ok(None)
            }
            // of a path without brackets, what the file has tells more
            Err(of_references) => Err(match path.iter().any(|name| name.contains(['(', '['])) {
                true => of_references,
                false => why.unwrap_or(of_references),
            }),
        }
    }
}

impl Object<'_> {
    /// Whether a path as a mapping writes it leads to it.
    fn is_at(&self, path: &[String]) -> bool {
        let is_same =
            |(one, other): (&String, &String)| one == other || identifier_like(one) == *other;
        self.path.len() == path.len() && self.path.iter().zip(path).all(is_same)
    }
}

/// Attributes in which programs say a unit: netCDF's, and those of others.
const UNITS: [&str; 4] = ["units", "unit", "Units", "Unit"];

impl Archive for Datasets<'_> {
    fn unit(&self, path: &[String]) -> Option<String> {
        let (at, _) = self.find(path).ok()?;
        let header = &self.objects[at].header;
        let mut said = UNITS
            .iter()
            .filter_map(|name| attribute::text(&self.file, header, name));
        said.find(|unit| !unit.is_empty())
    }

    fn matrix(&mut self, path: &[String]) -> Result<Matrix<'_>, Why> {
        let (at, field) = match self.find(path) {
            Ok((at, field)) if self.objects[at].references().is_none() => (at, field),
            found => match self.follow(path, found.err())? {
                Some(at) => (at, None),
                None => return Ok(Matrix::of_rows(&self.values, self.columns)),
            },
        };
        let object = &self.objects[at];
        let unreadable = |why: String| {
            let message = format!("{} {why}", quoted(&object.name()));
            Err((code::UNREADABLE_SOURCE, message))
        };
        let Some(dataset) = &object.dataset else {
            return unreadable("is a group, not a dataset; name one that is in it".to_string());
        };
        if let Some(class) = object.class.as_deref()
            && !NUMERIC.contains(&class)
        {
            return unreadable(format!(
                "is not a matrix of numbers but {}; {}",
                object.description(),
                remedy(class)
            ));
        }
        let is_empty = attribute::is_there(&self.file, &object.header, "MATLAB_empty");
        if is_empty || dataset.count() == Some(0) {
            return unreadable("is empty; map another source".to_string());
        }
        let of_fault = |fault: Fault| (code_of(&fault), fault.message);
        if let Some(name) = field {
            let field = InTable::find(dataset, name)?;
            if self.table.as_ref().is_none_or(|(of, _)| *of != at) {
                self.table = None;
                let bytes = dataset.bytes(&self.file, &mut self.room);
                self.table = Some((at, bytes.map_err(of_fault)?));
            }
            let bytes = self.table.as_ref().map_or(&[][..], |(_, bytes)| bytes);
            self.values = field.values(bytes);
            let columns = field.columns;
            return Ok(Matrix::of_rows(&self.values, columns));
        }
        let Some(number) = dataset.kind.number() else {
            return unreadable(format!(
                "does not hold numbers but {}; {}",
                dataset.kind.name(),
                match &dataset.kind {
                    Type::Compound(fields, _) =>
                        format!("name one of its fields: {}", names(fields)),
                    _ => "write it as a dataset of numbers".to_string(),
                }
            ));
        };
        let Some([rows, columns]) = shape(&dataset.dimensions) else {
            return unreadable(format!(
                "is {}: it has more than two dimensions",
                object.description()
            ));
        };
        let by_columns = object.class.is_some();
        let packing = Packing::of(&self.file, &object.header).filter(|_| !by_columns);
        let bytes = dataset
            .bytes(&self.file, &mut self.room)
            .map_err(of_fault)?;
        if let Some(packing) = packing {
            self.packed.insert(object.name());
            let stored = bytes.chunks_exact(number.width).map(number.read);
            self.values = stored.map(|stored| packing.unpacked(stored)).collect();
            return Ok(Matrix::of_rows(&self.values, columns));
        }
        if by_columns || columns == 1 {
            // MATLAB's first dimension is the last one here
            let shape = if columns == 1 {
                [rows, 1]
            } else {
                [columns, rows]
            };
            self.bytes = bytes;
            let matrix = Matrix::of_bytes(shape, &self.bytes, number);
            return matrix.ok_or((
                code::DAMAGED_FILE,
                "a dataset is not as long as it says".to_string(),
            ));
        }
        self.values = bytes.chunks_exact(number.width).map(number.read).collect();
        Ok(Matrix::of_rows(&self.values, columns))
    }
}

/// Where the numbers of a field are in the rows of a table.
struct InTable {
    at: usize,
    number: Stored,
    columns: usize,
    /// Bytes of a row.
    width: usize,
}

impl InTable {
    fn find(dataset: &Dataset, name: &str) -> Result<Self, Why> {
        let Type::Compound(fields, width) = &dataset.kind else {
            return Err((code::UNKNOWN_SOURCE, "it is no table".to_string()));
        };
        let is_called = |field: &&Field| field.name == name || identifier_like(&field.name) == name;
        let Some(field) = fields.iter().find(is_called) else {
            let message = format!(
                "there is no field {}; the table has {}",
                quoted(name),
                names(fields)
            );
            return Err((code::UNKNOWN_SOURCE, message));
        };
        let (of, columns) = match &field.kind {
            Type::Array(of, count) => (of.as_ref(), *count),
            of => (of, 1),
        };
        let Some(number) = of.number() else {
            let message = format!(
                "field {} does not hold numbers but {}",
                quoted(name),
                of.name()
            );
            return Err((code::UNREADABLE_SOURCE, message));
        };
        Ok(Self {
            at: field.at,
            number,
            columns,
            width: *width,
        })
    }

    /// The values, row by row.
    fn values(&self, bytes: &[u8]) -> Vec<f64> {
        let cells = |row: &[u8]| -> Vec<f64> {
            let cells = row.get(self.at..).unwrap_or_default();
            let cells = cells.chunks_exact(self.number.width).take(self.columns);
            cells.map(self.number.read).collect()
        };
        bytes
            .chunks_exact(self.width.max(1))
            .flat_map(cells)
            .collect()
    }
}

fn names(fields: &[Field]) -> String {
    listed(fields.iter().map(|field| quoted(&field.name)), LISTED)
}

/// Rows and columns, dimensions of one passed over.
fn shape(dimensions: &[u64]) -> Option<[usize; 2]> {
    let sizes = dimensions.iter().filter(|size| **size != 1);
    let sizes: Option<Vec<usize>> = sizes.map(|size| usize::try_from(*size).ok()).collect();
    match sizes?[..] {
        [] => Some([1, 1]),
        [rows] => Some([rows, 1]),
        [rows, columns] => Some([rows, columns]),
        _ => None,
    }
}

fn remedy(class: &str) -> &'static str {
    match class {
        "table" | "timetable" | "FileWrapper__" => {
            "save it as a struct: s = table2struct(timetable2table(T), 'ToScalar', true)"
        }
        "struct" | "cell" => "name one of its fields, or save it with '-v7'",
        _ => "save numbers",
    }
}

fn code_of(fault: &Fault) -> &'static str {
    match fault.code.as_ref() {
        code::TOO_MANY_VALUES => code::TOO_MANY_VALUES,
        code::FORMAT_NOT_READ => code::FORMAT_NOT_READ,
        _ => code::DAMAGED_FILE,
    }
}

#[cfg(test)]
mod tests {
    use super::super::header::Header;
    use super::*;

    #[test]
    fn a_table_is_read_once_for_all_of_its_fields() {
        let mut bytes = super::super::file::SIGNATURE.to_vec();
        bytes.extend([2, 8, 8, 0]);
        bytes.resize(48, 0);
        // two rows of the fields a and b, each of one byte
        let space = [&[1, 1, 0, 0, 0, 0, 0, 0][..], &2u64.to_le_bytes()].concat();
        let number = [0x30, 0, 0, 0, 1, 0, 0, 0, 0, 0, 8, 0];
        let mut kind = vec![0x36, 2, 0, 0, 2, 0, 0, 0];
        for (at, name) in [b"a\0", b"b\0"].into_iter().enumerate() {
            kind.extend(name);
            kind.push(at as u8);
            kind.extend(number);
        }
        let layout = vec![3, 0, 4, 0, 1, 2, 3, 4];
        let mut header = Vec::new();
        for (number, message) in [(1u16, space), (3, kind), (8, layout)] {
            header.extend(number.to_le_bytes());
            header.extend((message.len() as u16).to_le_bytes());
            header.extend([0; 4]);
            header.extend(message);
        }
        bytes.extend([1, 0, 3, 0, 1, 0, 0, 0]);
        bytes.extend((header.len() as u64).to_le_bytes());
        bytes.extend(header);
        let file = File::of(&bytes).unwrap();
        let header = Header::read(&file, 48, &mut 1000).unwrap();
        let table = Object {
            path: vec!["t".to_string()],
            dataset: Dataset::read(&file, &header).unwrap(),
            header,
            class: None,
        };
        let mut datasets = Datasets::of(file, vec![table], &Limits::default());
        datasets.room = 4;
        for (field, values) in [("a", [1.0, 3.0]), ("b", [2.0, 4.0])] {
            let path = ["t".to_string(), field.to_string()];
            datasets.matrix(&path).unwrap();
            assert_eq!(datasets.values, values);
        }
    }
}
