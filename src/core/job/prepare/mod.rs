//! From a spec and its data to a plan: all that bad input could break is found here.

mod assumed;
mod bounds;
mod checks;
mod diagnosis;
mod document;
mod elsewhere;
mod filter;
mod flown;
mod frequency;
mod gaps;
mod initial;
mod intervals;
mod knowledge;
mod missing;
mod plausible;
mod recorded;
mod resolve;
mod start;
mod stretch;
mod structure;
mod study;
mod to_predict;
mod twice;
mod unknown_name;

pub use checks::MOST_MANEUVERS;
pub(super) use stretch::rows_in_use;
pub(super) use to_predict::prepare_prediction;

use std::sync::Arc;

use initial::FreeInitial;
use stretch::Stretch;
use twice::Used;

use super::event::Prepared;
use super::plan::Plan;
use super::spec::{JobKind, JobSpec};
use crate::diagnose::Flight;
use crate::estimate::{Options, Problem, Role, Unknowns, Validation};
use crate::flight::{Fault, Faults, Finding, Maneuver};
use crate::model::{Model, ModelDocument};
use crate::simulate::Segment;

/// Compiles the model, applies edits and overrides, makes inputs and outputs from recorded channels,
/// checks units. `maneuvers` are in the order of `spec.maneuvers`; `declared` is the spec's model, looked up.
///
/// # Errors
/// Every fault that would prevent the start, each with its JSON pointer into the spec.
pub fn prepare(
    spec: &JobSpec,
    declared: &ModelDocument,
    maneuvers: &[Arc<Maneuver>],
) -> Result<Plan, Faults> {
    let (mut faults, mut findings) = (Vec::new(), Vec::new());
    let spec = flown::resolved(spec, declared, &mut faults);
    let spec = spec.as_ref();
    let document = document::edited(spec, declared, &mut faults);
    checks::check_shape(spec, maneuvers.len(), &mut faults);
    checks::check_kind(spec, &mut faults);
    let model = document::compiled(&document, spec, declared, &mut faults)?;
    check_settings(spec, &model, &mut faults);
    let stretches = gaps::stretches(spec, &model, maneuvers, &mut findings, &mut faults);
    bounds::check_data(&model, &stretches, &mut faults)?;
    let resolved = Resolved::of(spec, &model, &stretches, &mut faults);
    refuse_if_any(faults)?;
    findings.extend(assumed::findings(spec, declared));
    findings.extend(resolved.findings(spec, &model, maneuvers));

    let Opened {
        document,
        model,
        unknowns,
        initial,
    } = with_unknowns(spec, document, model, &resolved, &mut findings)?;
    findings.extend(elsewhere::findings(&document, &resolved.labels(spec)));
    let fitted = resolved.fitted.into_iter();
    let fitted = fitted.map(|(segment, stretch)| (segment, stretch.index));
    let (segments, from): (Vec<Segment>, Vec<usize>) = fitted.unzip();
    check_samples(&model, &segments, &unknowns, &spec.options, &mut findings)?;
    // a structure determination brings parameters of its own
    if spec.kind != JobKind::Structure || !unknowns.is_empty() {
        bounds::check_unknowns(&model, &segments, &unknowns, &spec.options)?;
    }
    let validation = resolved.predicted.into_iter();
    let validation: Vec<Validation> = validation
        .map(|held_out| to_predict(spec, &model, &initial, held_out))
        .collect::<Result<_, _>>()?;
    filter::check_data(&model, &segments, &unknowns, &spec.options)?;
    frequency::check_data(&model, &segments, &unknowns, &spec.options, &mut findings)?;
    findings.extend(plausible::findings(&model, &segments));
    refuse_if_any(spec.strict.faults(&findings))?;

    let problem = Problem::new(model, segments, unknowns, spec.options.clone());
    if spec.kind == JobKind::DerivativeStudy {
        study::check(&problem)?;
    }
    intervals::check(&problem)?;
    checks::check_stiffness(&problem)?;
    checks::check_estimator(&problem)?;
    let case = match spec.kind {
        JobKind::Diagnose => {
            let flights = resolved.flights;
            Some(diagnosis::case(spec, &document, &problem, flights)?)
        }
        JobKind::Estimate | JobKind::DerivativeStudy | JobKind::Structure => None,
    };
    let terms = match &spec.structure {
        Some(options) => Some(structure::terms(options, &problem, &mut findings)?),
        None => None,
    };
    Ok(Plan {
        prepared: prepared(&problem, &validation, findings),
        model: document,
        problem,
        from,
        validation,
        case,
        terms,
        strict: spec.strict.clone(),
    })
}

/// The model with what is unknown of it over the data.
struct Opened {
    document: ModelDocument,
    model: Model,
    unknowns: Unknowns,
    /// Parameters of the initial states of parts that begin in mid-motion.
    initial: Vec<String>,
}

/// The unknowns; where parts of a recording begin in mid-motion, of the model with their initial states as parameters more.
fn with_unknowns(
    spec: &JobSpec,
    document: ModelDocument,
    model: Model,
    resolved: &Resolved<'_, '_>,
    findings: &mut Vec<Finding>,
) -> Result<Opened, Vec<Fault>> {
    let free = FreeInitial::of(spec, &document, &model, &resolved.fitted);
    findings.extend((free.as_ref()).map(|free| free.finding(spec.kind, &resolved.fitted)));
    // a diagnosis fits many edits of one model, each to parts that begin alike
    let Some(free) = free.filter(|_| spec.kind != JobKind::Diagnose) else {
        let unknowns = start::unknowns(spec, &model, &resolved.fitted)?;
        return Ok(Opened {
            document,
            model,
            unknowns,
            initial: Vec::new(),
        });
    };
    let model = Model::compile(&free.document)?;
    let unknowns = start::unknowns(spec, &model, &resolved.fitted)?;
    Ok(Opened {
        unknowns: free.hold(&model, &unknowns),
        document: free.document,
        model,
        initial: free.names,
    })
}

