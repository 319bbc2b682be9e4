//! A mapping and a file become a maneuver.

use std::collections::BTreeMap;

use crate::flight::{Fault, Maneuver};

use super::super::{
    IngestError, Limits, code,
    fault::pointer,
    matrix::Matrix,
    recording::{Channels, Number, RecordedChannel, RecordedTime, Recording},
};
use super::{MappedChannel, Mapping, NoValue, Part, Source};

/// A file that values are taken from by name.
pub(in super::super) trait Archive {
    /// The matrix at a path; an empty path is the only matrix of the file.
    ///
    /// # Errors
    /// A code and a message: there is none, with what there is instead; or it cannot be read.
    fn matrix(&mut self, path: &[String]) -> Result<Matrix<'_>, (&'static str, String)>;
}

impl Mapping {
    /// Takes time and channels out of a file. A channel whose source is a whole matrix of n columns becomes
    /// n channels, `name_1` to `name_n`.
    ///
    /// # Errors
    /// Every source that is not in the file, by its place in the mapping; else the faults of names, units, lengths
    /// and time, as a JSON recording has them.
    pub(in super::super) fn apply(
        &self,
        archive: &mut impl Archive,
        limits: &Limits,
    ) -> Result<Maneuver, IngestError> {
        limits
            .columns(self.channels.len() + 1)
            .map_or(Ok(()), Err)?;
        let mut taken = Taken::new(limits, self.channels.len() + 1);
        // in the order of paths, so that every variable is unpacked once
        let mut by_path: BTreeMap<Vec<String>, Vec<(usize, Part)>> = BTreeMap::new();
        let of_time = self.time.from.as_ref().map(|from| (TIME, from.first()));
        let of_channels = self.channels.values().enumerate();
        let of_channels = of_channels.map(|(at, channel)| (at + 1, channel.from.first()));
        for (slot, from) in of_time.into_iter().chain(of_channels) {
            match from.parse::<Source>() {
                Ok(Source { path, part }) => by_path.entry(path).or_default().push((slot, part)),
                Err(why) => taken
                    .faults
                    .push((slot, code::INVALID_MAPPING, why.to_string())),
            }
        }
        for (path, wanted) in by_path {
            match archive.matrix(&path) {
                Ok(matrix) => {
                    for (slot, part) in wanted {
                        taken.take(slot, part, &matrix)?;
                    }
                }
                Err((code, message)) => {
                    let faults = wanted
                        .into_iter()
                        .map(|(slot, _)| (slot, code, message.clone()));
                    taken.faults.extend(faults);
                }
            }
        }
        let faults = self.not_said().chain(self.faults(taken.faults)).collect();
        IngestError::refuse(faults)?;
        self.recording(taken.columns).into_maneuver(limits)
    }

    /// What this file does not say itself, and neither does the mapping.
    fn not_said(&self) -> impl Iterator<Item = Fault> {
        let time = &self.time;
        let no_time = (time.from.is_none() && time.step.is_none()).then(|| {
            let message = "mapping: time has either \"from\", or \"step\" and perhaps \"start\"";
            Fault::new("/time", code::INVALID_MAPPING, message)
        });
        let silent = self
            .channels
            .iter()
            .filter(|(_, channel)| channel.unit.is_empty());
        let no_units = silent.map(|(name, _)| {
            let place = pointer(["channels", name, "unit"]);
            let message = "this file does not say units: say this one, - for a pure number";
            Fault::new(place, code::INVALID_MAPPING, message)
        });
        no_time.into_iter().chain(no_units)
    }

