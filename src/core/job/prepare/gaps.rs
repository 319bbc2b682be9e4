//! What becomes of the gaps of a recording: parts of their own, one time history, or samples without values between.

use std::ops::Range;
use std::sync::Arc;

use super::stretch::{Bridge, Stretch, rows_in_use};
use crate::flight::{Fault, Finding, FindingCode, Gap, Maneuver, Severity};
use crate::job::spec::{Gaps, JobSpec};
use crate::model::{ChannelFormula, Model, Recorded};
use crate::simulate::Steps;

/// A gap this near to a whole number of steps leaves the sampling even.
const WHOLE: f64 = 0.1;
/// More samples than are recorded, so many times, are not put into a gap.
const MOST_INSERTED: usize = 10;
/// The share of its variance that an output may change by over a time that is short against its motion: a sixth of the
/// period of a sine.
const SHORT: f64 = 0.5;
/// An output that changes by this share from one sample to the next is noise, and tells nothing of the motion.
const NOISE: f64 = 0.25;

/// Cuts the maneuvers of a job into the stretches that are simulated.
pub(super) fn stretches<'m>(
    spec: &JobSpec,
    model: &Model,
    maneuvers: &'m [Arc<Maneuver>],
    findings: &mut Vec<Finding>,
    faults: &mut Vec<Fault>,
) -> Vec<Vec<Stretch<'m>>> {
    let uses = spec.maneuvers.iter().zip(maneuvers).enumerate();
    let mut all = Vec::new();
    for (index, (usage, maneuver)) in uses {
        let cut = match rows_in_use(usage, maneuver) {
            Ok(rows) => cut(spec, model, index, maneuver, rows, findings),
            Err((part, message)) => {
                let pointer = format!("/maneuvers/{index}/{part}");
                Err(Fault::new(pointer, "bad_rows", message))
            }
        };
        all.push(cut.unwrap_or_else(|fault| {
            faults.push(fault);
            Vec::new()
        }));
    }
    all
}

/// What is done with one gap.
enum Done {
    Split,
    Join,
    Through(Bridge),
}

fn cut<'m>(
    spec: &JobSpec,
    model: &Model,
    index: usize,
    maneuver: &'m Maneuver,
    rows: Range<usize>,
    findings: &mut Vec<Finding>,
) -> Result<Vec<Stretch<'m>>, Fault> {
    let usage = &spec.maneuvers[index];
    let sampling = maneuver.sampling();
    let name = spec.label(index);
    let gaps: Vec<&Gap> = (sampling.gaps.iter())
        .filter(|gap| rows.start < gap.before && gap.before < rows.end)
        .collect();
    let short = match usage.gaps {
        Gaps::Auto if !gaps.is_empty() => short_time(spec, model, index, maneuver, &rows),
        _ => 0.0,
    };
    let done: Vec<Done> = gaps
        .iter()
        .map(|gap| {
            let bridge = Bridge {
                before: gap.before,
                samples: ((gap.duration / sampling.step).round() as usize).saturating_sub(1),
            };
            match usage.gaps {
                Gaps::Split => Done::Split,
                Gaps::Join => Done::Join,
                Gaps::Through => Done::Through(bridge),
                Gaps::Auto if gap.duration <= short => Done::Through(bridge),
                Gaps::Auto => Done::Split,
            }
        })
        .collect();
    let inserted: usize = (done.iter())
        .map(|done| match done {
            Done::Through(bridge) => bridge.samples,
            _ => 0,
        })
        .sum();
    if inserted > MOST_INSERTED * rows.len() {
        let message = format!(
            "integrating through the gaps takes {inserted} samples without values, more than {MOST_INSERTED} times as many as are recorded; say \"split\", or choose \"rows\""
        );
        return Err(Fault::new(
            format!("/maneuvers/{index}/gaps"),
            "gap_too_long",
            message,
        ));
    }
    findings.extend(told(&name, index, sampling.step, &gaps, &done));
    let mut parts: Vec<(Range<usize>, Vec<Bridge>)> = vec![(rows.start..rows.start, Vec::new())];
    for (gap, done) in gaps.iter().zip(&done) {
        let last = parts.len() - 1;
        parts[last].0.end = gap.before;
        match done {
            Done::Split => parts.push((gap.before..gap.before, Vec::new())),
            Done::Through(bridge) => parts[last].1.push(*bridge),
            Done::Join => {}
        }
    }
    let last = parts.len() - 1;
    parts[last].0.end = rows.end;
    let many = parts.len() > 1;
    let stretch = |(number, (rows, bridges)): (usize, (Range<usize>, Vec<Bridge>))| {
        let label = match many {
            true => format!("{name}.{}", number + 1),
            false => name.clone(),
        };
        let mut stretch = Stretch::new(index, maneuver, rows, label).through(&bridges);
        stretch.is_behind_gap = number > 0;
        let is_whole = |bridge: &Bridge| {
            let steps = gaps.iter().find(|gap| gap.before == bridge.before);
            let steps = steps.map_or(0.0, |gap| gap.duration / sampling.step);
            (steps - steps.round()).abs() < WHOLE
        };
        let even = sampling.even && bridges.iter().all(is_whole);
        if !even && usage.gaps != Gaps::Join {
            let pairs = stretch.time().windows(2);
            stretch.steps = Steps::Uneven(pairs.map(|pair| pair[1] - pair[0]).collect());
        }
        stretch
    };
    Ok(parts.into_iter().enumerate().map(stretch).collect())
}

