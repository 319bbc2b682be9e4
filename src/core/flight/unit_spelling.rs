//! Units as people write them, and the symbols that are meant: `DEG/SEC`, `m/s²`, `degrees per second`, `ft msl`.

use super::unit_symbols::{SYMBOLS, meaning};
use super::unit_words::{QUALIFIERS, WHOLE, WORDS};

/// The same unit in symbols, as far as they are known; what is not stays as it is written.
pub(super) fn plain(text: &str) -> String {
    let text = without_brackets(text.trim()).trim_matches(['_', '\u{200b}']);
    if let Some(symbols) = as_a_whole(text) {
        return symbols.to_string();
    }
    if let Some((unit, qualifier)) = text.rsplit_once([' ', '_'])
        && QUALIFIERS.contains(&qualifier.to_lowercase().as_str())
        && !unit.trim().is_empty()
    {
        return plain(unit);
    }
    // deg (TEU +): which way is positive is said behind the unit
    if let Some((unit, remark)) = text.rsplit_once(" (")
        && let Some(remark) = remark.strip_suffix(')')
        && !remark.contains(['/', '^', '*'])
        && meaning(remark).is_none()
    {
        return plain(unit);
    }
    match text.strip_suffix('.') {
        Some(unit) if !unit.is_empty() && !unit.contains('.') => in_symbols(unit),
        _ => in_symbols(text),
    }
}

/// What is meant by a text that is symbols, too, of something that is not recorded in flight: `lb/ft^2` is a pressure,
/// `ft lb` a moment, `deg K` a temperature, `deg*100` hundredths of a degree.
pub(super) fn other_than_written(text: &str) -> Option<&'static str> {
    let is_compound = |c: char| matches!(c, '/' | '*' | ' ' | '-');
    let text = without_brackets(text.trim());
    text.contains(is_compound)
        .then(|| as_a_whole(text))
        .flatten()
        .filter(|symbols| *symbols != "-")
}

fn without_brackets(text: &str) -> &str {
    let pairs = [('[', ']'), ('(', ')'), ('{', '}'), ('<', '>')];
    let inside = pairs.iter().find_map(|&(open, close)| {
        let inside = text.strip_prefix(open)?.strip_suffix(close)?;
        (!inside.contains([open, close])).then_some(inside)
    });
    inside.map_or(text, str::trim)
}

fn as_a_whole(text: &str) -> Option<&'static str> {
    match text {
        // a coulomb or a farad is not recorded in flight
        "C" => return Some("degC"),
        "F" => return Some("degF"),
        _ => {}
    }
    let key: String = text
        .chars()
        .filter(|c| !c.is_whitespace() && *c != '_')
        .map(|c| if matches!(c, 'º' | '˚') { '°' } else { c })
        .flat_map(char::to_lowercase)
        .collect();
    let found = WHOLE.iter().find(|(written, _)| *written == key);
    found.map(|&(_, symbols)| symbols).or(match key.as_str() {
        "inhg" | "in.hg" | "inchhg" | "incheshg" | "inmercury" => Some("inHg"),
        "mmhg" | "torr" => Some("mmHg"),
        "inh2o" => Some("inH2O"),
        _ => None,
    })
}

/// Word by word: symbols for words, `^` for powers, `*` and `/` for what is between.
fn in_symbols(text: &str) -> String {
    let is_compound = text.contains(['/', '*', '^']);
    let mut plain = String::with_capacity(text.len() + 4);
    let mut rest = text;
    // whether a digit that comes now is a power
    let mut is_behind_symbol = false;
    while let Some(first) = rest.chars().next() {
        if is_of_word(first) {
            let end = rest.find(|c| !is_of_word(c)).unwrap_or(rest.len());
            let (word, behind) = rest.split_at(end);
            rest = behind;
            match word.to_lowercase().as_str() {
                "per" => {
                    replace_blanks(&mut plain, "/");
                    rest = rest.trim_start();
                }
                "squared" | "sq" if ends_with_symbol(&plain) => replace_blanks(&mut plain, "^2"),
                "cubed" if ends_with_symbol(&plain) => replace_blanks(&mut plain, "^3"),
                _ => plain.push_str(&symbol(word, is_compound)),
            }
            is_behind_symbol = true;
            continue;
        }
        if first.is_ascii_digit() && !is_behind_symbol {
            let (number, behind) = rest.split_at(number_length(rest));
            plain.push_str(number);
            rest = behind;
            continue;
        }
        rest = &rest[first.len_utf8()..];
        let next = rest.chars().next();
        let is_before = |accept: fn(char) -> bool| next.is_some_and(accept);
        match first {
            '*' if next == Some('*') => {
                rest = &rest[1..];
                plain.push('^');
            }
            '·' | '⋅' | '×' | '•' => plain.push('*'),
            '²' => plain.push_str("^2"),
            '³' => plain.push_str("^3"),
            '⁻' => {
                plain.push_str("^-");
                if let Some(digit) = next.and_then(superscript) {
                    rest = &rest[next.map_or(0, char::len_utf8)..];
                    plain.push(digit);
                }
            }
            '¹' => {}
            '-' | '−' if is_behind_symbol && is_before(is_of_word) => plain.push('*'),
            '-' | '−' if is_behind_symbol && is_before(|c| c.is_ascii_digit()) => {
                plain.push_str("^-");
                is_behind_symbol = false;
                continue;
            }
            '0'..='9' if is_behind_symbol => {
                plain.push('^');
                plain.push(first);
            }
            _ => plain.push(first),
        }
        is_behind_symbol = first == ')';
    }
    plain
}

