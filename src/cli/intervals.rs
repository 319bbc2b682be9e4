//! Confidence intervals by refits: how they are asked for, and as a table.

use super::bordered::bordered;
use crate::estimate::{
    ConfidenceInterval, ConfidenceIntervals, IntervalMethod, IntervalOptions, ParameterIntervals,
};
use crate::flight::bounded;

/// The words, each with what may follow behind a colon.
const WORDS: &str =
    "bootstrap[:COUNT], block:SAMPLES, profile[:NAME+NAME...], monte_carlo[:COUNT], seed:NUMBER";

/// Half the width of a 95 % interval, standard deviations.
const HALF_WIDTH: f64 = 1.96;

/// Reads `bootstrap:2000,profile:Ma+Mq`; nothing asks for all methods.
pub(super) fn interval_options(text: &str) -> Result<IntervalOptions, String> {
    let usual = IntervalOptions::default();
    if text.is_empty() {
        return Ok(usual);
    }
    let mut options = IntervalOptions {
        bootstrap: 0,
        profile: false,
        monte_carlo: 0,
        ..usual.clone()
    };
    for part in text.split(',') {
        let (word, value) = match part.trim().split_once(':') {
            Some((word, value)) => (word, Some(value)),
            None => (part.trim(), None),
        };
        let count = |usual: Option<usize>| match value {
            Some(value) => value.parse::<usize>().ok(),
            None => usual,
        };
        let unfit = || format!("'{part}': choose from {WORDS}, with commas between");
        match word {
            "bootstrap" => options.bootstrap = count(Some(usual.bootstrap)).ok_or_else(unfit)?,
            "monte_carlo" => {
                options.monte_carlo = count(Some(usual.monte_carlo)).ok_or_else(unfit)?;
            }
            "block" => options.block = Some(count(None).ok_or_else(unfit)?),
            "seed" => options.seed = count(None).ok_or_else(unfit)? as u64,
            "profile" => {
                options.profile = true;
                let names = value.into_iter().flat_map(|names| names.split('+'));
                options.parameters.extend(names.map(str::to_string));
            }
            _ => return Err(unfit()),
        }
    }
    Ok(options)
}

/// All intervals, and what to know of them.
pub(super) fn intervals(found: &ConfidenceIntervals) -> String {
    let rows = found.parameters.iter().flat_map(of_parameter);
    let header = [
        "95 % interval of",
        "unit",
        "method",
        "lower",
        "upper",
        "std. dev.",
        "asymmetry",
        "",
    ];
    let mut parts = Vec::new();
    if !found.parameters.is_empty() {
        parts.push(bordered(header, rows, 3..7));
    }
    parts.extend(found.made_of());
    parts.extend(found.remarks.iter().map(|remark| format!("note: {remark}")));
    parts.join("\n")
}

fn of_parameter(parameter: &ParameterIntervals) -> impl Iterator<Item = Vec<String>> {
    let name = parameter.label();
    let rows = parameter.intervals.iter().enumerate();
    rows.map(move |(number, interval)| {
        let [lower, upper, deviation] = numbers(interval);
        let first = number == 0;
        let once = |text: &str| {
            if first {
                text.to_string()
            } else {
                String::new()
            }
        };
        vec![
            once(&name),
            once(&parameter.unit),
            interval.method.title().to_string(),
            lower,
            upper,
            deviation,
            asymmetry(interval),
            interval.remark().to_string(),
        ]
    })
}

/// Lower and upper end and standard deviation, with the digits that this leaves.
fn numbers(interval: &ConfidenceInterval) -> [String; 3] {
    let width = interval.lower.zip(interval.upper).map(|(a, b)| b - a);
    let size = interval.standard_deviation;
    let size = size.or_else(|| width.map(|width| 0.5 * width / HALF_WIDTH));
    let end =
        |value: Option<f64>| value.map_or("-".to_string(), |value| bounded(value, size)[0].clone());
    let deviation = interval.standard_deviation;
    [
        end(interval.lower),
        end(interval.upper),
        deviation.map_or_else(String::new, |error| bounded(0.0, Some(error))[1].clone()),
    ]
}

/// That of the error bounds is 1 by construction.
fn asymmetry(interval: &ConfidenceInterval) -> String {
    let is_bound = matches!(
        interval.method,
        IntervalMethod::Conventional | IntervalMethod::Corrected
    );
    let told = interval.asymmetry.filter(|_| !is_bound);
    told.map_or_else(String::new, |ratio| format!("{ratio:.2}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn methods_are_named_with_their_settings() {
        assert_eq!(interval_options(""), Ok(IntervalOptions::default()));
        let wanted = IntervalOptions {
            bootstrap: 2000,
            block: Some(25),
            profile: true,
            parameters: vec!["Ma".into(), "Mq".into()],
            monte_carlo: 0,
            seed: 3,
        };
        let text = "bootstrap:2000,block:25, profile:Ma+Mq,seed:3";
        assert_eq!(interval_options(text), Ok(wanted));
        let only = interval_options("monte_carlo").unwrap();
        assert_eq!(
            (only.bootstrap, only.profile, only.monte_carlo),
            (0, false, 1000)
        );
        for wrong in ["jackknife", "bootstrap:many", "block", "seed:"] {
            assert!(interval_options(wrong).is_err(), "{wrong}");
        }
    }
}
