//! The groups of a file: channels of one length that have the same times.

use super::super::groups::{Channel, Group, Groups, Time};
use super::super::label::Label;
use super::super::units::RecordedUnit;
use super::layout::Kind;
use super::object::Object;
use super::property::{Properties, Value};
use super::samples::{Values, Wanted};
use super::scale::Scales;
use super::scan::File;
use super::stamp::Stamp;
use crate::flight::Unit;

pub(super) fn of(file: File<'_>) -> Groups<Values<'_>> {
    let mut making = Making {
        start: start(&file),
        groups: Vec::new(),
        left_out: Vec::new(),
        wanted: Vec::new(),
    };
    let mut names: Vec<&String> = Vec::new();
    for object in &file.objects {
        if let [name, _] = &object.path[..]
            && !names.contains(&name)
        {
            names.push(name);
        }
    }
    for name in names {
        making.group(&file, name);
    }
    Groups {
        groups: making.groups,
        left_out: making.left_out,
        samples: Values {
            wanted: making.wanted,
            start: making.start,
            file,
        },
    }
}

/// The first time that anything in the file has.
fn start(file: &File) -> Option<Stamp> {
    let of_object = |(at, object): (usize, &Object)| {
        let stated = match object.properties.get("wf_start_time") {
            Some(Value::Time(stamp)) => Some(*stamp),
            _ => None,
        };
        stated.or_else(|| file.first_stamp(at))
    };
    file.objects.iter().enumerate().filter_map(of_object).min()
}

struct Making {
    start: Option<Stamp>,
    groups: Vec<Group>,
    left_out: Vec<(String, String)>,
    wanted: Vec<Wanted>,
}

/// A channel that has values.
struct Found<'f> {
    object: &'f Object,
    at: usize,
    name: &'f str,
    rows: usize,
    kind: Kind,
    /// Where its properties say it.
    time: Option<Time>,
}

impl Making {
    fn group(&mut self, file: &File, name: &str) {
        let first = self.groups.len();
        let found: Vec<Found> = found(file, name, self.start);
        let clock = found.iter().find_map(|found| Some((found, found.clock()?)));
        let clock = clock.filter(|_| found.iter().any(|found| found.time.is_none()));
        let recorded =
            clock.map(|(found, unit)| (found.rows, found.at, self.want(file, found, Some(unit))));
        for found in &found {
            if let Some((_, at, wanted)) = recorded
                && at == found.at
            {
                if wanted.is_none() {
                    let why = "it is scaled in a way that is not read".to_string();
                    self.left_out.push((format!("{name}/{}", found.name), why));
                }
                continue;
            }
            if !matches!(found.kind, Kind::Number(_)) {
                let index = found.object.index;
                let why = match index.is_some_and(|index| index.daqmx.is_some()) {
                    true => "DAQmx stores it in a way that is not read, such as digital lines",
                    false => "it does not hold numbers",
                };
                let left_out = (format!("{name}/{}", found.name), why.to_string());
                self.left_out.push(left_out);
                continue;
            }
            let time = match (found.time, recorded) {
                (Some(time), _) => time,
                (None, Some((rows, _, Some(at)))) if rows == found.rows => Time::Recorded(at),
                _ => Time::Unknown,
            };
            let Some(at) = self.want(file, found, None) else {
                let why = "it is scaled in a way that is not read".to_string();
                self.left_out.push((format!("{name}/{}", found.name), why));
                continue;
            };
            let channel = Channel {
                name: found.name.to_string(),
                unit: found.unit().to_string(),
                at,
            };
            let is_of = |group: &&mut Group| group.rows == found.rows && group.time == time;
            match self.groups[first..].iter_mut().find(is_of) {
                Some(group) => group.channels.push(channel),
                None => self.groups.push(Group {
                    name: name.to_string(),
                    rows: found.rows,
                    said: found.rows,
                    time,
                    channels: vec![channel],
                }),
            }
        }
    }

    /// What a channel will be read by; `None` where it is scaled in a way that is not read.
    fn want(&mut self, file: &File, found: &Found, unit: Option<Unit>) -> Option<usize> {
        let scales = match found.kind {
            Kind::Number(_) => Scales::first(file.above(found.object))?,
            _ => Scales::default(),
        };
        self.wanted.push(Wanted {
            object: found.at,
            scales,
            unit,
        });
        Some(self.wanted.len() - 1)
    }
}

