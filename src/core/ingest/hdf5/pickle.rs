//! Texts that pandas has Python pickle into attributes, with protocol 0.

/// The texts in a list, or the one text: a line each, in Latin-1, other letters as `\u03b2`.
pub(super) fn pickled(text: &[u8]) -> Vec<String> {
    let text = text.split(|byte| *byte == 0).next().unwrap_or_default();
    let texts = text.split(|byte| *byte == b'\n').filter_map(|line| {
        let line = line.strip_prefix(b"a").unwrap_or(line);
        line.strip_prefix(b"V").map(unescaped)
    });
    texts.collect()
}

/// A text of Python's codec `raw_unicode_escape`.
fn unescaped(mut text: &[u8]) -> String {
    let mut plain = String::new();
    while let Some((&byte, after)) = text.split_first() {
        let (letter, after) = escaped(text).unwrap_or((char::from(byte), after));
        plain.push(letter);
        text = after;
    }
    plain
}

/// The letter that a text begins with by its number, and what is behind it.
fn escaped(text: &[u8]) -> Option<(char, &[u8])> {
    let digits = match text.get(..2)? {
        b"\\u" => 4,
        b"\\U" => 8,
        _ => return None,
    };
    let (code, after) = text[2..].split_at_checked(digits)?;
    let code = u32::from_str_radix(str::from_utf8(code).ok()?, 16).ok()?;
    Some((char::from_u32(code)?, after))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_are_read_as_python_pickles_them() {
        // pickle.dumps(["alpha [°]", "β", "a\\b", "😀"], 0) of Python 3.11
        let text =
            b"(lp0\nValpha [\xb0]\np1\naV\\u03b2\np2\naVa\\u005cb\np3\naV\\U0001f600\np4\na.\0Vx\n";
        assert_eq!(pickled(text), ["alpha [°]", "β", "a\\b", "😀"]);
        assert_eq!(unescaped(b"\\x \\u12 \\uzzzz \\"), "\\x \\u12 \\uzzzz \\");
    }
}
