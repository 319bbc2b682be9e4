//! Text to tokens.

use super::{Span, SyntaxError};

#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Token<'a> {
    Number(f64),
    Name(&'a str),
    /// A unit with its square brackets.
    Unit(&'a str),
    /// An operator, bracket or comma, as it is written.
    Symbol(&'static str),
    End,
}

/// Longest first, so that `<=` is not read as `<`.
const SYMBOLS: [&str; 12] = ["<=", ">=", "+", "-", "*", "/", "^", "(", ")", ",", "<", ">"];

pub(super) fn tokens(text: &str) -> Result<Vec<(Token<'_>, Span)>, SyntaxError> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(next) = text[at..].chars().next() {
        let rest = &text[at..];
        if next.is_whitespace() {
            at += next.len_utf8();
            continue;
        }
        let (token, length) = if next.is_ascii_digit() || next == '.' {
            number(rest, at)?
        } else if next.is_ascii_alphabetic() || next == '_' {
            let length = rest
                .find(|c: char| !c.is_ascii_alphanumeric() && c != '_')
                .unwrap_or(rest.len());
            (Token::Name(&rest[..length]), length)
        } else if let Some(end) = rest.find(']').filter(|_| next == '[') {
            (Token::Unit(&rest[..=end]), end + 1)
        } else if let Some(symbol) = SYMBOLS.into_iter().find(|symbol| rest.starts_with(symbol)) {
            (Token::Symbol(symbol), symbol.len())
        } else {
            let span = Span {
                start: at,
                end: at + next.len_utf8(),
            };
            return Err(SyntaxError {
                span,
                message: format!("'{}' has no meaning here", next.escape_default()),
            });
        };
        tokens.push((
            token,
            Span {
                start: at,
                end: at + length,
            },
        ));
        at += length;
    }
    tokens.push((
        Token::End,
        Span {
            start: text.len(),
            end: text.len(),
        },
    ));
    Ok(tokens)
}

fn number(rest: &str, at: usize) -> Result<(Token<'static>, usize), SyntaxError> {
    let bytes = rest.as_bytes();
    let digits = |from: usize| {
        bytes[from..]
            .iter()
            .take_while(|b| b.is_ascii_digit())
            .count()
    };
    let mut end = digits(0);
    if bytes.get(end) == Some(&b'.') {
        end += 1;
        end += digits(end);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits(end + 1 + sign);
        if exponent > 0 {
            end += 1 + sign + exponent;
        }
    }
    match rest[..end].parse::<f64>() {
        Ok(value) if value.is_finite() => Ok((Token::Number(value), end)),
        _ => {
            let span = Span {
                start: at,
                end: at + end.max(1),
            };
            Err(SyntaxError {
                span,
                message: format!("'{}' is not a number", &rest[..end.max(1)]),
            })
        }
    }
}
