//! Zip archives: what is in them, and one entry unpacked (PKWARE's APPNOTE.TXT 6.3, entries stored or deflated).
//!
//! The crate `zip` was weighed: for two methods of packing it brings ten crates more, and the sizes that it trusts are
//! those that the archive declares.

use flate2::{Crc, bufread::DeflateDecoder};

use super::super::text::{quoted, short_message};
use super::super::{code, fault::of_file, recognition::Foreign};
use super::bounded::{damaged, read};
use crate::flight::Fault;

/// An archive whose directory is read.
pub(in super::super) struct Zip<'a> {
    bytes: &'a [u8],
    entries: Vec<Entry>,
}

/// A file of an archive.
#[derive(Clone, Debug)]
pub(in super::super) struct Entry {
    pub(in super::super) name: String,
    /// 0: as it is; 8: deflated.
    method: u16,
    is_encrypted: bool,
    checksum: u32,
    packed: usize,
    /// Of its header.
    at: usize,
}

const WHAT: &str = "zip archive";

/// An archive of more entries is no recording.
const MOST_ENTRIES: usize = 10_000;

impl<'a> Zip<'a> {
    /// # Errors
    /// The archive is damaged: its directory, which stands at its end, cannot be read.
    pub(in super::super) fn of(bytes: &'a [u8]) -> Result<Self, Fault> {
        let Some(end) = end_of_directory(bytes) else {
            let is_workbook = memchr::memmem::find(bytes, b"xl/w").is_some();
            let what = if is_workbook { "Excel workbook" } else { WHAT };
            return Err(damaged(what, "its directory is missing; it was cut off"));
        };
        let mut at = end.directory;
        let mut entries = Vec::new();
        if end.count > MOST_ENTRIES {
            return Err(damaged(WHAT, "it has too many entries"));
        }
        for _ in 0..end.count {
            let (entry, next) = entry(bytes, at)
                .ok_or_else(|| damaged(WHAT, "an entry of its directory cannot be read"))?;
            entries.push(entry);
            at = next;
        }
        Ok(Self { bytes, entries })
    }

    /// The entry of this name.
    pub(in super::super) fn find(&self, name: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.name == name)
    }

    /// Whether it is a workbook of Excel (.xlsx, .xlsm).
    pub(in super::super) fn is_workbook(&self) -> bool {
        self.find("xl/workbook.xml").is_some()
    }

    /// The only file in it that may be a recording.
    ///
    /// # Errors
    /// There is none, or there are several; or it is a document that is not read.
    pub(super) fn recording(&self) -> Result<&Entry, Fault> {
        let has = |name: &str| self.find(name).is_some();
        let document = if has("xl/workbook.bin") {
            Some((
                "a binary Excel workbook (.xlsb)",
                "save it as .xlsx or as CSV",
            ))
        } else if has("content.xml") && has("mimetype") {
            Some(("an OpenDocument file", "save it as .xlsx or as CSV"))
        } else if has("word/document.xml") {
            Some(("a Word document", "send the recording itself"))
        } else if !self.entries.is_empty()
            && self
                .entries
                .iter()
                .all(|entry| entry.name.ends_with(".npy"))
        {
            let remedy = "write the arrays as columns of text, with numpy.savetxt";
            Some(("an archive of NumPy (.npz)", remedy))
        } else {
            None
        };
        if let Some((what, remedy)) = document {
            return Err(Foreign::named(what, remedy));
        }
        let mut files = self.entries.iter().filter(|entry| entry.is_wanted());
        match (files.next(), files.next()) {
            (Some(only), None) => Ok(only),
            (None, _) => {
                let message = "there is no file in the zip archive; pack a recording into it";
                Err(of_file(code::SEVERAL_FILES, message))
            }
            _ => {
                let files = self.entries.iter().filter(|entry| entry.is_wanted());
                let names: Vec<String> = files.map(|entry| quoted(&entry.name)).collect();
                let message = format!(
                    "the zip archive has {} files; send each recording by itself: {}",
                    names.len(),
                    short_message(&names.join(", "))
                );
                Err(of_file(code::SEVERAL_FILES, message))
            }
        }
    }

    /// The content of an entry, of `most` bytes at most.
    ///
    /// # Errors
    /// It is larger, damaged, encrypted, or packed in a way that is not read.
    pub(in super::super) fn unpack(&self, entry: &Entry, most: usize) -> Result<Vec<u8>, Fault> {
        let what = format!("entry {} of the zip archive", quoted(&entry.name));
        if entry.is_encrypted {
            let message = format!("the {what} is encrypted; pack it without a password");
            return Err(of_file(code::FORMAT_NOT_READ, message));
        }
        let packed = self
            .content(entry)
            .ok_or_else(|| damaged(&what, "it ends too early"))?;
        let unpacked = match entry.method {
            0 => read(packed, most, &what)?,
            8 => read(DeflateDecoder::new(packed), most, &what)?,
            method => {
                let message = format!(
                    "the {what} is packed by method {method}, which is not read; pack it with deflate"
                );
                return Err(of_file(code::FORMAT_NOT_READ, message));
            }
        };
        let mut checksum = Crc::new();
        checksum.update(&unpacked);
        if checksum.sum() == entry.checksum {
            Ok(unpacked)
        } else {
            Err(damaged(&what, "its checksum is another"))
        }
    }

    fn content(&self, entry: &Entry) -> Option<&'a [u8]> {
        let header = self.bytes.get(entry.at..)?;
        if !header.starts_with(b"PK\x03\x04") {
            return None;
        }
        let names = usize::from(u16_at(header, 26)?) + usize::from(u16_at(header, 28)?);
        let content = header.get(30 + names..)?;
        content.get(..entry.packed)
    }
}

