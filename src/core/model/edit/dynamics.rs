//! Effects in the equations of motion: terms, channels and states that the model leaves out.

use super::edited::AddedRole;
use super::error::EditError;
use super::sheet::{Sheet, dimension, unknown};
use super::text::{names, replace};
use super::written::{Edit, Reference};
use crate::flight::{Dimension, Unit};
use crate::model::dimensions::measure;
use crate::model::document::{Parameter, Per};
use crate::model::expression;
use crate::model::names::Names;

/// ψ term. A name such as `alphadot` that the document does not have is the derivative of that state.
pub(super) fn missing_term(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    let wanted = "an expression, such as \"alpha^2\"";
    let term = with_rates(sheet, sheet.edit.needed_term(wanted)?)?;
    let parsed = expression::parse(&term).map_err(|source| EditError::Syntax {
        term: term.clone(),
        source,
    })?;
    for name in names(&term) {
        if let Some(told) = sheet.edit.channels.get(&name) {
            add_channel(sheet, &name, &told.unit)?;
        }
    }
    let measured = {
        let names = Names::collect(&sheet.document, &mut Vec::new());
        measure(&parsed, &|name| names.dimension(name))
    };
    let measured = measured.map_err(|mismatch| EditError::Units {
        term: term.clone(),
        message: mismatch.message,
    })?;
    let name = sheet.name(&format!("{target}_term"))?;
    let (_, measures) = sheet.equation(target)?;
    let unit = measures.over(measured.unwrap_or(Dimension::NONE));
    let words = format!("missing term of {target}");
    sheet.add(
        &name,
        AddedRole::Size,
        unknown(unit.to_string(), 0.0, None, words),
    );
    let term = about(sheet, &parsed.to_string())?;
    let (equation, _) = sheet.equation(target)?;
    *equation = format!("{equation} + {name}*({term})");
    Ok(())
}

fn add_channel(sheet: &mut Sheet, name: &str, unit: &str) -> Result<String, EditError> {
    if let Err(error) = Unit::parse(unit) {
        return Err(sheet.edit.bad_term(error.to_string()));
    }
    if !expression::is_name(name) {
        return Err(sheet.edit.bad_term("it is not the name of a channel"));
    }
    sheet.channel(name, unit, "recorded")
}

/// A term with differences in the place of the names that the edit takes so.
fn about(sheet: &mut Sheet, term: &str) -> Result<String, EditError> {
    let mut differences = Vec::new();
    for (name, reference) in &sheet.edit.about {
        if !names(term).contains(name) {
            let message = format!("\"about\" has '{name}', which does not stand in it");
            return Err(sheet.edit.bad_term(message));
        }
        let from = match reference {
            Reference::Expression(text) => match expression::parse(text) {
                Ok(parsed) if expression::is_name(text) => parsed.to_string(),
                Ok(parsed) => format!("({parsed})"),
                Err(source) => {
                    let term = text.clone();
                    return Err(EditError::Syntax { term, source });
                }
            },
            Reference::Value(value) => {
                let unit = sheet.unit_of(name).unwrap_or_default();
                let held = sheet.free(&format!("{name}_about"));
                let words = format!("{name} from which differences are taken");
                let fixed = Parameter {
                    fixed: true,
                    ..unknown(unit, *value, None, words)
                };
                sheet.add(&held, AddedRole::Reference, fixed);
                held
            }
        };
        differences.push((name, format!("({name} - {from})")));
    }
    let difference = |name: &str| {
        let found = differences.iter().find(|(of, _)| *of == name);
        found.map(|(_, text)| text.clone())
    };
    Ok(replace(term, difference))
}

/// A term with the derivatives of states written out.
fn with_rates(sheet: &Sheet, term: &str) -> Result<String, EditError> {
    let document = &sheet.document;
    let rate = |name: &str| {
        let state = document.states.get(name.strip_suffix("dot")?)?;
        (!sheet.is_taken(name)).then(|| format!("({})", state.derivative))
    };
    let written = replace(term, rate);
    if written != term
        && document.definitions.contains_key(sheet.target())
        && reads(sheet, &written, sheet.target())
    {
        let message = format!("the rate depends on '{}' itself at once", sheet.target());
        return Err(sheet.edit.bad_term(message));
    }
    Ok(written)
}

/// Whether a text depends on a name, through definitions.
pub(super) fn reads(sheet: &Sheet, text: &str, name: &str) -> bool {
    let mut pending = names(text);
    let mut seen = Vec::new();
    while let Some(found) = pending.pop() {
        if found == name {
            return true;
        }
        if let Some(definition) = sheet.document.definitions.get(&found)
            && !seen.contains(&found)
        {
            pending.extend(names(&definition.equation));
            seen.push(found);
        }
    }
    false
}

