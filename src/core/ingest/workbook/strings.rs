//! The strings of a workbook, which its cells refer to by number.

use super::xml::{Event, Events, text};

/// All strings, one behind the other.
#[derive(Default)]
pub(super) struct Strings {
    text: String,
    ends: Vec<usize>,
}

impl Strings {
    pub(super) fn read(part: &str) -> Self {
        let mut strings = Self::default();
        let mut is_text = false;
        // how a word is spoken (rPh) is no part of it
        let mut is_phonetic = false;
        for event in Events::of(part) {
            match event {
                Event::Open {
                    name: "t",
                    is_empty,
                    ..
                } => is_text = !is_empty,
                Event::Close("t") => is_text = false,
                Event::Open {
                    name: "rPh",
                    is_empty,
                    ..
                } => is_phonetic = !is_empty,
                Event::Close("rPh") => is_phonetic = false,
                Event::Open {
                    name: "si",
                    is_empty: true,
                    ..
                }
                | Event::Close("si") => {
                    strings.ends.push(strings.text.len());
                }
                Event::Text(written) if is_text && !is_phonetic => {
                    strings.text.push_str(&text(written));
                }
                Event::Plain(plain) if is_text && !is_phonetic => strings.text.push_str(plain),
                _ => {}
            }
        }
        strings
    }

    /// The string of this number, from 0.
    pub(super) fn get(&self, at: usize) -> Option<&str> {
        let end = *self.ends.get(at)?;
        let start = at.checked_sub(1).map_or(0, |before| self.ends[before]);
        self.text.get(start..end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_are_found_by_number() {
        let part = "<sst><si><t>time</t></si><si><r><t>al</t></r><r><t xml:space='preserve'>pha </t></r><rPh><t>x</t></rPh></si><si/><si><t>&#176;</t></si></sst>";
        let strings = Strings::read(part);
        let all: Vec<&str> = (0..4).filter_map(|at| strings.get(at)).collect();
        assert_eq!(all, ["time", "alpha ", "", "°"]);
        assert_eq!(strings.get(4), None);
    }
}
