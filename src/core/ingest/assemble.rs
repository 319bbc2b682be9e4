//! A recording whose values stand there by name becomes a maneuver.

use indexmap::IndexMap;

use crate::flight::{Channel, Fault, Maneuver, ManeuverError};

use super::{
    IngestError, Limits,
    axis::{TimeAxis, code_of},
    code,
    fault::pointer,
    fault::{CELLS_LISTED, of_file},
    name::Names,
    recording::{Channels, RecordedTime, Recording},
    units::RecordedUnit,
};

impl Recording {
    /// # Errors
    /// Every limit that is exceeded.
    pub(super) fn check_size(&self, limits: &Limits) -> Result<(), IngestError> {
        let channels = &self.channels.0;
        let lengths = channels.iter().map(|(_, channel)| channel.values.len());
        let time = self.time.values.as_ref().map_or(0, Vec::len);
        let longest = lengths.clone().max().unwrap_or(0).max(time);
        let faults = [
            limits.columns(channels.len() + 1),
            limits.samples(longest),
            limits.values(lengths.sum::<usize>() + time),
        ];
        IngestError::refuse(faults.into_iter().flatten().collect())
    }

    /// # Errors
    /// Every fault of names, units and lengths and the first [`CELLS_LISTED`] of the time axis.
    pub(super) fn into_maneuver(self, limits: &Limits) -> Result<Maneuver, IngestError> {
        let mut faults = Vec::new();
        let first = self.channels.0.first();
        let samples = match &self.time.values {
            Some(values) => values.len(),
            None => first.map_or(0, |(_, channel)| channel.values.len()),
        };
        if first.is_none() {
            faults.push(Fault::new(
                "/channels",
                code::NO_CHANNELS,
                "there is no channel besides time; add every recorded quantity",
            ));
        } else if samples < 2 {
            let error = ManeuverError::TooFewSamples { count: samples };
            faults.push(of_file(code_of(&error), error.to_string()));
        }
        let time = self.time.into_seconds(samples, &mut faults);
        let channels = self.channels.into_si(samples, limits, &mut faults);
        IngestError::refuse(faults)?;
        Maneuver::new(time, channels)
            .map_err(|error| of_file(code_of(&error), error.to_string()).into())
    }
}

impl RecordedTime {
    fn into_seconds(self, samples: usize, faults: &mut Vec<Fault>) -> Vec<f64> {
        let unit = match RecordedUnit::parse_time(&self.unit) {
            Ok(unit) => unit.unit(),
            Err((code, message)) => {
                faults.push(Fault::new("/time/unit", code, message));
                return Vec::new();
            }
        };
        let recorded: Box<dyn Iterator<Item = f64>> = match (self.values, self.start, self.step) {
            (Some(values), None, None) => Box::new(values.into_iter().map(|number| number.0)),
            (None, start, Some(step)) => {
                let start = start.unwrap_or(0.0);
                Box::new((0..samples).map(move |k| start + k as f64 * step))
            }
            _ => {
                faults.push(Fault::new(
                    "/time",
                    code::WRONG_SHAPE,
                    r#"time has either "values", or "step" and perhaps "start""#,
                ));
                return Vec::new();
            }
        };
        let is_even = self.step.is_some();
        let mut axis = TimeAxis::new(unit, samples);
        let mut found = 0;
        for (k, time) in recorded.enumerate() {
            let Err(error) = axis.push(time) else {
                continue;
            };
            let place = if is_even {
                "/time/step".to_string()
            } else {
                pointer(["time", "values", &k.to_string()])
            };
            faults.push(Fault::new(place, code_of(&error), error.to_string()));
            found += 1;
            if is_even || found == CELLS_LISTED {
                break;
            }
        }
        axis.into_seconds()
    }
}

impl Channels {
    fn into_si(
        self,
        samples: usize,
        limits: &Limits,
        faults: &mut Vec<Fault>,
    ) -> IndexMap<String, Channel> {
        let mut names = Names::new(limits);
        let mut channels = IndexMap::with_capacity(self.0.len());
        for (name, channel) in self.0 {
            // A key too long to be a name is also too long to repeat.
            let place = if name.len() <= limits.max_name_length {
                vec!["channels", name.as_str()]
            } else {
                vec!["channels"]
            };
            let within = |member: &'static str| pointer(place.iter().copied().chain([member]));
            if let Err((code, message)) = names.take(&name) {
                faults.push(Fault::new(pointer(&place), code, message));
            }
            if channel.values.len() != samples {
                let error = ManeuverError::LengthMismatch {
                    channel: name.chars().take(limits.max_name_length).collect(),
                    expected: samples,
                    found: channel.values.len(),
                };
                faults.push(Fault::new(
                    within("values"),
                    code_of(&error),
                    error.to_string(),
                ));
            }
            match RecordedUnit::parse(&channel.unit) {
                Ok(unit) => {
                    let values = channel.values.into_iter().map(|number| number.0).collect();
                    channels.insert(name, unit.channel(values));
                }
                Err((code, message)) => faults.push(Fault::new(within("unit"), code, message)),
            }
        }
        channels
    }
}