impl Entry {
    /// Whether it is a file, and not one that an operating system adds.
    fn is_wanted(&self) -> bool {
        let file = self.name.rsplit('/').next().unwrap_or_default();
        !file.is_empty()
            && !file.starts_with('.')
            && !self.name.starts_with("__MACOSX/")
            && !matches!(file, "Thumbs.db" | "desktop.ini")
    }
}

struct End {
    count: usize,
    directory: usize,
}

/// What stands at the end of an archive: where its directory is.
fn end_of_directory(bytes: &[u8]) -> Option<End> {
    const LENGTH: usize = 22;
    /// Of the comment behind it.
    const LONGEST: usize = 65_535;
    let last = bytes.len().checked_sub(LENGTH)?;
    let first = last.saturating_sub(LONGEST);
    let at = (first..=last)
        .rev()
        .find(|&at| bytes[at..].starts_with(b"PK\x05\x06"))?;
    let end = &bytes[at..];
    let (count, directory) = (u16_at(end, 10)?, u32_at(end, 16)?);
    if count != u16::MAX && directory != u32::MAX {
        return Some(End {
            count: usize::from(count),
            directory: directory as usize,
        });
    }
    // an archive of more than 4 GB or 65 534 entries (zip64)
    let locator = bytes.get(at.checked_sub(20)?..at)?;
    if !locator.starts_with(b"PK\x06\x07") {
        return None;
    }
    let end = bytes.get(size_at(locator, 8)?..)?;
    if !end.starts_with(b"PK\x06\x06") {
        return None;
    }
    Some(End {
        count: size_at(end, 32)?,
        directory: size_at(end, 48)?,
    })
}

/// An entry of the directory, and where the next one begins.
fn entry(bytes: &[u8], at: usize) -> Option<(Entry, usize)> {
    let header = bytes.get(at..)?;
    if !header.starts_with(b"PK\x01\x02") {
        return None;
    }
    let lengths = [28, 30, 32].map(|at| u16_at(header, at));
    let [Some(name), Some(extra), Some(comment)] = lengths.map(|length| length.map(usize::from))
    else {
        return None;
    };
    let rest = header.get(46..)?;
    let (mut packed, mut start) = (u32_at(header, 20)? as usize, u32_at(header, 42)? as usize);
    let whole = u32_at(header, 24)?;
    if [packed, start].contains(&(u32::MAX as usize)) || whole == u32::MAX {
        let mut large = zip64(rest.get(name..name + extra)?)?;
        if whole == u32::MAX {
            large = large.get(8..)?;
        }
        if packed == u32::MAX as usize {
            packed = size_at(large, 0)?;
            large = large.get(8..)?;
        }
        if start == u32::MAX as usize {
            start = size_at(large, 0)?;
        }
    }
    let entry = Entry {
        name: String::from_utf8_lossy(rest.get(..name)?).into_owned(),
        method: u16_at(header, 10)?,
        is_encrypted: u16_at(header, 8)? & 1 != 0,
        checksum: u32_at(header, 16)?,
        packed,
        at: start,
    };
    Some((entry, at + 46 + name + extra + comment))
}

/// The sizes of a large entry, among its extra fields.
fn zip64(mut extra: &[u8]) -> Option<&[u8]> {
    loop {
        let length = usize::from(u16_at(extra, 2)?);
        let field = extra.get(4..4 + length)?;
        if u16_at(extra, 0)? == 1 {
            return Some(field);
        }
        extra = &extra[4 + length..];
    }
}

fn u16_at(bytes: &[u8], at: usize) -> Option<u16> {
    let bytes = bytes.get(at..at.checked_add(2)?)?;
    bytes.try_into().ok().map(u16::from_le_bytes)
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    let bytes = bytes.get(at..at.checked_add(4)?)?;
    bytes.try_into().ok().map(u32::from_le_bytes)
}

fn size_at(bytes: &[u8], at: usize) -> Option<usize> {
    let bytes = bytes.get(at..at.checked_add(8)?)?;
    let size = bytes.try_into().ok().map(u64::from_le_bytes)?;
    // so that sums of sizes stay within range
    usize::try_from(size)
        .ok()
        .filter(|&size| size < usize::MAX / 4)
}

