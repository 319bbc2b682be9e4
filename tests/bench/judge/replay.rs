//! Real inputs, read when they are there: `TRIMTAB_FLIGHT_DATA`, or `../shared/data/flight`.

use std::path::PathBuf;
use std::sync::Arc;

use crate::inputs::{Command, still};
use crate::motion::{AILERON, ELEVATOR, RUDDER};
use crate::random::Random;

/// Deflections of real maneuvers, by control: time since the start, and share of the largest.
pub(crate) struct Replay {
    records: Vec<(usize, f64, Vec<f64>)>,
}

/// File, control, the columns it is made of with their factors, and the step, s.
type Source = (&'static str, usize, &'static [(&'static str, f64)], f64);

const SOURCES: [Source; 6] = [
    ("attas_elv1.csv", ELEVATOR, &[("de", 1.0)], 0.04),
    ("hfb320_1_10.csv", ELEVATOR, &[("de", 1.0)], 0.1),
    (
        "attas_ail1.csv",
        AILERON,
        &[("da_right", 0.5), ("da_left", -0.5)],
        0.04,
    ),
    (
        "attas_rud1.csv",
        AILERON,
        &[("da_right", 0.5), ("da_left", -0.5)],
        0.04,
    ),
    ("attas_rud1.csv", RUDDER, &[("dr", 1.0)], 0.04),
    ("attas_ail1.csv", RUDDER, &[("dr", 1.0)], 0.04),
];

impl Replay {
    /// `None`, and a word to say so, where there is no flight data.
    pub(crate) fn read() -> Option<Self> {
        let places = [
            std::env::var_os("TRIMTAB_FLIGHT_DATA").map(PathBuf::from),
            Some(PathBuf::from("../shared/data/flight")),
            Some(PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/flight")),
        ];
        let place = (places.into_iter().flatten()).find(|place| place.is_dir());
        let records: Vec<_> = (place.iter())
            .flat_map(|place| {
                (SOURCES.iter()).filter_map(|(file, control, columns, step)| {
                    let text = std::fs::read_to_string(place.join(file)).ok()?;
                    Some((*control, *step, series(&text, columns)?))
                })
            })
            .collect();
        if records.is_empty() {
            eprintln!(
                "NO FLIGHT DATA: real inputs are not replayed, random ones take their place. \
                 Set TRIMTAB_FLIGHT_DATA to have them."
            );
            return None;
        }
        Some(Self { records })
    }

    /// The record of a control, from `start` on, at most `amplitude` large.
    pub(crate) fn command(
        &self,
        control: usize,
        start: f64,
        amplitude: f64,
        random: &mut Random,
    ) -> Command {
        let fit: Vec<_> = self
            .records
            .iter()
            .filter(|(c, ..)| *c == control)
            .collect();
        if fit.is_empty() {
            return still();
        }
        // the first of them moves that control most
        let pick = if random.chance(0.7) {
            0
        } else {
            random.index(fit.len())
        };
        let (_, step, values) = fit[pick];
        let (step, values) = (*step, Arc::new(values.clone()));
        let skip = random.between(0.0, 2.0);
        Arc::new(move |t| amplitude * cubic(&values, (t - start + skip).max(0.0) / step))
    }
}

/// Sum of columns, less the first value, over the largest.
fn series(text: &str, columns: &[(&str, f64)]) -> Option<Vec<f64>> {
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next()?.split(',').collect();
    let place = |name: &str| {
        header
            .iter()
            .position(|h| h.split('[').next().is_some_and(|h| h.trim() == name))
    };
    let places: Vec<(usize, f64)> = (columns.iter())
        .map(|(name, factor)| Some((place(name)?, *factor)))
        .collect::<Option<_>>()?;
    let raw: Vec<f64> = lines
        .filter_map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            let of =
                |(at, factor): &(usize, f64)| Some(factor * cells.get(*at)?.parse::<f64>().ok()?);
            places.iter().map(of).sum::<Option<f64>>()
        })
        .collect();
    let first = *raw.first()?;
    let largest = raw.iter().map(|v| (v - first).abs()).fold(0.0, f64::max);
    Some(raw.iter().map(|v| (v - first) / largest).collect())
}

/// Catmull-Rom between samples, the ends held.
fn cubic(values: &[f64], at: f64) -> f64 {
    let last = values.len() - 1;
    let k = (at as usize).min(last);
    let s = (at - k as f64).min(1.0);
    let v = |offset: isize| values[(k as isize + offset).clamp(0, last as isize) as usize];
    let (a, b, c, d) = (v(-1), v(0), v(1), v(2));
    b + 0.5 * s * (c - a + s * (2.0 * a - 5.0 * b + 4.0 * c - d + s * (3.0 * (b - c) + d - a)))
}
