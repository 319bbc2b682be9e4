//! The equations of a document as trees.

use indexmap::IndexMap;

use super::sums::{Term, expanded};
use crate::flight::{Dimension, Unit};
use crate::model::document::ModelDocument;
use crate::model::expression::{self, Expression};

pub(super) fn dimension(unit: &str) -> Dimension {
    Unit::parse(unit).map_or(Dimension::NONE, |unit| unit.dimension)
}

/// The equations of a document as trees. What cannot be read is left out.
pub(super) struct Equations<'d> {
    pub document: &'d ModelDocument,
    pub states: IndexMap<&'d str, Expression>,
    pub definitions: IndexMap<&'d str, Expression>,
    pub outputs: IndexMap<&'d str, Expression>,
}

impl<'d> Equations<'d> {
    pub(super) fn of(document: &'d ModelDocument) -> Self {
        fn read<'d>(
            texts: impl Iterator<Item = (&'d String, &'d String)>,
        ) -> IndexMap<&'d str, Expression> {
            texts
                .filter_map(|(name, text)| Some((name.as_str(), expression::parse(text).ok()?)))
                .collect()
        }
        Self {
            document,
            states: read((document.states.iter()).map(|(name, x)| (name, &x.derivative))),
            definitions: read((document.definitions.iter()).map(|(name, x)| (name, &x.equation))),
            outputs: read((document.outputs.iter()).map(|(name, x)| (name, &x.equation))),
        }
    }

    /// Whether a name varies along a maneuver.
    pub(super) fn varies(&self, name: &str) -> bool {
        let document = self.document;
        document.inputs.contains_key(name)
            || document.states.contains_key(name)
            || document.definitions.contains_key(name)
    }

    pub(super) fn dimension(&self, name: &str) -> Dimension {
        let document = self.document;
        let unit = (document.inputs.get(name).map(|x| &x.unit))
            .or_else(|| document.states.get(name).map(|x| &x.unit))
            .or_else(|| document.definitions.get(name).map(|x| &x.unit));
        unit.map_or(Dimension::NONE, |unit| dimension(unit))
    }

    /// The terms of a sum, definitions that are sums themselves written out.
    pub(super) fn terms<'e>(&'e self, expression: &'e Expression) -> Vec<Term<'e>> {
        let definition = |name: &str| self.definitions.get(name);
        expanded(expression, &definition)
    }
}
