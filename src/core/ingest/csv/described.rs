//! What a table says of its columns, and the mapping that says more of them.

use std::borrow::Cow;

use super::super::{
    mapping::{Mapping, Titles as Wanted},
    units::RecordedUnit,
};
use super::{plan::Plan, titles::Titles};

pub(super) struct Described<'a> {
    pub(super) titles: Titles<'a>,
    pub(super) mapping: Cow<'a, Mapping>,
    /// The bundled mapping that was recognised.
    pub(super) recognised: Option<&'static str>,
}

impl<'a> Described<'a> {
    /// With the mapping that is given, else the one that is recognised.
    pub(super) fn of(titles: Titles<'a>, mapping: Option<&'a Mapping>) -> Self {
        let recognised = mapping
            .is_none()
            .then(|| Mapping::recognised(|wanted| titles.has(wanted)))
            .flatten();
        let (recognised, mapping) = match (mapping, recognised) {
            (Some(mapping), _) => (None, Cow::Borrowed(mapping)),
            (None, Some((name, mapping))) => {
                (Some(name), Cow::Owned(without_units_of(&titles, mapping)))
            }
            (None, None) => (None, Cow::Owned(Mapping::default())),
        };
        Self {
            titles,
            mapping,
            recognised,
        }
    }

    /// What faults call the column of time.
    pub(super) fn name_of_time(&self, plan: &Plan) -> String {
        let time = plan
            .time
            .column()
            .map_or("", |at| self.titles.any_label(at).name);
        let is_mapped = !self.mapping.channels.is_empty() && self.recognised.is_none();
        match time.is_empty() || is_mapped {
            true => "t".to_string(),
            false => time.to_string(),
        }
    }
}

/// A mapping that was only recognised says no unit where the file states one that can be read.
fn without_units_of(titles: &Titles, mapping: &Mapping) -> Mapping {
    let stated = |from: &Wanted| {
        let label = titles.find(from).and_then(|at| titles.label(at)).ok()?;
        Some(label.unit).filter(|unit| !unit.is_empty())
    };
    let mut mapping = mapping.clone();
    let time = &mut mapping.time;
    let of_time = time.from.as_ref().and_then(stated);
    if of_time.is_some_and(|unit| RecordedUnit::parse_time(unit).is_ok()) {
        time.unit.clear();
    }
    for channel in mapping.channels.values_mut() {
        if stated(&channel.from).is_some_and(|unit| RecordedUnit::parse(unit).is_ok()) {
            channel.unit.clear();
        }
    }
    mapping
}
