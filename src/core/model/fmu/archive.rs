//! A zip archive of files as they are, without compression (PKWARE APPNOTE 6.3.4, 4.3).

use flate2::Crc;

/// 1980-01-01 00:00, the first that a zip archive can say: the archive has no clock.
const DATE: u16 = 0x21;

/// Files by their paths, one after the other, and the directory behind them.
pub(super) fn archive(files: &[(&str, &[u8])]) -> Vec<u8> {
    let (mut all, mut directory) = (Vec::new(), Vec::new());
    for (path, content) in files {
        let offset = word(all.len());
        let common = entry(path, content);
        all.extend(0x0403_4b50_u32.to_le_bytes());
        all.extend(&common);
        all.extend(path.as_bytes());
        all.extend(*content);
        directory.extend(0x0201_4b50_u32.to_le_bytes());
        directory.extend(20_u16.to_le_bytes());
        directory.extend(&common);
        // no comment, first disk, no attributes
        directory.extend([0; 10]);
        directory.extend(offset.to_le_bytes());
        directory.extend(path.as_bytes());
    }
    let (start, size) = (word(all.len()), word(directory.len()));
    let count = u16::try_from(files.len()).unwrap_or(u16::MAX);
    all.extend(directory);
    all.extend(0x0605_4b50_u32.to_le_bytes());
    all.extend([0; 4]);
    all.extend(count.to_le_bytes());
    all.extend(count.to_le_bytes());
    all.extend(size.to_le_bytes());
    all.extend(start.to_le_bytes());
    all.extend([0; 2]);
    all
}

/// What a file and its row in the directory say alike: version, flags, method, time, checksum, sizes, length of the name.
fn entry(path: &str, content: &[u8]) -> Vec<u8> {
    let mut checksum = Crc::new();
    checksum.update(content);
    let mut bytes = Vec::new();
    for part in [20_u16, 0, 0, 0, DATE] {
        bytes.extend(part.to_le_bytes());
    }
    for part in [checksum.sum(), word(content.len()), word(content.len())] {
        bytes.extend(part.to_le_bytes());
    }
    bytes.extend(u16::try_from(path.len()).unwrap_or(u16::MAX).to_le_bytes());
    bytes.extend(0_u16.to_le_bytes());
    bytes
}

fn word(size: usize) -> u32 {
    u32::try_from(size).unwrap_or(u32::MAX)
}