/// ψ channel, for a channel that the model does not use yet.
pub(super) fn unrecorded_input(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    let (channel, unit) = channel_of(sheet.edit)?;
    sheet.equation(target)?;
    let known = sheet.document.inputs.get(channel);
    let told = sheet.edit.channels.get(channel).map(|told| &told.unit);
    let unit = match (known, unit, told) {
        (Some(input), ..) => input.unit.clone(),
        (None, Some(unit), _) => unit.to_string(),
        (None, None, Some(unit)) => unit.clone(),
        (None, None, None) => {
            let message =
                "say in which unit the model is to have it: \"dt[rad]\", or \"unit\": \"rad\"";
            return Err(sheet.edit.bad_term(message));
        }
    };
    let channel = add_channel(sheet, channel, &unit)?;
    let name = sheet.name(&format!("{target}_{channel}"))?;
    let (_, measures) = sheet.equation(target)?;
    let unit = measures.over(dimension(&unit));
    let words = format!("{channel} in the equation of {target}");
    sheet.add(
        &name,
        AddedRole::Size,
        unknown(unit.to_string(), 0.0, None, words),
    );
    let term = about(sheet, &channel)?;
    let (equation, _) = sheet.equation(target)?;
    *equation = format!("{equation} + {name}*{term}");
    Ok(())
}

fn channel_of(edit: &Edit) -> Result<(&str, Option<&str>), EditError> {
    let term = edit.needed_term("the recorded channel and its unit, such as \"dt[rad]\"")?;
    let (channel, inside) = match term.split_once('[') {
        Some((channel, rest)) => (channel, rest.strip_suffix(']')),
        None => (term, None),
    };
    Ok((channel.trim(), inside.or(edit.unit.as_deref())))
}

/// The angle whose history an effect sees: a state, a definition or a recorded input.
pub(super) fn angle<'e>(sheet: &Sheet<'e>) -> Result<(&'e str, String), EditError> {
    let angle = sheet.edit.term.as_deref().unwrap_or("alpha");
    let document = &sheet.document;
    let unit = (document.states.get(angle).map(|state| &state.unit)).or_else(|| {
        let definition = document.definitions.get(angle);
        definition.map(|definition| &definition.unit)
    });
    let unit = unit.or_else(|| document.inputs.get(angle).map(|input| &input.unit));
    match unit {
        Some(unit) => Ok((angle, unit.clone())),
        None => {
            let known = document.states.keys().chain(document.definitions.keys());
            let known = known.chain(document.inputs.keys());
            Err(sheet.no_target("state, definition or input", angle, known))
        }
    }
}

/// ψ (α - w), T ẇ = α - w, w(0) = α(0)
pub(super) fn unsteady(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    let (angle, unit) = angle(sheet)?;
    let (_, measures) = sheet.law(target)?;
    let name = sheet.name(&format!("{target}_unsteady"))?;
    let words = format!("effect on {target} of {angle} ahead of the flow");
    let of_name = measures.over(dimension(&unit));
    sheet.add(
        &name,
        AddedRole::Size,
        unknown(of_name.to_string(), 0.0, None, words),
    );
    let time = sheet.free(&format!("{target}_unsteady_time"));
    let words = format!("time constant of the flow behind {angle}");
    sheet.add(
        &time,
        AddedRole::TimeConstant,
        unknown("s", 0.2, Some((0.01, 5.0)), words),
    );
    let lagged = sheet.free(&format!("{angle}_lagged"));
    let (equation, _) = sheet.law(target)?;
    *equation = format!("{equation} + {name}*({angle} - {lagged})");
    let initial = sheet.at_start(angle, &unit, angle);
    let derivative = format!("({angle} - {lagged})/{time}");
    let words = format!("{angle} as the flow follows it");
    sheet.add_state(&lagged, &unit, initial, derivative, words);
    Ok(())
}

pub(super) fn initial_state(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    let Some(state) = sheet.document.states.get(target) else {
        return Err(sheet.no_target("state", target, sheet.document.states.keys()));
    };
    let unit = super::sheet::of_a_difference(&state.unit);
    let name = sheet.name(&format!("{target}_start"))?;
    if let Some(state) = sheet.document.states.get_mut(target) {
        state.initial = format!("{} + {name}", state.initial);
    }
    let words = format!("initial {target}, beyond where the model has it");
    let parameter = Parameter {
        per: Per::Maneuver,
        ..unknown(unit, 0.0, None, words)
    };
    sheet.add(&name, AddedRole::Size, parameter);
    Ok(())
}

/// A parameter that was fixed, at what would be no effect, is to be estimated.
pub(super) fn freed(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    let is_fixed = |(_, parameter): &(&String, &Parameter)| parameter.fixed;
    let known = sheet.document.parameters.iter().filter(is_fixed);
    let missing = sheet.no_target("fixed parameter", target, known.map(|(name, _)| name));
    match sheet.document.parameters.get_mut(target) {
        Some(parameter) if parameter.fixed => {
            parameter.fixed = false;
            sheet.note(target, AddedRole::Size);
            Ok(())
        }
        _ => Err(missing),
    }
}
