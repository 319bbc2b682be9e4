//! How a model meets recordings: segments of inputs and measured outputs, made from channels.

use super::stretch::Stretch;
use crate::flight::{Dimension, Fault, escape};
use crate::job::spec::JobSpec;
use crate::model::{ChannelFormula, Model, Quantity, Recorded};
use crate::simulate::{Segment, Substeps};

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
        substeps: Substeps::default(),
    }
}

/// As [`segment`], of a recording that may have inputs alone: an output that is not recorded has no values.
pub(super) fn to_predict(
    spec: &JobSpec,
    model: &Model,
    stretch: &Stretch<'_>,
    index: usize,
    faults: &mut Vec<Fault>,
) -> Segment {
    let inputs = (model.inputs.iter())
        .map(|input| samples(spec, input, Side::Input, stretch, index, faults))
        .collect();
    let mut output = |output: &Quantity| {
        let mut found = Vec::new();
        let values = samples(spec, output, Side::Output, stretch, index, &mut found);
        let is_absent = |fault: &Fault| fault.code == UNKNOWN_CHANNEL;
        if found.iter().any(is_absent) {
            return vec![f64::NAN; stretch.len()];
        }
        faults.extend(found);
        values
    };
    Segment {
        inputs,
        measured: model.outputs.iter().map(&mut output).collect(),
        label: stretch.label.clone(),
        time: stretch.time().to_vec(),
        steps: stretch.steps.clone(),
        substeps: Substeps::default(),
    }
}

/// The code of a formula that names what is not recorded.
const UNKNOWN_CHANNEL: &str = "unknown_channel";

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
    let own = spec.maneuvers[index].channels.get(name);
    let mapped = own.or_else(|| spec.channels.get(name));
    let pointer = match (own, mapped) {
        (Some(_), _) => format!("/maneuvers/{index}/channels/{}", escape(name)),
        (None, Some(_)) => format!("/channels/{}", escape(name)),
        (None, None) => format!("/maneuvers/{index}"),
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
        let inserted = stretch.inserted().iter().cloned().flatten();
        inserted.for_each(|sample| values[sample] = f64::NAN);
        return values;
    }
    straight(&mut values, stretch.inserted());
    let missing: Vec<usize> = (0..values.len())
        .filter(|&k| !values[k].is_finite())
        .collect();
    if let Some(&first) = missing.first() {
        let message = format!(
            "the model's input '{name}' ('{text}') has no value in {} row(s), first in row {}; {}",
            missing.len(),
            stretch.row(first) + 1,
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

/// Fills samples that were put into gaps, straight between those at both sides.
fn straight(values: &mut [f64], inserted: &[std::ops::Range<usize>]) {
    for range in inserted {
        let (before, behind) = (values[range.start - 1], values[range.end]);
        let count = (range.len() + 1) as f64;
        for (k, value) in values[range.clone()].iter_mut().enumerate() {
            let share = (k + 1) as f64 / count;
            *value = (1.0 - share) * before + share * behind;
        }
    }
}
