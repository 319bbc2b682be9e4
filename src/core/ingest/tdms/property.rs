//! Properties: names with values beside a channel.

use super::super::cursor::Cursor;
use super::super::stored::Order;
use super::layout::kind;
use super::stamp::{self, Stamp};

#[derive(Clone, PartialEq, Debug)]
pub(super) enum Value {
    Number(f64),
    Text(String),
    Time(Stamp),
}

/// Properties by name, as far as they say something of values or times.
pub(super) type Properties = std::collections::HashMap<String, Value>;

/// Properties of one channel.
const MOST: usize = 300;
/// Characters of a text.
const LONGEST: usize = 100;

/// Reads the properties of an object into those that it has.
pub(super) fn read(cursor: &mut Cursor, order: Order, properties: &mut Properties) -> Option<()> {
    for _ in 0..cursor.u32()? {
        let name = text(cursor)?;
        let value = value(cursor, order)?;
        let is_of_use =
            name.starts_with(b"wf_") || name.starts_with(b"NI_") || name == b"unit_string";
        if let Some(value) = value.filter(|_| is_of_use && properties.len() < MOST) {
            properties.insert(clipped(name), value);
        }
    }
    Some(())
}

pub(super) fn text<'a>(cursor: &mut Cursor<'a>) -> Option<&'a [u8]> {
    let length = cursor.u32()?;
    cursor.take(length as usize)
}

fn clipped(text: &[u8]) -> String {
    String::from_utf8_lossy(text)
        .chars()
        .take(LONGEST)
        .collect()
}

/// A value; nothing where it is of a kind that says nothing here.
fn value(cursor: &mut Cursor, order: Order) -> Option<Option<Value>> {
    let found = cursor.u32()?;
    if found == kind::TEXT {
        return text(cursor).map(|text| Some(Value::Text(clipped(text))));
    }
    if found == kind::STAMP {
        let stamp = Stamp::read(cursor.take(stamp::WIDTH)?, order)?;
        return Some(Some(Value::Time(stamp)));
    }
    if let Some(number) = kind::number(found, order) {
        return Some(Some(Value::Number((number.read)(
            cursor.take(number.width)?,
        ))));
    }
    cursor.take(kind::width_of_others(found)?)?;
    Some(None)
}
