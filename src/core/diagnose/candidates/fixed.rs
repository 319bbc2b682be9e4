//! Parameters that the document holds fixed: whoever wrote it thought of them, so they come first.

use super::monomials::Monomial;
use super::subject::Subject;
use crate::diagnose::effect::Effect;
use crate::flight::{Dimension, Unit};
use crate::model::expression;
use crate::model::{EditKind, Parameter, Per, Start};

pub(super) fn candidates(subject: &Subject<'_>) -> Vec<Effect> {
    let parameters = subject.document.parameters.iter();
    let offered = parameters.filter(|(name, parameter)| is_offered(subject, name, parameter));
    offered
        .map(|(name, _)| Effect::edit(EditKind::FixedParameter, name.as_str(), None))
        .collect()
}

/// A coefficient or a bias in the equation of a state, a definition or an output. Not what describes the steady flight or
/// the start of a maneuver (one value for each, or read off the data), and not geometry, mass or inertia.
fn is_offered(subject: &Subject<'_>, name: &str, parameter: &Parameter) -> bool {
    let known = subject.quantities.get(name).is_some();
    let dimension = Unit::parse(&parameter.unit).map_or(Dimension::NONE, |unit| unit.dimension);
    let is_geometry = dimension.seconds() == Some(0) && !dimension.is_none();
    let is_number = matches!(parameter.start, Start::Value(_));
    parameter.fixed
        && parameter.per == Per::Job
        && is_number
        && !known
        && !is_geometry
        && influences(subject, name)
}

fn influences(subject: &Subject<'_>, name: &str) -> bool {
    let document = subject.document;
    let laws = (document.states.values().map(|state| &state.derivative))
        .chain(document.definitions.values().map(|x| &x.equation))
        .chain(document.outputs.values().map(|x| &x.equation));
    let mut equations = laws.filter_map(|text| expression::parse(text).ok());
    equations.any(|equation| {
        let terms = Monomial::all_of(&equation, &|_| None);
        terms.iter().any(|term| term.holds(name))
    })
}
