//! Bodies of several files: `multipart/form-data`, RFC 7578.

use memchr::memmem;

use crate::http::code::Code;
use crate::http::problem::Problem;

/// A part of a body.
pub(crate) struct Part<'a> {
    /// Of the field.
    pub name: String,
    /// Of the file, where it is one.
    pub file: Option<String>,
    /// With its parameters; empty where it is not stated.
    pub content_type: String,
    pub bytes: &'a [u8],
}

impl Part<'_> {
    /// In lower case and without parameters; empty where it is not stated.
    pub(crate) fn media_type(&self) -> String {
        let media_type = self.content_type.split(';').next().unwrap_or_default();
        media_type.trim().to_ascii_lowercase()
    }
}

/// Parts of one body.
const MOST: usize = 100;
const LONGEST_HEAD: usize = 16_384;

/// The parts of a body, in their order.
///
/// # Errors
/// The boundary is not stated, or the body is not written as it says.
pub(crate) fn parts<'a>(content_type: &str, body: &'a [u8]) -> Result<Vec<Part<'a>>, Problem> {
    let boundary = parameter(content_type, "boundary");
    let boundary = boundary.filter(|boundary| (1..=70).contains(&boundary.len()));
    let boundary =
        boundary.ok_or_else(|| bad("the Content-Type has no boundary of 1 to 70 characters"))?;
    let delimiter = format!("\r\n--{boundary}");
    let finder = memmem::Finder::new(delimiter.as_bytes());
    let first = &delimiter.as_bytes()[2..];
    let mut rest = match body.strip_prefix(first).filter(|rest| ends_line(rest)) {
        Some(rest) => rest,
        // what stands before the first is no part
        None => match find(&finder, body) {
            Some(at) => &body[at + delimiter.len()..],
            None => return Err(bad("there is no part between boundaries")),
        },
    };
    let mut parts = Vec::new();
    while !rest.starts_with(b"--") {
        if parts.len() == MOST {
            return Err(bad(&format!("there are more than {MOST} parts")));
        }
        let end = memmem::find(&rest[..rest.len().min(LONGEST_HEAD)], b"\r\n\r\n");
        let end = end.ok_or_else(|| bad("a part has no end of its head"))?;
        let (head, content) = (&rest[..end], &rest[end + 4..]);
        let length = find(&finder, content)
            .ok_or_else(|| bad("the last part has no end: the body was cut off"))?;
        parts.push(part(head, &content[..length])?);
        rest = &content[length + delimiter.len()..];
    }
    Ok(parts)
}

/// Where a delimiter is; a line that only begins like it is none.
fn find(finder: &memmem::Finder, text: &[u8]) -> Option<usize> {
    let length = finder.needle().len();
    let mut all = finder.find_iter(text);
    all.find(|at| ends_line(&text[at + length..]))
}

/// Whether a delimiter ends here: with its line, or as the last of the body.
fn ends_line(rest: &[u8]) -> bool {
    let blank = |byte: &&u8| matches!(**byte, b' ' | b'\t');
    let padding = rest.iter().take_while(blank).count();
    rest.starts_with(b"--") || rest[padding..].starts_with(b"\r\n")
}

fn part<'a>(head: &[u8], bytes: &'a [u8]) -> Result<Part<'a>, Problem> {
    let head = String::from_utf8_lossy(head);
    let header = |wanted: &str| {
        head.lines().find_map(|line| {
            let (name, value) = line.split_once(':')?;
            name.trim()
                .eq_ignore_ascii_case(wanted)
                .then(|| value.trim().to_string())
        })
    };
    let disposition = header("content-disposition").unwrap_or_default();
    let name = parameter(&disposition, "name");
    let name = name.ok_or_else(|| bad("a part has no name in its Content-Disposition"))?;
    Ok(Part {
        name,
        file: parameter(&disposition, "filename"),
        content_type: header("content-type").unwrap_or_default(),
        bytes,
    })
}

/// A parameter of a header, quoted or not.
fn parameter(header: &str, wanted: &str) -> Option<String> {
    let mut rest = header.split_once(';')?.1;
    loop {
        let (name, value) = rest.split_once('=')?;
        let value = value.trim_start();
        let (text, behind) = match value.strip_prefix('"') {
            Some(quoted) => unquoted(quoted)?,
            None => {
                let end = value.find(';').unwrap_or(value.len());
                (value[..end].trim().to_string(), &value[end..])
            }
        };
        if name.trim().eq_ignore_ascii_case(wanted) {
            return Some(text);
        }
        rest = behind.trim_start().strip_prefix(';')?;
    }
}

