//! Bodies of several files: `multipart/form-data`, RFC 7578, by the crate `multer`.

use axum::body::Bytes;
use axum::http::header;
use futures_util::stream;
use multer::{Error, Field, Multipart};
use sha2::{Digest, Sha256};

use crate::http::code::Code;
use crate::http::problem::Problem;

pub(crate) const MEDIA_TYPE: &str = "multipart/form-data";

/// A part of a body.
pub(crate) struct Part {
    /// Of the field.
    pub name: String,
    /// Of the file, where it is one.
    pub file: Option<String>,
    /// With its parameters; empty where it is not stated.
    pub content_type: String,
    pub bytes: Bytes,
}

impl Part {
    /// In lower case and without parameters; empty where it is not stated.
    pub(crate) fn media_type(&self) -> String {
        let media_type = self.content_type.split(';').next().unwrap_or_default();
        media_type.trim().to_ascii_lowercase()
    }
}

/// Parts of one body.
const MOST: usize = 100;
/// Bytes of the headers of a part.
const LONGEST_HEAD: usize = 16_384;

/// The parts of a body, in their order.
///
/// # Errors
/// The boundary is not stated, or the body is not written as it says.
pub(crate) async fn parts(content_type: &str, body: Bytes) -> Result<Vec<Part>, Problem> {
    let boundary = multer::parse_boundary(content_type).ok();
    let boundary = boundary.filter(|boundary| (1..=70).contains(&boundary.len()));
    let boundary =
        boundary.ok_or_else(|| bad("the Content-Type has no boundary of 1 to 70 characters"))?;
    let body = stream::iter([Ok::<_, std::convert::Infallible>(body)]);
    let mut multipart = Multipart::new(body, boundary);
    let mut parts = Vec::new();
    while let Some(field) = multipart
        .next_field()
        .await
        .map_err(|error| unread(&error))?
    {
        if parts.len() == MOST {
            return Err(bad(&format!("there are more than {MOST} parts")));
        }
        parts.push(part(field).await?);
    }
    Ok(parts)
}

/// What is asked for by a body, whatever its boundary is: a client that sends it again makes another one.
///
/// # Errors
/// Those of [`parts`].
pub(crate) async fn digest(content_type: &str, body: Bytes) -> Result<[u8; 32], Problem> {
    let mut digest = Sha256::new();
    for part in parts(content_type, body).await? {
        let file = part.file.as_deref();
        let texts = [
            Some(part.name.as_bytes()),
            file.map(str::as_bytes),
            Some(part.content_type.as_bytes()),
            Some(&part.bytes[..]),
        ];
        for text in texts {
            // a text that is absent is not an empty one
            digest.update([u8::from(text.is_some())]);
            digest.update((text.map_or(0, <[u8]>::len) as u64).to_le_bytes());
            digest.update(text.unwrap_or_default());
        }
    }
    Ok(digest.finalize().into())
}

async fn part(field: Field<'_>) -> Result<Part, Problem> {
    let headers = field.headers().iter();
    let length = headers.map(|(name, value)| name.as_str().len() + value.len());
    if length.sum::<usize>() > LONGEST_HEAD {
        return Err(bad(&format!(
            "the headers of a part are longer than {LONGEST_HEAD} bytes"
        )));
    }
    let name = field.name().map(unescaped);
    let name = name.ok_or_else(|| bad("a part has no name in its Content-Disposition"))?;
    let content_type = field.headers().get(header::CONTENT_TYPE);
    let content_type = content_type.and_then(|value| value.to_str().ok());
    Ok(Part {
        name,
        file: field.file_name().map(unescaped),
        content_type: content_type.unwrap_or_default().to_string(),
        bytes: bytes(field).await?,
    })
}

/// The content of a part. `multer` has copied the body once; as all of it is there, a part comes in one piece, which is not
/// copied again.
async fn bytes(mut field: Field<'_>) -> Result<Bytes, Problem> {
    let mut content = Bytes::new();
    while let Some(piece) = field.chunk().await.map_err(|error| unread(&error))? {
        content = match content.is_empty() {
            true => piece,
            false => [content, piece].concat().into(),
        };
    }
    Ok(content)
}

/// Browsers write a quote in a name as `%22`.
fn unescaped(name: &str) -> String {
    name.replace("%22", "\"")
}

