//! The part of XML that the parts of a workbook are written in: elements, attributes, text. Prefixes are left out.

/// What comes next in a text.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Event<'a> {
    Open {
        name: &'a str,
        attributes: &'a str,
        /// Whether it is closed at once.
        is_empty: bool,
    },
    Close(&'a str),
    /// As it is written; see [`text`].
    Text(&'a str),
    /// Text in which nothing is escaped.
    Plain(&'a str),
}

/// The events of a text, one after the other; what cannot be read ends it.
#[derive(Clone)]
pub(super) struct Events<'a> {
    rest: &'a str,
}

impl<'a> Events<'a> {
    pub(super) fn of(text: &'a str) -> Self {
        let rest = text.strip_prefix('\u{feff}').unwrap_or(text);
        Self { rest }
    }
}

impl<'a> Iterator for Events<'a> {
    type Item = Event<'a>;

    fn next(&mut self) -> Option<Event<'a>> {
        loop {
            if self.rest.is_empty() {
                return None;
            }
            let Some(tag) = self.rest.strip_prefix('<') else {
                let end = memchr::memchr(b'<', self.rest.as_bytes()).unwrap_or(self.rest.len());
                let (text, rest) = self.rest.split_at(end);
                self.rest = rest;
                return Some(Event::Text(text));
            };
            let mut skip = |open: &str, close: &str| {
                let inside = tag.strip_prefix(open)?;
                let end = inside.find(close).unwrap_or(inside.len());
                self.rest = inside.get(end + close.len()..).unwrap_or_default();
                Some(&inside[..end])
            };
            if let Some(plain) = skip("![CDATA[", "]]>") {
                return Some(Event::Plain(plain));
            }
            if skip("!--", "-->").is_some() || skip("?", "?>").is_some() || skip("!", ">").is_some()
            {
                continue;
            }
            let end = end_of_tag(tag)?;
            self.rest = &tag[end + 1..];
            let tag = &tag[..end];
            if let Some(name) = tag.strip_prefix('/') {
                return Some(Event::Close(local(name.trim())));
            }
            let (tag, is_empty) = match tag.strip_suffix('/') {
                Some(tag) => (tag, true),
                None => (tag, false),
            };
            let (name, attributes) = tag.split_once(char::is_whitespace).unwrap_or((tag, ""));
            return Some(Event::Open {
                name: local(name),
                attributes,
                is_empty,
            });
        }
    }
}

/// Where the `>` of a tag is; one in a value of an attribute does not count.
fn end_of_tag(tag: &str) -> Option<usize> {
    let mut quote = None;
    tag.bytes().position(|byte| match (quote, byte) {
        (None, b'>') => true,
        (None, b'"' | b'\'') => {
            quote = Some(byte);
            false
        }
        (Some(open), _) if open == byte => {
            quote = None;
            false
        }
        _ => false,
    })
}

fn local(name: &str) -> &str {
    name.rsplit_once(':').map_or(name, |(_, local)| local)
}

/// The value of an attribute, as it is written.
pub(super) fn attribute<'a>(attributes: &'a str, name: &str) -> Option<&'a str> {
    let mut rest = attributes;
    loop {
        let (key, behind) = rest.split_once('=')?;
        let behind = behind.trim_start();
        let quote = behind
            .chars()
            .next()
            .filter(|quote| matches!(quote, '"' | '\''))?;
        let (value, next) = behind[1..].split_once(quote)?;
        if local(key.trim()) == name {
            return Some(value);
        }
        rest = next;
    }
}

/// Bytes of the longest name behind an `&`, with its `;`: `#x0010FFFF;`.
const LONGEST_NAME: usize = 12;

/// Text as it is meant: `&lt;` is `<`.
pub(super) fn text(written: &str) -> String {
    let mut text = String::with_capacity(written.len());
    let mut rest = written;
    while let Some((before, behind)) = rest.split_once('&') {
        text.push_str(before);
        let near = &behind.as_bytes()[..behind.len().min(LONGEST_NAME)];
        let known = memchr::memchr(b';', near).and_then(|end| {
            let (name, next) = (&behind[..end], &behind[end + 1..]);
            let code = match name.strip_prefix('#') {
                Some(number) => match number.strip_prefix(['x', 'X']) {
                    Some(digits) => u32::from_str_radix(digits, 16).ok()?,
                    None => number.parse().ok()?,
                },
                None => match name {
                    "lt" => '<' as u32,
                    "gt" => '>' as u32,
                    "amp" => '&' as u32,
                    "quot" => '"' as u32,
                    "apos" => '\'' as u32,
                    _ => return None,
                },
            };
            Some((char::from_u32(code)?, next))
        });
        match known {
            Some((character, next)) => {
                text.push(character);
                rest = next;
            }
            None => {
                text.push('&');
                rest = behind;
            }
        }
    }
    text.push_str(rest);
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_attributes_and_text_are_told_apart() {
        let text = "\u{feff}<?xml version=\"1.0\"?><!-- <a> --><x:c r='A1' t=\"s>\"><v>1</v><e /><![CDATA[<]]></x:c>";
        let events: Vec<Event> = Events::of(text).collect();
        assert_eq!(events.len(), 7);
        let Event::Open {
            name,
            attributes,
            is_empty,
        } = events[0]
        else {
            panic!("{events:?}");
        };
        assert_eq!((name, is_empty), ("c", false));
        assert_eq!(attribute(attributes, "t"), Some("s>"));
        assert_eq!(attribute(attributes, "r"), Some("A1"));
        assert_eq!(attribute(attributes, "s"), None);
        assert_eq!(events[2], Event::Text("1"));
        assert!(matches!(
            events[4],
            Event::Open {
                name: "e",
                is_empty: true,
                ..
            }
        ));
        assert_eq!(events[5], Event::Plain("<"));
        assert_eq!(events[6], Event::Close("c"));
        for broken in ["<a", "<a b='", "<![CDATA[", "<!--", "&", "<"] {
            assert!(Events::of(broken).count() <= 1);
        }
    }

    #[test]
    fn escaped_characters_are_what_they_stand_for() {
        assert_eq!(
            super::text("a &lt; b &amp;&#176;&#xb0;&no; &"),
            "a < b &°°&no; &"
        );
    }
}