#[cfg(test)]
pub(in super::super) mod tests {
    use std::io::Write;

    use flate2::{Compression, write::DeflateEncoder};

    use super::super::super::{Format, Limits, fault::places, read as read_recording};
    use super::*;

    /// An archive of files, deflated.
    pub(in super::super::super) fn archive(files: &[(&str, &[u8])]) -> Vec<u8> {
        let (mut bytes, mut directory) = (Vec::new(), Vec::new());
        for (name, content) in files {
            let mut encoder = DeflateEncoder::new(Vec::new(), Compression::best());
            encoder.write_all(content).unwrap();
            let packed = encoder.finish().unwrap();
            let mut checksum = Crc::new();
            checksum.update(content);
            let mut shared = vec![20, 0, 0, 0, 8, 0, 0, 0, 0, 0];
            for size in [checksum.sum(), packed.len() as u32, content.len() as u32] {
                shared.extend(size.to_le_bytes());
            }
            shared.extend((name.len() as u16).to_le_bytes());
            shared.extend([0, 0]);
            directory.extend(b"PK\x01\x02\x14\0");
            directory.extend(&shared);
            directory.extend([0; 10]);
            directory.extend((bytes.len() as u32).to_le_bytes());
            directory.extend(name.as_bytes());
            bytes.extend(b"PK\x03\x04");
            bytes.extend(&shared);
            bytes.extend(name.as_bytes());
            bytes.extend(packed);
        }
        let (at, length, count) = (
            bytes.len() as u32,
            directory.len() as u32,
            files.len() as u16,
        );
        bytes.extend(directory);
        bytes.extend(b"PK\x05\x06\0\0\0\0");
        bytes.extend([count, count].map(u16::to_le_bytes).concat());
        bytes.extend([length, at].map(u32::to_le_bytes).concat());
        bytes.extend([0, 0]);
        bytes
    }

    const CSV: &[u8] = b"t[s],q[deg/s]\n0,1\n0.1,2\n";

    #[test]
    fn the_recording_in_an_archive_is_read() {
        let limits = Limits::default();
        let plain = read_recording(CSV, Format::Csv, &limits).unwrap();
        let packed = archive(&[
            ("flight/", b""),
            ("flight/7.csv", CSV),
            ("__MACOSX/flight/._7.csv", b"\0\x05"),
        ]);
        let read = read_recording(&packed, Format::Unstated, &limits).unwrap();
        assert_eq!(read.digest(), plain.digest());
        let json =
            br#"{"time":{"unit":"s","step":0.1},"channels":{"q":{"unit":"deg/s","values":[1,2]}}}"#;
        let packed = archive(&[("flight.json", json)]);
        let read = read_recording(&packed, Format::Csv, &limits).unwrap();
        assert_eq!(read.digest(), plain.digest(), "the name in it counts");
    }

    #[test]
    fn what_is_not_one_recording_is_said() {
        let limits = Limits {
            max_bytes: 10_000,
            ..Limits::default()
        };
        let refused = |bytes: &[u8], code: &str, expected: &str| {
            let error = read_recording(bytes, Format::Unstated, &limits).unwrap_err();
            assert_eq!(error.faults()[0].code, code, "{error}");
            assert!(error.to_string().contains(expected), "{error}");
        };
        let two = archive(&[("a.csv", CSV), ("b.csv", CSV)]);
        refused(
            &two,
            code::SEVERAL_FILES,
            "2 files; send each recording by itself: 'a.csv', 'b.csv'",
        );
        refused(&archive(&[]), code::SEVERAL_FILES, "no file");
        let sheet = archive(&[("mimetype", b"x"), ("content.xml", b"<a/>")]);
        refused(&sheet, code::FORMAT_NOT_READ, "OpenDocument");
        let bomb = archive(&[("a.csv", &[b'1'; 1_000_000])]);
        refused(&bomb, code::UNPACKED_TOO_LARGE, "more than 10000 bytes");
        refused(b"PK\x03\x04\x14\0", code::DAMAGED_FILE, "cut off");
        let workbook = archive(&[("xl/workbook.xml", b"<a/>")]);
        refused(
            &workbook[..60],
            code::DAMAGED_FILE,
            "the Excel workbook is damaged",
        );

        let good = archive(&[("a.csv", CSV)]);
        let mut wrong = good.clone();
        wrong[14] ^= 1;
        assert!(
            read_recording(&wrong, Format::Csv, &limits).is_ok(),
            "the directory counts"
        );
        let checksum = good.len() - 22 - 51 + 16;
        wrong[checksum] ^= 1;
        refused(&wrong, code::DAMAGED_FILE, "checksum");
        for at in 0..good.len() {
            assert!(!places(read_recording(&good[..at], Format::Csv, &limits)).is_empty());
            for with in [0, 0x7f, 0xff, good[at] ^ 1] {
                let mut damaged = good.clone();
                damaged[at] = with;
                let _ = read_recording(&damaged, Format::Csv, &limits);
            }
        }
    }
}
