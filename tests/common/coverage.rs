//! How often intervals contain the truth, over many seeds.

use std::ops::{ControlFlow, Range};
use std::sync::Arc;

use indexmap::IndexMap;
use trimtab_core::estimate::Estimate;
use trimtab_core::flight::Maneuver;
use trimtab_core::job::{self, JobSpec};
use trimtab_core::model::ModelDocument;

/// Half the width of a 95 % interval in standard errors.
const TWO_SIDED_95: f64 = 1.959_964;

/// Errors and standard errors of one parameter, by seed.
#[derive(Default)]
pub(crate) struct Row {
    pub errors: Vec<f64>,
    pub corrected: Vec<f64>,
    pub conventional: Vec<f64>,
}

/// By name of the parameter.
#[derive(Default)]
pub(crate) struct Coverage(pub IndexMap<String, Row>);

impl Coverage {
    /// Adds the estimate of one seed; parameters without a standard error do not count.
    pub(crate) fn add(&mut self, estimate: &Estimate, truth: &IndexMap<String, f64>) {
        for parameter in &estimate.parameters {
            let errors = (
                parameter.standard_error,
                parameter.conventional_standard_error,
            );
            if let (Some(corrected), Some(conventional)) = errors {
                let row = self.0.entry(parameter.name.clone()).or_default();
                row.errors.push(parameter.estimate - truth[&parameter.name]);
                row.corrected.push(corrected);
                row.conventional.push(conventional);
            }
        }
    }

    /// Share of all intervals, of all parameters, that contain the truth.
    pub(crate) fn pooled(&self, bounds: fn(&Row) -> &Vec<f64>) -> f64 {
        let rows = self.0.values();
        rows.map(|row| row.share(bounds)).sum::<f64>() / self.0.len() as f64
    }

    pub(crate) fn print(&self, title: &str) {
        println!("\n{title}");
        println!(
            "{:12} {:>5} {:>9} {:>12} {:>11} {:>11} {:>11} {:>11}",
            "parameter",
            "seeds",
            "corrected",
            "conventional",
            "bias",
            "bias/s.e.m.",
            "scatter",
            "mean s.e."
        );
        for (name, row) in &self.0 {
            let mean_error = mean(&row.corrected);
            println!(
                "{name:12} {:5} {:8.1}% {:11.1}% {:11.2e} {:11.2} {:11.3e} {mean_error:11.3e}",
                row.errors.len(),
                100.0 * row.share(|row| &row.corrected),
                100.0 * row.share(|row| &row.conventional),
                mean(&row.errors),
                row.bias(),
                row.scatter(),
            );
        }
        println!(
            "{:12} {:5} {:8.1}% {:11.1}%",
            "all",
            "",
            100.0 * self.pooled(|row| &row.corrected),
            100.0 * self.pooled(|row| &row.conventional)
        );
    }
}

impl Row {
    /// Share of the 95 % intervals that contain the truth.
    pub(crate) fn share(&self, bounds: fn(&Row) -> &Vec<f64>) -> f64 {
        let both = self.errors.iter().zip(bounds(self));
        let inside = both.filter(|(error, bound)| error.abs() <= TWO_SIDED_95 * **bound);
        inside.count() as f64 / self.errors.len() as f64
    }

    /// Mean error in standard errors of the mean.
    pub(crate) fn bias(&self) -> f64 {
        mean(&self.errors) / (self.scatter() / (self.errors.len() as f64).sqrt())
    }

    /// Standard deviation of the errors.
    pub(crate) fn scatter(&self) -> f64 {
        let middle = mean(&self.errors);
        let squares: f64 = self.errors.iter().map(|e| (e - middle).powi(2)).sum();
        (squares / (self.errors.len() as f64 - 1.0)).sqrt()
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Fits one recording.
pub(crate) fn fit(document: &ModelDocument, spec: &JobSpec, recording: Arc<Maneuver>) -> Estimate {
    let plan = job::prepare(spec, document, &[recording]).unwrap_or_else(|f| panic!("{f:#?}"));
    let result = job::run(&plan, &mut |_| ControlFlow::Continue(()));
    result.unwrap_or_else(|f| panic!("{f:#?}")).estimate
}

/// Fits the recordings of `seeds` on all cores.
pub(crate) fn over_seeds(
    seeds: Range<u64>,
    truth: &IndexMap<String, f64>,
    fit: impl Fn(u64) -> Estimate + Sync,
) -> Coverage {
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get() as u64);
    let estimates = std::thread::scope(|scope| {
        let part = |thread: u64| {
            let (fit, seeds) = (&fit, seeds.clone());
            scope.spawn(move || -> Vec<(u64, Estimate)> {
                let own = seeds.filter(|seed| seed % threads == thread);
                own.map(|seed| (seed, fit(seed))).collect()
            })
        };
        let running: Vec<_> = (0..threads).map(part).collect();
        let parts = running
            .into_iter()
            .map(|part| part.join().expect("no panic"));
        let mut all: Vec<(u64, Estimate)> = parts.flatten().collect();
        all.sort_by_key(|(seed, _)| *seed);
        all
    });
    let mut coverage = Coverage::default();
    for (seed, estimate) in &estimates {
        let reason = &estimate.reason;
        assert!(estimate.outcome.is_minimum(), "seed {seed}: {reason}");
        coverage.add(estimate, truth);
    }
    coverage
}
