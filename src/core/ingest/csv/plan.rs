//! What is made of each column of a table: time, a channel, or nothing.

use super::super::{
    IngestError, Limits, code,
    fault::pointer,
    label::Label,
    mapping::{ChannelTime, MappedChannel, Mapping},
    name::{Names, is_identifier},
    text::quoted,
    union::Between,
    units::RecordedUnit,
};
use super::{
    column::{Column, OwnTime, Use},
    own_times,
    time::{self, Time},
    titles::Titles,
};
use crate::flight::Fault;

/// Columns by what becomes of them.
pub(super) struct Plan {
    pub(super) time: Time,
    pub(super) columns: Vec<Column>,
    /// Those that could have been channels, and why they are none.
    pub(super) left_out: Vec<(String, Fault)>,
    /// Titles that are no identifiers, and the names that their channels have.
    pub(super) renamed: Vec<(String, String)>,
    /// Channels whose unit is said nowhere.
    pub(super) without_unit: Vec<String>,
    /// Channels of a mapping that the table does not have.
    pub(super) absent: Vec<String>,
}

impl Plan {
    /// What a mapping, and then the titles themselves, make of the columns.
    ///
    /// # Errors
    /// Every fault of the mapping at its place. There is no time.
    pub(super) fn of(
        titles: &Titles,
        mapping: &Mapping,
        limits: &Limits,
    ) -> Result<Self, IngestError> {
        let mut faults = Vec::new();
        faults.extend((!mapping.tables.is_empty()).then(one_table));
        let time = match own_times::is_said_of_all(mapping) {
            true => None,
            false => time::of(titles, &mapping.time, &mut faults),
        };
        let mut making = Making {
            titles,
            mapping,
            limits,
            names: Names::new(limits),
            taken: vec![None; titles.width],
            plan: Self {
                time: time.unwrap_or(Time::Even {
                    start: 0.0,
                    step: 1.0,
                }),
                columns: Vec::new(),
                left_out: Vec::new(),
                renamed: Vec::new(),
                without_unit: Vec::new(),
                absent: Vec::new(),
            },
        };
        for at in making.plan.time.columns() {
            making.taken[at] = Some("time".to_string());
        }
        making.mapped(&mut faults);
        let is_as_the_file_says = mapping.others || mapping.channels.is_empty();
        if is_as_the_file_says && faults.is_empty() && titles.names.is_some() {
            making.others();
        }
        let mut plan = making.plan;
        plan.columns.sort_by_key(|column| column.at);
        if faults.is_empty() && plan.columns.is_empty() {
            faults.extend(plan.left_out.iter().map(|(_, fault)| fault.clone()));
            if faults.is_empty() {
                faults.push(no_channels());
            }
        }
        IngestError::refuse(faults)?;
        Ok(plan)
    }
}

fn no_channels() -> Fault {
    let message = "there is no channel besides time; add a column for every recorded quantity";
    Fault::new("", code::NO_CHANNELS, message)
}

fn one_table() -> Fault {
    let message = "this file is one table; say \"time\" beside the \"from\" of a channel that has times of its own";
    Fault::new("/tables", code::INVALID_MAPPING, message)
}

struct Making<'m, 'a> {
    titles: &'m Titles<'a>,
    mapping: &'m Mapping,
    limits: &'m Limits,
    names: Names<'m>,
    /// What has a column already.
    taken: Vec<Option<String>>,
    plan: Plan,
}

impl Making<'_, '_> {
    /// The columns that the mapping names.
    fn mapped(&mut self, faults: &mut Vec<Fault>) {
        for (name, channel) in &self.mapping.channels {
            let mut refuse = |member: Option<&str>, (code, message): (&'static str, String)| {
                let place = ["channels", name].into_iter().chain(member);
                faults.push(Fault::new(pointer(place), code, message));
            };
            let found = self.titles.find(&channel.from);
            if self.mapping.optional && matches!(found, Err((code::UNKNOWN_SOURCE, _))) {
                self.plan.absent.push(name.clone());
                continue;
            }
            if let Err(why) = self.names.take(name) {
                refuse(None, why);
                continue;
            }
            let at = match found {
                Ok(at) => at,
                Err(why) => {
                    refuse(Some("from"), why);
                    continue;
                }
            };
            if let Some(other) = &self.taken[at] {
                let message = format!("column {} is '{other}' already", at + 1);
                refuse(Some("from"), (code::INVALID_MAPPING, message));
                continue;
            }
            let unit = match self.unit(at, &channel.unit) {
                Ok(unit) => unit,
                Err(why) => {
                    refuse(Some("unit"), why);
                    continue;
                }
            };
            self.taken[at] = Some(name.clone());
            let own = match self.own_time(name, channel) {
                Ok(own) => own,
                Err(why) => {
                    refuse(Some("time"), why);
                    continue;
                }
            };
            let no_values = self.mapping.missing.iter().chain(&channel.missing);
            self.plan.columns.push(Column {
                at,
                name: name.clone(),
                unit,
                factor: channel.factor(),
                no_values: no_values.cloned().collect(),
                is_needed: !self.mapping.optional,
                used: Use::Channel,
                own,
                between: channel.between,
            });
        }
    }

