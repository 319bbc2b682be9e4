//! How a model meets recordings: segments of inputs and measured outputs, made from channels.

use std::ops::Range;
use std::sync::Arc;

use crate::flight::{Dimension, Fault, Finding, Maneuver, Severity, escape};
use crate::job::spec::{Gaps, JobSpec, ManeuverUse};
use crate::model::{ChannelFormula, Model, Quantity, Recorded};
use crate::simulate::{Segment, Steps};

/// Some rows of a recording, and what the job makes of them.
pub(super) struct Stretch<'m> {
    maneuver: &'m Maneuver,
    rows: Range<usize>,
    label: String,
    steps: Steps,
}

impl Stretch<'_> {
    pub(super) fn label(&self) -> &str {
        &self.label
    }

    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    /// Counted from 1.
    pub(super) fn first_row(&self) -> usize {
        self.rows.start + 1
    }
}

/// Cuts the maneuvers of a job into stretches without gaps.
pub(super) fn stretches<'m>(
    spec: &JobSpec,
    maneuvers: &'m [Arc<Maneuver>],
    findings: &mut Vec<Finding>,
    faults: &mut Vec<Fault>,
) -> Vec<Vec<Stretch<'m>>> {
    let uses = spec.maneuvers.iter().zip(maneuvers).enumerate();
    uses.map(
        |(index, (usage, maneuver))| match rows_in_use(usage, maneuver) {
            Ok(rows) => cut(usage, maneuver, rows, index, findings),
            Err(message) => {
                let part = if usage.rows.is_some() {
                    "rows"
                } else {
                    "seconds"
                };
                let place = format!("/maneuvers/{index}/{part}");
                faults.push(Fault::new(place, "bad_rows", message));
                Vec::new()
            }
        },
    )
    .collect()
}

fn rows_in_use(usage: &ManeuverUse, maneuver: &Maneuver) -> Result<Range<usize>, String> {
    let [first, last] = match (usage.rows, usage.seconds) {
        (None, None) => return Ok(0..maneuver.len()),
        (Some(rows), None) => rows,
        (None, Some(seconds)) => return rows_between(seconds, maneuver),
        (Some(_), Some(_)) => {
            return Err("a part is said by \"rows\" or by \"seconds\", not by both".to_string());
        }
    };
    if first < 1 || last > maneuver.len() || first >= last {
        return Err(format!(
            "rows {first} to {last} of a recording of {} rows; rows count from 1 and at least two are needed",
            maneuver.len()
        ));
    }
    Ok(first - 1..last)
}

fn rows_between([from, to]: [f64; 2], maneuver: &Maneuver) -> Result<Range<usize>, String> {
    let time = maneuver.time();
    // times that were added up from steps are a little beside what is written
    let nothing = 1e-6 * maneuver.sampling().step;
    let start = time.partition_point(|&t| t < from - nothing);
    let end = time.partition_point(|&t| t <= to + nothing);
    if from >= to || end < start + 2 {
        return Err(format!(
            "seconds {from} to {to} of a recording from {} s to {} s; at least two samples are needed",
            time[0],
            time[time.len() - 1]
        ));
    }
    Ok(start..end)
}

fn cut<'m>(
    usage: &ManeuverUse,
    maneuver: &'m Maneuver,
    rows: Range<usize>,
    index: usize,
    findings: &mut Vec<Finding>,
) -> Vec<Stretch<'m>> {
    let sampling = maneuver.sampling();
    let name = usage
        .label
        .clone()
        .unwrap_or_else(|| (index + 1).to_string());
    let parts: Vec<Range<usize>> = (sampling.segments().into_iter())
        .map(|part| part.start.max(rows.start)..part.end.min(rows.end))
        .filter(|part| !part.is_empty())
        .collect();
    for gap in sampling
        .gaps
        .iter()
        .filter(|gap| rows.start < gap.before && gap.before < rows.end)
    {
        findings.push(gap_finding(
            usage,
            &name,
            gap.before,
            gap.duration,
            sampling.step,
        ));
    }
    let stretch = |rows: Range<usize>, label: String| Stretch {
        maneuver,
        label,
        steps: if sampling.even || usage.gaps == Gaps::Join {
            Steps::Even(sampling.step)
        } else {
            Steps::Uneven(
                maneuver.time()[rows.clone()]
                    .windows(2)
                    .map(|pair| pair[1] - pair[0])
                    .collect(),
            )
        },
        rows,
    };
    match usage.gaps {
        Gaps::Join => vec![stretch(rows, name)],
        Gaps::Split if parts.len() == 1 => parts
            .into_iter()
            .map(|part| stretch(part, name.clone()))
            .collect(),
        Gaps::Split => parts
            .into_iter()
            .enumerate()
            .map(|(i, part)| stretch(part, format!("{name}.{}", i + 1)))
            .collect(),
    }
}

fn gap_finding(
    usage: &ManeuverUse,
    name: &str,
    before: usize,
    duration: f64,
    step: f64,
) -> Finding {
    let (done, remedy) = match usage.gaps {
        Gaps::Split => (
            "each part is simulated from the initial state that the model gives it",
            "say \"gaps\": \"join\" beside the maneuver\'s \"id\" (--join on the command line) to run them as one continuous time history, or choose \"rows\"",
        ),
        Gaps::Join => (
            "it is closed up, as if there were none",
            "leave \"gaps\" out to simulate each part on its own",
        ),
    };
    Finding {
        code: "gap".to_string(),
        severity: Severity::Warning,
        channel: None,
        rows: vec![before + 1],
        count: 1,
        message: format!(
            "maneuver {name}: {duration:.2} s between rows {before} and {}, where samples are {step} s apart; {done}",
            before + 1
        ),
        remedy: remedy.to_string(),
    }
}

