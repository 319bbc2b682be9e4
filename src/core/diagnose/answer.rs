//! The answer, put together from what the rounds found.

use std::ops::ControlFlow;

use nalgebra::DMatrix;

use super::accepted::Accepted;
use super::candidates::taken_for;
use super::case::{Case, Unfit};
use super::declared::Declared;
use super::difference::difference;
use super::fitted::Fitted;
use super::found::Found;
use super::remarks;
use super::report::{Diagnosis, EffectParameter, FitChange, NamedEffect, ParameterChange, Verdict};
use super::residual::analyse;
use super::rival::Rival;
use super::screen::Screen;
use super::sentence;
use super::size::sizes;
use super::unmodelled::Picture;
use super::verdict::{self, Doubt, Left};
use crate::estimate::{
    Estimate, OutputFit, ParameterEstimate, Problem, Role, Solution, TimeHistory, estimate, predict,
};
use crate::flight::{PhysicalQuantity, Unit};
use crate::model::{ModelDocument, Quantities, Start};

/// Noise alone makes a residual look coherent with an input once in so many diagnoses.
const COHERENT: f64 = 1e-3;

/// Everything that a diagnosis comes to.
pub struct Conclusion {
    /// Verdict, effects, evidence.
    pub diagnosis: Diagnosis,
    /// Of the model with the effects in it.
    pub estimate: Estimate,
    /// Measured outputs beside those of the model with its effects and of the declared one, for each segment.
    pub histories: Vec<TimeHistory>,
}

pub(super) fn answer(
    case: &Case,
    declared: &Declared,
    last: &Fitted,
    found: Found,
    picture: Option<Picture>,
    rival: Option<Rival>,
) -> Result<Conclusion, Unfit> {
    let Declared {
        fitted: declared,
        histories: fitted,
        remarks,
        ..
    } = declared;
    let after = full(case, declared, last)?;
    let estimated = after.solution.estimate.clone();
    let mut histories = after.solution.histories.clone();
    let mut fits = Vec::new();
    for (history, before) in histories.iter_mut().zip(fitted) {
        compare(history, before);
    }
    for (b, a) in declared.estimate.outputs.iter().zip(&estimated.outputs) {
        fits.push(FitChange {
            role: Role::Estimation,
            segment: None,
            before: b.clone(),
            after: a.clone(),
        });
    }
    for role in [Role::Validation, Role::Final] {
        let before = predictions(
            case,
            role,
            &declared.problem,
            &declared.theta,
            &declared.covariance,
        )?;
        let now = predictions(
            case,
            role,
            &after.problem,
            &after.solution.theta,
            &after.solution.covariance,
        )?;
        for ((label, b, then), (_, a, history)) in before.into_iter().zip(now) {
            let of = |(before, after): (OutputFit, OutputFit)| FitChange {
                role,
                segment: Some(label.clone()),
                before,
                after,
            };
            fits.extend(b.into_iter().zip(a).map(of));
            histories.extend(history.map(|history| {
                let mut history = TimeHistory { role, ..history };
                then.iter().for_each(|then| compare(&mut history, then));
                history
            }));
        }
    }
    let residuals = analyse(&after.solution.histories);
    let following = if found.accepted.iter().any(|a| a.effect.is_noise()) {
        Vec::new()
    } else {
        coherent(case, last)
    };
    let doubt = rival.as_ref().map(|rival| Doubt {
        named: rival.named,
        force: rival.picture.unmodelled.likelihood_ratio,
    });
    let picture = rival.map(|rival| rival.picture).or(picture);
    let unmodelled = picture.map(|picture| picture.unmodelled);
    let left = Left {
        coherent: &following,
        refused: found.clear_but_refused(),
        terms: verdict::terms(&found),
        pushed: found.pushed.as_deref(),
        doubt,
        force: unmodelled.as_ref(),
    };
    let verdict = verdict::of(case, declared, &found, &left);
    let is_shown = verdict == Verdict::Unexplained;
    let mut remarks = remarks.clone();
    remarks.extend(remarks::of(case, &fits, &after.solution));
    let hint = unmodelled.as_ref().filter(|_| !is_shown);
    remarks.extend(hint.map(remarks::of_force));
    let effects: Vec<NamedEffect> = found
        .accepted
        .iter()
        .map(|accepted| named(accepted, &after))
        .collect();
    let left_over = verdict::left_over(verdict, &left);
    let diagnosis = Diagnosis {
        verdict,
        sentence: verdict::sentence(verdict, &effects, &fits, left_over.as_deref()),
        left_over,
        effects,
        refused: found.truly_refused(),
        quantities: taken_for(case),
        parameters: changes(&declared.estimate, &estimated),
        before: declared.estimate.clone(),
        model: estimated_document(&after.problem, &after.solution.theta),
        diff: difference(&case.document, &last.document),
        fits,
        residuals,
        unmodelled: unmodelled.filter(|_| is_shown),
        remarks,
    };
    Ok(Conclusion {
        diagnosis,
        estimate: estimated,
        histories,
    })
}

