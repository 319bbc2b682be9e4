//! The terms that a structure is chosen from, made of the inputs of a model along its segments.

use nalgebra::{DMatrix, DVector};

use super::bounds::JOB_TOO_LARGE;
use super::unknown_name::unknown_name;
use crate::estimate::{Estimator, Problem};
use crate::flight::{Dimension, Fault, Finding, FindingCode};
use crate::job::spec::{JobKind, JobSpec};
use crate::job::term_search::TermSearch;
use crate::model::{ChannelFormula, Model, Recorded};
use crate::simulate::{Outputs, Segment};
use crate::structure::{Candidates, MOST_TERMS, StructureOptions, polynomials};

/// Most values of all terms: some hundred megabytes.
const MOST_VALUES: usize = 10_000_000;

/// What only a structure determination reads, and what it needs.
pub(super) fn check_kind(spec: &JobSpec, faults: &mut Vec<Fault>) {
    let is_structure = spec.kind == JobKind::Structure;
    match &spec.structure {
        None if is_structure => {
            let message = "a structure determination needs to know which output is explained by what: say \"structure\": {\"output\": ..., \"variables\": [...]}";
            faults.push(Fault::new("/structure", "bad_option", message));
        }
        Some(_) if !is_structure => {
            let message = "only a structure determination chooses terms; say \"kind\": \"structure\", or leave this out";
            faults.push(Fault::new("/structure", "bad_option", message));
        }
        Some(options) => {
            if let Some((field, message)) = options.fault() {
                let pointer = format!("/structure/{field}");
                faults.push(Fault::new(pointer, "bad_option", message));
            }
        }
        None => {}
    }
    if is_structure && spec.options.estimator != Estimator::OutputError {
        let message = "the parameters of a structure are estimated by \"output_error\", which is least squares for a model without states; leave this out";
        faults.push(Fault::new("/options/estimator", "bad_option", message));
    }
}

/// The inputs of a model along a segment, as terms see them.
struct Along<'a> {
    model: &'a Model,
    segment: &'a Segment,
}

impl Recorded for Along<'_> {
    fn time(&self) -> &[f64] {
        &self.segment.time
    }
    fn channel(&self, name: &str) -> Option<(&[f64], Dimension)> {
        let mut inputs = self.model.inputs.iter().zip(&self.segment.inputs);
        let (input, values) = inputs.find(|(input, _)| input.name == name)?;
        Some((values, input.unit.dimension))
    }
    fn names(&self) -> Vec<String> {
        let inputs = self.model.inputs.iter();
        inputs.map(|input| input.name.clone()).collect()
    }
}

