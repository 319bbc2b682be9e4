//! The way into a variable along a path: fields of structs, elements of arrays of structs.

use super::super::{
    code,
    mapping::element as element_of,
    matrix::Matrix,
    stored::Order,
    text::{LISTED, listed, quoted},
};
use super::array::{Fields, Head};
use super::element::{Damage, Elements, damaged};

/// What is at the end of a path.
pub(super) enum Found<'a> {
    Matrix(Matrix<'a>),
    Gathered(Gathered),
}

/// One field of all structs of an array, a row for each struct.
#[derive(Default)]
pub(super) struct Gathered {
    values: Vec<f64>,
    columns: usize,
}

impl Gathered {
    pub(super) fn matrix(&self) -> Matrix<'_> {
        Matrix::of_rows(&self.values, self.columns)
    }
}

type Refusal = (&'static str, String);

fn of_damage(why: Damage) -> Refusal {
    (code::DAMAGED_FILE, damaged(why).message)
}

fn unreadable(message: String) -> Refusal {
    (code::UNREADABLE_SOURCE, message)
}

/// What a path leads to in a variable, whose elements are `bytes`.
///
/// # Errors
/// A code and a message: it leads nowhere, or not to numbers.
pub(super) fn find<'a>(
    bytes: &'a [u8],
    order: Order,
    path: &[String],
) -> Result<Found<'a>, Refusal> {
    let mut elements = Elements { rest: bytes, order };
    let mut head = Head::read(&mut elements).map_err(of_damage)?;
    let mut here = path.first().map_or(head.name.clone(), Clone::clone);
    let mut index = path.first().and_then(|name| element_of(name).1);
    for (at, name) in path.iter().enumerate().skip(1) {
        let (field, next) = element_of(name);
        if !head.is_struct() {
            let message = format!(
                "'{here}' is not a struct but {}; '{field}' cannot be taken from it",
                head.description()
            );
            return Err(unreadable(message));
        }
        let fields = Fields::read(&mut elements).map_err(of_damage)?;
        let Some(place) = fields.names.iter().position(|name| name == field) else {
            let names = listed(fields.names.iter().map(|name| quoted(name)), LISTED);
            let message = format!("'{here}' has no field '{field}'; it has {names}");
            return Err((code::UNKNOWN_SOURCE, message));
        };
        let count = head.count().unwrap_or(usize::MAX);
        let which = match index {
            Some(which) if which < count => which,
            None if count == 1 => 0,
            None if at + 1 == path.len() && next.is_none() && count > 0 => {
                let gathered = gather(fields, count, place, order)?;
                return gathered.map(Found::Gathered).ok_or_else(|| {
                    unreadable(format!(
                        "'{field}' is not numbers of one size in each struct of '{here}', {}; name one of them, as {here}(1).{field}",
                        head.description()
                    ))
                });
            }
            _ => {
                let which = if index.is_some() {
                    "there is no such one"
                } else {
                    "say which"
                };
                let message = format!(
                    "'{here}' is {}; {which}, from {name}(1).{field} to {name}({count}).{field}",
                    head.description(),
                    name = element_of(&here).0
                );
                return Err((code::UNKNOWN_SOURCE, message));
            }
        };
        let value = fields.value(which, place).map_err(of_damage)?;
        here = format!("{here}.{name}");
        if value.bytes.is_empty() {
            return Err(unreadable(format!("'{here}' is empty; map another source")));
        }
        elements = Elements {
            rest: value.bytes,
            order,
        };
        head = Head::read(&mut elements).map_err(of_damage)?;
        index = next;
    }
    let matrix = head.matrix(&mut elements).map_err(of_damage)?;
    let matrix = matrix.map_err(|found| unreadable(not_numbers(&here, &found, &head)))?;
    match index {
        None => Ok(Found::Matrix(matrix)),
        // one number of an array, as xyz[0], is no time history; a column of it is
        Some(at) if at < matrix.columns => Ok(Found::Gathered(Gathered {
            values: matrix.column(at),
            columns: 1,
        })),
        Some(_) => Err((
            code::UNKNOWN_SOURCE,
            format!("'{here}': the matrix has {} column(s)", matrix.columns),
        )),
    }
}

fn not_numbers(here: &str, found: &str, head: &Head) -> String {
    let remedy = if head.is_object() {
        "save a table or timetable as a struct: s = table2struct(timetable2table(T), 'ToScalar', true), a timeseries as [ts.Time, ts.Data]"
    } else {
        "save numbers, or name a field of a struct with a dot"
    };
    format!("'{here}' is not a matrix of real numbers but {found}; {remedy}")
}

/// The numbers in a field of every struct of an array: one, or a row of as many, in each. `None` where it is anything else.
fn gather(
    fields: Fields,
    count: usize,
    place: usize,
    order: Order,
) -> Result<Option<Gathered>, Refusal> {
    let mut gathered = Gathered::default();
    let mut values = fields.values(place);
    for which in 0..count {
        let value = values.next_value().map_err(of_damage)?;
        let mut elements = Elements {
            rest: value.bytes,
            order,
        };
        if value.bytes.is_empty() {
            return Ok(None);
        }
        let head = Head::read(&mut elements).map_err(of_damage)?;
        let Ok(matrix) = head.matrix(&mut elements).map_err(of_damage)? else {
            return Ok(None);
        };
        let row = match (matrix.rows, matrix.columns) {
            (_, 1) => matrix.column(0),
            (1, _) => matrix.row(0),
            _ => return Ok(None),
        };
        if which > 0 && row.len() != gathered.columns {
            return Ok(None);
        }
        gathered.columns = row.len();
        gathered.values.extend(row);
    }
    Ok((gathered.columns > 0).then_some(gathered))
}