    fn faults(&self, mut faults: Vec<(usize, &'static str, String)>) -> Vec<Fault> {
        faults.sort_by_key(|&(slot, ..)| slot);
        let fault = |(slot, code, message): (usize, &'static str, String)| {
            let place = match slot
                .checked_sub(1)
                .and_then(|at| self.channels.get_index(at))
            {
                Some((name, _)) => pointer(["channels", name, "from"]),
                None => pointer(["time", "from"]),
            };
            Fault::new(place, code, message)
        };
        faults.into_iter().map(fault).collect()
    }

    /// The recording of what was taken, by slot.
    fn recording(&self, columns: Vec<Vec<Vec<f64>>>) -> Recording {
        let numbers = |values: Vec<f64>| values.into_iter().map(Number).collect::<Vec<_>>();
        let mut slots = columns.into_iter();
        let time = slots.next().and_then(|mut columns| columns.pop());
        let mut channels = Vec::new();
        for ((name, channel), columns) in self.channels.iter().zip(slots) {
            let is_one = columns.len() == 1;
            for (at, values) in columns.into_iter().enumerate() {
                let name = if is_one {
                    name.clone()
                } else {
                    format!("{name}_{}", at + 1)
                };
                let values = values.into_iter().map(|value| self.meant(channel, value));
                let (unit, values) = (channel.unit.clone(), numbers(values.collect()));
                channels.push((name, RecordedChannel { unit, values }));
            }
        }
        Recording {
            time: RecordedTime {
                unit: self.time.unit.clone(),
                values: time.map(numbers),
                start: self.time.start,
                step: self.time.step,
            },
            channels: Channels(channels),
        }
    }
}

impl Mapping {
    /// Whether all that it takes are rows or columns of a matrix, and nothing else of it is for tables.
    pub(in super::super) fn names_parts_of_one_matrix(&self) -> bool {
        let time = &self.time;
        let of_channels = self.channels.values().map(|channel| &channel.from);
        let is_part = |from: &super::Titles| {
            from.first()
                .parse::<Source>()
                .is_ok_and(|source| source.part != Part::Whole)
        };
        let is_for_tables = self.others
            || self.optional
            || self.skip.is_some()
            || self.header.is_some()
            || time.repeated.is_some();
        !is_for_tables
            && !self.channels.is_empty()
            && time.from.iter().chain(of_channels).all(is_part)
    }

    /// What a recorded number means: nothing, or its multiple.
    fn meant(&self, channel: &MappedChannel, value: f64) -> f64 {
        let mut no_values = self.missing.iter().chain(&channel.missing);
        if no_values.any(|no_value| *no_value == NoValue::Number(value)) {
            return f64::NAN;
        }
        value * channel.factor()
    }
}

/// The slot of time; that of a channel is its number from 1.
const TIME: usize = 0;

/// What was taken out of a file, by slot, and what could not be.
struct Taken<'a> {
    limits: &'a Limits,
    columns: Vec<Vec<Vec<f64>>>,
    faults: Vec<(usize, &'static str, String)>,
    count: usize,
    values: usize,
}

impl<'a> Taken<'a> {
    fn new(limits: &'a Limits, slots: usize) -> Self {
        Self {
            limits,
            columns: vec![Vec::new(); slots],
            faults: Vec::new(),
            count: 0,
            values: 0,
        }
    }

    /// Takes a part of a matrix, within the limits.
    ///
    /// # Errors
    /// A limit is exceeded. What the matrix does not have becomes one of the faults.
    fn take(&mut self, slot: usize, part: Part, matrix: &Matrix) -> Result<(), Fault> {
        let Matrix { rows, columns, .. } = *matrix;
        let (count, length) = match part {
            Part::Row(_) => (1, columns),
            Part::Whole if matrix.is_vector() => (1, rows.max(columns)),
            Part::Whole if slot != TIME => (columns, rows),
            Part::Column(_) | Part::Whole => (1, rows),
        };
        self.count = self.count.saturating_add(count);
        self.values = self.values.saturating_add(count.saturating_mul(length));
        let limits = self.limits;
        let too_much = [
            limits.columns(self.count),
            limits.samples(length),
            limits.values(self.values),
        ];
        if let Some(fault) = too_much.into_iter().flatten().next() {
            return Err(fault);
        }
        let missing = match part {
            Part::Column(at) if at > columns => Some(format!("there is no column {at}")),
            Part::Row(at) if at > rows => Some(format!("there is no row {at}")),
            Part::Whole if slot == TIME && !matrix.is_vector() => {
                Some("time is one column, as (:,1); say which".to_string())
            }
            _ => None,
        };
        if let Some(why) = missing {
            let message = format!("{why}: the matrix has {rows} row(s) and {columns} column(s)");
            self.faults.push((slot, code::UNKNOWN_SOURCE, message));
            return Ok(());
        }
        let taken = &mut self.columns[slot];
        match part {
            Part::Column(at) => taken.push(matrix.column(at - 1)),
            Part::Row(at) => taken.push(matrix.row(at - 1)),
            Part::Whole if rows == 1 => taken.push(matrix.row(0)),
            Part::Whole => taken.extend((0..columns).map(|at| matrix.column(at))),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::fault::places;
    use super::*;

    /// `t`: 3 x 1; `m`: 3 x 2; `r`: 2 x 3.
    struct Three;

    impl Archive for Three {
        fn matrix(&mut self, path: &[String]) -> Result<Matrix<'_>, (&'static str, String)> {
            match path.join(".").as_str() {
                "t" => Ok(Matrix::of_rows(&[0.0, 1.0, 2.0], 1)),
                "m" => Ok(Matrix::of_rows(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], 2)),
                "r" => Ok(Matrix::of_rows(
                    &[1.0, 2.0, 3.0, 4.0, 5.0, f64::INFINITY],
                    3,
                )),
                _ => Err((code::UNKNOWN_SOURCE, "there is t, m and r".to_string())),
            }
        }
    }