/// Makes the terms over all segments.
pub(super) fn terms(
    options: &StructureOptions,
    problem: &Problem,
    findings: &mut Vec<Finding>,
) -> Result<TermSearch, Vec<Fault>> {
    let model = &problem.model;
    let mut faults = Vec::new();
    let known = || model.outputs.iter().map(|output| output.name.as_str());
    let output = known().position(|name| name == options.output);
    if output.is_none() {
        let what = ("output", options.output.as_str());
        unknown_name(
            "/structure/output",
            "unknown_output",
            what,
            known(),
            &mut faults,
        );
    }
    if !model.states.is_empty() {
        let message = "a structure is determined of the equation of an output, in a model without states; make what the terms depend on inputs of the model, and a derivative that is to be explained an output, as \"channels\": {\"q_dot\": \"derivative(q)\"}";
        faults.push(Fault::new("/model/states", "bad_option", message));
    }
    let names = names(options, model, &mut faults);
    let (Some(output), true) = (output, faults.is_empty()) else {
        return Err(faults);
    };
    let response = response(problem, output);
    let rows: usize = response
        .iter()
        .map(|segment| segment.iter().filter(|z| z.is_finite()).count())
        .sum();
    if rows * names.len() > MOST_VALUES {
        let message = format!(
            "{} terms over {rows} samples are {} values, at most {MOST_VALUES} are allowed; choose \"rows\", fewer terms, or a lower order",
            names.len(),
            rows * names.len()
        );
        return Err(vec![Fault::new("/structure", JOB_TOO_LARGE, message)]);
    }
    if rows < 2 {
        let message = format!(
            "the output '{}' has {rows} value(s), at least 2 are needed",
            options.output
        );
        return Err(vec![Fault::new("/maneuvers", "too_few_samples", message)]);
    }
    let mut made = Made {
        names: Vec::new(),
        columns: Vec::new(),
        dimensions: Vec::new(),
        left_out: Vec::new(),
    };
    for (pointer, name) in names {
        made.add(
            problem,
            &response,
            &pointer,
            name,
            options.constant,
            &mut faults,
        );
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    if !made.left_out.is_empty() {
        let message = format!(
            "terms that are the same everywhere, or no numbers somewhere, were left out: {}",
            made.left_out.join(", ")
        );
        let remedy =
            "see that the maneuvers move these variables, and that no term divides by zero";
        let finding = Finding::new(FindingCode::LeftOutTerms, message, remedy);
        findings.push(finding.at("/structure/terms"));
    }
    let present = response.into_iter().flatten().filter(|z| z.is_finite());
    Ok(TermSearch {
        options: options.clone(),
        candidates: Candidates {
            columns: DMatrix::from_columns(&made.columns),
            names: made.names,
            response: DVector::from_iterator(rows, present),
            constant: options.constant,
        },
        dimensions: made.dimensions,
        left_out: made.left_out,
        output,
    })
}

/// Where each term was asked for, and as it is written; each once.
fn names(
    options: &StructureOptions,
    model: &Model,
    faults: &mut Vec<Fault>,
) -> Vec<(String, String)> {
    for (i, variable) in options.variables.iter().enumerate() {
        let known = model.inputs.iter().map(|input| input.name.as_str());
        if !known.clone().any(|name| name == variable) {
            let what = ("input", variable.as_str());
            unknown_name(
                "/structure/variables",
                "unknown_channel",
                what,
                known,
                faults,
            );
        }
        if options.variables[..i].contains(variable) {
            let message = format!("'{variable}' stands here twice; name each variable once");
            faults.push(Fault::new(
                format!("/structure/variables/{i}"),
                "bad_option",
                message,
            ));
        }
    }
    let own = options.terms.iter().enumerate();
    let mut names: Vec<(String, String)> = own
        .map(|(i, term)| (format!("/structure/terms/{i}"), term.trim().to_string()))
        .collect();
    let generated = match options.variables.as_slice() {
        [] => Some(Vec::new()),
        variables => polynomials(variables, options.order),
    };
    let pointer = "/structure/variables".to_string();
    let generated = generated.unwrap_or_else(|| {
        let message = format!(
            "{} variables to the order {} make more than {MOST_TERMS} terms; choose fewer, or a lower order",
            options.variables.len(),
            options.order
        );
        faults.push(Fault::new(&pointer, JOB_TOO_LARGE, message));
        Vec::new()
    });
    names.extend(generated.into_iter().map(|term| (pointer.clone(), term)));
    let mut seen = std::collections::BTreeSet::new();
    names.retain(|(_, term)| seen.insert(term.clone()));
    if names.len() > MOST_TERMS {
        let message = format!("{} terms; at most {MOST_TERMS} are allowed", names.len());
        faults.push(Fault::new("/structure/terms", JOB_TOO_LARGE, message));
    }
    names
}

/// What the equation of an output leaves of it with the start values, by segment; NaN where it was not measured.
fn response(problem: &Problem, output: usize) -> Vec<Vec<f64>> {
    let (model, options) = (&problem.model, &problem.options);
    let mut machinery = Outputs::new(model, options.integrator, options.input_interpolation);
    let (start, mut parameters) = (problem.unknowns.start(), Vec::new());
    let of_segment = |(index, segment): (usize, &Segment)| {
        problem.unknowns.parameters(index, &start, &mut parameters);
        let mut modelled = Vec::with_capacity(segment.len());
        let run = machinery.run(segment, &parameters, |_, y| {
            modelled.extend_from_slice(y[output])
        });
        if run.is_err() {
            modelled.resize(segment.len(), f64::NAN);
        }
        let both = segment.measured[output].iter().zip(modelled);
        both.map(|(z, y)| z - y).collect()
    };
    problem
        .segments
        .iter()
        .enumerate()
        .map(of_segment)
        .collect()
}

/// The columns so far.
struct Made {
    names: Vec<String>,
    columns: Vec<DVector<f64>>,
    dimensions: Vec<Dimension>,
    left_out: Vec<String>,
}

impl Made {
    fn add(
        &mut self,
        problem: &Problem,
        response: &[Vec<f64>],
        pointer: &str,
        name: String,
        constant: bool,
        faults: &mut Vec<Fault>,
    ) {
        let mut fault = |code: &'static str, message: String| {
            faults.push(Fault::new(pointer, code, message));
        };
        let formula = match ChannelFormula::parse(&name) {
            Ok(formula) => formula,
            Err(error) => return fault(error.code(), error.to_string()),
        };
        let (mut values, mut measures) = (Vec::new(), Dimension::NONE);
        for (segment, z) in problem.segments.iter().zip(response) {
            let on = Along {
                model: &problem.model,
                segment,
            };
            let found = (formula.dimension(&on))
                .and_then(|dimension| Ok((dimension, formula.samples(&on)?)));
            let (dimension, samples) = match found {
                Ok(found) => found,
                Err(error) => return fault(error.code(), error.to_string()),
            };
            measures = dimension.unwrap_or(Dimension::NONE);
            let present = samples.into_iter().zip(z).filter(|(_, z)| z.is_finite());
            values.extend(present.map(|(value, _)| value));
        }
        let first = values[0];
        let is_flat = values.iter().all(|value| *value == first) && (constant || first == 0.0);
        if is_flat || values.iter().any(|value| !value.is_finite()) {
            self.left_out.push(name);
            return;
        }
        self.names.push(name);
        self.columns.push(DVector::from_vec(values));
        self.dimensions.push(measures);
    }
}
