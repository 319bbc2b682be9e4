//! An equation multiplied out: which products it holds.

use std::collections::BTreeMap;

use crate::model::expression::{BinaryOperator, Expression, Kind};

/// A product of names, to whole powers. What divides is left out: it scales.
#[derive(Clone, PartialEq, Debug, Default)]
pub(super) struct Monomial {
    pub powers: BTreeMap<String, u32>,
    /// Something is multiplied that is no power of a name.
    pub opaque: bool,
}

/// More terms than this are not multiplied out.
const MOST: usize = 200;

/// Highest power that is multiplied out.
const HIGHEST: f64 = 4.0;

impl Monomial {
    /// The terms of an expression. `definition` gives what is to be written out.
    pub(super) fn all_of(
        expression: &Expression,
        definition: &dyn Fn(&str) -> Option<Expression>,
    ) -> Vec<Self> {
        expand(expression, definition, 0)
    }

    pub(super) fn holds(&self, name: &str) -> bool {
        self.powers.contains_key(name)
    }

    fn times(&self, other: &Self) -> Self {
        let mut product = self.clone();
        product.opaque |= other.opaque;
        for (name, power) in &other.powers {
            *product.powers.entry(name.clone()).or_default() += power;
        }
        product
    }

    fn opaque() -> Self {
        Self {
            opaque: true,
            ..Self::default()
        }
    }
}

const DEEPEST: usize = 6;

fn expand(
    expression: &Expression,
    definition: &dyn Fn(&str) -> Option<Expression>,
    depth: usize,
) -> Vec<Monomial> {
    let inner = |expression: &Expression| expand(expression, definition, depth);
    match &expression.kind {
        Kind::Number(_) => vec![Monomial::default()],
        Kind::Name(name) => match definition(name) {
            Some(written) if depth < DEEPEST => expand(&written, definition, depth + 1),
            _ => {
                let powers = BTreeMap::from([(name.clone(), 1)]);
                vec![Monomial {
                    powers,
                    opaque: false,
                }]
            }
        },
        Kind::Negate(of) => inner(of),
        Kind::Binary(BinaryOperator::Add | BinaryOperator::Subtract, left, right) => {
            let mut all = inner(left);
            all.extend(inner(right));
            all
        }
        Kind::Binary(BinaryOperator::Multiply, left, right) => product(&inner(left), &inner(right)),
        Kind::Binary(BinaryOperator::Divide, left, _) => inner(left),
        Kind::Binary(BinaryOperator::Power, base, exponent) => match exponent.kind {
            Kind::Number(power) if power.fract() == 0.0 && (1.0..=HIGHEST).contains(&power) => {
                let base = inner(base);
                let mut all = base.clone();
                for _ in 1..power as u32 {
                    all = product(&all, &base);
                }
                all
            }
            _ => vec![Monomial::opaque()],
        },
        Kind::Binary(..) | Kind::Call(..) => vec![Monomial::opaque()],
    }
}

fn product(left: &[Monomial], right: &[Monomial]) -> Vec<Monomial> {
    if left.len() * right.len() > MOST {
        return vec![Monomial::opaque()];
    }
    let of = |a: &Monomial| right.iter().map(|b| a.times(b)).collect::<Vec<_>>();
    left.iter().flat_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::expression::parse;

    #[test]
    fn sums_are_multiplied_out_and_divisors_left_out() {
        let equation = parse("(a + b*m)*(x - x0)/(2*V) + c*sin(y)").unwrap();
        let written = |terms: &[Monomial]| -> Vec<String> {
            let of = |term: &Monomial| {
                let names: Vec<&str> = term.powers.keys().map(String::as_str).collect();
                format!("{}{}", names.join("*"), if term.opaque { "?" } else { "" })
            };
            terms.iter().map(of).collect()
        };
        let terms = Monomial::all_of(&equation, &|_| None);
        assert_eq!(written(&terms), ["a*x", "a*x0", "b*m*x", "b*m*x0", "c?"]);
        let terms = Monomial::all_of(&equation, &|name| {
            (name == "x").then(|| parse("u^2").unwrap())
        });
        assert_eq!(terms[0].powers["u"], 2);
    }
}