    /// The time axis that a mapping says of a channel; its column of times is read, too.
    fn own_time(
        &mut self,
        name: &str,
        channel: &MappedChannel,
    ) -> Result<Option<OwnTime>, (&'static str, String)> {
        let Some(axis) = channel.time.as_ref().map(ChannelTime::axis) else {
            return Ok(None);
        };
        let offset = axis.offset;
        let Some(from) = &axis.from else {
            return Ok(Some(OwnTime { at: None, offset }));
        };
        let at = self.titles.find(from)?;
        if self.plan.time.columns().any(|column| column == at) {
            return Ok(Some(OwnTime { at: None, offset }));
        }
        let is_read = |column: &Column| column.at == at && column.used == Use::Times;
        let own = OwnTime {
            at: Some(at),
            offset,
        };
        if self.plan.columns.iter().any(is_read) {
            return Ok(Some(own));
        }
        if let Some(other) = &self.taken[at] {
            let message = format!("column {} is '{other}' already", at + 1);
            return Err((code::INVALID_MAPPING, message));
        }
        let of_table = &self.mapping.time.unit;
        let unit = own_times::unit(self.titles, at, axis.unit.as_deref(), of_table)?;
        self.taken[at] = Some(format!("the time of {name}"));
        self.plan.columns.push(Column {
            at,
            name: format!("time of {name}"),
            unit,
            factor: 1.0,
            no_values: self.mapping.missing.clone(),
            is_needed: true,
            used: Use::Times,
            own: None,
            between: Between::Missing,
        });
        Ok(Some(own))
    }

    /// The unit of a mapping, else that of the file.
    fn unit(&self, at: usize, said: &str) -> Result<RecordedUnit, (&'static str, String)> {
        if !said.is_empty() {
            return RecordedUnit::parse(said);
        }
        let label = self.titles.label(at)?;
        if label.unit.is_empty() {
            let message = "the unit is said nowhere; say it here, - for a pure number".to_string();
            return Err((code::UNKNOWN_UNIT, message));
        }
        RecordedUnit::parse(label.unit)
    }

    /// All other columns, as their titles say.
    fn others(&mut self) {
        // names that need no change go first: no title takes one that another has
        let all: Vec<usize> = (0..self.titles.width)
            .filter(|&at| self.taken[at].is_none())
            .collect();
        let is_clear = |at: &usize| is_identifier(self.titles.any_label(*at).name);
        let (clear, others): (Vec<usize>, Vec<usize>) = all.into_iter().partition(is_clear);
        for at in clear.into_iter().chain(others) {
            match self.channel(at) {
                Ok(Some(column)) => self.plan.columns.push(column),
                Ok(None) => {}
                Err((code, message)) => {
                    let label = self.titles.any_label(at);
                    let is_clear = is_identifier(label.name)
                        && label.name.len() <= self.limits.max_name_length;
                    let place = if is_clear {
                        label.name.to_string()
                    } else {
                        (at + 1).to_string()
                    };
                    let message = format!("column {}: {message}", at + 1);
                    let fault = Fault::new(pointer(["columns", &place]), code, message);
                    let title = match self.titles.title(at) {
                        "" => format!("column {}", at + 1),
                        title => quoted(title),
                    };
                    self.plan.left_out.push((title, fault));
                }
            }
        }
        self.plan.left_out.sort_by_key(|(_, fault)| place_of(fault));
    }

    /// Whether a column is called as time is and has nothing in it, or the same as that of time.
    fn is_time_again(&self, at: usize) -> bool {
        let titles = self.titles;
        let is_again =
            |time: usize| titles.title(time) == titles.title(at) && titles.are_alike(time, at);
        let is_called_time = titles.any_label(at).is_called_time_or_stamp();
        is_called_time && titles.is_empty(at) || self.plan.time.column().is_some_and(is_again)
    }

    /// The channel of a column; `None` where there is nothing in it.
    fn channel(&mut self, at: usize) -> Result<Option<Column>, (&'static str, String)> {
        let title = self.titles.title(at);
        if title.is_empty() {
            // a delimiter too many, or the rows' numbers
            let message = "this column has no title".to_string();
            return match self.titles.first_said(at) {
                None if !self.titles.first.is_empty() => Ok(None),
                _ => Err((code::EMPTY_NAME, message)),
            };
        }
        if self.is_time_again(at) {
            return Ok(None);
        }
        let label = self.titles.label(at)?;
        if label.name.len() > self.limits.max_name_length {
            return Err(self
                .names
                .take(label.name)
                .err()
                .unwrap_or((code::NAME_TOO_LONG, String::new())));
        }
        let unit = RecordedUnit::parse(label.unit)?;
        // a plain number is one, though it may look like a year and a day of it
        let first = self.titles.first_said(at).unwrap_or_default().trim();
        let is_stamp = (self.titles.stamp(at).is_some() || self.titles.has_dates(at))
            && first.parse::<f64>().is_err();
        if self.titles.is_text(at) || is_stamp {
            let cell = quoted(self.titles.first_said(at).unwrap_or_default().trim());
            return Err((code::NOT_A_NUMBER, format!("{cell} is not a number")));
        }
        let name = match self.names.take(label.name) {
            Ok(()) => label.name.to_string(),
            Err(_) => {
                let name = self.names.take_like(readable(&label, title));
                self.plan.renamed.push((title.to_string(), name.clone()));
                name
            }
        };
        if label.unit.is_empty() {
            self.plan.without_unit.push(name.clone());
        }
        Ok(Some(Column {
            at,
            name,
            unit,
            factor: 1.0,
            no_values: self.mapping.missing.clone(),
            is_needed: false,
            used: Use::Channel,
            own: None,
            between: Between::Missing,
        }))
    }
}

/// What a name is made of.
fn readable<'a>(label: &Label<'a>, title: &'a str) -> &'a str {
    if label.name.is_empty() {
        title
    } else {
        label.name
    }
}

/// The number of the column that a fault is about.
fn place_of(fault: &Fault) -> Option<usize> {
    let message = fault.message.strip_prefix("column ")?;
    message.split(':').next()?.parse().ok()
}
