//! The variables of a file as a mapping sees them.

use super::super::code;
use super::super::mapping::Archive;
use super::super::matrix::Matrix;
use super::super::text::{LISTED, listed, quoted};

/// A variable, or a field of a struct.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Variable {
    /// The fields on the way to it, from the name of the variable on.
    pub(super) path: Vec<String>,
    /// What Octave calls it, with what else keeps it from being a matrix of real numbers.
    pub(super) kind: String,
    /// Row by row; none where it is no matrix of real numbers.
    pub(super) values: Option<Vec<f64>>,
    pub(super) columns: usize,
}

pub(super) struct Variables {
    all: Vec<Variable>,
    /// Those that stand again further on, and why they do not count.
    pub(super) saved_again: Vec<(String, String)>,
}

impl Variables {
    /// Of several with one path the last counts, as Octave's `load` has it.
    pub(super) fn of(mut all: Vec<Variable>) -> Self {
        let paths: Vec<Vec<String>> = all.iter().map(|variable| variable.path.clone()).collect();
        let last: std::collections::HashMap<_, _> = paths.iter().zip(0..).collect();
        let mut saved_again = Vec::new();
        let mut at = 0;
        all.retain(|variable| {
            let is_last = last.get(&variable.path) == Some(&at);
            at += 1;
            if !is_last {
                let why = "it was saved again, and the last one counts".to_string();
                saved_again.push((quoted(&variable.path.join(".")), why));
            }
            is_last
        });
        Self { all, saved_again }
    }

    pub(super) fn contents(&self) -> String {
        let all = self.all.iter().map(|variable| {
            let name = quoted(&variable.path.join("."));
            match &variable.values {
                Some(values) => {
                    let columns = variable.columns.max(1);
                    format!("{name} ({}x{columns})", values.len() / columns)
                }
                None => format!("{name} ({})", variable.kind),
            }
        });
        listed(all, LISTED)
    }
}

impl Archive for Variables {
    fn matrix(&mut self, path: &[String]) -> Result<Matrix<'_>, (&'static str, String)> {
        let mut fitting = self.all.iter().filter(|variable| match path {
            [] => variable
                .values
                .as_ref()
                .is_some_and(|values| values.len() > 1),
            path => variable.path == path,
        });
        let (Some(found), None) = (fitting.next(), fitting.next()) else {
            let message = format!(
                "there is no one variable {}; the file has {}",
                quoted(&path.join(".")),
                self.contents()
            );
            return Err((code::UNKNOWN_SOURCE, message));
        };
        match &found.values {
            Some(values) => Ok(Matrix::of_rows(values, found.columns)),
            None => {
                let message = format!(
                    "{} is not real numbers but {}; save numbers",
                    quoted(&found.path.join(".")),
                    found.kind
                );
                Err((code::UNREADABLE_SOURCE, message))
            }
        }
    }
}
