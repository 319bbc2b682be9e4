//! A structure determination: terms chosen, written into the equation of the output, and their parameters estimated.

use std::ops::ControlFlow;

use super::finish::finish;
use super::predicted;
use crate::estimate::{self, Problem, Solution, Unknowns, Validation, estimate};
use crate::flight::{Dimension, Fault, Faults, Finding, FindingCode};
use crate::job::no_start::no_start;
use crate::job::plan::Plan;
use crate::job::result::JobResult;
use crate::job::term_search::TermSearch;
use crate::model::{Model, ModelDocument, Parameter, Per, Start};
use crate::structure::{Structure, StructureMethod, Term, orthogonal, stepwise};

/// What a structure determination tells as it goes.
#[derive(Clone, Copy, Debug)]
pub enum StructureProgress<'a> {
    /// The search for terms: nothing new, but an occasion to stop it.
    Underway,
    /// The estimation of their parameters got on.
    Estimation(estimate::Progress<'a>),
}

/// Runs the plan of a structure determination; `watcher` may stop it. What there is of a structure and of an estimate is then kept.
///
/// # Errors
/// The model with the equation cannot be compiled or fitted. A finding that a strict job refuses.
pub fn run_structure(
    plan: &Plan,
    watcher: &mut dyn FnMut(StructureProgress<'_>) -> ControlFlow<()>,
) -> Result<JobResult, Faults> {
    let Some(search) = &plan.terms else {
        let message = "the job was not prepared as a structure determination";
        return Err(Fault::new("/kind", "bad_option", message).into());
    };
    let mut stopped = false;
    let mut keep_going = || {
        stopped = watcher(StructureProgress::Underway).is_break();
        !stopped
    };
    let (candidates, options) = (&search.candidates, &search.options);
    let chosen = match options.method {
        StructureMethod::Stepwise => stepwise(candidates, options, &mut keep_going),
        StructureMethod::Orthogonal => orthogonal(candidates, options, &mut keep_going),
    };
    let Some(mut structure) = chosen else {
        let message = "there are fewer samples than it takes to tell a variance";
        return Err(Fault::new("/maneuvers", "too_few_samples", message).into());
    };
    let remarks = remarks(&structure);
    structure.left_out.splice(0..0, search.left_out.clone());
    let document = written(&plan.model, search, &mut structure);
    let model = Model::compile(&document)?;
    let problem = with_model(&plan.problem, model, &structure);
    let Solution {
        theta,
        covariance,
        estimate: mut result,
        mut histories,
        distance: _,
    } = estimate(&problem, &mut |progress| match stopped {
        true => ControlFlow::Break(()),
        false => watcher(StructureProgress::Estimation(progress)),
    })
    .map_err(|why| no_start(&problem, why))?;
    result.findings.splice(0..0, remarks);
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

/// What is doubtful about the terms that were kept.
fn remarks(structure: &Structure) -> Vec<Finding> {
    let mut findings = Vec::new();
    if !structure.left_out.is_empty() {
        let message = format!(
            "these data do not tell terms that were left out from those that were kept: {}; an equation with them may fit as well",
            structure.left_out.join(", ")
        );
        let remedy = "choose by what is known of the aircraft, with \"terms\"; or fly maneuvers that move the variables by more than a few sizes, and not together";
        let finding = Finding::new(FindingCode::CollinearTerms, message, remedy);
        findings.push(finding.at("/structure/terms"));
    }
    let by_chance = structure.insignificant();
    if !by_chance.is_empty() {
        let terms: Vec<String> = (by_chance.iter())
            .map(|term| format!("{} (F = {:.1})", term.term, term.partial_f))
            .collect();
        let message = format!(
            "terms of pure noise reach the partial F of these in more than one of 20 searches among {} candidates: {}",
            structure.candidates,
            terms.join(", ")
        );
        let remedy = "leave them out, with \"most_terms\" or a larger \"f_to_enter\", unless maneuvers of the role \"validation\" are predicted better with them";
        let finding = Finding::new(FindingCode::InsignificantTerms, message, remedy);
        findings.push(finding.at("/structure"));
    }
    findings
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
