//! A MAT file of version 5 as a mapping sees it: variables by name, unpacked when they are asked for.

use super::super::{
    Limits, code,
    mapping::{Archive, element},
    matrix::Matrix,
    stored::Order,
    text::{LISTED, listed, quoted},
};
use super::array::Head;
use super::structs::{self, Found, Gathered};
use super::variables::Variables;
use crate::flight::Fault;

/// The variables of a file.
pub(super) struct Version5<'a> {
    order: Order,
    variables: Variables<'a>,
    /// What an array of structs has in one of its fields.
    gathered: Gathered,
}

impl<'a> Version5<'a> {
    /// # Errors
    /// It is damaged, or has more variables than the limit of columns.
    pub(super) fn of(body: &'a [u8], order: Order, limits: &Limits) -> Result<Self, Fault> {
        Ok(Self {
            order,
            variables: Variables::of(body, order, limits)?,
            gathered: Gathered::default(),
        })
    }

    /// What there is, for a message.
    pub(super) fn contents(&self) -> String {
        let variables = self.variables.list().iter();
        let name = |head: &Head| format!("{} ({})", quoted(&head.name), head.description());
        listed(variables.map(|variable| name(&variable.head)), LISTED)
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
        let (name, _) = element(name);
        let found = list.iter().position(|variable| variable.head.name == name);
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

impl Archive for Version5<'_> {
    fn matrix(&mut self, path: &[String]) -> Result<Matrix<'_>, (&'static str, String)> {
        let at = self.find(path)?;
        let of_fault = |fault: Fault| (code_of(&fault), fault.message);
        let bytes = self.variables.unpack(at).map_err(of_fault)?;
        let found = structs::find(bytes, self.order, path)?;
        match found {
            Found::Matrix(matrix) => Ok(matrix),
            Found::Gathered(gathered) => {
                self.gathered = gathered;
                Ok(self.gathered.matrix())
            }
        }
    }
}

fn code_of(fault: &Fault) -> &'static str {
    if fault.code == code::TOO_MANY_VALUES {
        code::TOO_MANY_VALUES
    } else {
        code::DAMAGED_FILE
    }
}
