//! Definitions of messages: `vehicle_acceleration:uint64_t timestamp;float[3] xyz;`, flattened to numbers.

use std::collections::HashMap;
use std::rc::Rc;

use super::super::messages::{Field, Fields};
use super::super::stored::{Order, Stored, stored};

/// Definitions by name, as they are written, and what was made of those that are used.
#[derive(Default)]
pub(super) struct Definitions<'a> {
    texts: HashMap<&'a str, &'a str>,
    flat: HashMap<&'a str, Flat>,
    /// Steps of making all definitions that are in use.
    steps: usize,
}

/// A definition without nested ones.
#[derive(Clone)]
pub(super) struct Flat {
    pub(super) fields: Fields,
    /// Bytes of a message, padding at its end left out.
    pub(super) length: usize,
    /// Which field is the time stamp.
    pub(super) time: usize,
}

/// Messages are no longer, so that nothing in one is further behind.
const LONGEST: usize = 65_535;
const DEEPEST: usize = 8;
/// Numbers and fields that all definitions in use may have.
const MOST_STEPS: usize = 200_000;
/// Bytes of a name of a field, with those that it is nested in.
const LONGEST_NAME: usize = 256;

impl<'a> Definitions<'a> {
    /// Adds a definition; one that is no text is left out.
    pub(super) fn add(&mut self, text: &'a [u8]) {
        let text = std::str::from_utf8(text).ok();
        if let Some((name, fields)) = text.and_then(|text| text.split_once(':')) {
            self.texts.insert(name, fields);
        }
    }

    /// The definition of this name.
    ///
    /// # Errors
    /// Why there is none: it is not there, has no time stamp, or is larger than a message can be.
    pub(super) fn find(&mut self, name: &str) -> Result<Flat, &'static str> {
        if let Some(flat) = self.flat.get(name) {
            return Ok(flat.clone());
        }
        let Some((&name, _)) = self.texts.get_key_value(name) else {
            return Err("a topic has no definition");
        };
        let mut made = Made::default();
        self.flatten(name, "", 0, &mut made)?;
        self.steps += made.steps;
        if self.steps > MOST_STEPS {
            return Err("its definitions have more fields than any aircraft");
        }
        let is_time = |field: &Field| field.name == "timestamp" && field.number.width == 8;
        let time = made.fields.iter().position(is_time);
        let flat = Flat {
            time: time.ok_or("a topic has no timestamp")?,
            length: made.length,
            fields: Rc::new(made.fields),
        };
        self.flat.insert(name, flat.clone());
        Ok(flat)
    }

    fn flatten(
        &self,
        name: &str,
        prefix: &str,
        depth: usize,
        made: &mut Made,
    ) -> Result<(), &'static str> {
        const UNDEFINED: &str = "a definition has a field of a type that is not defined";
        if depth > DEEPEST {
            return Err("its definitions are nested too deep");
        }
        let text = self.texts.get(name).ok_or(UNDEFINED)?;
        for field in text.split(';') {
            made.step()?;
            if prefix.len() + field.len() > LONGEST_NAME {
                return Err("a field has a longer name than any");
            }
            if field.trim().is_empty() {
                continue;
            }
            let (kind, name) = field.trim().split_once(' ').ok_or("a field has no name")?;
            let (kind, count) = match kind.split_once('[') {
                Some((kind, count)) => {
                    let count = count.strip_suffix(']').and_then(|count| count.parse().ok());
                    (kind, Some(count.ok_or("an array has no length")?))
                }
                None => (kind, None),
            };
            let is_padding = name.starts_with("_padding");
            for at in 0..count.unwrap_or(1usize) {
                made.step()?;
                let name = match count {
                    Some(_) => format!("{prefix}{name}[{at}]"),
                    None => format!("{prefix}{name}"),
                };
                match number(kind) {
                    Some(number) => made.push(name, number, is_padding || kind == "char")?,
                    None => self.flatten(kind, &format!("{name}."), depth + 1, made)?,
                }
            }
        }
        Ok(())
    }
}

#[derive(Default)]
struct Made {
    fields: Vec<Field>,
    at: usize,
    length: usize,
    /// Fields as they are written, empty ones too, and the elements of each.
    steps: usize,
}

impl Made {
    fn step(&mut self) -> Result<(), &'static str> {
        self.steps += 1;
        if self.steps > LONGEST {
            return Err("a definition is longer than a message can be");
        }
        Ok(())
    }

    fn push(
        &mut self,
        name: String,
        number: Stored,
        is_left_out: bool,
    ) -> Result<(), &'static str> {
        let at = self.at;
        self.at += number.width;
        if self.at > LONGEST {
            return Err("a definition is longer than a message can be");
        }
        if !is_left_out {
            self.length = self.at;
            self.fields.push(Field {
                name,
                at,
                number,
                unit: String::new(),
            });
        }
        Ok(())
    }
}

/// How a number of this type is stored; `None` for the name of a definition.
fn number(kind: &str) -> Option<Stored> {
    Some(match kind {
        "int8_t" => stored!(i8, Order::Little),
        "uint8_t" | "bool" | "char" => stored!(u8, Order::Little),
        "int16_t" => stored!(i16, Order::Little),
        "uint16_t" => stored!(u16, Order::Little),
        "int32_t" => stored!(i32, Order::Little),
        "uint32_t" => stored!(u32, Order::Little),
        "int64_t" => stored!(i64, Order::Little),
        "uint64_t" => stored!(u64, Order::Little),
        "float" => stored!(f32, Order::Little),
        "double" => stored!(f64, Order::Little),
        _ => return None,
    })
}