/// The bytes of a number at the beginning of a text: digits, a point, an exponent.
pub(super) fn number_length(text: &str) -> usize {
    let is_digit = |c: char| c.is_ascii_digit();
    let is_of_number = |c: char| is_digit(c) || c == '.';
    let mantissa = text.find(|c| !is_of_number(c)).unwrap_or(text.len());
    let Some(exponent) = text[mantissa..].strip_prefix(['e', 'E']) else {
        return mantissa;
    };
    let digits = exponent.strip_prefix(['-', '+']).unwrap_or(exponent);
    match digits.find(|c| !is_digit(c)).unwrap_or(digits.len()) {
        0 => mantissa,
        count => mantissa + 1 + (exponent.len() - digits.len()) + count,
    }
}

fn ends_with_symbol(plain: &str) -> bool {
    plain.trim_end().ends_with(is_of_word)
}

fn replace_blanks(plain: &mut String, with: &str) {
    plain.truncate(plain.trim_end().len());
    plain.push_str(with);
}

fn superscript(c: char) -> Option<char> {
    match c {
        '¹' => Some('1'),
        '²' => Some('2'),
        '³' => Some('3'),
        _ => None,
    }
}

fn is_of_word(c: char) -> bool {
    (c.is_alphabetic() && c != 'º') || matches!(c, '%' | '°' | 'º' | '˚' | '_')
}

/// The symbol that a word means; the word itself where none is known.
fn symbol(word: &str, is_compound: bool) -> String {
    let word = word.replace(['º', '˚'], "°");
    match word.as_str() {
        // siemens are not recorded in flight; M alone may be a Mach number
        "S" => return "s".to_string(),
        "M" if is_compound => return "m".to_string(),
        "Nm" => return "N*m".to_string(),
        "kNm" => return "kN*m".to_string(),
        _ => {}
    }
    let lower = word.to_lowercase();
    if let Some((_, symbol)) = WORDS.iter().find(|(written, _)| *written == lower) {
        return (*symbol).to_string();
    }
    if meaning(&word).is_some() {
        return word;
    }
    in_another_case(&word, &lower).map_or(word, str::to_string)
}

/// The one symbol that differs from a word in case only. Where case tells two apart there is none.
fn in_another_case(word: &str, lower: &str) -> Option<&'static str> {
    if matches!(word, "Mm" | "Ms" | "Mg" | "M" | "H" | "nm") {
        return None;
    }
    let mut found: Option<&'static str> = None;
    for candidate in SYMBOLS
        .iter()
        .filter(|symbol| symbol.to_lowercase() == lower)
    {
        match found {
            Some(other) if meaning(other) != meaning(candidate) => return None,
            Some(_) => {}
            None => found = Some(candidate),
        }
    }
    found
}

/// What may have been meant by a symbol that is not known.
pub(super) fn suggestion(symbol: &str) -> Option<&'static str> {
    match symbol {
        "M" => return Some("m for metres, or - for a Mach number"),
        "nm" | "Nautical" | "nautical" => return Some("nmi for nautical miles, or N*m"),
        "KN" => return Some("kt for knots, or kN"),
        "H" => return Some("h"),
        _ => {}
    }
    let lower = symbol.to_lowercase();
    let spellings = SYMBOLS
        .iter()
        .map(|symbol| (*symbol, *symbol))
        .chain(WORDS.iter().copied());
    let allowed = match lower.chars().count() {
        0..=2 => 0,
        3..=4 => 1,
        _ => 2,
    };
    spellings
        .map(|(written, symbol)| {
            (
                strsim::osa_distance(&lower, &written.to_lowercase()),
                symbol,
            )
        })
        .filter(|&(distance, _)| distance <= allowed)
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, symbol)| symbol)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spellings_become_symbols() {
        for (written, expected) in [
            ("DEG/SEC", "deg/s"),
            ("degrees per second", "deg/s"),
            ("M/S**2", "m/s^2"),
            ("m/s²", "m/s^2"),
            ("m s-1", "m s^-1"),
            ("m·s⁻²", "m*s^-2"),
            ("kg-m2", "kg*m^2"),
            ("slug-ft^2", "slug*ft^2"),
            ("deg C", "degC"),
            ("ºC", "degC"),
            ("ft msl", "ft"),
            ("kt_IAS", "kt"),
            ("__deg", "deg"),
            ("_kias", "kt"),
            ("[deg]", "deg"),
            ("FT-LBS", "ft*lbf"),
            ("Nm", "N*m"),
            ("0.01 deg", "0.01 deg"),
            ("1e-7 degrees", "1e-7 deg"),
            ("in Hg", "inHg"),
            ("LBS", "lb"),
            ("meters/second squared", "m/s^2"),
            ("furlong", "furlong"),
        ] {
            assert_eq!(plain(written), expected, "{written}");
        }
    }

    #[test]
    fn case_that_tells_two_apart_is_not_guessed() {
        for written in ["nm", "KN", "Mg", "M", "H"] {
            assert_eq!(plain(written), written);
            assert!(meaning(written).is_none(), "{written}");
        }
        assert!(suggestion("M").unwrap().contains("Mach"));
        assert_eq!(suggestion("degg"), Some("deg"));
        assert_eq!(suggestion("furlong"), None);
    }
}
