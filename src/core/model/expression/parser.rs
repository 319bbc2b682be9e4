//! Tokens to a tree, by precedence climbing, within bounds on length, depth and size.

use super::lexer::{Token, tokens};
use super::{
    BinaryOperator, DEEPEST, Expression, Function, Kind, LONGEST, MOST_NODES, Span, SyntaxError,
    written_unit,
};

/// Reads an expression.
///
/// # Errors
/// Names the column at which reading stopped making sense, or the bound that was passed.
pub fn parse(text: &str) -> Result<Expression, SyntaxError> {
    if text.len() > LONGEST {
        let span = Span {
            start: LONGEST,
            end: text.len(),
        };
        let message = format!(
            "the expression has {} bytes, at most {LONGEST} are allowed",
            text.len()
        );
        return Err(SyntaxError { span, message });
    }
    let mut parser = Parser {
        tokens: tokens(text)?,
        at: 0,
        depth: 0,
        nodes: 0,
    };
    let expression = parser.expression(0)?;
    if parser.peek() != Token::End {
        return Err(parser.unexpected("an operator or the end of the expression"));
    }
    match misplaced_comparison(&expression) {
        Some(span) => Err(SyntaxError {
            span,
            message: "a comparison may stand only as the condition of if(condition, a, b)"
                .to_string(),
        }),
        None => Ok(expression),
    }
}

/// A comparison that is not the condition of an `if`.
fn misplaced_comparison(expression: &Expression) -> Option<Span> {
    match &expression.kind {
        Kind::Number(_) | Kind::Name(_) => None,
        Kind::Negate(inner) => misplaced_comparison(inner),
        Kind::Binary(operator, ..) if operator.is_comparison() => Some(expression.span),
        Kind::Binary(_, left, right) => {
            misplaced_comparison(left).or_else(|| misplaced_comparison(right))
        }
        Kind::Call(Function::If, arguments) => {
            arguments
                .iter()
                .enumerate()
                .find_map(|(i, argument)| match &argument.kind {
                    Kind::Binary(operator, left, right) if i == 0 && operator.is_comparison() => {
                        misplaced_comparison(left).or_else(|| misplaced_comparison(right))
                    }
                    _ => misplaced_comparison(argument),
                })
        }
        Kind::Call(_, arguments) => arguments.iter().find_map(misplaced_comparison),
    }
}

struct Parser<'a> {
    tokens: Vec<(Token<'a>, Span)>,
    at: usize,
    depth: usize,
    nodes: usize,
}

/// Binding powers: an operator takes what follows as long as that binds tighter.
const COMPARISON: u8 = 1;
const SUM: u8 = 2;
const PRODUCT: u8 = 3;
const SIGN: u8 = 4;
const POWER: u8 = 5;

fn operator(symbol: &str) -> Option<(BinaryOperator, u8)> {
    Some(match symbol {
        "<" => (BinaryOperator::Less, COMPARISON),
        "<=" => (BinaryOperator::LessOrEqual, COMPARISON),
        ">" => (BinaryOperator::Greater, COMPARISON),
        ">=" => (BinaryOperator::GreaterOrEqual, COMPARISON),
        "+" => (BinaryOperator::Add, SUM),
        "-" => (BinaryOperator::Subtract, SUM),
        "*" => (BinaryOperator::Multiply, PRODUCT),
        "/" => (BinaryOperator::Divide, PRODUCT),
        "^" => (BinaryOperator::Power, POWER),
        _ => return None,
    })
}

