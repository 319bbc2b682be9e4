//! Equations as MathML: from the tree of an expression to what a browser typesets and a screen reader reads.
//!
//! Quotients are fractions and powers are raised, so that parentheses stand only where the meaning needs them.

use maud::{Markup, html};

use super::notation::Notation;
use crate::model::Element;
use crate::model::expression::{BinaryOperator, Expression, Function, Kind, parse};

/// What stands to the left of the `=`.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Left<'a> {
    /// The rate of change of a state.
    Rate(&'a str),
    /// The value of a state at the start of a segment.
    Initial(&'a str),
    /// A definition.
    Value(&'a str),
    Output(&'a str),
    /// The size of an element in the path of an input or output: its play, rate limit, lag or delay.
    Size(Element, &'a str),
}

impl Left<'_> {
    fn markup(self, notation: &Notation) -> Markup {
        match self {
            Left::Rate(name) => notation.rate(name),
            Left::Initial(name) => html! {
                mrow { (notation.name(name)) mo stretchy="false" { "(" } mn { "0" } mo stretchy="false" { ")" } }
            },
            Left::Value(name) => notation.name(name),
            Left::Output(name) => notation.output(name),
            Left::Size(element, name) => {
                html! { mrow { mtext { (element.words()) " of\u{a0}" } (notation.name(name)) } }
            }
        }
    }

    fn text(self) -> String {
        match self {
            Left::Rate(name) => format!("d {name}/dt"),
            Left::Initial(name) => format!("{name}(0)"),
            Left::Value(name) => name.to_string(),
            Left::Output(name) => format!("output {name}"),
            Left::Size(element, name) => format!("{} of {name}", element.words()),
        }
    }
}

/// One equation of a document, typeset. What cannot be parsed stands as it is written.
///
/// `notation` is that of the document (`Notation::of`), or `Notation::default()` where there is none: then
/// derivatives such as `Mde` stay as they are written. For a place in a document see `equations_at` in `model_diff`.
pub(super) fn equation(notation: &Notation, left: Left<'_>, text: &str) -> Markup {
    let Ok(expression) = parse(text) else {
        return html! { code { (left.text()) " = " (text) } };
    };
    let plain = format!("{} = {expression}", left.text());
    html! {
        math displaystyle="true" alttext=(plain) {
            mrow { (left.markup(notation)) mo { "=" } (Typesetter { notation }.whole(&expression)) }
        }
    }
}

/// A name of a document, typeset by itself.
pub(super) fn name(notation: &Notation, name: &str) -> Markup {
    html! { math alttext=(name) { (notation.name(name)) } }
}

struct Typesetter<'a> {
    notation: &'a Notation,
}

/// How tightly the parts of an expression hold together.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Strength {
    /// A choice has no end of its own.
    Choice,
    Comparison,
    Sum,
    Product,
    Power,
    Whole,
}

fn strength(expression: &Expression) -> Strength {
    match &expression.kind {
        Kind::Call(Function::If, _) => Strength::Choice,
        Kind::Binary(BinaryOperator::Add | BinaryOperator::Subtract, ..) => Strength::Sum,
        Kind::Binary(BinaryOperator::Multiply | BinaryOperator::Divide, ..) | Kind::Negate(_) => {
            Strength::Product
        }
        Kind::Binary(BinaryOperator::Power, ..) => Strength::Power,
        Kind::Binary(..) => Strength::Comparison,
        Kind::Number(value) if is_scientific(*value) => Strength::Product,
        Kind::Number(_) | Kind::Name(_) | Kind::Call(..) => Strength::Whole,
    }
}

/// Whether the first thing written of it is a minus sign.
fn begins_with_sign(mut expression: &Expression) -> bool {
    while let Kind::Binary(operator, left, _) = &expression.kind {
        if strength(left) < strength(expression) || *operator == BinaryOperator::Power {
            return false;
        }
        expression = left;
    }
    matches!(expression.kind, Kind::Negate(_))
}

fn is_scientific(value: f64) -> bool {
    value != 0.0 && !(1e-4..1e7).contains(&value.abs())
}

/// What is at the left end of a chain of operators of one strength, and the rest of it.
///
/// A chain may be as long as an expression, so that it is walked and not descended.
fn chain(expression: &Expression) -> (&Expression, Vec<(BinaryOperator, &Expression)>) {
    let own = strength(expression);
    let (mut first, mut rest) = (expression, Vec::new());
    while let Kind::Binary(operator, left, right) = &first.kind {
        if strength(first) != own {
            break;
        }
        rest.push((*operator, &**right));
        first = left;
    }
    rest.reverse();
    (first, rest)
}

impl Typesetter<'_> {
    fn whole(&self, expression: &Expression) -> Markup {
        match &expression.kind {
            Kind::Number(value) => number(*value),
            Kind::Name(name) => self.notation.name(name),
            Kind::Negate(inner) => html! { mrow { (minus()) (self.signed(inner)) } },
            Kind::Binary(BinaryOperator::Power, base, exponent) => {
                let base = self.inside(base, strength(base) < Strength::Whole || is_call(base));
                html! { msup { (base) (self.whole(exponent)) } }
            }
            Kind::Binary(BinaryOperator::Add | BinaryOperator::Subtract, ..) => {
                self.sum(expression)
            }
            Kind::Binary(BinaryOperator::Multiply | BinaryOperator::Divide, ..) => {
                self.product(expression)
            }
            Kind::Binary(operator, left, right) => html! {
                mrow { (self.whole(left)) mo { (symbol(*operator)) } (self.whole(right)) }
            },
            Kind::Call(function, arguments) => self.call(*function, arguments),
        }
    }

    /// In parentheses, where they are needed.
    fn inside(&self, expression: &Expression, parentheses: bool) -> Markup {
        let inner = self.whole(expression);
        if parentheses {
            html! { mrow { mo { "(" } (inner) mo { ")" } } }
        } else {
            inner
        }
    }

    /// Behind a minus sign.
    fn signed(&self, inner: &Expression) -> Markup {
        self.inside(
            inner,
            strength(inner) < Strength::Product || begins_with_sign(inner),
        )
    }

    fn sum(&self, expression: &Expression) -> Markup {
        let (first, rest) = chain(expression);
        html! {
            mrow {
                (self.inside(first, strength(first) < Strength::Sum))
                @for (operator, term) in rest {
                    @let weakest = if operator == BinaryOperator::Add { Strength::Sum } else { Strength::Product };
                    mo { (symbol(operator)) }
                    (self.inside(term, strength(term) < weakest || begins_with_sign(term)))
                }
            }
        }
    }

    /// Factors in a row; what is divided so far is the numerator of a fraction.
    fn product(&self, expression: &Expression) -> Markup {
        let (mut first, rest) = chain(expression);
        let mut sign = false;
        if let Kind::Negate(inner) = &first.kind
            && strength(inner) >= Strength::Product
            && !begins_with_sign(inner)
        {
            // the sign of a numerator is the fraction's
            (first, sign) = (inner, true);
        }
        let mut factors: Vec<Factor<'_>> = vec![Factor::Plain(first)];
        for (operator, right) in rest {
            if operator == BinaryOperator::Multiply {
                factors.push(Factor::Plain(right));
            } else if let [Factor::Fraction(_, divisors)] = factors.as_mut_slice() {
                divisors.push(right);
            } else {
                let numerator = self.factors(&factors);
                factors = vec![Factor::Fraction(numerator, vec![right])];
            }
        }
        html! { mrow { @if sign { (minus()) } (self.factors(&factors)) } }
    }

    fn factors(&self, factors: &[Factor<'_>]) -> Markup {
        html! {
            @for (at, factor) in factors.iter().enumerate() {
                @if at > 0 { (times(factor)) }
                @match factor {
                    Factor::Plain(single) => {
                        @let is_loose = strength(single) < Strength::Product || at > 0 && begins_with_sign(single);
                        (self.inside(single, is_loose && factors.len() > 1))
                    }
                    Factor::Fraction(numerator, divisors) => {
                        @let below: Vec<Factor<'_>> = divisors.iter().map(|divisor| Factor::Plain(divisor)).collect();
                        mfrac { mrow { (numerator) } mrow { (self.factors(&below)) } }
                    }
                }
            }
        }
    }

    fn call(&self, function: Function, arguments: &[Expression]) -> Markup {
        match (function, arguments) {
            (Function::Sqrt, [inner]) => html! { msqrt { (self.whole(inner)) } },
            (Function::Abs, [inner]) => {
                html! { mrow { mo form="prefix" { "|" } (self.whole(inner)) mo form="postfix" { "|" } } }
            }
            (Function::If, [condition, yes, no]) => html! {
                mrow {
                    mo form="prefix" { "{" }
                    mtable class="cases" {
                        mtr { mtd { (self.whole(yes)) } mtd { mtext { "if\u{a0}" } (self.whole(condition)) } }
                        mtr { mtd { (self.whole(no)) } mtd { mtext { "otherwise" } } }
                    }
                }
            },
            _ => html! {
                mrow {
                    mi mathvariant="normal" { (upright(function)) }
                    // tells a screen reader that a function is applied
                    mo { "\u{2061}" }
                    mo { "(" }
                    @for (at, argument) in arguments.iter().enumerate() {
                        @if at > 0 { mo separator="true" { "," } }
                        (self.whole(argument))
                    }
                    mo { ")" }
                }
            },
        }
    }
}

enum Factor<'a> {
    Plain(&'a Expression),
    /// Numerator and divisors.
    Fraction(Markup, Vec<&'a Expression>),
}

/// Between two factors: a dot where digits would run together, else a thin space.
fn times(next: &Factor<'_>) -> Markup {
    let mut next = match next {
        Factor::Fraction(..) => return invisible_times(),
        Factor::Plain(next) => *next,
    };
    while let Kind::Binary(BinaryOperator::Multiply | BinaryOperator::Power, left, _) = &next.kind {
        next = left;
    }
    if matches!(next.kind, Kind::Number(_)) {
        return html! { mo { "·" } };
    }
    invisible_times()
}

fn invisible_times() -> Markup {
    html! { mo lspace="0.1em" rspace="0.1em" { "\u{2062}" } }
}

fn minus() -> Markup {
    html! { mo form="prefix" { "−" } }
}

fn number(value: f64) -> Markup {
    if !is_scientific(value) {
        return html! { mn { (value) } };
    }
    let text = format!("{value:e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    html! {
        mrow { mn { (digits) } mo { "×" } msup { mn { "10" } mn { (exponent.replace('-', "−")) } } }
    }
}

fn is_call(expression: &Expression) -> bool {
    matches!(&expression.kind, Kind::Call(function, _) if *function != Function::Abs)
}

fn symbol(operator: BinaryOperator) -> &'static str {
    match operator {
        BinaryOperator::Add => "+",
        BinaryOperator::Subtract => "−",
        BinaryOperator::Multiply => "·",
        BinaryOperator::Divide => "/",
        BinaryOperator::Power => "^",
        BinaryOperator::Less => "<",
        BinaryOperator::LessOrEqual => "≤",
        BinaryOperator::Greater => ">",
        BinaryOperator::GreaterOrEqual => "≥",
    }
}

fn upright(function: Function) -> &'static str {
    match function {
        Function::Asin => "arcsin",
        Function::Acos => "arccos",
        Function::Atan => "arctan",
        _ => function.name(),
    }
}
