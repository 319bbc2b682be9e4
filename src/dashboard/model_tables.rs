//! The quantities of a model in tables: parameters, constants, inputs and outputs.

use std::borrow::Cow;

use maud::{Markup, html};

use super::mathml;
use super::notation::Notation;
use crate::estimate::five_digits;
use crate::flight::{Shown, shown_in};
use crate::model::{Element, ModelDocument, Parameter, Per, Start};

pub(super) fn parameters(document: &ModelDocument, notation: &Notation) -> Markup {
    let has_priors = document.parameters.values().any(|one| one.prior.is_some());
    html! {
        table {
            thead { tr {
                th scope="col" { "parameter" } th scope="col" { "symbol" } th scope="col" { "unit" } th.number scope="col" { "start" }
                th.number scope="col" { "lower" } th.number scope="col" { "upper" } th scope="col" { "free or fixed" }
                @if has_priors { th.number scope="col" { "prior" } }
                th scope="col" { "description" }
            } }
            tbody {
                @for (name, parameter) in &document.parameters {
                    @let Shown { scale, unit } = shown_in(&parameter.unit);
                    tr {
                        th scope="row" { (name) } td { (mathml::name(notation, name)) } td.soft { (unit) }
                        td.number { @match &parameter.start {
                            Start::Value(value) => { (number(*value, scale)) }
                            Start::FromData(text) => { code { (text) } }
                        } }
                        td.number.soft { @if let Some(bound) = parameter.lower { (number(bound, scale)) } }
                        td.number.soft { @if let Some(bound) = parameter.upper { (number(bound, scale)) } }
                        td { (freedom(parameter)) }
                        @if has_priors {
                            td.number { @if let Some(prior) = parameter.prior { (number(prior.mean, scale)) " ± " (number(prior.sd, scale)) } }
                        }
                        td.soft { (parameter.description) }
                    }
                }
            }
        }
    }
}

/// Whether a parameter is free, and how many values it has.
fn freedom(parameter: &Parameter) -> Cow<'static, str> {
    match (parameter.fixed, parameter.per) {
        (true, Per::Job) => "fixed".into(),
        (true, Per::Maneuver) => "fixed in each maneuver".into(),
        (false, Per::Job) => "free".into(),
        (false, Per::Maneuver) if parameter.only_in.is_empty() => "free in each maneuver".into(),
        (false, Per::Maneuver) => format!("free in {}", parameter.only_in.join(", ")).into(),
    }
}

pub(super) fn constants(document: &ModelDocument, notation: &Notation) -> Markup {
    html! {
        table {
            thead { tr {
                th scope="col" { "constant" } th scope="col" { "symbol" } th scope="col" { "unit" } th.number scope="col" { "value" } th scope="col" { "description" }
            } }
            tbody {
                @for (name, constant) in &document.constants {
                    @let Shown { scale, unit } = shown_in(&constant.unit);
                    tr {
                        th scope="row" { (name) } td { (mathml::name(notation, name)) } td.soft { (unit) }
                        td.number { (number(constant.value, scale)) } td.soft { (constant.description) }
                    }
                }
            }
        }
    }
}

pub(super) fn inputs(document: &ModelDocument, notation: &Notation) -> Markup {
    let rows = (document.inputs.iter())
        .map(|(name, input)| (name, &input.unit, input.path(), &input.description));
    channels("input", rows, notation)
}

pub(super) fn outputs(document: &ModelDocument, notation: &Notation) -> Markup {
    let rows = (document.outputs.iter())
        .map(|(name, output)| (name, &output.unit, output.path(), &output.description));
    channels("output", rows, notation)
}

fn channels<'a>(
    heading: &str,
    rows: impl Iterator<Item = (&'a String, &'a String, Vec<(Element, &'a str)>, &'a String)>,
    notation: &Notation,
) -> Markup {
    let rows: Vec<_> = rows.collect();
    let has_paths = rows.iter().any(|(_, _, path, _)| !path.is_empty());
    html! {
        table {
            thead { tr {
                th scope="col" { (heading) } th scope="col" { "symbol" } th scope="col" { "unit" }
                @if has_paths { th scope="col" { "path" } }
                th scope="col" { "description" }
            } }
            tbody {
                @for (name, unit, path, description) in rows {
                    tr {
                        th scope="row" { (name) } td { (mathml::name(notation, name)) } td.soft { (shown_in(unit).unit) }
                        @if has_paths { td {
                            @for (at, (element, size)) in path.iter().enumerate() {
                                @if at > 0 { ", " }
                                (element.words()) " " code { (size) }
                            }
                        } }
                        td.soft { (description) }
                    }
                }
            }
        }
    }
}

/// A number of a document: as it is written, but for angles.
pub(super) fn number(value: f64, scale: f64) -> String {
    if scale != 1.0 {
        five_digits(value * scale)
    } else if value == 0.0 || (1e-4..1e7).contains(&value.abs()) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}
