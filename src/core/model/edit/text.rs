//! Names replaced in the text of equations; the rest stays as it was written.

use crate::model::document::ModelDocument;
use crate::model::expression;

impl ModelDocument {
    /// Puts a text in the place of a name in all equations but those of initial states.
    pub fn substitute(&mut self, name: &str, by: &str) {
        for equation in laws(self) {
            *equation = replace_name(equation, name, by);
        }
        for output in self.outputs.values_mut() {
            output.equation = replace_name(&output.equation, name, by);
        }
    }
}

/// The equations of definitions and states.
pub(super) fn laws(document: &mut ModelDocument) -> impl Iterator<Item = &mut String> {
    let definitions = document
        .definitions
        .values_mut()
        .map(|definition| &mut definition.equation);
    let states = document
        .states
        .values_mut()
        .map(|state| &mut state.derivative);
    definitions.chain(states)
}

/// The text with a name replaced wherever it stands.
pub(super) fn replace_name(text: &str, name: &str, by: &str) -> String {
    replace(text, |found| (found == name).then(|| by.to_string()))
}

/// The text with names replaced by what `by` says of them.
pub(super) fn replace(text: &str, by: impl Fn(&str) -> Option<String>) -> String {
    // an equation that cannot be read is left alone: compiling says what is wrong with it
    let Ok(parsed) = expression::parse(text) else {
        return text.to_string();
    };
    let mut replaced = String::new();
    let mut from = 0;
    for (name, span) in parsed.names() {
        if let Some(by) = by(name) {
            replaced.push_str(&text[from..span.start]);
            replaced.push_str(&by);
            from = span.end;
        }
    }
    replaced.push_str(&text[from..]);
    replaced
}

/// The names that stand in a text, each once.
pub(super) fn names(text: &str) -> Vec<String> {
    let Ok(parsed) = expression::parse(text) else {
        return Vec::new();
    };
    let mut names: Vec<String> = (parsed.names().into_iter())
        .map(|(name, _)| name.to_string())
        .collect();
    names.sort();
    names.dedup();
    names
}
