//! What a mapping may not say, whatever file it is for.

use super::super::{code, fault::pointer};
use super::{MappedChannel, MappedTime, Mapping, Titles};
use crate::flight::Fault;

impl Mapping {
    /// What it says does not contradict itself.
    pub(super) fn checked(self) -> Result<Self, Fault> {
        self.check_time()?;
        if !matches!(self.decimal.as_deref(), None | Some("." | ",")) {
            return Err(refused("/decimal", "decimal is \".\" or \",\""));
        }
        for (name, axis) in &self.tables {
            let place = ["tables", name, "from"];
            check_source(axis.from.as_ref(), &place)?;
            check_offset(axis.offset, &["tables", name, "offset"])?;
        }
        for (name, channel) in &self.channels {
            check_channel(name, channel)?;
        }
        Ok(self)
    }

    fn check_time(&self) -> Result<(), Fault> {
        let time = &self.time;
        let is_said_twice = time.from.is_some() && time.step.is_some();
        if is_said_twice || time.start.is_some() && time.step.is_none() {
            return Err(refused("/time", EITHER));
        }
        let others = [
            ("from", &time.from),
            ("date", &time.date),
            ("week", &time.week),
        ];
        for (member, titles) in others.into_iter().chain(time.parts()) {
            if titles.as_ref().is_some_and(Titles::is_empty) {
                return Err(refused(&pointer(["time", member]), "this title is empty"));
            }
        }
        check_parts(time)
    }
}

/// What parts of a time may stand beside each other.
fn check_parts(time: &MappedTime) -> Result<(), Fault> {
    if !time.has_parts() {
        return Ok(());
    }
    if time.from.is_none() || time.date.is_some() || time.week.is_some() {
        let message = "a time in parts has \"from\" for the finest of them, and neither \"date\" nor \"week\"";
        return Err(refused("/time", message));
    }
    let is_whole = matches!(
        (&time.year, &time.month, &time.day),
        (None, None, _) | (Some(_), _, Some(_))
    );
    let message =
        "a month needs a year and a day, and a year a day; a day alone is that of the year";
    is_whole
        .then_some(())
        .ok_or_else(|| refused("/time", message))
}

/// How time is said.
pub(super) const EITHER: &str = "time has either \"from\", or \"step\" and perhaps \"start\"";

fn check_channel(name: &str, channel: &MappedChannel) -> Result<(), Fault> {
    check_source(Some(&channel.from), &["channels", name, "from"])?;
    if let Some(time) = &channel.time {
        let (place, axis) = (["channels", name, "time"], time.axis());
        check_source(axis.from.as_ref(), &place)?;
        check_offset(axis.offset, &place)?;
    }
    if !matches!(channel.sign, None | Some(1 | -1)) {
        let place = pointer(["channels", name, "sign"]);
        return Err(refused(&place, "sign is 1 or -1"));
    }
    if !channel.factor().is_normal() {
        let place = pointer(["channels", name, "scale"]);
        return Err(refused(&place, "scale is a number other than 0"));
    }
    Ok(())
}

fn check_source(from: Option<&Titles>, place: &[&str]) -> Result<(), Fault> {
    match from {
        Some(from) if from.is_empty() => Err(refused(&pointer(place), "this source is empty")),
        _ => Ok(()),
    }
}

fn check_offset(offset: f64, place: &[&str]) -> Result<(), Fault> {
    match offset.is_finite() {
        true => Ok(()),
        false => Err(refused(&pointer(place), "offset is a number of seconds")),
    }
}

pub(super) fn refused(place: &str, message: &str) -> Fault {
    Fault::new(place, code::INVALID_MAPPING, format!("mapping: {message}"))
}