    fn apply(time: &str, channels: &str, limits: &Limits) -> Result<Maneuver, IngestError> {
        let text = format!(r#"{{"time": {{{time}}}, "channels": {{{channels}}}}}"#);
        Mapping::from_json(&text)?.apply(&mut Three, limits)
    }

    const T: &str = r#""from": "t", "unit": "s""#;

    #[test]
    fn parts_become_channels_in_the_order_of_the_mapping() {
        let channels = r#""row": {"from": "r(2,:)", "unit": "-"}, "m": {"from": "m", "unit": "km"},
            "a": {"from": "m(:,2)", "unit": "m"}, "time": {"from": "t", "unit": "s"}"#;
        let maneuver = apply(T, channels, &Limits::default()).unwrap();
        let names: Vec<&String> = maneuver.channels().keys().collect();
        assert_eq!(names, ["row", "m_1", "m_2", "a", "time"]);
        assert_eq!(maneuver.channels()["m_2"].values, [2000.0, 4000.0, 6000.0]);
        assert_eq!(maneuver.channels()["a"].values, [2.0, 4.0, 6.0]);
        assert!(maneuver.channels()["row"].values[2].is_nan());
        assert_eq!(maneuver.channels()["row"].values[..2], [4.0, 5.0]);

        let even = apply(
            r#""step": 40, "start": 1000, "unit": "ms""#,
            r#""a": {"from": "t", "unit": "m"}"#,
            &Limits::default(),
        );
        assert_eq!(even.unwrap().time(), [1.0, 1.04, 1.08]);
    }

    #[test]
    fn all_faults_stand_at_their_place_in_the_mapping() {
        let channels = r#""b": {"from": "x.y", "unit": "-"}, "c": {"from": "m(:,3)", "unit": "-"}, "d": {"from": "r(3,:)", "unit": "-"}"#;
        let refused = apply(r#""from": "m", "unit": "s""#, channels, &Limits::default());
        let expected = [
            "/time/from",
            "/channels/b/from",
            "/channels/c/from",
            "/channels/d/from",
        ];
        assert_eq!(
            places(refused),
            expected.map(|place| format!("unknown_source {place}"))
        );
        let channels =
            r#""a b": {"from": "t", "unit": "-"}, "c": {"from": "r(:,1)", "unit": "warp"}"#;
        assert_eq!(
            places(apply(T, channels, &Limits::default())),
            [
                "invalid_name /channels/a b",
                "length_mismatch /channels/c/values",
                "unknown_unit /channels/c/unit"
            ]
        );
    }

    #[test]
    fn limits_hold_before_anything_is_taken() {
        let limits = Limits {
            max_columns: 4,
            max_samples: 3,
            max_values: 100,
            max_name_length: 5,
        };
        let refused = |sources: &[&str], limits: &Limits| {
            let channel = |(at, from)| format!(r#""c{at}": {{"from": "{from}", "unit": "-"}}"#);
            let channels: Vec<String> = sources.iter().enumerate().map(channel).collect();
            places(apply(T, &channels.join(","), limits))
        };
        assert_eq!(refused(&["t"; 4], &limits), ["too_many_columns "]);
        assert_eq!(refused(&["r", "t"], &limits), ["too_many_columns "]);
        let few_values = Limits {
            max_values: 8,
            ..limits
        };
        assert_eq!(refused(&["m"], &few_values), ["too_many_values "]);
        let few_samples = Limits {
            max_samples: 2,
            ..limits
        };
        assert_eq!(refused(&["t"], &few_samples), ["too_many_samples "]);
    }
}
