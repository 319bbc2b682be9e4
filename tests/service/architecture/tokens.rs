//! Rust source to tokens, as far as it takes to see what a file names: identifiers, `::` and punctuation.
//!
//! Comments, literals and what stands under `#[cfg(test)]` are left out. A literal that is a path
//! (`deserialize_with = "super::unique::unique"`) names something and is read like code.

#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Token {
    pub(super) text: String,
    /// Counted from one.
    pub(super) line: usize,
}

impl Token {
    pub(super) fn is_word(&self) -> bool {
        self.text.starts_with(is_of_word)
    }
}

/// The tokens of a file without its unit tests.
pub(super) fn of_program(text: &str) -> Vec<Token> {
    without_tests(tokens(text))
}

fn tokens(text: &str) -> Vec<Token> {
    let mut found = Vec::new();
    let (mut rest, mut line) = (text, 1);
    while let Some(first) = rest.chars().next() {
        let length;
        if first.is_whitespace() {
            length = first.len_utf8();
        } else if let Some(comment) = comment(rest) {
            length = comment;
        } else if let Some(literal) = literal(rest) {
            length = literal;
            found.extend(path_in(&rest[..length], line));
        } else {
            length = word(rest)
                .or_else(|| rest.starts_with("::").then_some(2))
                .unwrap_or(first.len_utf8());
            let text = rest[..length].trim_start_matches("r#").to_owned();
            found.push(Token { text, line });
        }
        line += rest[..length].matches('\n').count();
        rest = &rest[length..];
    }
    found
}

/// The tokens of a literal that is a path.
fn path_in(literal: &str, line: usize) -> Vec<Token> {
    let text = literal.trim_matches('"');
    let starts = ["crate::", "super::", "self::"];
    if !starts.iter().any(|start| text.starts_with(start)) {
        return Vec::new();
    }
    let path = tokens(text).into_iter();
    path.map(|token| Token { line, ..token }).collect()
}

fn is_of_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn word(rest: &str) -> Option<usize> {
    let raw = if rest.starts_with("r#") { 2 } else { 0 };
    let end = rest[raw..]
        .find(|c| !is_of_word(c))
        .unwrap_or(rest.len() - raw);
    (end > 0).then_some(raw + end)
}

/// The length of the comment that begins here; block comments nest.
fn comment(rest: &str) -> Option<usize> {
    if rest.starts_with("//") {
        return Some(rest.find('\n').unwrap_or(rest.len()));
    }
    if !rest.starts_with("/*") {
        return None;
    }
    let (mut at, mut depth) = (2, 1);
    while depth > 0 {
        let next = &rest[at..];
        let (step, change) = if next.starts_with("/*") {
            (2, 1)
        } else if next.starts_with("*/") {
            (2, -1)
        } else {
            (next.chars().next()?.len_utf8(), 0)
        };
        at += step;
        depth += change;
    }
    Some(at)
}

/// The length of the string or character that begins here. A lifetime is none.
fn literal(rest: &str) -> Option<usize> {
    raw_string(rest)
        .or_else(|| plain_string(rest))
        .or_else(|| character(rest))
}

fn raw_string(rest: &str) -> Option<usize> {
    let after = ["br", "cr", "r"]
        .iter()
        .find_map(|prefix| rest.strip_prefix(prefix))?;
    let hashes = after.len() - after.trim_start_matches('#').len();
    let inside = after[hashes..].strip_prefix('"')?;
    let end = format!("\"{}", &after[..hashes]);
    Some(rest.len() - inside.len() + inside.find(&end)? + end.len())
}

fn plain_string(rest: &str) -> Option<usize> {
    let inside = rest
        .strip_prefix(['b', 'c'])
        .unwrap_or(rest)
        .strip_prefix('"')?;
    let mut characters = inside.char_indices();
    while let Some((at, c)) = characters.next() {
        match c {
            '\\' => drop(characters.next()),
            '"' => return Some(rest.len() - inside.len() + at + 1),
            _ => {}
        }
    }
    None
}

fn character(rest: &str) -> Option<usize> {
    let inside = rest.strip_prefix('b').unwrap_or(rest).strip_prefix('\'')?;
    let first = inside.chars().next()?;
    let end = if first == '\\' {
        2 + inside.get(2..)?.find('\'')?
    } else {
        inside[first.len_utf8()..]
            .starts_with('\'')
            .then_some(first.len_utf8())?
    };
    Some(rest.len() - inside.len() + end + 1)
}

fn without_tests(tokens: Vec<Token>) -> Vec<Token> {
    let mut kept = Vec::new();
    let mut rest = &tokens[..];
    while !rest.is_empty() {
        if starts_with(rest, &["#", "[", "cfg", "(", "test", ")", "]"]) {
            rest = &rest[end_of_item(rest)..];
        } else {
            kept.push(rest[0].clone());
            rest = &rest[1..];
        }
    }
    kept
}

fn starts_with(tokens: &[Token], words: &[&str]) -> bool {
    tokens.len() >= words.len()
        && tokens
            .iter()
            .zip(words)
            .all(|(token, word)| token.text == *word)
}

/// Behind the attributes, the first `;` or the end of the first `{...}`; a `use` ends with its `;` alone.
fn end_of_item(tokens: &[Token]) -> usize {
    let mut at = 0;
    while starts_with(&tokens[at..], &["#", "["]) {
        at += 1 + end_of_group(&tokens[at + 1..]);
    }
    let to_semicolon = starts_with(&tokens[at..], &["use"]);
    while at < tokens.len() {
        match tokens[at].text.as_str() {
            ";" => return at + 1,
            "{" => {
                at += end_of_group(&tokens[at..]);
                if !to_semicolon {
                    return at;
                }
            }
            "(" | "[" => at += end_of_group(&tokens[at..]),
            _ => at += 1,
        }
    }
    at
}

/// Behind the bracket that closes the first.
pub(super) fn end_of_group(tokens: &[Token]) -> usize {
    let mut depth = 0;
    for (at, token) in tokens.iter().enumerate() {
        match token.text.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return at + 1;
        }
    }
    tokens.len()
}

#[test]
fn comments_literals_and_tests_are_left_out() {
    let text = r##"
        // crate::a
        /* crate::b /* nested */ crate::c */
        fn f<'a>(x: &'a str) -> char { let _ = ("crate :: d", r#"crate::"e"#, b'\'', '"'); '\u{1}' }
        #[serde(with = "super::unique::unique")]
        struct S;
        #[cfg(test)]
        #[allow(unused)]
        use crate::{f, g};
        #[cfg(test)]
        mod tests { use crate::h; fn x() {} }
        type T = r#type::End;
    "##;
    let words: Vec<String> = of_program(text)
        .into_iter()
        .filter(Token::is_word)
        .map(|token| token.text)
        .collect();
    let expected =
        "fn f a x a str char let _ serde with super unique unique struct S type T type End";
    assert_eq!(words.join(" "), expected);
    assert_eq!(of_program("a\n/*\n*/ b")[1].line, 3);
}
