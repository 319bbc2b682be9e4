//! Trees to text, with no more brackets than needed.

use std::fmt;

use super::{BinaryOperator, Expression, Kind};

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            Kind::Number(value) if *value == 0.0 || (1e-4..1e7).contains(&value.abs()) => {
                write!(f, "{value}")
            }
            Kind::Number(value) => write!(f, "{value:e}"),
            Kind::Name(name) => write!(f, "{name}"),
            Kind::Negate(inner) => {
                write!(f, "-")?;
                bracketed(f, inner, strength(inner) < SIGN)
            }
            Kind::Binary(operator, left, right) => {
                let own = operator_strength(*operator);
                let power = *operator == BinaryOperator::Power;
                // `^` groups to the right, all others to the left
                bracketed(
                    f,
                    left,
                    if power {
                        strength(left) <= own
                    } else {
                        strength(left) < own
                    },
                )?;
                write!(f, "{}", symbol(*operator))?;
                bracketed(
                    f,
                    right,
                    if power {
                        strength(right) < SIGN
                    } else {
                        strength(right) <= own
                    },
                )
            }
            Kind::Call(function, arguments) => {
                write!(f, "{}(", function.name())?;
                for (i, argument) in arguments.iter().enumerate() {
                    write!(f, "{}{argument}", if i > 0 { ", " } else { "" })?;
                }
                write!(f, ")")
            }
        }
    }
}

const SIGN: u8 = 4;

fn bracketed(f: &mut fmt::Formatter<'_>, inner: &Expression, brackets: bool) -> fmt::Result {
    if brackets {
        write!(f, "({inner})")
    } else {
        write!(f, "{inner}")
    }
}

fn strength(expression: &Expression) -> u8 {
    match &expression.kind {
        Kind::Binary(operator, ..) => operator_strength(*operator),
        Kind::Negate(_) => SIGN,
        // a negative literal prints with a sign
        Kind::Number(value) if value.is_sign_negative() => SIGN,
        Kind::Number(_) | Kind::Name(_) | Kind::Call(..) => 6,
    }
}

fn operator_strength(operator: BinaryOperator) -> u8 {
    match operator {
        BinaryOperator::Add | BinaryOperator::Subtract => 2,
        BinaryOperator::Multiply | BinaryOperator::Divide => 3,
        BinaryOperator::Power => 5,
        _ => 1,
    }
}

fn symbol(operator: BinaryOperator) -> &'static str {
    match operator {
        BinaryOperator::Add => " + ",
        BinaryOperator::Subtract => " - ",
        BinaryOperator::Multiply => "*",
        BinaryOperator::Divide => "/",
        BinaryOperator::Power => "^",
        BinaryOperator::Less => " < ",
        BinaryOperator::LessOrEqual => " <= ",
        BinaryOperator::Greater => " > ",
        BinaryOperator::GreaterOrEqual => " >= ",
    }
}
