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
    recording::{Channels, Number, RecordedChannel, RecordedTime, Recording},
    union::Union,
    units::RecordedUnit,
};

impl Recording {
    /// # Errors
    /// Every limit that is exceeded.
    pub(super) fn check_size(&self, limits: &Limits) -> Result<(), IngestError> {
        let channels = &self.channels.0;
        let lengths = channels.iter().map(|(_, channel)| channel.values.len());
        let count = |time: &RecordedTime| time.values.as_ref().map_or(0, Vec::len);
        let own = channels
            .iter()
            .filter_map(|(_, channel)| channel.time.as_ref());
        let time = count(&self.time) + own.map(count).sum::<usize>();
        let longest = lengths.clone().max().unwrap_or(0).max(count(&self.time));
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
        let has_own = |(_, channel): &(String, RecordedChannel)| channel.time.is_some();
        if self.channels.0.iter().any(has_own) {
            return self.on_one_axis(limits)?.into_maneuver(limits);
        }
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

impl Recording {
    /// The same with one time axis, of the times of all channels.
    ///
    /// # Errors
    /// An axis is not one of time, does not increase, or is not as long as a channel on it; or all together are too long.
    fn on_one_axis(mut self, limits: &Limits) -> Result<Self, IngestError> {
        let mut faults = Vec::new();
        let on_main = self
            .channels
            .0
            .iter()
            .find(|(_, channel)| channel.time.is_none());
        let samples = on_main.map_or(0, |(_, channel)| channel.values.len());
        let mut axes = vec![self.time.into_seconds(samples, &mut faults)];
        let mut of = Vec::with_capacity(self.channels.0.len());
        for (name, channel) in &mut self.channels.0 {
            let samples = channel.values.len();
            let Some(time) = channel.time.take() else {
                of.push(0);
                continue;
            };
            let mut own = Vec::new();
            axes.push(time.into_seconds(samples, &mut own));
            of.push(axes.len() - 1);
            let place = pointer(["channels", name]);
            faults.extend(own.into_iter().map(|fault| fault.under(&place)));
        }
        for ((name, channel), &axis) in self.channels.0.iter().zip(&of) {
            let (expected, found) = (axes[axis].len(), channel.values.len());
            if expected != found {
                let channel = name.chars().take(limits.max_name_length).collect();
                let error = ManeuverError::LengthMismatch {
                    channel,
                    expected,
                    found,
                };
                let place = pointer(["channels", name, "values"]);
                faults.push(Fault::new(place, code_of(&error), error.to_string()));
            }
        }
        IngestError::refuse(faults)?;
        let union = Union::of(&axes, limits)?;
        let values = of.len().saturating_mul(union.time.len());
        limits.values(values).map_or(Ok(()), Err)?;
        for ((_, channel), &axis) in self.channels.0.iter_mut().zip(&of) {
            let values: Vec<f64> = channel.values.iter().map(|number| number.0).collect();
            channel.values = union
                .spread(axis, &values)
                .into_iter()
                .map(Number)
                .collect();
        }
        self.time = RecordedTime {
            unit: "s".to_string(),
            values: Some(union.time.into_iter().map(Number).collect()),
            start: None,
            step: None,
        };
        Ok(self)
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

#[cfg(test)]
mod tests {
    use super::super::{Format, fault::places, read};
    use super::*;

    fn read_json(text: &str) -> Result<Maneuver, IngestError> {
        read(text.as_bytes(), Format::Json, &Limits::default())
    }

    #[test]
    fn channels_with_times_of_their_own_keep_their_samples() {
        let text = r#"{"time": {"unit": "s", "step": 0.1}, "channels": {
            "q": {"unit": "deg/s", "values": [1, 2, 3, 4]},
            "alpha": {"unit": "deg", "values": [5, null, 7], "time": {"unit": "ms", "values": [0, 100, 250]}}}}"#;
        let maneuver = read_json(text).unwrap();
        assert_eq!(maneuver.len(), 5);
        assert_eq!(maneuver.time()[2..4], [0.2, 0.25]);
        let there = |name: &str| -> Vec<usize> {
            let values = &maneuver.channels()[name].values;
            (0..5).filter(|&k| !values[k].is_nan()).collect()
        };
        assert_eq!((there("q"), there("alpha")), (vec![0, 1, 2, 4], vec![0, 3]));
        assert_eq!(maneuver.channels()["alpha"].values[3], 7f64.to_radians());
    }

    #[test]
    fn faults_of_own_times_stand_at_their_place() {
        let refused = |values: &str, time: &str| {
            let text = format!(
                r#"{{"time": {{"unit": "s", "step": 0.1}}, "channels": {{"q": {{"values": [1, 2]}}, "a": {{"values": {values}, "time": {time}}}}}}}"#
            );
            places(read_json(&text))
        };
        let late = refused("[1, 2]", r#"{"unit": "s", "values": [1, 0]}"#);
        assert_eq!(late, ["time_not_increasing /channels/a/time/values/1"]);
        let unit = refused("[1, 2]", r#"{"unit": "kg", "values": [0, 1]}"#);
        assert_eq!(unit[0], "time_unit /channels/a/time/unit");
        let short = refused("[1, 2, 3]", r#"{"unit": "s", "values": [0, 1]}"#);
        assert_eq!(short, ["length_mismatch /channels/a/values"]);
    }
}
