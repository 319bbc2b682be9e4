//! Expressions: the text of an equation as a tree.
//!
//! Numbers, with or without a unit (`9.80665[m/s^2]`), names, `+ - * / ^`, calls, and comparisons (inside
//! `if(condition, a, b)` only).
//! A tree prints as text that parses to the same tree.

mod function;
mod lexer;
mod parser;
mod print;

pub use function::Function;
pub use parser::parse;

use crate::flight::{Unit, UnitError};

/// A place in the text of an expression, in bytes.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Span {
    /// The first byte.
    pub start: usize,
    /// The byte behind the last.
    pub end: usize,
}

/// A node of the tree and where it stands in the text.
#[derive(Clone, Debug)]
pub struct Expression {
    /// The node, its operands below it.
    pub kind: Kind,
    /// Its place in the text that it was parsed from.
    pub span: Span,
}

/// What a node of the tree is.
#[derive(Clone, PartialEq, Debug)]
pub enum Kind {
    /// A number as written, at least 0.
    Number(f64),
    /// A constant, input, state, definition, parameter, output, channel, `t` or `pi`; or a unit, as `[m/s^2]`.
    Name(String),
    /// A minus sign before its operand.
    Negate(Box<Expression>),
    /// An operator between its operands, the left one first.
    Binary(BinaryOperator, Box<Expression>, Box<Expression>),
    /// A function of its arguments, in the order of the text.
    Call(Function, Vec<Expression>),
}

/// What stands between two operands.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum BinaryOperator {
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
    /// `^`
    Power,
    /// `<`
    Less,
    /// `<=`
    LessOrEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterOrEqual,
}

impl BinaryOperator {
    /// Whether it gives a condition, which only `if` takes.
    pub fn is_comparison(self) -> bool {
        matches!(
            self,
            Self::Less | Self::LessOrEqual | Self::Greater | Self::GreaterOrEqual
        )
    }
}

/// Trees are equal when they mean the same, wherever they stand.
impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        self.kind == other.kind
    }
}

impl Expression {
    /// All names in the tree, in order of appearance, with repetitions.
    pub fn names(&self) -> Vec<(&str, Span)> {
        let mut names = Vec::new();
        let mut pending = vec![self];
        while let Some(node) = pending.pop() {
            match &node.kind {
                Kind::Number(_) => {}
                Kind::Name(name) => names.push((name.as_str(), node.span)),
                Kind::Negate(inner) => pending.push(inner),
                Kind::Binary(_, left, right) => pending.extend([&**right, &**left]),
                Kind::Call(_, arguments) => pending.extend(arguments.iter().rev()),
            }
        }
        names
    }
}

/// What is wrong with the text of an expression.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[error("column {}: {message}", span.start + 1)]
pub struct SyntaxError {
    /// Where the text cannot be read.
    pub span: Span,
    /// What is wrong there.
    pub message: String,
}

/// Longest expression, in bytes.
pub const LONGEST: usize = 8_192;
/// Deepest nesting of brackets, calls, signs and powers.
pub const DEEPEST: usize = 64;
/// Most operators, names and numbers in one expression.
pub const MOST_NODES: usize = 2_000;

/// Longest name, in bytes.
pub const LONGEST_NAME: usize = 64;

/// The unit that a name in square brackets is; `None` for other names.
pub fn written_unit(name: &str) -> Option<Result<Unit, UnitError>> {
    let text = name.strip_prefix('[')?.strip_suffix(']')?;
    let is_empty = matches!(text.trim(), "");
    (!is_empty).then(|| Unit::parse(text))
}

/// Whether a text can stand as a name in equations.
pub fn is_name(text: &str) -> bool {
    let mut characters = text.chars();
    characters
        .next()
        .is_some_and(|c| c.is_ascii_alphabetic() || c == '_')
        && characters.all(|c| c.is_ascii_alphanumeric() || c == '_')
        && text.len() <= LONGEST_NAME
}