/// A text up to its closing quote, and what is behind it. Browsers write a quote in it as `%22`.
fn unquoted(text: &str) -> Option<(String, &str)> {
    let mut plain = String::new();
    let mut letters = text.char_indices();
    while let Some((at, letter)) = letters.next() {
        match letter {
            '"' => return Some((plain.replace("%22", "\""), &text[at + 1..])),
            '\\' => plain.push(letters.next()?.1),
            letter => plain.push(letter),
        }
    }
    None
}

fn bad(why: &str) -> Problem {
    let detail = format!(
        "{why}; send multipart/form-data as RFC 7578 has it, as curl -F 'file=@imu.csv' -F 'file=@air.csv' does"
    );
    Problem::new(Code::InvalidMultipart, detail)
}

#[cfg(test)]
mod tests {
    use super::*;

    const BODY: &str = "preamble\r\n--x\r\nContent-Disposition: form-data; name=\"file\"; filename=\"a;\\\"b.csv\"\r\nContent-Type: text/csv; charset=utf-8\r\n\r\nt,a\r\n0,1\r\n\r\n--x\r\ncontent-disposition: form-data; name=offsets\r\n\r\n{}\r\n--x--\r\nepilogue";

    /// Name, file, content type and text.
    type Told = (String, Option<String>, String, String);

    fn told(content_type: &str, body: &str) -> Option<Vec<Told>> {
        let parts = parts(content_type, body.as_bytes()).ok()?;
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        Some(
            parts
                .into_iter()
                .map(|part| (part.name, part.file, part.content_type, text(part.bytes)))
                .collect(),
        )
    }

    #[test]
    fn parts_have_names_and_bytes() {
        let words = |words: [&str; 4]| {
            let [name, file, content_type, bytes] = words.map(str::to_string);
            (
                name,
                (!file.is_empty()).then_some(file),
                content_type,
                bytes,
            )
        };
        let expected = vec![
            words([
                "file",
                "a;\"b.csv",
                "text/csv; charset=utf-8",
                "t,a\r\n0,1\r\n",
            ]),
            words(["offsets", "", "", "{}"]),
        ];
        for content_type in [
            "multipart/form-data; boundary=x",
            "multipart/form-data; charset=utf-8; Boundary=\"x\"",
        ] {
            assert_eq!(
                told(content_type, BODY).as_ref(),
                Some(&expected),
                "{content_type}"
            );
        }
        assert_eq!(
            told("multipart/form-data; boundary=x", &BODY[10..]),
            Some(expected)
        );
    }

    #[test]
    fn a_line_that_begins_like_a_delimiter_is_content() {
        let body = "--x\r\ncontent-disposition: form-data; name=a\r\n\r\n1\r\n--xy\r\n--x-\r\n2\r\n--x  \r\n\
                    content-disposition: form-data; name=b\r\n\r\n\r\n--x--";
        let told = told("multipart/form-data; boundary=x", body).unwrap();
        let texts: Vec<&str> = told.iter().map(|part| part.3.as_str()).collect();
        assert_eq!(texts, ["1\r\n--xy\r\n--x-\r\n2", ""]);
        let media_types = ["Text/CSV; charset=utf-8", ""].map(|content_type| {
            let part = Part {
                name: String::new(),
                file: None,
                content_type: content_type.to_string(),
                bytes: &[],
            };
            part.media_type()
        });
        assert_eq!(media_types, ["text/csv", ""]);
    }

    #[test]
    fn what_is_cut_off_is_refused_and_nothing_panics() {
        for at in 0..BODY.len() - 12 {
            let told = told("multipart/form-data; boundary=x", &BODY[..at]);
            assert!(told.is_none(), "{at}: {told:?}");
        }
        for content_type in [
            "multipart/form-data",
            "multipart/form-data; boundary=",
            "multipart/form-data; boundary=\"x",
        ] {
            assert!(told(content_type, BODY).is_none());
        }
        let many =
            "--x\r\ncontent-disposition: form-data; name=a\r\n\r\n\r\n".repeat(101) + "--x--";
        assert!(told("multipart/form-data; boundary=x", &many).is_none());
    }
}
