//! Arrays of a MAT file: what each is, the numbers of a numeric one, the fields of a struct.

use super::super::matrix::Matrix;
use super::super::stored::{Order, Stored, stored};
use super::element::{Damage, Element, Elements, kind};

/// What stands before the content of an array.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Head {
    class: u8,
    is_complex: bool,
    pub(super) dimensions: Vec<usize>,
    pub(super) name: String,
}

const STRUCT: u8 = 2;
const OBJECT: u8 = 3;
const OPAQUE: u8 = 17;
const COMPLEX: u32 = 1 << 11;
/// Fields of a struct. Their names in memory are larger than in the file.
const MOST_FIELDS: usize = 65_535;

/// MATLAB's classes by number, from 1.
const CLASSES: [&str; 17] = [
    "cell",
    "struct",
    "object",
    "char",
    "sparse",
    "double",
    "single",
    "int8",
    "uint8",
    "int16",
    "uint16",
    "int32",
    "uint32",
    "int64",
    "uint64",
    "function_handle",
    "object",
];

impl Head {
    /// Reads the head of an array and leaves `elements` at its content.
    pub(super) fn read(elements: &mut Elements) -> Result<Self, Damage> {
        let flags = elements.expect()?;
        let flags = elements
            .order
            .u32(flags.bytes)
            .ok_or("an array has no flags")?;
        let class = (flags & 0xff) as u8;
        // an object has its name where others have dimensions
        let dimensions = if class == OPAQUE {
            Vec::new()
        } else {
            dimensions(elements)?
        };
        let name = elements.expect()?;
        Ok(Self {
            class,
            is_complex: flags & COMPLEX != 0,
            dimensions,
            name: String::from_utf8_lossy(name.bytes).into_owned(),
        })
    }

    pub(super) fn is_struct(&self) -> bool {
        self.class == STRUCT
    }

    /// Whether it is an object of MATLAB's own, such as a table, whose layout is not documented.
    pub(super) fn is_object(&self) -> bool {
        matches!(self.class, OBJECT | OPAQUE)
    }

    /// Whether it is an array of numbers, not a sparse one.
    pub(super) fn is_numeric(&self) -> bool {
        (6..=15).contains(&self.class)
    }

    /// How many values or structs it has; `None` beyond any number.
    pub(super) fn count(&self) -> Option<usize> {
        self.dimensions
            .iter()
            .try_fold(1usize, |product, &length| product.checked_mul(length))
    }

    /// For people: `626x45 double`.
    pub(super) fn description(&self) -> String {
        let sizes: Vec<String> = self.dimensions.iter().map(ToString::to_string).collect();
        let class = CLASSES
            .get(usize::from(self.class).wrapping_sub(1))
            .unwrap_or(&"unknown");
        let complex = if self.is_complex { "complex " } else { "" };
        format!("{} {complex}{class}", sizes.join("x"))
            .trim()
            .to_string()
    }

    /// Rows and columns. Sides of length 1 of an array of more dimensions are left out, as `squeeze` does it.
    fn shape(&self) -> Option<[usize; 2]> {
        if let &[rows, columns] = self.dimensions.as_slice() {
            return Some([rows, columns]);
        }
        let long: Vec<usize> = self
            .dimensions
            .iter()
            .copied()
            .filter(|&length| length != 1)
            .collect();
        match *long.as_slice() {
            [] => Some([1, 1]),
            [length] => Some([length, 1]),
            [rows, columns] => Some([rows, columns]),
            _ => None,
        }
    }

    /// The numbers of the array whose content is next in `elements`.
    ///
    /// # Errors
    /// Outside: the file is damaged. Inside: the array is no matrix of real numbers; what it is.
    pub(super) fn matrix<'a>(
        &self,
        elements: &mut Elements<'a>,
    ) -> Result<Result<Matrix<'a>, String>, Damage> {
        let shape = self
            .shape()
            .filter(|_| self.is_numeric() && !self.is_complex);
        let Some(shape) = shape else {
            return Ok(Err(self.description()));
        };
        let numbers = elements.expect()?;
        let number = number(numbers, elements.order).ok_or("numbers are of an unknown kind")?;
        let matrix = Matrix::of_bytes(shape, numbers.bytes, number);
        matrix
            .map(Ok)
            .ok_or("an array does not have as many values as its dimensions say")
    }
}

fn dimensions(elements: &mut Elements) -> Result<Vec<usize>, Damage> {
    let order = elements.order;
    let Element { bytes, .. } = elements.expect()?;
    let length = |bytes| {
        order
            .u32(bytes)
            .filter(|&length| length <= i32::MAX as u32)
            .map(|length| length as usize)
    };
    let dimensions: Option<Vec<usize>> = bytes.chunks_exact(4).map(length).collect();
    dimensions
        .filter(|dimensions| dimensions.len() >= 2)
        .ok_or("an array has no dimensions")
}

/// How the numbers of an element are stored.
fn number(element: Element, order: Order) -> Option<Stored> {
    Some(match element.kind {
        kind::INT8 => stored!(i8, order),
        kind::UINT8 => stored!(u8, order),
        kind::INT16 => stored!(i16, order),
        kind::UINT16 => stored!(u16, order),
        kind::INT32 => stored!(i32, order),
        kind::UINT32 => stored!(u32, order),
        kind::SINGLE => stored!(f32, order),
        kind::DOUBLE => stored!(f64, order),
        kind::INT64 => stored!(i64, order),
        kind::UINT64 => stored!(u64, order),
        _ => return None,
    })
}

/// The fields of the struct whose content is next in `elements`.
pub(super) struct Fields<'a> {
    pub(super) names: Vec<String>,
    values: Elements<'a>,
}

impl<'a> Fields<'a> {
    pub(super) fn read(elements: &mut Elements<'a>) -> Result<Self, Damage> {
        let width = elements.expect()?;
        let width = elements.order.u32(width.bytes).filter(|&width| width > 0);
        let width = width.ok_or("the fields of a struct have no names")? as usize;
        let names = elements.expect()?.bytes.chunks(width);
        if names.len() > MOST_FIELDS {
            return Err("a struct has more fields than any");
        }
        let name = |bytes: &[u8]| {
            let end = bytes
                .iter()
                .position(|&byte| byte == 0)
                .unwrap_or(bytes.len());
            String::from_utf8_lossy(&bytes[..end]).into_owned()
        };
        Ok(Self {
            names: names.map(name).collect(),
            values: *elements,
        })
    }

    /// The array in the field `place` of the struct `which`, both counted from 0.
    pub(super) fn value(self, which: usize, place: usize) -> Result<Element<'a>, Damage> {
        let mut values = self.values(place);
        for _ in 0..which {
            values.next_value()?;
        }
        values.next_value()
    }

    /// The arrays in a field of the structs of an array, one behind the other.
    pub(super) fn values(self, place: usize) -> FieldValues<'a> {
        FieldValues {
            values: self.values,
            before: place,
            behind: self.names.len() - place - 1,
        }
    }
}

/// The values of one field in an array of structs.
pub(super) struct FieldValues<'a> {
    values: Elements<'a>,
    /// Fields before it in a struct, and behind it.
    before: usize,
    behind: usize,
}

impl<'a> FieldValues<'a> {
    pub(super) fn next_value(&mut self) -> Result<Element<'a>, Damage> {
        for _ in 0..self.before {
            self.values.expect()?;
        }
        let value = self.values.expect()?;
        for _ in 0..self.behind {
            // those of the last struct may be missing where it is not asked for them
            if self.values.next()?.is_none() {
                break;
            }
        }
        Ok(value)
    }
}
