//! What a filter-error job asks for beyond an output-error job, and what it cannot have.

use super::bounds::JOB_TOO_LARGE;
use super::unknown_name::unknown_name;
use crate::estimate::{
    Estimator, Noise, NoiseStructure, Options, Problem, Unknowns, process_noise_names,
};
use crate::flight::{Fault, escape};
use crate::model::Model;
use crate::simulate::{Segment, Steps};

/// Most operations of an evaluation with sensitivities: some ten seconds.
const MOST_OPERATIONS: f64 = 1e10;

/// Intensities for which the Riccati equation stays in the range of numbers.
const INTENSITIES: std::ops::RangeInclusive<f64> = 1e-30..=1e30;

/// Checks the settings against the model.
pub(super) fn check_options(options: &Options, model: &Model, faults: &mut Vec<Fault>) {
    let fault = |pointer: &str, message: String| Fault::new(pointer, "bad_option", message);
    if options.estimator != Estimator::FilterError {
        if !options.process_noise.is_empty() {
            let message = "only the estimator \"filter_error\" has process noise; say \"estimator\": \"filter_error\", or leave this out";
            faults.push(fault("/options/process_noise", message.to_string()));
        }
        return;
    }
    if !model.paths.of_outputs().is_empty() {
        let message = "the filter-error estimator does not handle a lag or delay of an output; leave them out of the model, or use the estimator \"output_error\"";
        faults.push(fault("/options/estimator", message.to_string()));
    }
    if model.states.is_empty() {
        let message =
            "a model without states has nothing to filter; use the estimator \"output_error\"";
        faults.push(fault("/options/estimator", message.to_string()));
    }
    for (name, noise) in &options.process_noise {
        let pointer = format!("/options/process_noise/{}", escape(name));
        let Some(state) = model.states.iter().find(|state| state.name == *name) else {
            let known = model.states.iter().map(|state| state.name.as_str());
            let what = ("state", name.as_str());
            let pointer = "/options/process_noise";
            unknown_name(pointer, "bad_option", what, known, faults);
            continue;
        };
        match noise.start {
            None if noise.fixed => {
                let message = "a fixed intensity needs a \"start\"; 0 is no process noise";
                faults.push(fault(&pointer, message.to_string()));
            }
            Some(start) if start == 0.0 && !noise.fixed => {
                let message = "an intensity that starts at 0 stays there: leave \"start\" out for an automatic one, or say \"fixed\": true for no process noise";
                faults.push(fault(&format!("{pointer}/start"), message.to_string()));
            }
            Some(start) if start != 0.0 && !INTENSITIES.contains(&(start * state.unit.scale)) => {
                let message = "give an intensity from 1e-30 to 1e30, in the state's unit per root of a second";
                faults.push(fault(&format!("{pointer}/start"), message.to_string()));
            }
            _ => {}
        }
    }
}

/// Checks that the filter can have a steady gain, and what it will cost.
pub(super) fn check_data(
    model: &Model,
    segments: &[Segment],
    unknowns: &Unknowns,
    options: &Options,
) -> Result<(), Vec<Fault>> {
    if options.estimator != Estimator::FilterError {
        return Ok(());
    }
    if let Some(segment) = segments
        .iter()
        .find(|segment| matches!(segment.steps, Steps::Uneven(_)))
    {
        let message = format!(
            "segment {} is sampled unevenly, and a steady gain is that of one step; upload the recording evenly sampled, say \"gaps\": \"join\" to run it at its usual step, or use the estimator \"output_error\"",
            segment.label
        );
        return Err(vec![Fault::new("/maneuvers", "uneven_sampling", message)]);
    }
    let (states, outputs) = (model.states.len() as f64, model.outputs.len() as f64);
    let columns = unknowns.len() as f64 + states;
    let samples: usize = segments.iter().map(Segment::len).sum();
    let pairs = match options.noise {
        Noise::Estimated {
            structure: NoiseStructure::Full,
        } => outputs * outputs,
        _ => outputs,
    };
    let stages = options.integrator.stage_count() as f64;
    // of the recursion and the sums, and of one Lyapunov equation for each unknown and segment
    let along =
        samples as f64 * columns * (stages * states * states + states * outputs + pairs * columns);
    let gains = segments.len() as f64 * columns * 100.0 * states.powi(3);
    if along + gains > MOST_OPERATIONS {
        let message = format!(
            "{samples} samples, {states} states, {outputs} outputs and {columns} unknowns take {:.0e} operations an iteration of the filter-error estimator, at most {MOST_OPERATIONS:.0e} are allowed; fix parameters, choose \"rows\", or fit fewer maneuvers at a time",
            along + gains
        );
        return Err(vec![Fault::new(
            "/options/estimator",
            JOB_TOO_LARGE,
            message,
        )]);
    }
    Ok(())
}

/// Names of the unknowns that follow the parameters.
pub(super) fn process_noise(problem: &Problem) -> Vec<String> {
    match problem.options.estimator {
        Estimator::FilterError => process_noise_names(problem),
        _ => Vec::new(),
    }
}
