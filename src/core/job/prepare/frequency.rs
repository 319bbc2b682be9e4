//! What a job in the frequency domain asks for, and what it cannot have.

use super::bounds::JOB_TOO_LARGE;
use crate::estimate::{
    Derivatives, Ends, Estimator, Noise, Options, StartMethod, StepsPerSample, Trend, Unknowns,
    band_frequencies,
};
use crate::flight::{Fault, Finding, FindingCode, escape};
use crate::job::no_start::no_band;
use crate::job::spec::{JobKind, JobSpec};
use crate::model::{Element, Model};
use crate::simulate::{Integrator, Segment, Steps};

/// Most operations of an evaluation with derivatives: some ten seconds.
const MOST_OPERATIONS: f64 = 1e10;
/// Most samples and frequencies of a segment.
const MOST_FREQUENCIES: usize = 1 << 20;

/// Numbers of all outputs, by unknown, below which little is left to tell the noise from.
const FEW: usize = 3;

/// Checks the settings against the kind of job and the model.
pub(super) fn check_options(spec: &JobSpec, model: &Model, faults: &mut Vec<Fault>) {
    let options = &spec.options;
    let estimator = options.estimator;
    let mut refuse = |pointer: &str, message: String| {
        faults.push(Fault::new(pointer, "bad_option", message));
    };
    if !estimator.is_in_frequency_domain() {
        if options.frequency.is_some() {
            let message = "only the estimators \"output_error_frequency\" and \"equation_error_frequency\" have a band of frequencies; choose one of them, or leave this out";
            refuse("/options/frequency", message.to_string());
        }
        return;
    }
    let name = estimator.name();
    if spec.kind == JobKind::DerivativeStudy {
        let message = format!(
            "a derivative study compares derivatives of simulations, which \"{name}\" does not make; choose the estimator \"output_error\""
        );
        refuse("/options/estimator", message);
    }
    if let Some((field, message)) = options.frequency.and_then(|frequency| frequency.fault()) {
        refuse(&format!("/options/frequency/{field}"), message);
    }
    let steps = format!("\"{name}\" integrates nothing; leave this out");
    if options.integrator != Integrator::default() {
        refuse("/options/integrator", steps.clone());
    }
    if options.steps_per_sample != StepsPerSample::default() {
        refuse("/options/steps_per_sample", steps);
    }
    if options.derivatives != Derivatives::default() {
        let message = format!("\"{name}\" has exact derivatives of its own; leave this out");
        refuse("/options/derivatives", message);
    }
    let is_output_error = estimator == Estimator::OutputErrorFrequency;
    match options.start {
        StartMethod::Automatic {} => {}
        StartMethod::Document {} | StartMethod::EquationError {} if is_output_error => {}
        _ => {
            let message = if is_output_error {
                "\"output_error_frequency\" starts \"automatic\", from the \"document\", or from \"equation_error\", which is then that of the frequency domain"
            } else {
                "\"equation_error_frequency\" is least squares and needs no start of its own; leave this out"
            };
            refuse("/options/start", message.to_string());
        }
    }
    if !is_output_error && matches!(options.noise, Noise::Given { .. }) {
        let message = "the noise of equation error is that of derivatives, not of outputs: it cannot be given; leave this out";
        refuse("/options/noise", message.to_string());
    }
    check_paths(name, model, faults);
}

/// Play and rate limits have no frequency response.
fn check_paths(estimator: &str, model: &Model, faults: &mut Vec<Fault>) {
    for (place, passed) in model.paths.elements().iter().enumerate() {
        if !matches!(passed.element, Element::Play | Element::RateLimit) {
            continue;
        }
        let (list, signal) = match model.paths.is_of_input(place) {
            true => ("inputs", &model.inputs[passed.signal]),
            false => ("outputs", &model.outputs[passed.signal]),
        };
        let message = format!(
            "a {} has no frequency response, which \"{estimator}\" needs; leave it out of the model, or use the estimator \"output_error\"",
            passed.element.words()
        );
        let field = passed.element.field();
        let pointer = format!("/model/{list}/{}/{field}", escape(&signal.name));
        faults.push(Fault::new(pointer, "bad_option", message));
    }
}

