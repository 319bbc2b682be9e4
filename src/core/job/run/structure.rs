//! A structure determination: terms chosen, written into the equation of the output, and their parameters estimated.

use std::ops::ControlFlow;

use super::finish::finish;
use super::predicted;
use crate::estimate::{self, Problem, Solution, Unknowns, Validation, estimate};
use crate::flight::{Dimension, Fault, Faults};
use crate::job::no_start::no_start;
use crate::job::plan::Plan;
use crate::job::result::JobResult;
use crate::job::term_search::TermSearch;
use crate::model::{Model, ModelDocument, Parameter, Per, Start};
use crate::structure::{Structure, StructureMethod, Term, orthogonal, stepwise};

/// Runs the plan of a structure determination; `watcher` is told of the estimation and may stop it.
///
/// # Errors
/// The model with the equation cannot be compiled or fitted. A finding that a strict job refuses.
pub fn run_structure(
    plan: &Plan,
    watcher: &mut dyn FnMut(estimate::Progress<'_>) -> ControlFlow<()>,
) -> Result<JobResult, Faults> {
    let Some(search) = &plan.terms else {
        let message = "the job was not prepared as a structure determination";
        return Err(Fault::new("/kind", "bad_option", message).into());
    };
    let chosen = match search.options.method {
        StructureMethod::Stepwise => stepwise(&search.candidates, &search.options),
        StructureMethod::Orthogonal => orthogonal(&search.candidates, &search.options),
    };
    let Some(mut structure) = chosen else {
        let message = "there are fewer samples than it takes to tell a variance";
        return Err(Fault::new("/maneuvers", "too_few_samples", message).into());
    };
    structure.left_out.clone_from(&search.left_out);
    let document = written(&plan.model, search, &mut structure);
    let model = Model::compile(&document)?;
    let problem = with_model(&plan.problem, model, &structure);
    let Solution {
        theta,
        covariance,
        estimate: mut result,
        mut histories,
    } = estimate(&problem, watcher).map_err(|why| no_start(&problem, why))?;
    let validation = plan.validation.iter().map(|validation| Validation {
        segment: validation.segment.clone(),
        unknowns: unknowns(&problem.model, 1, &structure, |parameter, _| {
            validation
                .unknowns
                .all
                .iter()
                .find(|u| u.parameter == parameter)
                .map(|u| u.start)
        }),
    });
    let validation: Vec<Validation> = validation.collect();
    predicted(
        &problem,
        &theta,
        &covariance,
        &validation,
        &mut result,
        &mut histories,
    );
    result.reason = format!(
        "{} of {} terms: {}; {}",
        structure
            .terms
            .iter()
            .filter(|term| term.term != "1")
            .count(),
        structure.candidates,
        structure.reason,
        result.reason
    );
    finish(
        plan,
        JobResult {
            estimate: result,
            histories,
            model: document,
            study: None,
            diagnosis: None,
            structure: Some(structure),
        },
    )
}

/// The document with the terms in the equation of the output, each with a parameter of its own.
fn written(
    declared: &ModelDocument,
    search: &TermSearch,
    structure: &mut Structure,
) -> ModelDocument {
    let mut document = declared.clone();
    let Some((output, _)) = declared.outputs.get_index(search.output) else {
        return document;
    };
    let output = output.clone();
    let mut summands = Vec::new();
    for term in &structure.terms {
        let name = free_name(&document, &output, &term.term);
        let measures = measured_by(search, &term.term);
        let parameter = Parameter {
            unit: unit(declared, search.output, measures),
            start: Start::Value(term.estimate),
            lower: None,
            upper: None,
            fixed: false,
            per: Per::Job,
            only_in: Vec::new(),
            prior: None,
            quantity: None,
            description: match term.term.as_str() {
                "1" => format!("constant of {output}"),
                other => format!("{output} due to {other}"),
            },
        };
        document.parameters.insert(name.clone(), parameter);
        summands.push(summand(&name, term));
    }
    let own = declared.outputs[search.output].equation.trim();
    let is_nothing = own.parse::<f64>().is_ok_and(|value| value == 0.0);
    if !is_nothing {
        summands.insert(0, own.to_string());
    }
    if !summands.is_empty() {
        document.outputs[search.output].equation = summands.join(" + ");
    }
    structure
        .equation
        .clone_from(&document.outputs[search.output].equation);
    document
}

fn summand(name: &str, term: &Term) -> String {
    let is_factor = |text: &str| !text.contains(['+', '-', '/', '<', '>', ' ']);
    match term.term.as_str() {
        "1" => name.to_string(),
        factor if is_factor(factor) => format!("{name}*{factor}"),
        sum => format!("{name}*({sum})"),
    }
}

/// What a term of the search measures; the constant, nothing.
fn measured_by(search: &TermSearch, term: &str) -> Dimension {
    let place = search.candidates.names.iter().position(|name| name == term);
    place.map_or(Dimension::NONE, |place| search.dimensions[place])
}

/// The SI unit of the parameter of a term.
fn unit(declared: &ModelDocument, output: usize, term: Dimension) -> String {
    let own = &declared.outputs[output].unit;
    let own = crate::flight::Unit::parse(own).map_or(Dimension::NONE, |unit| unit.dimension);
    own.over(term).to_string()
}

/// `Cm_alpha2` for the term `alpha^2` of `Cm`, `Cm_0` for the constant: a name that nothing else has.
fn free_name(document: &ModelDocument, output: &str, term: &str) -> String {
    let mut plain = String::new();
    for c in term.chars() {
        match c {
            '^' | ' ' => {}
            c if c.is_alphanumeric() => plain.push(c),
            _ if !plain.ends_with('_') => plain.push('_'),
            _ => {}
        }
    }
    let plain = match term {
        "1" => "0".to_string(),
        _ => plain.trim_matches('_').to_string(),
    };
    let name = format!("{output}_{plain}");
    let is_taken = |name: &str| {
        document.parameters.contains_key(name)
            || document.inputs.contains_key(name)
            || document.constants.contains_key(name)
            || document.definitions.contains_key(name)
            || document.states.contains_key(name)
    };
    let numbered = (2..).map(|number| format!("{name}_{number}"));
    std::iter::once(name.clone())
        .chain(numbered)
        .find(|name| !is_taken(name))
        .unwrap_or_default()
}

/// The problem of a model that has more parameters behind those of the declared one.
fn with_model(declared: &Problem, model: Model, structure: &Structure) -> Problem {
    let (start, mut parameters) = (declared.unknowns.start(), Vec::new());
    let segments = declared.segments.clone();
    let unknowns = unknowns(&model, segments.len(), structure, |parameter, segment| {
        declared
            .unknowns
            .parameters(segment, &start, &mut parameters);
        parameters.get(parameter).copied()
    });
    Problem::new(model, segments, unknowns, declared.options.clone())
}

/// Unknowns that start at those of the declared model, and at the estimates of the structure behind them.
fn unknowns(
    model: &Model,
    segments: usize,
    structure: &Structure,
    mut declared: impl FnMut(usize, usize) -> Option<f64>,
) -> Unknowns {
    let own = model.parameters.len() - structure.terms.len();
    let start = |parameter: usize, segment: usize| -> Result<f64, std::convert::Infallible> {
        let of_structure = parameter
            .checked_sub(own)
            .map(|term| structure.terms[term].estimate);
        Ok(of_structure
            .or_else(|| declared(parameter, segment))
            .unwrap_or(0.0))
    };
    match Unknowns::new(model, segments, start) {
        Ok(unknowns) => unknowns,
        Err(never) => match never {},
    }
}
