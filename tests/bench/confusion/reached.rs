//! What was reached with the effect named: the prediction error against the true model's, and the declared parameters
//! against the truth.

use std::ops::ControlFlow;

use indexmap::IndexMap;
use trimtab_core::diagnose::{Case, Diagnosis, Effect};
use trimtab_core::estimate::{Role, output_error, predict};

use crate::aircraft::{Aircraft, Flown};

/// Bounds of a declared parameter that no longer is biased, in corrected standard errors.
const UNBIASED: f64 = 3.0;

#[derive(Clone, Debug, Default)]
pub(crate) struct Reached {
    /// Error of the prediction, over that of the true model fitted to the same flights.
    pub error_ratio: Option<f64>,
    /// Declared parameters that are further from the truth than three standard errors, and how far.
    pub biased: Vec<(String, f64)>,
}

impl Reached {
    pub(crate) fn of(
        aircraft: &Aircraft,
        flown: &Flown,
        effects: &[(&Effect, f64)],
        diagnosis: &Diagnosis,
    ) -> Self {
        let variances = aircraft.variances();
        let outputs = variances.len();
        let predicted = (diagnosis.fits.iter()).filter(|fit| fit.role == Role::Validation);
        let rms: Vec<f64> = predicted.map(|fit| fit.after.rms).collect();
        let truth = best_possible(aircraft, &flown.case, effects);
        let error_ratio = truth.filter(|truth| truth.len() == rms.len()).map(|truth| {
            let whole = |rms: &[f64]| -> f64 {
                let of = |(i, rms): (usize, &f64)| rms * rms / variances[i % outputs];
                rms.iter().enumerate().map(of).sum()
            };
            (whole(&rms) / whole(&truth)).sqrt()
        });
        Self {
            error_ratio,
            biased: biased(flown, diagnosis),
        }
    }
}

/// RMS errors of the prediction by the true model, by flight and output.
fn best_possible(aircraft: &Aircraft, case: &Case, effects: &[(&Effect, f64)]) -> Option<Vec<f64>> {
    let mut document = aircraft.document.clone();
    let mut values = IndexMap::new();
    for (effect, size) in effects {
        let edited = effect.apply(&document).ok()?;
        let is_free = |name: &str| !edited.document.parameters[name].fixed;
        if let Some(added) = edited.added.iter().find(|added| is_free(&added.name)) {
            values.insert((added.name.clone(), None), *size);
        }
        document = edited.document;
    }
    let problem = case.problem(&document, &values).ok()?;
    let solution = output_error(&problem, &mut |_| ControlFlow::Continue(())).ok()?;
    let mut rms = Vec::new();
    for validation in case.held_out(Role::Validation, &problem).ok()? {
        let (prediction, _) = predict(&problem, &solution.theta, &solution.covariance, &validation);
        rms.extend(prediction.outputs.iter().map(|output| output.rms));
    }
    Some(rms)
}

fn biased(flown: &Flown, diagnosis: &Diagnosis) -> Vec<(String, f64)> {
    let of = |change: &trimtab_core::diagnose::ParameterChange| {
        let truth = match &change.segment {
            Some(label) => flown.truth.get(label)?,
            None => flown.truth.first()?.1,
        };
        let off = (change.after - truth.get(&change.name)?) / change.standard_error?;
        (off.abs() > UNBIASED).then(|| (change.name.clone(), off))
    };
    diagnosis.parameters.iter().filter_map(of).collect()
}
