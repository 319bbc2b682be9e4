//! Equations as sums of products.

use crate::model::expression::{BinaryOperator, Expression, Kind};

/// One term of a sum.
#[derive(Clone, Debug)]
pub(super) struct Term<'e> {
    /// Whether it is taken off.
    pub negative: bool,
    /// What is multiplied, and what divides.
    pub factors: Vec<&'e Expression>,
    pub divisors: Vec<&'e Expression>,
}

impl<'e> Term<'e> {
    fn one() -> Self {
        Self {
            negative: false,
            factors: Vec::new(),
            divisors: Vec::new(),
        }
    }

    /// The names among its factors.
    pub(super) fn names(&self) -> impl Iterator<Item = &'e str> {
        self.factors.iter().filter_map(|factor| name_of(factor))
    }

    fn with(&self, negative: bool, expression: &'e Expression, below: bool) -> Self {
        let mut term = self.clone();
        term.negative ^= negative;
        term.multiply(expression, below);
        term
    }

    fn multiply(&mut self, expression: &'e Expression, below: bool) {
        match &expression.kind {
            Kind::Negate(inner) => {
                self.negative = !self.negative;
                self.multiply(inner, below);
            }
            Kind::Binary(BinaryOperator::Multiply, left, right) => {
                self.multiply(left, below);
                self.multiply(right, below);
            }
            Kind::Binary(BinaryOperator::Divide, left, right) => {
                self.multiply(left, below);
                self.multiply(right, !below);
            }
            _ if below => self.divisors.push(expression),
            _ => self.factors.push(expression),
        }
    }
}

/// The name that an expression is.
pub(super) fn name_of(expression: &Expression) -> Option<&str> {
    match &expression.kind {
        Kind::Name(name) => Some(name),
        _ => None,
    }
}

/// Calls back for each part of a sum, and whether it is taken off.
fn parts<'e>(expression: &'e Expression, negative: bool, to: &mut Vec<(bool, &'e Expression)>) {
    match &expression.kind {
        Kind::Negate(inner) => parts(inner, !negative, to),
        Kind::Binary(BinaryOperator::Add, left, right) => {
            parts(left, negative, to);
            parts(right, negative, to);
        }
        Kind::Binary(BinaryOperator::Subtract, left, right) => {
            parts(left, negative, to);
            parts(right, !negative, to);
        }
        _ => to.push((negative, expression)),
    }
}

/// The terms of a sum as it is written.
pub(super) fn terms(expression: &Expression) -> Vec<Term<'_>> {
    expanded(expression, &|_| None)
}

/// Deepest definition in a definition that is written out.
const DEEPEST: usize = 8;

/// The terms of a sum, a term that is a definition alone replaced by the terms of that.
pub(super) fn expanded<'e>(
    expression: &'e Expression,
    definition: &dyn Fn(&str) -> Option<&'e Expression>,
) -> Vec<Term<'e>> {
    let mut found = Vec::new();
    expand(expression, false, definition, 0, &mut found);
    found
}

fn expand<'e>(
    expression: &'e Expression,
    negative: bool,
    definition: &dyn Fn(&str) -> Option<&'e Expression>,
    depth: usize,
    to: &mut Vec<Term<'e>>,
) {
    let mut all = Vec::new();
    parts(expression, negative, &mut all);
    for (negative, part) in all {
        match name_of(part).and_then(definition) {
            Some(inner) if depth < DEEPEST => expand(inner, negative, definition, depth + 1, to),
            _ => to.push(Term::one().with(negative, part, false)),
        }
    }
}

/// The names that stand in an expression, each once.
pub(super) fn names_of(expression: &Expression) -> Vec<&str> {
    let mut names: Vec<&str> = expression
        .names()
        .into_iter()
        .map(|(name, _)| name)
        .collect();
    names.sort_unstable();
    names.dedup();
    names
}