/// Faults that were collected so far end the preparation: what comes next would only repeat them.
fn refuse_if_any(faults: Vec<Fault>) -> Result<(), Vec<Fault>> {
    if faults.is_empty() {
        Ok(())
    } else {
        Err(faults)
    }
}

fn check_settings(spec: &JobSpec, model: &Model, faults: &mut Vec<Fault>) {
    checks::check_options(&spec.options, model, faults);
    filter::check_options(&spec.options, model, faults);
    frequency::check_options(spec, model, faults);
    intervals::check_options(spec, faults);
    checks::check_names(spec, model, faults);
    faults.extend(spec.strict.unknown());
}

/// What the stretches of the recordings become, by what is done with them.
struct Resolved<'s, 'm> {
    fitted: Vec<(Segment, &'s Stretch<'m>)>,
    predicted: Vec<(Segment, &'s Stretch<'m>)>,
    /// Of a diagnosis: all of them, with every channel that was recorded.
    flights: Vec<Flight>,
}

impl<'s, 'm> Resolved<'s, 'm> {
    fn of(
        spec: &JobSpec,
        model: &Model,
        stretches: &'s [Vec<Stretch<'m>>],
        faults: &mut Vec<Fault>,
    ) -> Self {
        let mut resolved = Self {
            fitted: Vec::new(),
            predicted: Vec::new(),
            flights: Vec::new(),
        };
        for (index, stretches) in stretches.iter().enumerate() {
            let usage = &spec.maneuvers[index];
            for stretch in stretches {
                let segment = resolve::segment(spec, model, stretch, index, faults);
                if spec.kind == JobKind::Diagnose {
                    let flight = diagnosis::flight(model, &segment, stretch, usage);
                    resolved.flights.push(flight);
                }
                match usage.role {
                    Role::Estimation => resolved.fitted.push((segment, stretch)),
                    Role::Validation | Role::Final => resolved.predicted.push((segment, stretch)),
                }
            }
        }
        resolved
    }

    /// Of the maneuvers, and of the parts that gaps cut.
    fn labels(&self, spec: &JobSpec) -> Vec<String> {
        let all = self.fitted.iter().chain(&self.predicted);
        let mut labels: Vec<String> = (0..spec.maneuvers.len()).map(|i| spec.label(i)).collect();
        labels.extend(all.map(|(segment, _)| segment.label.clone()));
        labels.sort();
        labels.dedup();
        labels
    }

    /// What is odd about the recordings as they are used.
    fn findings(&self, spec: &JobSpec, model: &Model, maneuvers: &[Arc<Maneuver>]) -> Vec<Finding> {
        let all = self.fitted.iter().chain(&self.predicted);
        let used: Vec<Used<'_, '_>> = all.map(|(segment, stretch)| (segment, *stretch)).collect();
        let mut findings = Vec::new();
        for (index, maneuver) in maneuvers.iter().enumerate() {
            let of_this = used.iter().filter(|(_, stretch)| stretch.index == index);
            let parts: Vec<Used<'_, '_>> = of_this.copied().collect();
            findings.extend(recorded::findings(spec, model, index, maneuver, &parts));
        }
        findings.extend(twice::findings(spec, &used));
        findings
    }
}

/// Whether the samples that have values are enough, and what is to be said of those that have none.
fn check_samples(
    model: &Model,
    segments: &[Segment],
    unknowns: &Unknowns,
    options: &Options,
    findings: &mut Vec<Finding>,
) -> Result<(), Vec<Fault>> {
    let mut faults = Vec::new();
    missing::check_samples(model, segments, options, findings, &mut faults);
    faults.extend(missing::check_counts(model, segments, unknowns, options));
    refuse_if_any(faults)
}

/// A segment that is predicted with the estimate, and not fitted.
fn to_predict(
    spec: &JobSpec,
    model: &Model,
    initial: &[String],
    held_out: (Segment, &Stretch<'_>),
) -> Result<Validation, Vec<Fault>> {
    let unknowns = start::unknowns(spec, model, std::slice::from_ref(&held_out))?;
    let (segment, stretch) = held_out;
    let unknowns = initial::hold_predicted(initial, model, (&segment, stretch), &unknowns);
    bounds::check_validation(model, &segment, &unknowns)?;
    Ok(Validation { segment, unknowns })
}

/// What the job amounts to, in names and numbers.
fn prepared(problem: &Problem, validation: &[Validation], findings: Vec<Finding>) -> Prepared {
    let validation = validation.iter();
    let (segments, outputs) = (problem.segments.iter(), problem.model.outputs.iter());
    let parameters = (0..problem.unknowns.len()).map(|place| problem.name(place));
    Prepared {
        segments: segments.map(|segment| segment.label.clone()).collect(),
        validation: validation
            .map(|validation| validation.segment.label.clone())
            .collect(),
        samples: problem.samples(),
        outputs: outputs.map(|output| output.name.clone()).collect(),
        parameters: parameters.chain(filter::process_noise(problem)).collect(),
        findings,
    }
}
