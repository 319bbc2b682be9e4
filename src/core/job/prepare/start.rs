//! Where the unknowns start: at the numbers of the document, or at what its formulas make of the recordings.

use super::resolve::Named;
use super::stretch::Stretch;
use crate::estimate::Unknowns;
use crate::flight::{Dimension, Fault, escape};
use crate::job::constant::ConstantValue;
use crate::job::spec::JobSpec;
use crate::model::{ChannelFormula, Model, Start};
use crate::simulate::Segment;

/// The unknowns over segments, with start values from the recordings where the model asks for that.
pub(super) fn unknowns(
    spec: &JobSpec,
    model: &Model,
    resolved: &[(Segment, &Stretch<'_>)],
) -> Result<Unknowns, Vec<Fault>> {
    let start = |parameter: usize, segment: usize| {
        let info = &model.parameters[parameter];
        let (segment, stretch) = &resolved[segment];
        let usage = &spec.maneuvers[stretch.index];
        match usage.constants.get(&info.name) {
            Some(ConstantValue::Number(value)) => return Ok(info.unit.to_si(*value)),
            Some(ConstantValue::Recording(text)) => {
                return Err(not_found(stretch.index, &info.name, text));
            }
            None => {}
        }
        let own = usage.start.get(&info.name);
        let text = match own.unwrap_or(&info.document.start) {
            Start::Value(value) => return Ok(info.unit.to_si(*value)),
            Start::FromData(text) => text,
        };
        let pointer = match own {
            Some(_) => format!("/maneuvers/{}/start/{}", stretch.index, escape(&info.name)),
            None => start_pointer(spec, &info.name),
        };
        let on = Named {
            model,
            stretch,
            segment,
        };
        start_from_data(text, &on, info.unit.dimension)
            .map_err(|(code, message)| Fault::new(pointer, code, message))
    };
    let unknowns = Unknowns::new(model, resolved.len(), start).map_err(|fault| vec![fault])?;
    let is_called = |segment: usize, label: &str| {
        let (segment, stretch) = &resolved[segment];
        segment.label == label || spec.label(stretch.index) == label
    };
    Ok(unknowns.held_elsewhere(model, is_called))
}

/// Nothing is started from a quantity of a recording that has no number by now.
fn not_found(maneuver: usize, name: &str, text: &str) -> Fault {
    let message = format!("'{text}' was not found in what is said of the recording; give a number");
    let pointer = format!("/maneuvers/{maneuver}/constants/{}", escape(name));
    Fault::new(pointer, "unknown_quantity", message)
}

/// Where a parameter's start was given.
fn start_pointer(spec: &JobSpec, name: &str) -> String {
    let overridden = spec
        .parameters
        .get(name)
        .is_some_and(|change| change.start.is_some());
    format!(
        "{}/parameters/{}/start",
        if overridden { "" } else { "/model" },
        escape(name)
    )
}

fn start_from_data(
    text: &str,
    on: &Named<'_>,
    wanted: Dimension,
) -> Result<f64, (&'static str, String)> {
    let formula = ChannelFormula::parse(text).map_err(|error| (error.code(), error.to_string()))?;
    let number = formula.number(on).map_err(|error| {
        (error.code(), format!("{error}; give the start as a number: \"parameters\": {{\"<name>\": {{\"start\": ...}}}}"))
    })?;
    match formula.dimension(on) {
        Ok(Some(found)) if found != wanted => Err((
            "unit_mismatch",
            format!("'{text}' is in {found} where the parameter is in {wanted}"),
        )),
        _ => Ok(number),
    }
}
