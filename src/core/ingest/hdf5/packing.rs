//! Numbers that a dataset stores packed, as netCDF's conventions have it.
//!
//! "NetCDF Climate and Forecast Metadata Conventions", 8.1 (packed data) and 2.5.1 (missing data): a number is what is stored
//! times `scale_factor`, and `add_offset` more; `_FillValue` and `missing_value` are compared with what is stored.

use super::attribute;
use super::file::File;
use super::header::Header;

/// How numbers are packed.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Packing {
    factor: f64,
    offset: f64,
    missing: Vec<f64>,
}

impl Packing {
    /// As the attributes of an object say it; `None` where they say nothing.
    pub(super) fn of(file: &File, header: &Header) -> Option<Self> {
        let said = |name: &str| attribute::number(file, header, name);
        let missing = ["_FillValue", "missing_value"].iter();
        let packing = Self {
            factor: said("scale_factor").unwrap_or(1.0),
            offset: said("add_offset").unwrap_or(0.0),
            missing: missing
                .filter_map(|name| said(name))
                .filter(|number| !number.is_nan())
                .collect(),
        };
        let is_plain = packing.factor == 1.0 && packing.offset == 0.0 && packing.missing.is_empty();
        (!is_plain).then_some(packing)
    }

    /// The number that is meant by one that is stored.
    pub(super) fn unpacked(&self, stored: f64) -> f64 {
        match self.missing.contains(&stored) {
            true => f64::NAN,
            false => stored * self.factor + self.offset,
        }
    }
}
