//! The values of channels, scaled; and those of time, in seconds.

use super::super::groups::Samples;
use super::layout::Kind;
use super::scale::Scales;
use super::scan::File;
use super::stamp::Stamp;
use crate::flight::{Fault, Unit};

/// A channel as it is to be read.
pub(super) struct Wanted {
    /// Which object has its values.
    pub(super) object: usize,
    pub(super) scales: Scales,
    /// Of a channel of times: what they are in.
    pub(super) unit: Option<Unit>,
}

pub(super) struct Values<'a> {
    pub(super) file: File<'a>,
    pub(super) wanted: Vec<Wanted>,
    /// Time stamps count from here.
    pub(super) start: Option<Stamp>,
}

impl Samples for Values<'_> {
    fn values(&mut self, at: usize) -> Result<Vec<f64>, Fault> {
        let mut values = Vec::new();
        let Some(wanted) = self.wanted.get(at) else {
            return Ok(values);
        };
        let start = self.start;
        self.file.each(wanted.object, |slot, bytes| {
            let value = match slot.kind {
                Kind::Number(number) => wanted.scales.apply((number.read)(bytes)),
                Kind::Stamp(order) => match (Stamp::read(bytes, order), start) {
                    (Some(stamp), Some(start)) => stamp.since(start),
                    _ => f64::NAN,
                },
                Kind::Other => f64::NAN,
            };
            values.push(wanted.unit.map_or(value, |unit| unit.to_si(value)));
        })?;
        Ok(values)
    }
}
