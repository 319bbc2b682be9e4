//! What is odd about the recordings as the job uses them: its inputs and outputs, made by its formulas, looked at as
//! the channels of an upload are. What a formula has mended is not said again.

use std::borrow::Cow;
use std::ops::Range;

use super::twice::Used;
use crate::flight::{Finding, FindingCode, Maneuver, Record, Sampling, Series, Unit, quality_of};
use crate::job::spec::JobSpec;
use crate::model::{Model, Quantity};
use crate::simulate::InputInterpolation;

/// Of one maneuver, `parts` being what was made of it.
pub(super) fn findings(
    spec: &JobSpec,
    model: &Model,
    index: usize,
    maneuver: &Maneuver,
    parts: &[Used<'_, '_>],
) -> Vec<Finding> {
    let rows = parts.iter().map(|(_, stretch)| stretch.rows.clone());
    let Some(rows) = rows.reduce(|all, part| all.start.min(part.start)..all.end.max(part.end))
    else {
        return Vec::new();
    };
    let label = spec.label(index);
    let record = record(spec, model, index, maneuver, rows.clone(), parts);
    let told_elsewhere = [FindingCode::Gap.name(), FindingCode::MissingValues.name()];
    let found = quality_of(&record).into_iter();
    // a command that a computer holds is what the job says that it is
    let holds = spec.options.input_interpolation == InputInterpolation::Hold;
    let is_meant = |finding: &Finding| {
        let inputs = model.inputs.iter().map(|input| Some(&input.name));
        let is_input = inputs
            .into_iter()
            .any(|name| name == finding.channel.as_ref());
        holds && is_input && finding.code == FindingCode::HeldChannel.name()
    };
    found
        .filter(|finding| !told_elsewhere.contains(&finding.code.as_str()) && !is_meant(finding))
        .map(|mut finding| {
            finding.rows.iter_mut().for_each(|row| *row += rows.start);
            finding.of_recording(&label)
        })
        .collect()
}

fn record<'r>(
    spec: &JobSpec,
    model: &'r Model,
    index: usize,
    maneuver: &'r Maneuver,
    rows: Range<usize>,
    parts: &[Used<'r, '_>],
) -> Record<'r> {
    let time = &maneuver.time()[rows.clone()];
    let sampling = match rows.len() == maneuver.len() {
        true => Cow::Borrowed(maneuver.sampling()),
        false => {
            let channels = maneuver.channels().values();
            let values = channels.map(|channel| &channel.values[rows.clone()]);
            Cow::Owned(Sampling::of(time, values))
        }
    };
    let series = |quantity: &'r Quantity, values: &dyn Fn(&Used<'r, '_>) -> &'r [f64]| {
        // a channel that is taken as it is recorded is judged in the unit of the recording
        let recorded = maneuver.channels().get(&quantity.name);
        let recorded = recorded.filter(|_| spec.formula(index, &quantity.name) == quantity.name);
        Series {
            name: &quantity.name,
            values: whole(&rows, parts, values),
            unit: recorded.map_or(quantity.unit, |channel| channel.unit),
            is_angle: quantity.si == "rad",
            is_used: true,
        }
    };
    let mut all = Vec::new();
    for (place, quantity) in model.inputs.iter().enumerate() {
        all.push(series(quantity, &|(segment, _)| &segment.inputs[place]));
    }
    for (place, quantity) in model.outputs.iter().enumerate() {
        all.push(series(quantity, &|(segment, _)| &segment.measured[place]));
    }
    for (name, channel) in maneuver.channels() {
        if all.iter().any(|series| series.name == name) {
            continue;
        }
        all.push(Series {
            name,
            values: Cow::Borrowed(&channel.values[rows.clone()]),
            unit: channel.unit,
            is_angle: Unit::si_name(&channel.recorded_unit) == "rad",
            is_used: false,
        });
    }
    Record {
        time: Cow::Borrowed(time),
        sampling,
        first_row: rows.start,
        series: all,
    }
}

/// The samples of all parts, row by row of the recording.
fn whole<'r>(
    rows: &Range<usize>,
    parts: &[Used<'r, '_>],
    values: &dyn Fn(&Used<'r, '_>) -> &'r [f64],
) -> Cow<'r, [f64]> {
    if let [part] = parts
        && part.1.inserted().is_empty()
    {
        return Cow::Borrowed(values(part));
    }
    let mut all = vec![f64::NAN; rows.len()];
    for part in parts {
        let of_part = values(part);
        for (sample, row) in part.1.recorded() {
            all[row - rows.start] = of_part[sample];
        }
    }
    Cow::Owned(all)
}
