//! Blocks, of which a file consists: a kind, links to others, and data.

use super::super::cursor::Cursor;
use super::super::stored::Order;
use super::damage::damaged;
use crate::flight::Fault;

#[derive(Clone, Copy)]
pub(super) struct Block<'a> {
    pub(super) kind: [u8; 2],
    links: &'a [u8],
    data: &'a [u8],
}

const HEAD: usize = 24;
/// Bytes of a link.
const LINK: usize = 8;
/// Characters of a name or a unit.
const LONGEST: usize = 200;

impl<'a> Block<'a> {
    /// # Errors
    /// There is none at the address.
    pub(super) fn read(file: &'a [u8], address: u64) -> Result<Self, Fault> {
        Self::of(file, address).ok_or_else(|| damaged("a block is not where it should be"))
    }

    fn of(file: &'a [u8], address: u64) -> Option<Self> {
        let rest = file.get(usize::try_from(address).ok()?..)?;
        let mut cursor = Cursor::of(rest, Order::Little);
        if cursor.take(2)? != b"##" {
            return None;
        }
        let kind = cursor.take(2)?.try_into().ok()?;
        cursor.take(4)?;
        let (length, links) = (cursor.count()?, cursor.count()?);
        // one that is cut off has what there is of it
        let block = rest.get(HEAD..length.min(rest.len()))?;
        let (links, data) = block.split_at_checked(links.checked_mul(LINK)?)?;
        Some(Self { kind, links, data })
    }

    /// The block of a kind that a link leads to; `None` where it leads nowhere.
    ///
    /// # Errors
    /// It leads to another one.
    pub(super) fn find(
        file: &'a [u8],
        address: u64,
        kind: &[u8; 2],
    ) -> Result<Option<Self>, Fault> {
        if address == 0 {
            return Ok(None);
        }
        let block = Self::read(file, address)?;
        match block.kind == *kind {
            true => Ok(Some(block)),
            false => Err(damaged("a block is of another kind than it should be")),
        }
    }

    /// Where a link leads; 0 is nowhere.
    pub(super) fn link(&self, at: usize) -> u64 {
        self.links().nth(at).unwrap_or(0)
    }

    pub(super) fn links(&self) -> impl Iterator<Item = u64> + use<'a> {
        let links = self.links.as_chunks::<LINK>().0;
        links.iter().map(|link| u64::from_le_bytes(*link))
    }

    pub(super) fn bytes(&self) -> &'a [u8] {
        self.data
    }

    pub(super) fn cursor(&self) -> Cursor<'a> {
        Cursor::of(self.data, Order::Little)
    }

    /// The text of the block that a link leads to: itself, or what stands in its XML.
    pub(super) fn text(&self, file: &[u8], at: usize) -> String {
        let Ok(block) = Block::read(file, self.link(at)) else {
            return String::new();
        };
        let end = memchr::memchr(0, block.data).unwrap_or(block.data.len());
        let text = String::from_utf8_lossy(&block.data[..end.min(10 * LONGEST)]);
        let text = match &block.kind {
            b"TX" => text.as_ref(),
            b"MD" => within(&text, "<TX>", "</TX>").unwrap_or_default(),
            _ => "",
        };
        text.trim().chars().take(LONGEST).collect()
    }
}

fn within<'t>(text: &'t str, open: &str, close: &str) -> Option<&'t str> {
    let (_, rest) = text.split_once(open)?;
    rest.split_once(close).map(|(text, _)| text)
}