impl<'a> Parser<'a> {
    fn expression(&mut self, weakest: u8) -> Result<Expression, SyntaxError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            let message = format!("nested deeper than {DEEPEST} levels; split it with definitions");
            return Err(SyntaxError {
                span: self.span(),
                message,
            });
        }
        let mut left = self.operand()?;
        while let Token::Symbol(symbol) = self.peek()
            && let Some((operator, strength)) = operator(symbol)
            && strength > weakest
        {
            self.advance();
            // `^` groups to the right, all others to the left
            let right = self.expression(if operator == BinaryOperator::Power {
                strength - 1
            } else {
                strength
            })?;
            let span = Span {
                start: left.span.start,
                end: right.span.end,
            };
            left = self.node(
                Kind::Binary(operator, Box::new(left), Box::new(right)),
                span,
            )?;
        }
        self.depth -= 1;
        Ok(left)
    }

    fn operand(&mut self) -> Result<Expression, SyntaxError> {
        let span = self.span();
        match self.peek() {
            Token::Number(value) => {
                self.advance();
                let number = self.node(Kind::Number(value), span)?;
                let Token::Unit(_) = self.peek() else {
                    return Ok(number);
                };
                // 2[Hz] is 2*[Hz], and binds tighter than all else
                let unit = self.operand()?;
                let span = Span {
                    start: span.start,
                    end: unit.span.end,
                };
                let product =
                    Kind::Binary(BinaryOperator::Multiply, Box::new(number), Box::new(unit));
                self.node(product, span)
            }
            Token::Unit(text) => {
                let why = match written_unit(text) {
                    Some(Ok(unit)) if unit.offset == 0.0 => None,
                    Some(Ok(_)) => Some("a temperature that does not count from absolute zero has no place in a formula; write it in K".to_string()),
                    Some(Err(error)) => Some(error.to_string()),
                    None => Some("there is no unit in the brackets".to_string()),
                };
                if let Some(message) = why {
                    return Err(SyntaxError { span, message });
                }
                self.advance();
                self.node(Kind::Name(text.to_string()), span)
            }
            Token::Name(name) => {
                self.advance();
                if self.peek() == Token::Symbol("(") {
                    return self.call(name, span);
                }
                self.node(Kind::Name(name.to_string()), span)
            }
            Token::Symbol("(") => {
                self.advance();
                let inner = self.expression(0)?;
                self.expect(")")?;
                Ok(inner)
            }
            Token::Symbol(sign @ ("-" | "+")) => {
                self.advance();
                let inner = self.expression(SIGN)?;
                let span = Span {
                    start: span.start,
                    end: inner.span.end,
                };
                if sign == "+" {
                    Ok(inner)
                } else {
                    self.node(Kind::Negate(Box::new(inner)), span)
                }
            }
            _ => Err(self.unexpected("a number, a name or '('")),
        }
    }

    fn call(&mut self, name: &str, span: Span) -> Result<Expression, SyntaxError> {
        let Some(function) = Function::find(name) else {
            let known: Vec<_> = Function::names().collect();
            let message = format!(
                "there is no function '{name}'; choose one of {}",
                known.join(", ")
            );
            return Err(SyntaxError { span, message });
        };
        self.expect("(")?;
        let mut arguments = vec![self.expression(0)?];
        while self.peek() == Token::Symbol(",") {
            self.advance();
            arguments.push(self.expression(0)?);
        }
        let end = self.span().end;
        self.expect(")")?;
        if arguments.len() != function.arguments() {
            let message = format!(
                "{name} takes {} argument(s), {} are given",
                function.arguments(),
                arguments.len()
            );
            return Err(SyntaxError { span, message });
        }
        self.node(
            Kind::Call(function, arguments),
            Span {
                start: span.start,
                end,
            },
        )
    }

    fn node(&mut self, kind: Kind, span: Span) -> Result<Expression, SyntaxError> {
        self.nodes += 1;
        if self.nodes > MOST_NODES {
            let message = format!(
                "more than {MOST_NODES} operators, names and numbers; split it with definitions"
            );
            return Err(SyntaxError { span, message });
        }
        Ok(Expression { kind, span })
    }

    fn peek(&self) -> Token<'a> {
        self.tokens[self.at].0
    }

    fn span(&self) -> Span {
        self.tokens[self.at].1
    }

    fn advance(&mut self) {
        // the last token is `End`, which nothing moves past
        self.at = (self.at + 1).min(self.tokens.len() - 1);
    }

    fn expect(&mut self, symbol: &'static str) -> Result<(), SyntaxError> {
        if self.peek() == Token::Symbol(symbol) {
            self.advance();
            return Ok(());
        }
        Err(self.unexpected(&format!("'{symbol}'")))
    }

    fn unexpected(&self, wanted: &str) -> SyntaxError {
        let found = match self.peek() {
            Token::End => "the expression ends".to_string(),
            Token::Number(value) => format!("there is the number {value}"),
            Token::Name(name) => format!("there is '{name}'"),
            Token::Unit(unit) => format!("there is the unit {unit}"),
            Token::Symbol(symbol) => format!("there is '{symbol}'"),
        };
        SyntaxError {
            span: self.span(),
            message: format!("{found} where {wanted} should be"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn printed(text: &str) -> String {
        parse(text).unwrap().to_string()
    }

    #[test]
    fn precedence_is_that_of_mathematics() {
        assert_eq!(parse("a+b*c"), parse("a+(b*c)"));
        assert_eq!(parse("a-b-c"), parse("(a-b)-c"));
        assert_eq!(parse("a^b^c"), parse("a^(b^c)"));
        assert_eq!(parse("-a^2"), parse("-(a^2)"));
        assert_eq!(parse("-a*b"), parse("(-a)*b"));
        assert_eq!(parse("a^-2"), parse("a^(-2)"));
        assert_eq!(parse("a/b*c"), parse("(a/b)*c"));
        assert_ne!(parse("a-(b-c)"), parse("a-b-c"));
    }

    #[test]
    fn prints_what_it_read() {
        for text in [
            "a + b*c",
            "a - (b - c)",
            "(-a)^2",
            "-a^2",
            "if(a < 0.5, a^2, -b)",
            "a*(b + c)/d",
            "1e-300*x",
            "9.80665[m/s^2]*a",
            "2[m]^2/3 [1/(m*s)]",
            "a*[deg]",
        ] {
            assert_eq!(
                parse(&printed(text)),
                parse(text),
                "{text} became {}",
                printed(text)
            );
        }
        assert_eq!(printed("a-(b-c)*2"), "a - (b - c)*2");
    }

    #[test]
    fn errors_name_the_column() {
        let fault = |text: &str| parse(text).unwrap_err().to_string();
        assert_eq!(
            fault("a + "),
            "column 5: the expression ends where a number, a name or '(' should be"
        );
        assert_eq!(
            fault("a b"),
            "column 3: there is 'b' where an operator or the end of the expression should be"
        );
        assert!(
            fault("a + sine(b)")
                .starts_with("column 5: there is no function 'sine'; choose one of sin,")
        );
        assert_eq!(
            fault("atan2(a)"),
            "column 1: atan2 takes 2 argument(s), 1 are given"
        );
        assert_eq!(fault("a $ b"), "column 3: '$' has no meaning here");
        assert_eq!(
            fault("1.2.3"),
            "column 4: there is the number 0.3 where an operator or the end of the expression should be"
        );
        assert_eq!(fault("1e999"), "column 1: '1e999' is not a number");
        assert!(fault("a + 2[warp]").starts_with("column 6: unknown unit 'warp'"));
        assert!(fault("15[degC]").contains("write it in K"));
        assert!(fault("a[deg]").starts_with("column 2: there is the unit [deg] where"));
        assert!(fault("2[m").contains("'[' has no meaning here"));
        assert!(fault("α").contains("has no meaning"));
        assert!(
            fault("1 + (a < b)").starts_with("column 6: a comparison may stand only"),
            "{}",
            fault("1 + (a < b)")
        );
        assert!(parse("if(a < b, if(c >= d, 1, 2), 3)").is_ok());
    }

    #[test]
    fn hostile_text_is_bounded() {
        assert!(
            parse(&"(".repeat(100_000))
                .unwrap_err()
                .message
                .contains("bytes")
        );
        assert!(
            parse(&"(".repeat(8_000))
                .unwrap_err()
                .message
                .contains("nested deeper")
        );
        assert!(
            parse(&"-".repeat(8_000))
                .unwrap_err()
                .message
                .contains("nested deeper")
        );
        assert!(
            parse(&format!("{}1", "2^".repeat(4_000)))
                .unwrap_err()
                .message
                .contains("nested deeper")
        );
        assert!(
            parse(&format!("1{}", "+1".repeat(4_000)))
                .unwrap_err()
                .message
                .contains("operators")
        );
        assert!(parse("").is_err());
    }
}
