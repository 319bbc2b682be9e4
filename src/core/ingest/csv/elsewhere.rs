//! Titles that do not stand over their columns: a program says them in a line of its own before the rows.

use super::super::lines::Line;
use super::sample::Looked;

/// Names of as many columns as rows have cells, with the line that they begin in.
pub(super) fn names<'a>(lines: &[Looked<'a>], width: usize) -> Option<(Line<'a>, Vec<&'a str>)> {
    let found = [of_sections(lines), of_tecplot(lines), of_igor(lines)];
    found.into_iter().flatten().find_map(|(line, mut names)| {
        // a row may begin with a delimiter
        if names.len() + 1 == width {
            names.insert(0, "");
        }
        (names.len() == width).then_some((line, names))
    })
}

/// `[column names]` and below it a line of words (VBOX).
fn of_sections<'a>(lines: &[Looked<'a>]) -> Option<(Line<'a>, Vec<&'a str>)> {
    let is_heading = |looked: &Looked| {
        let text = looked.line.text.trim();
        text.eq_ignore_ascii_case("[column names]")
    };
    let at = lines.iter().position(is_heading)?;
    let line = lines.get(at + 1)?.line;
    Some((line, line.text.split_whitespace().collect()))
}

/// `VARIABLES = "t [s]" "alpha [deg]"`, over several lines where there are many (Tecplot).
fn of_tecplot<'a>(lines: &[Looked<'a>]) -> Option<(Line<'a>, Vec<&'a str>)> {
    let begins = |looked: &Looked| {
        let text = looked.line.text.trim_start();
        let word = text.get(..9).unwrap_or_default();
        word.eq_ignore_ascii_case("variables") && text[9..].trim_start().starts_with('=')
    };
    let at = lines.iter().position(begins)?;
    let line = lines[at].line;
    let (_, first) = line.text.split_once('=')?;
    let mut names = quoted(first);
    for looked in &lines[at + 1..] {
        let text = looked.line.text.trim();
        if !text.starts_with('"') {
            break;
        }
        names.extend(quoted(text));
    }
    Some((line, names))
}

/// Names in quotes; without any, words.
fn quoted(text: &str) -> Vec<&str> {
    match text.contains('"') {
        true => text.split('"').skip(1).step_by(2).collect(),
        false => {
            let words = text.split(|c: char| c == ',' || c.is_whitespace());
            words.filter(|word| !word.is_empty()).collect()
        }
    }
}

/// `WAVES/D t, alpha, q` (Igor).
fn of_igor<'a>(lines: &[Looked<'a>]) -> Option<(Line<'a>, Vec<&'a str>)> {
    let is_igor = lines.first()?.line.text.trim_end() == "IGOR";
    let begins = |looked: &&Looked| looked.line.text.starts_with("WAVES");
    let line = lines.iter().find(begins).filter(|_| is_igor)?.line;
    let names = line.text.split([' ', '\t', ',']).skip(1);
    Some((line, names.filter(|name| !name.is_empty()).collect()))
}
