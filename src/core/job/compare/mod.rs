//! A comparison: what some jobs say of the same parameters, side by side.
//!
//! Each value is held against the first job that has the parameter, in standard errors of independent estimates:
//!
//! ```text
//! deviation = (θ_k − θ_1)/√(σ_k² + σ_1²)
//! ```
//!
//! Jobs that were fitted to the same samples are not independent, and this is not the standard error of their difference then:
//! which they are is said.

mod report;

use super::campaign::{Flown, share_data};
use crate::estimate::ParameterEstimate;

pub use report::{ComparedJob, ComparedParameter, ComparedValue, Comparison};

/// Compares jobs in their order. Parameters of one maneuver alone (initial states, biases) are no part of it.
pub fn compare(jobs: &[Flown]) -> Comparison {
    let mut keys: Vec<(&str, &str)> = Vec::new();
    for row in jobs.iter().flat_map(shared_rows) {
        let key = (row.name.as_str(), row.unit.as_str());
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    let parameters = keys
        .into_iter()
        .map(|(name, unit)| parameter(jobs, name, unit));
    Comparison {
        parameters: parameters.collect(),
        jobs: (0..jobs.len()).map(|at| compared_job(jobs, at)).collect(),
    }
}

/// The parameters that all maneuvers of a job share.
fn shared_rows(job: &Flown) -> impl Iterator<Item = &ParameterEstimate> {
    let rows = job.estimate.parameters.iter();
    rows.filter(|row| row.segment.is_none())
}

fn compared_job(jobs: &[Flown], at: usize) -> ComparedJob {
    let job = &jobs[at];
    let others = jobs.iter().enumerate().filter(|(other, _)| *other != at);
    let sharing = others.filter(|(_, other)| share_data(&job.recordings, &other.recordings));
    ComparedJob {
        job: job.job.clone(),
        name: job.name.clone(),
        reason: job.estimate.reason.clone(),
        fit: job.estimate.fit_summary(),
        modes: job.estimate.modes.clone(),
        shares_data_with: sharing.map(|(_, other)| other.job.clone()).collect(),
    }
}

fn parameter(jobs: &[Flown], name: &str, unit: &str) -> ComparedParameter {
    let row = |job| shared_rows(job).find(|row| row.name == name && row.unit == unit);
    let rows: Vec<Option<&ParameterEstimate>> = jobs.iter().map(row).collect();
    let first = rows.iter().position(Option::is_some);
    let value = |(at, row): (usize, &Option<&ParameterEstimate>)| {
        let row = (*row)?;
        let reference = first.filter(|first| *first != at);
        let other = reference.and_then(|first| Some((&jobs[first], rows[first]?)));
        Some(ComparedValue {
            estimate: row.estimate,
            standard_error: row.standard_error,
            remark: jobs[at].estimate.remark(row).to_string(),
            difference: other.map(|(_, other)| row.estimate - other.estimate),
            deviation: other.and_then(|(_, other)| deviation(row, other)),
            is_independent: other
                .map(|(job, _)| !share_data(&job.recordings, &jobs[at].recordings)),
        })
    };
    ComparedParameter {
        parameter: name.to_string(),
        unit: unit.to_string(),
        values: rows.iter().enumerate().map(value).collect(),
    }
}

/// In standard errors of the difference of independent estimates; nothing where one has no standard error, or is not converged.
fn deviation(row: &ParameterEstimate, other: &ParameterEstimate) -> Option<f64> {
    let error = |row: &ParameterEstimate| {
        let error = row
            .standard_error
            .filter(|_| !row.fixed && !row.provisional);
        error.filter(|error| *error > 0.0 && error.is_finite())
    };
    let deviation = (row.estimate - other.estimate) / error(row)?.hypot(error(other)?);
    deviation.is_finite().then_some(deviation)
}