/// Checks that signals have transforms, that there are frequencies in the band, and what it will cost.
pub(super) fn check_data(
    model: &Model,
    segments: &[Segment],
    unknowns: &Unknowns,
    options: &Options,
    findings: &mut Vec<Finding>,
) -> Result<(), Vec<Fault>> {
    if !options.estimator.is_in_frequency_domain() {
        return Ok(());
    }
    let Some(frequency) = options.frequency else {
        return Err(vec![no_band(segments, options.estimator)]);
    };
    let name = options.estimator.name();
    let mut independent = 0;
    for segment in segments {
        check_signals(model, segment, name)?;
        let nyquist = 0.5 / segment.steps.length(0);
        let [from, to] = frequency.band_hz;
        if to > nyquist {
            let message = format!(
                "segment {} is sampled at {:.4} Hz, which tells of frequencies up to {nyquist:.4} Hz; let the band end below that",
                segment.label,
                2.0 * nyquist
            );
            return Err(vec![Fault::new(
                "/options/frequency/band_hz",
                "bad_option",
                message,
            )]);
        }
        let band = band_frequencies(segment, &frequency);
        let duration = (segment.len() - 1) as f64 * segment.steps.length(0);
        if band.frequencies.count == 0 {
            let message = format!(
                "from {from} Hz to {to} Hz there is no multiple of 1/T = {:.4} Hz for the {duration:.2} s of segment {}; widen the band, or choose longer segments",
                1.0 / duration,
                segment.label
            );
            return Err(vec![Fault::new(
                "/options/frequency/band_hz",
                "too_few_frequencies",
                message,
            )]);
        }
        if band.frequencies.count.max(segment.len()) > MOST_FREQUENCIES {
            let message = format!(
                "segment {} has {} samples and {} frequencies; at most {MOST_FREQUENCIES} of each are allowed",
                segment.label,
                segment.len(),
                band.frequencies.count
            );
            return Err(vec![Fault::new(
                "/options/frequency",
                JOB_TOO_LARGE,
                message,
            )]);
        }
        independent += band.independent;
    }
    let (states, outputs) = (model.states.len(), model.outputs.len());
    let lines = if frequency.trend == Trend::Linear {
        outputs
    } else {
        0
    };
    let both = if frequency.step_hz.is_some() { 2 } else { 1 };
    let ends = if frequency.ends == Ends::Estimated {
        both * states
    } else {
        0
    };
    let count = unknowns.len() + segments.len() * (lines + ends);
    let work = independent as f64
        * (states.pow(3) + outputs * (states.pow(2) + count * (states + count / 2))) as f64;
    let solve = (count as f64).powi(3);
    if work + solve > MOST_OPERATIONS {
        let message = format!(
            "{independent} frequencies and {count} unknowns, those of ends and trends with them, take {:.0e} operations an iteration, at most {MOST_OPERATIONS:.0e} are allowed; fit fewer maneuvers at a time, or say \"ends\": \"at_rest\" and \"trend\": \"constant\"",
            work + solve
        );
        return Err(vec![Fault::new(
            "/options/frequency",
            JOB_TOO_LARGE,
            message,
        )]);
    }
    let numbers = 2 * independent * outputs;
    if numbers <= count {
        let message = format!(
            "{independent} independent frequencies tell {numbers} numbers of the outputs, fewer than the {count} unknowns, those of ends and trends with them; widen the band, add maneuvers, or fix parameters"
        );
        return Err(vec![Fault::new(
            "/options/frequency/band_hz",
            "too_few_frequencies",
            message,
        )]);
    }
    if numbers < FEW * count {
        let message = format!(
            "{independent} independent frequencies tell {numbers} numbers of the outputs for {count} unknowns, those of ends and trends with them: error bounds are rough"
        );
        let remedy = "widen the band, or add maneuvers; say \"ends\": \"at_rest\" where the maneuver ends in the steady state in which it begins";
        let finding = Finding::new(FindingCode::FewFrequencies, message, remedy);
        findings.push(finding.at("/options/frequency/band_hz"));
    }
    Ok(())
}

/// Even steps, and a value of each output at each sample.
fn check_signals(model: &Model, segment: &Segment, estimator: &str) -> Result<(), Vec<Fault>> {
    if matches!(segment.steps, Steps::Uneven(_)) {
        let message = format!(
            "segment {} is sampled unevenly, and \"{estimator}\" needs even steps; upload the recording evenly sampled, say \"gaps\": \"join\" to run it at its usual step, or use the estimator \"output_error\"",
            segment.label
        );
        return Err(vec![Fault::new("/maneuvers", "uneven_sampling", message)]);
    }
    let outputs = model.outputs.iter().zip(&segment.measured);
    for (output, measured) in outputs {
        let missing = measured.iter().filter(|z| z.is_nan()).count();
        if missing > 0 {
            let message = format!(
                "the output '{}' has no value in {missing} of {} samples of segment {}, and a transform needs all; choose \"rows\" without them, say with \"channels\" how to make it (\"interpolated({})\"), or use the estimator \"output_error\"",
                output.name,
                segment.len(),
                segment.label,
                output.name
            );
            return Err(vec![Fault::new("/maneuvers", "missing_values", message)]);
        }
    }
    Ok(())
}