impl Recorded for Stretch<'_> {
    fn time(&self) -> &[f64] {
        &self.maneuver.time()[self.rows.clone()]
    }
    fn channel(&self, name: &str) -> Option<(&[f64], Dimension)> {
        let channel = self.maneuver.channels().get(name)?;
        Some((&channel.values[self.rows.clone()], channel.unit.dimension))
    }
    fn names(&self) -> Vec<String> {
        self.maneuver.channels().keys().cloned().collect()
    }
}

/// A segment under the names of the model, with the recording's other channels behind it.
pub(super) struct Named<'a> {
    pub model: &'a Model,
    pub stretch: &'a Stretch<'a>,
    pub segment: &'a Segment,
}

impl Recorded for Named<'_> {
    fn time(&self) -> &[f64] {
        self.stretch.time()
    }
    fn channel(&self, name: &str) -> Option<(&[f64], Dimension)> {
        let inputs = self.model.inputs.iter().zip(&self.segment.inputs);
        let outputs = self.model.outputs.iter().zip(&self.segment.measured);
        let of_model = inputs
            .chain(outputs)
            .find(|(quantity, _)| quantity.name == name);
        match of_model {
            Some((quantity, values)) => Some((values, quantity.unit.dimension)),
            None => self.stretch.channel(name),
        }
    }
    fn names(&self) -> Vec<String> {
        self.stretch.names()
    }
}

/// Makes the segment of one stretch; `index` is the maneuver's place in the spec.
pub(super) fn segment(
    spec: &JobSpec,
    model: &Model,
    stretch: &Stretch<'_>,
    index: usize,
    faults: &mut Vec<Fault>,
) -> Segment {
    let mut make = |quantities: &[Quantity], side: Side| -> Vec<Vec<f64>> {
        quantities
            .iter()
            .map(|quantity| samples(spec, quantity, side, stretch, index, faults))
            .collect()
    };
    Segment {
        inputs: make(&model.inputs, Side::Input),
        measured: make(&model.outputs, Side::Output),
        label: stretch.label.clone(),
        time: stretch.time().to_vec(),
        steps: stretch.steps.clone(),
    }
}

/// What a channel is to the model.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    Input,
    Output,
}

impl Side {
    fn name(self) -> &'static str {
        match self {
            Self::Input => "input",
            Self::Output => "output",
        }
    }
}

/// The samples of one input or output, those of an output NaN where it has no value; with a fault added where they cannot be made.
fn samples(
    spec: &JobSpec,
    quantity: &Quantity,
    side: Side,
    stretch: &Stretch<'_>,
    index: usize,
    faults: &mut Vec<Fault>,
) -> Vec<f64> {
    let name = &quantity.name;
    let mapped = spec.channels.get(name);
    let pointer = if mapped.is_some() {
        format!("/channels/{}", escape(name))
    } else {
        format!("/maneuvers/{index}")
    };
    let mut fault = |code: &'static str, message: String| {
        // several stretches of one recording have the same fault
        let fault = Fault::new(&pointer, code, message);
        if !faults.contains(&fault) {
            faults.push(fault);
        }
        Vec::new()
    };
    let text = mapped.map_or(name.as_str(), String::as_str);
    let formula = match ChannelFormula::parse(text) {
        Ok(formula) => formula,
        Err(error) => return fault(error.code(), error.to_string()),
    };
    let wanted = quantity.unit.dimension;
    match formula.dimension(stretch) {
        Err(error) if mapped.is_none() => {
            let message = format!(
                "no channel '{name}' is recorded for the model's {}; say how to make it, as \"channels\": {{\"{name}\": \"<formula>\"}}; recorded are {}",
                side.name(),
                stretch.names().join(", ")
            );
            return fault(error.code(), message);
        }
        Err(error) => return fault(error.code(), error.to_string()),
        Ok(Some(found)) if found != wanted => {
            let message = format!(
                "'{text}' is in {found}, the model's {} '{name}' in {wanted}; correct the unit in the recording's header, or the formula",
                side.name()
            );
            return fault("unit_mismatch", message);
        }
        Ok(_) => {}
    }
    let mut values = match formula.samples(stretch) {
        Ok(values) => values,
        Err(error) => return fault(error.code(), error.to_string()),
    };
    if side == Side::Output {
        let missing = values.iter_mut().filter(|value| !value.is_finite());
        missing.for_each(|value| *value = f64::NAN);
        return values;
    }
    let missing: Vec<usize> = (0..values.len())
        .filter(|&k| !values[k].is_finite())
        .collect();
    if let Some(&first) = missing.first() {
        let message = format!(
            "the model's input '{name}' ('{text}') has no value in {} row(s), first in row {}; {}",
            missing.len(),
            stretch.rows.start + first + 1,
            if mapped.is_some() {
                "correct the formula where it gives no number (interpolated(...) and held(...) fill in between values), or choose \"rows\" without them"
                    .to_string()
            } else {
                format!(
                    "say \"channels\": {{\"{name}\": \"interpolated({name})\"}}, or held({name}), to fill in between values, or choose \"rows\" without them"
                )
            }
        );
        return fault("missing_values", message);
    }
    values
}