/// The channels of a group that have values.
fn found<'f>(file: &'f File, group: &str, start: Option<Stamp>) -> Vec<Found<'f>> {
    let objects = file.objects.iter().enumerate();
    let found = objects.filter_map(|(at, object)| {
        let [of, name] = &object.path[..] else {
            return None;
        };
        let rows = if of == group { file.count(at) } else { 0 };
        (rows > 0).then(|| Found {
            object,
            at,
            name,
            rows,
            kind: file.kind(at),
            time: waveform(object, start),
        })
    });
    found.collect()
}

/// The times that the properties of a waveform say, in the unit of its axis: seconds where it says none; none where its axis is
/// another than time.
fn waveform(object: &Object, start: Option<Stamp>) -> Option<Time> {
    let number = |name: &str| match object.properties.get(name) {
        Some(Value::Number(number)) if number.is_finite() => Some(*number),
        _ => None,
    };
    let step = number("wf_increment").filter(|step| *step > 0.0)?;
    let unit = match object.properties.get("wf_xunit_string") {
        Some(Value::Text(unit)) if !unit.trim().is_empty() => unit.trim(),
        _ => "s",
    };
    let unit = RecordedUnit::parse_time(unit).ok()?.unit();
    let of_stamp = match (object.properties.get("wf_start_time"), start) {
        (Some(Value::Time(stamp)), Some(start)) => stamp.since(start),
        _ => 0.0,
    };
    let offset = number("wf_start_offset").unwrap_or(0.0);
    Some(Time::Even {
        start: of_stamp + unit.to_si(offset),
        step: unit.to_si(step),
    })
}

impl Found<'_> {
    /// As the file says it.
    fn unit(&self) -> &str {
        let text = |name: &str| match self.object.properties.get(name) {
            Some(Value::Text(text)) => Some(text.trim()).filter(|text| !text.is_empty()),
            _ => None,
        };
        text("unit_string")
            .or_else(|| text("NI_UnitDescription"))
            .unwrap_or_default()
    }

    /// Of a channel of times: their unit.
    fn clock(&self) -> Option<Unit> {
        let seconds = RecordedUnit::parse_time("s").ok()?.unit();
        let label = Label::split(self.name);
        match self.kind {
            Kind::Stamp(_) => Some(seconds),
            Kind::Number(_) if label.is_called_time_or_stamp() => {
                let units = [self.unit(), label.unit, label.unit_in_name().unwrap_or("")];
                let unit = units.into_iter().find(|unit| !unit.is_empty())?;
                Some(RecordedUnit::parse_time(unit).ok()?.unit())
            }
            _ => None,
        }
    }
}

impl File<'_> {
    /// The properties of an object, of its group, and of the file.
    fn above<'f>(&'f self, object: &'f Object) -> impl Iterator<Item = &'f Properties> {
        let paths = (0..object.path.len())
            .rev()
            .map(|length| &object.path[..length]);
        let above = paths.filter_map(|path| {
            let is_at = |object: &&Object| object.path == path;
            self.objects.iter().find(is_at)
        });
        let above = above.map(|object| &object.properties);
        std::iter::once(&object.properties).chain(above)
    }

    /// What the values of an object are, where they are the same everywhere.
    fn kind(&self, at: usize) -> Kind {
        let kinds = self.segments.iter().filter_map(|segment| {
            let slot = segment.layout.slots.get(at).copied().flatten()?;
            Some(slot.kind)
        });
        let mut first = None;
        for kind in kinds {
            let is_same = matches!(
                (first, kind),
                (None, _)
                    | (Some(Kind::Number(_)), Kind::Number(_))
                    | (Some(Kind::Stamp(_)), Kind::Stamp(_))
            );
            if !is_same {
                return Kind::Other;
            }
            first = first.or(Some(kind));
        }
        first.unwrap_or(Kind::Other)
    }

    /// The first value of an object that has time stamps.
    fn first_stamp(&self, at: usize) -> Option<Stamp> {
        let slot = |layout: &super::layout::Layout| layout.slots.get(at).copied().flatten();
        let segment = self
            .segments
            .iter()
            .find(|segment| slot(&segment.layout).is_some())?;
        let slot = slot(&segment.layout)?;
        let Kind::Stamp(order) = slot.kind else {
            return None;
        };
        let start = segment.start.checked_add(slot.at)?;
        Stamp::read(self.bytes.get(start..)?.get(..super::stamp::WIDTH)?, order)
    }
}
