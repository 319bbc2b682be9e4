//! A model with its estimates as source code: functions in C, in Python and in MATLAB, written from the flat programs.
//!
//! ```text
//! initial state  x0        derivative  dx/dt = f(x, u, t)        output  y = g(x, u, t)
//! ```
//!
//! All in SI, with the parameters as numbers in it. Signal paths are not in it: u is what the equations see, y what they give.

pub(super) mod c;
pub(super) mod function;
mod matlab;
mod python;
mod written;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use written::Written;

use super::element::Element;
use super::{Model, Quantity};

/// A programming language.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub enum SourceLanguage {
    /// C99 with `math.h`.
    #[default]
    C,
    /// Python 3 with its standard library alone.
    Python,
    /// MATLAB or Octave, also as a MATLAB Function block of Simulink.
    Matlab,
}

impl Model {
    /// The functions of the model for parameters, SI, as one file. `of` says in a line what they are of.
    pub fn source_code(&self, language: SourceLanguage, parameters: &[f64], of: &str) -> String {
        let written = Written {
            model: self,
            parameters,
            notes: self.notes(parameters, of),
        };
        match language {
            SourceLanguage::C => c::file(&written),
            SourceLanguage::Python => python::file(&written),
            SourceLanguage::Matlab => matlab::file(&written),
        }
    }

    /// What stands at the head of a file.
    pub(super) fn notes(&self, parameters: &[f64], of: &str) -> Vec<String> {
        let plain = |text: &str| -> String {
            // what would end a comment, or a line of one
            text.replace("*/", "* /").replace(['\n', '\r'], " ")
        };
        let mut notes = vec![
            plain(of),
            "Written by Trimtab. All quantities are in SI; parameters are where they were estimated.".to_string(),
        ];
        let list = |what: &str, all: &[Quantity]| -> Vec<String> {
            let line =
                |(at, of): (usize, &Quantity)| format!("{what}[{at}] = {} [{}]", of.name, of.si);
            all.iter().enumerate().map(line).collect()
        };
        notes.extend(list("x", &self.states));
        notes.extend(list("u", &self.inputs));
        notes.extend(list("y", &self.outputs));
        let named = (self.parameters.iter().zip(parameters))
            .map(|(info, value)| format!("{} = {value:?}", info.name));
        notes.extend(named);
        notes.extend(self.left_out(parameters));
        notes
    }

    /// Signal paths that are not in the functions, where they change anything.
    pub(super) fn left_out(&self, parameters: &[f64]) -> Vec<String> {
        let sizes = self.paths.at(parameters);
        let elements = self.paths.elements().iter().enumerate();
        let changes = |element: Element, size: f64| match element {
            Element::RateLimit => size.is_finite(),
            Element::Play | Element::Lag | Element::Delay => size != 0.0,
        };
        let line = |(place, at): (usize, &super::PathElement)| {
            let signals = if self.paths.is_of_input(place) {
                &self.inputs
            } else {
                &self.outputs
            };
            let (name, size) = (&signals[at.signal].name, sizes[place]);
            changes(at.element, size).then(|| {
                format!(
                    "NOT in it: the {} of {name}, {size:?} in SI",
                    at.element.words()
                )
            })
        };
        elements.filter_map(line).collect()
    }
}