/// The time that is short against the motion of the model's outputs, s; 0 where they show none.
fn short_time(
    spec: &JobSpec,
    model: &Model,
    index: usize,
    maneuver: &Maneuver,
    rows: &Range<usize>,
) -> f64 {
    let step = maneuver.sampling().step;
    let whole = Stretch::new(index, maneuver, rows.clone(), String::new());
    let segments: Vec<Range<usize>> = (maneuver.sampling().segments().into_iter())
        .map(|part| part.start.max(rows.start)..part.end.min(rows.end))
        .filter(|part| !part.is_empty())
        .map(|part| part.start - rows.start..part.end - rows.start)
        .collect();
    let times = model.outputs.iter().filter_map(|output| {
        let formula = ChannelFormula::parse(spec.formula(index, &output.name)).ok()?;
        let lag = short_lag(&formula.samples(&whole).ok()?, &segments)?;
        Some(lag as f64 * step)
    });
    times.reduce(f64::min).unwrap_or(0.0)
}

/// The samples over which a series changes by [`SHORT`] of its variance; `None` where it is noise or never does.
fn short_lag(values: &[f64], segments: &[Range<usize>]) -> Option<usize> {
    let present: Vec<f64> = values
        .iter()
        .copied()
        .filter(|value| value.is_finite())
        .collect();
    let mean = present.iter().sum::<f64>() / present.len() as f64;
    let variance = present.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / present.len() as f64;
    // half the mean square of the change over a lag, by the variance: the variogram
    let change = |lag: usize| {
        let (mut sum, mut count) = (0.0, 0_usize);
        for segment in segments {
            for k in segment.start + lag..segment.end {
                let change = values[k] - values[k - lag];
                if change.is_finite() {
                    sum += change * change;
                    count += 1;
                }
            }
        }
        (count > 0).then(|| 0.5 * sum / count as f64 / variance)
    };
    let longest = segments.iter().map(|segment| segment.len()).max()?;
    let first = (1..longest).find_map(|lag| Some((lag, change(lag)?)))?;
    if first.1.is_nan() || first.1 > NOISE {
        return None;
    }
    let mut lag = first.0;
    while lag < longest {
        if change(lag).is_some_and(|change| change > SHORT) {
            return Some(lag);
        }
        lag += (lag / 8).max(1);
    }
    None
}

/// What was done with each gap; of those that are integrated through, which may be many, the first ones, and how many more.
fn told(name: &str, index: usize, step: f64, gaps: &[&Gap], done: &[Done]) -> Vec<Finding> {
    let is_through = |(_, done): &(&&Gap, &Done)| matches!(done, Done::Through(_));
    let (through, others): (Vec<_>, Vec<_>) = gaps.iter().zip(done).partition(is_through);
    let tell = |(gap, done): (&&Gap, &Done)| finding(name, index, gap, step, done);
    let mut findings: Vec<Finding> = others.into_iter().map(tell).collect();
    let more = through.len().saturating_sub(Finding::ROWS_LISTED);
    findings.extend(through.into_iter().take(Finding::ROWS_LISTED).map(tell));
    if let Some(last) = findings.last_mut().filter(|_| more > 0) {
        last.message = format!("{}; so are {more} more gaps", last.message);
        last.count += more;
    }
    findings
}

fn finding(name: &str, index: usize, gap: &Gap, step: f64, done: &Done) -> Finding {
    let (done, remedy, severity) = match done {
        Done::Split => (
            "each part is simulated from an initial state of its own",
            "say \"gaps\": \"through\" beside the maneuver's \"id\" (--gaps through on the command line) to integrate on, \"join\" to close it up, or choose \"rows\"",
            Severity::Warning,
        ),
        Done::Join => (
            "it is closed up, as if there were none",
            "leave \"gaps\" out to integrate on, or to simulate each part on its own",
            Severity::Warning,
        ),
        Done::Through(_) => (
            "the model is integrated through it, inputs straight between the rows at both sides, outputs without values",
            "say \"gaps\": \"split\" to simulate each part on its own, where inputs moved meanwhile",
            Severity::Note,
        ),
    };
    let before = gap.before;
    let message = format!(
        "maneuver {name}: {:.2} s between rows {before} and {}, where samples are {step} s apart; {done}",
        gap.duration,
        before + 1
    );
    Finding::new(FindingCode::Gap, message, remedy)
        .with_severity(severity)
        .of_recording(name)
        .at(format!("/maneuvers/{index}/gaps"))
        .at_rows(&[before])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sixth_of_a_period_is_short() {
        let whole = std::slice::from_ref(&(0..2000)).to_vec();
        let sine = |period: f64| -> Vec<f64> {
            (0..2000)
                .map(|k| (f64::from(k) * std::f64::consts::TAU / period).sin())
                .collect()
        };
        for period in [60.0, 120.0, 400.0] {
            let lag = short_lag(&sine(period), &whole).unwrap() as f64;
            assert!(
                (lag - period / 6.0).abs() < 0.15 * period / 6.0 + 1.0,
                "{period}: {lag}"
            );
        }
        assert_eq!(
            short_lag(&sine(5.0), &whole),
            None,
            "too fast to tell from noise"
        );
        assert_eq!(short_lag(&[1.0; 2000], &whole), None);
    }
}
