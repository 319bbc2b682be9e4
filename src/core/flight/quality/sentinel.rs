//! Numbers that stand for "no value": -9999, 1e30, 65535 in samples of their own, far from all others.

use crate::flight::{Finding, FindingCode};

use super::record::Series;
use super::statistics::{percentile, sorted};

/// What recorders and programs write where there is nothing; a single one of these is enough.
const USUAL: [f64; 16] = [
    -9999.0,
    9999.0,
    -999.0,
    999.0,
    -999.25,
    -99999.0,
    99999.0,
    -999_999.0,
    999_999.0,
    32767.0,
    -32768.0,
    65535.0,
    2_147_483_647.0,
    -2_147_483_648.0,
    1e30,
    -1e30,
];
/// Further from what is usual than the usual range, so many times.
const FAR: f64 = 5.0;
const FURTHER: f64 = 20.0;
/// More samples than this share are no exception.
const MOST: f64 = 0.3;

/// The rows of a number that stands for no value, and the number in the recorded unit.
pub(super) fn sentinel(series: &Series<'_>) -> Option<(Vec<usize>, f64)> {
    let values = &series.values;
    let all = sorted(values.iter().copied());
    if all.len() < 10 {
        return None;
    }
    let (least, most) = (*all.first()?, *all.last()?);
    [least, most].into_iter().find_map(|extreme| {
        let rows: Vec<usize> = (0..values.len())
            .filter(|&k| values[k] == extreme)
            .collect();
        let others: Vec<f64> = all
            .iter()
            .copied()
            .filter(|value| *value != extreme)
            .collect();
        if others.len() < 10 || rows.len() as f64 > MOST * all.len() as f64 {
            return None;
        }
        // of the others some may be another such number
        let (low, high) = (percentile(&others, 0.02)?, percentile(&others, 0.98)?);
        let distance = (low - extreme).max(extreme - high);
        let size = (high - low).max(0.05 * low.abs().max(high.abs()));
        let recorded = series.unit.from_si(extreme);
        let is_usual = |usual: &f64| (recorded - usual).abs() <= 1e-6 * usual.abs();
        let known = USUAL.iter().copied().find(|usual| is_usual(usual));
        // a number of no fame must be further out, and of a channel that moves otherwise: a command has levels
        let is_odd = high > low && distance > FURTHER * size && rows.len() >= 3;
        let is_one = (known.is_some() && distance > FAR * size) || is_odd;
        is_one.then(|| (rows, known.unwrap_or(recorded)))
    })
}

pub(super) fn finding(name: &str, rows: &[usize], number: f64) -> Finding {
    let message = format!(
        "{} value(s) are {number} exactly, far from all others: a sign for \"no value\"?",
        rows.len()
    );
    let remedy = format!(
        "say \"missing\": [{number}] in a mapping of the recording, or make these cells empty"
    );
    Finding::new(FindingCode::Sentinel, message, remedy)
        .of_channel(name)
        .at_rows(rows)
}

#[cfg(test)]
mod tests {
    use std::borrow::Cow;

    use super::super::tests::noise;
    use super::*;
    use crate::flight::Unit;

    fn found(values: Vec<f64>) -> Option<(Vec<usize>, f64)> {
        let unit = Unit::parse("deg").unwrap();
        let values = values.into_iter().map(|value| unit.to_si(value));
        sentinel(&Series {
            name: "alpha",
            values: Cow::Owned(values.collect()),
            unit,
            is_angle: true,
            is_used: true,
        })
    }

    #[test]
    fn a_number_far_out_that_comes_again_or_is_usual_is_one() {
        let clean: Vec<f64> = (0..300).map(|k| 3.0 + noise(k)).collect();
        assert_eq!(found(clean.clone()), None);
        let mut values = clean.clone();
        values[7] = -9999.0;
        assert_eq!(found(values.clone()), Some((vec![7], -9999.0)));
        for k in [9, 100, 101] {
            values[k] = 1e30;
        }
        assert!(found(values).is_some());
        let mut values = clean.clone();
        values[30..40].fill(-77.7);
        let (rows, number) = found(values).unwrap();
        assert!(rows.len() == 10 && (number + 77.7).abs() < 1e-9);
        let mut spike = clean;
        spike[20] = 140.0;
        assert_eq!(found(spike), None, "a spike of its own");
        let steps: Vec<f64> = (0..300)
            .map(|k| if k % 100 < 10 { 10.0 } else { 0.0 })
            .collect();
        assert_eq!(found(steps), None, "a pulse is a command");
    }
}