/// Puts the declared model's outputs beside those of the model with its effects.
fn compare(history: &mut TimeHistory, declared: &TimeHistory) {
    for (output, before) in history.outputs.iter_mut().zip(&declared.outputs) {
        output.declared.clone_from(&before.model);
    }
}

struct Full {
    problem: Problem,
    solution: Solution,
}

/// The last model, fitted to the job's own tolerance and with its error bounds.
fn full(case: &Case, declared: &Fitted, last: &Fitted) -> Result<Full, Unfit> {
    let mut problem = case.problem(&last.document, &last.values())?;
    problem.options = last.problem.options.clone();
    let asked = &declared.problem.options;
    problem.options.tolerance = asked.tolerance;
    problem.options.max_iterations = asked.max_iterations;
    problem.options.error_bounds = asked.error_bounds;
    problem.options.start = crate::estimate::StartMethod::Document {};
    let solution = estimate(&problem, &mut |_| ControlFlow::Continue(())).map_err(|why| {
        Unfit(format!(
            "the model with its effects cannot be fitted again: {why}"
        ))
    })?;
    Ok(Full { problem, solution })
}

type Predicted = (String, Vec<OutputFit>, Option<TimeHistory>);

fn predictions(
    case: &Case,
    role: Role,
    problem: &Problem,
    theta: &[f64],
    covariance: &DMatrix<f64>,
) -> Result<Vec<Predicted>, Unfit> {
    let flights = case.held_out(role, problem)?;
    let of = |validation| {
        let (prediction, history) = predict(problem, theta, covariance, validation);
        (prediction.segment, prediction.outputs, history)
    };
    Ok(flights.iter().map(of).collect())
}

/// Outputs and inputs that the residual still is coherent with. An input that a sensor measures brings its noise along,
/// which what is left follows in any case.
fn coherent(case: &Case, last: &Fitted) -> Vec<(String, String)> {
    let model = &last.problem.model;
    let Some(screen) = Screen::new(case, last) else {
        return Vec::new();
    };
    let mut found = Vec::new();
    let quantities = Quantities::of(&last.document);
    let is_measured =
        |input: &str| (quantities.get(input)).is_some_and(PhysicalQuantity::is_motion);
    let inputs: Vec<usize> = (0..model.inputs.len())
        .filter(|&i| !is_measured(&model.inputs[i].name))
        .collect();
    let questions = (model.outputs.len() * inputs.len()) as f64;
    for (o, output) in model.outputs.iter().enumerate() {
        for &i in &inputs {
            let input = &model.inputs[i];
            if screen.follows(o, i, COHERENT / questions) {
                found.push((output.name.clone(), input.name.clone()));
            }
        }
    }
    found
}

fn named(accepted: &Accepted, after: &Full) -> NamedEffect {
    let Full { problem, solution } = after;
    let sizes = sizes(
        problem,
        &solution.theta,
        &solution.estimate,
        &accepted.added,
    );
    let parameters = sizes.iter().map(|size| EffectParameter {
        name: size.name.clone(),
        unit: Unit::si_name(&size.unit),
        segment: size.segment.clone(),
        estimate: size.value,
        standard_error: size.standard_error_si(),
    });
    NamedEffect {
        effect: accepted.effect.clone(),
        parameters: parameters.collect(),
        group: accepted.group.clone(),
        evidence: accepted.evidence.clone(),
        sentence: sentence::of(&accepted.effect, &sizes),
    }
}

fn changes(before: &Estimate, after: &Estimate) -> Vec<ParameterChange> {
    let of = |row: &ParameterEstimate| {
        let now =
            (after.parameters.iter()).find(|p| p.name == row.name && p.segment == row.segment)?;
        let shift = now
            .standard_error
            .filter(|e| *e > 0.0)
            .map(|e| (now.estimate - row.estimate) / e);
        Some(ParameterChange {
            name: row.name.clone(),
            unit: row.unit.clone(),
            segment: row.segment.clone(),
            before: row.estimate,
            after: now.estimate,
            standard_error: now.standard_error,
            shift,
        })
    };
    before
        .parameters
        .iter()
        .filter(|row| !row.fixed)
        .filter_map(of)
        .collect()
}

/// The document with the estimates as start values, to be saved and fitted again.
fn estimated_document(problem: &Problem, theta: &[f64]) -> ModelDocument {
    let mut document = problem.model.document.clone();
    for (place, &value) in theta.iter().enumerate() {
        let info = problem.parameter(place);
        let is_one =
            problem.unknowns.at(place).segment.is_none() || info.document.only_in.len() == 1;
        if is_one && let Some(parameter) = document.parameters.get_mut(&info.name) {
            parameter.start = Start::Value(info.unit.from_si(value));
        }
    }
    document
}