fn unread(error: &Error) -> Problem {
    match error {
        Error::IncompleteFieldData { .. } => bad("the last part has no end: the body was cut off"),
        Error::IncompleteStream => bad(
            "the body was cut off, has no part between boundaries, or has a line that begins as the boundary does",
        ),
        Error::ReadHeaderFailed(_) | Error::IncompleteHeaders => {
            bad("the headers of a part cannot be read, or are more than 32")
        }
        other => bad(&other.to_string()),
    }
}

fn bad(why: &str) -> Problem {
    let detail = format!(
        "{why}; send multipart/form-data as RFC 7578 has it, as curl -F 'file=@imu.csv' -F 'file=@air.csv' does"
    );
    Problem::new(Code::InvalidMultipart, detail)
}

#[cfg(test)]
mod tests {
    use futures_util::FutureExt;

    use super::*;

    const BODY: &str = "preamble\r\n--x\r\nContent-Disposition: form-data; name=\"file\"; filename=\"a;\\\"b.csv\"\r\nContent-Type: text/csv; charset=utf-8\r\n\r\nt,a\r\n0,1\r\n\r\n--x\r\ncontent-disposition: form-data; name=offsets\r\n\r\n{}\r\n--x--\r\nepilogue";

    /// Name, file, content type and text.
    type Told = (String, Option<String>, String, String);

    /// All of a body is there: nothing waits.
    fn at_once<T>(future: impl Future<Output = Result<T, Problem>>) -> Option<T> {
        future.now_or_never().expect("nothing to wait for").ok()
    }

    fn told(content_type: &str, body: &str) -> Option<Vec<Told>> {
        let body = Bytes::copy_from_slice(body.as_bytes());
        let parts = at_once(parts(content_type, body))?;
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        Some(
            parts
                .into_iter()
                .map(|part| (part.name, part.file, part.content_type, text(&part.bytes)))
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
    fn a_line_that_begins_as_the_boundary_is_refused() {
        let body = |line: &str| {
            format!(
                "--x\r\ncontent-disposition: form-data; name=a\r\n\r\n1\r\n{line}\r\n2\r\n--x  \r\n\
                 content-disposition: form-data; name=b\r\n\r\n\r\n--x--"
            )
        };
        let told_of = |line: &str| told("multipart/form-data; boundary=x", &body(line));
        let texts = told_of("--yx").unwrap().into_iter().map(|part| part.3);
        assert_eq!(texts.collect::<Vec<_>>(), ["1\r\n--yx\r\n2", ""]);
        // RFC 2046, 5.1.1: a line that begins with the delimiter is one, whatever follows
        assert_eq!(told_of("--xy"), None);
        assert_eq!(told_of("--x-"), None);
    }

    #[test]
    fn media_types_have_no_parameters() {
        let media_types = ["Text/CSV; charset=utf-8", ""].map(|content_type| {
            let part = Part {
                name: String::new(),
                file: None,
                content_type: content_type.to_string(),
                bytes: Bytes::new(),
            };
            part.media_type()
        });
        assert_eq!(media_types, ["text/csv", ""]);
    }

    /// What tells one request from another is in the parts, not in the line between them.
    #[test]
    fn a_digest_goes_by_the_parts() {
        let of = |boundary: &str, body: &str| {
            let content_type = format!("multipart/form-data; boundary={boundary}");
            let body = body.replace("--x", &format!("--{boundary}"));
            at_once(digest(&content_type, body.into_bytes().into())).unwrap()
        };
        assert_eq!(of("x", BODY), of("----z7", BODY));
        assert_eq!(of("x", BODY), of("x", &BODY[10..]));
        for (from, to) in [
            ("0,1", "0,2"),
            ("name=offsets", "name=offset"),
            ("b.csv", "c.csv"),
            ("utf-8", "utf-16"),
            ("; filename=\"a;\\\"b.csv\"", ""),
        ] {
            assert!(BODY.contains(from));
            assert_ne!(of("x", BODY), of("x", &BODY.replace(from, to)), "{from}");
        }
    }

    #[test]
    fn heads_have_an_end() {
        let body = |length: usize| {
            let more = "a".repeat(length);
            format!(
                "--x\r\ncontent-disposition: form-data; name=a\r\nmore: {more}\r\n\r\n1\r\n--x--"
            )
        };
        let told_of = |length| told("multipart/form-data; boundary=x", &body(length));
        assert!(told_of(16_000).is_some());
        assert!(told_of(16_384).is_none());
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
