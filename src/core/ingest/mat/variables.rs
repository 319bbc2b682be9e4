//! The variables of a MAT file, each unpacked once, when it is asked for, and all of them within bounds.

use std::io::Read;

use flate2::read::ZlibDecoder;

use super::super::stored::Order;
use super::super::{Limits, code, fault::of_file};
use super::array::Head;
use super::element::{Damage, Element, Elements, damaged, kind};
use crate::flight::Fault;

/// Room for the head of an array: flags, dimensions, and a name of up to 63 characters.
const HEAD_BYTES: u64 = 1024;

/// Beside numbers a file may have this many bytes of names and tags.
const OVERHEAD: usize = 1 << 20;

pub(super) struct Variables<'a> {
    order: Order,
    list: Vec<Variable<'a>>,
    /// Bytes that may still be unpacked.
    budget: usize,
    max_values: usize,
}

pub(super) struct Variable<'a> {
    pub(super) head: Head,
    element: Element<'a>,
    /// Its elements, where they were compressed and have been asked for.
    unpacked: Option<Vec<u8>>,
}

impl<'a> Variables<'a> {
    /// Looks at the head of every variable; `body` is what follows the file's header.
    ///
    /// # Errors
    /// The file is damaged, or has more variables than the limit of columns.
    pub(super) fn of(body: &'a [u8], order: Order, limits: &Limits) -> Result<Self, Fault> {
        let mut elements = Elements { rest: body, order };
        let mut list = Vec::new();
        let mut count = 0;
        while let Some(element) = elements.next().map_err(damaged)? {
            count += 1;
            limits.columns(count).map_or(Ok(()), Err)?;
            let head = head(element, order).map_err(damaged)?;
            // data of MATLAB's own have no name
            if !head.name.is_empty() {
                list.push(Variable {
                    head,
                    element,
                    unpacked: None,
                });
            }
        }
        Ok(Self {
            order,
            list,
            budget: limits
                .max_values
                .saturating_mul(size_of::<f64>())
                .saturating_add(OVERHEAD),
            max_values: limits.max_values,
        })
    }

    pub(super) fn list(&self) -> &[Variable<'a>] {
        &self.list
    }

    /// The elements that the variable `at` consists of, its head first.
    ///
    /// # Errors
    /// It is damaged, or has more values than the limit.
    pub(super) fn unpack(&mut self, at: usize) -> Result<&[u8], Fault> {
        let variable = &mut self.list[at];
        if variable.element.kind == kind::MATRIX {
            return Ok(variable.element.bytes);
        }
        let unpacked = match variable.unpacked.take() {
            Some(unpacked) => unpacked,
            None => {
                let unpacked = variable.unpack(self.order, self.budget, self.max_values)?;
                self.budget -= unpacked.len();
                unpacked
            }
        };
        Ok(variable.unpacked.insert(unpacked))
    }
}

impl Variable<'_> {
    fn unpack(&self, order: Order, budget: usize, max_values: usize) -> Result<Vec<u8>, Fault> {
        let Self { head, element, .. } = self;
        let mut unpacked = Vec::new();
        let read = ZlibDecoder::new(element.bytes)
            .take(budget as u64 + 1)
            .read_to_end(&mut unpacked);
        if unpacked.len() > budget || head.count().is_none_or(|count| count > max_values) {
            let message = format!(
                "with '{}' the file unpacks to more than max_values = {max_values} values; leave out what the estimation does not need",
                head.name
            );
            return Err(of_file(code::TOO_MANY_VALUES, message));
        }
        read.map_err(|_| damaged(NOT_UNPACKED))?;
        let mut inside = Elements {
            rest: &unpacked,
            order,
        };
        let length = inside.expect().map_err(damaged)?.bytes.len();
        unpacked.drain(..8);
        unpacked.truncate(length);
        Ok(unpacked)
    }
}

const NOT_UNPACKED: Damage = "a compressed variable cannot be unpacked";

/// The head of a variable, of which no more is unpacked.
fn head(element: Element, order: Order) -> Result<Head, Damage> {
    match element.kind {
        kind::MATRIX => Head::read(&mut Elements {
            rest: element.bytes,
            order,
        }),
        kind::COMPRESSED => {
            let mut start = Vec::new();
            // what is damaged behind the head is found when it is needed
            let _ = ZlibDecoder::new(element.bytes)
                .take(HEAD_BYTES)
                .read_to_end(&mut start);
            if order.u32(&start) != Some(kind::MATRIX) {
                return Err(NOT_UNPACKED);
            }
            let rest = start.get(8..).ok_or(NOT_UNPACKED)?;
            Head::read(&mut Elements { rest, order })
        }
        _ => Err("there is something between its variables"),
    }
}
