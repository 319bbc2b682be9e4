//! How large an effect must be to be worth a given likelihood ratio.

use std::ops::ControlFlow;

use trimtab_core::diagnose::{Effect, EffectKind, Treatment};
use trimtab_core::estimate::{
    ErrorBoundsKind, Estimator, Noise, OutputFit, ProcessNoise, filter_error, output_error,
};
use trimtab_core::model::{EditKind, ModelDocument};
use trimtab_core::simulate::NoiseColour;

use crate::aircraft::Aircraft;

/// Sizes that are worth these likelihood ratios; none where the physical range ends before.
pub(crate) fn sizes(
    aircraft: &Aircraft,
    effect: &Effect,
    colour: &NoiseColour,
    ratios: &[f64],
) -> Vec<Option<f64>> {
    let first = first_guess(effect);
    if effect.kind == EffectKind::Treatment(Treatment::SensorOutliers) {
        // spikes are counted, not weighed: each is worth a likelihood ratio of about SPIKE²
        return ratios
            .iter()
            .map(|ratio| Some((ratio / 10.0).max(4.0)))
            .collect();
    }
    ratios
        .iter()
        .map(|&ratio| {
            let mut size = first;
            for _ in 0..12 {
                let found = worth(aircraft, effect, colour, size)?;
                if found.is_nan() || found <= 1e-9 {
                    return None;
                }
                let share = (ratio / found).sqrt();
                if (0.98..1.02).contains(&share) {
                    // what initial states and trim values of the flight imitate is told apart by nothing
                    let seen =
                        worth_with(aircraft, &freed(&aircraft.document), effect, colour, size)?;
                    return (in_range(aircraft, effect, size) && seen > 0.1 * ratio)
                        .then_some(size);
                }
                size *= share.clamp(0.1, 10.0);
            }
            None
        })
        .collect()
}

/// Likelihood ratio of the true effect on the estimation flights: what is left of it, noise-free, when the declared
/// model has done what it can.
fn worth(aircraft: &Aircraft, effect: &Effect, colour: &NoiseColour, size: f64) -> Option<f64> {
    worth_with(aircraft, &aircraft.document, effect, colour, size)
}

/// The document with the initial values of its states free.
fn freed(document: &ModelDocument) -> ModelDocument {
    let mut freed = document.clone();
    for (name, parameter) in &mut freed.parameters {
        parameter.fixed &= !name.ends_with("_0");
    }
    freed
}

fn worth_with(
    aircraft: &Aircraft,
    document: &ModelDocument,
    effect: &Effect,
    colour: &NoiseColour,
    size: f64,
) -> Option<f64> {
    if effect.is_noise() {
        return worth_as_noise(aircraft, effect, colour, size);
    }
    let case = aircraft.case(&[(effect, size)], None, 1)?;
    let mut problem = case.problem(document, &Default::default()).ok()?;
    problem.options.noise = Noise::Given {
        variance: aircraft.variances(),
    };
    problem.options.error_bounds = ErrorBoundsKind::Conventional;
    let solution = output_error(&problem, &mut |_| ControlFlow::Continue(())).ok()?;
    let a = match colour {
        NoiseColour::FirstOrder { correlation_time } => (-aircraft.step() / correlation_time).exp(),
        _ => 0.0,
    };
    let mut sum = 0.0;
    for history in &solution.histories {
        for (output, variance) in history.outputs.iter().zip(aircraft.variances()) {
            let e = &output.residual;
            sum += e[0] * e[0] / variance;
            let innovations = e.windows(2).map(|pair| pair[1] - a * pair[0]);
            sum += innovations.map(|w| w * w).sum::<f64>() / (variance * (1.0 - a * a));
        }
    }
    Some(sum)
}

/// Turbulence makes no noise-free flight: what it is worth to the filter, on the average of some flights.
fn worth_as_noise(
    aircraft: &Aircraft,
    effect: &Effect,
    colour: &NoiseColour,
    size: f64,
) -> Option<f64> {
    const FLIGHTS: u64 = 3;
    let of = |seed: u64| {
        let case = aircraft.case(&[(effect, size)], Some(colour), 900_000 + seed)?;
        let mut problem = case.problem(&aircraft.document, &Default::default()).ok()?;
        problem.options.error_bounds = ErrorBoundsKind::Conventional;
        let without = output_error(&problem, &mut |_| ControlFlow::Continue(())).ok()?;
        problem.options.estimator = Estimator::FilterError;
        problem.options.process_noise = (problem.model.states.iter())
            .filter(|state| state.name != effect.target)
            .map(|state| {
                let none = ProcessNoise {
                    start: Some(0.0),
                    fixed: true,
                };
                (state.name.clone(), none)
            })
            .collect();
        let with = filter_error(&problem, &mut |_| ControlFlow::Continue(())).ok()?;
        // ln L of white residuals: -n/2 ln det R, R diagonal
        let gain = |(before, after): (&OutputFit, &OutputFit)| (before.rms / after.rms).ln();
        let outputs = without.estimate.outputs.iter().zip(&with.estimate.outputs);
        let samples: usize = without.histories.iter().map(|h| h.time.len()).sum();
        Some(2.0 * samples as f64 * outputs.map(gain).sum::<f64>())
    };
    let all: Vec<f64> = (0..FLIGHTS).filter_map(of).collect();
    (!all.is_empty()).then(|| all.iter().sum::<f64>() / all.len() as f64)
}

fn first_guess(effect: &Effect) -> f64 {
    use EditKind::*;
    let EffectKind::Edit(kind) = effect.kind else {
        return 0.01;
    };
    match kind {
        SensorBias | InputBias | Gust | InitialState => 0.005,
        SensorDrift => 0.0005,
        SensorScale | InputScale => 0.1,
        SensorDelay | InputDelay | SensorLag | ActuatorLag => 0.06,
        SensorPosition => 3.0,
        ActuatorRateLimit => 0.1,
        Backlash => 0.005,
        StructuralMode => 0.05,
        _ => 1.0,
    }
}

/// Sizes that the effect's edit allows.
fn in_range(aircraft: &Aircraft, effect: &Effect, size: f64) -> bool {
    if effect.edits.is_empty() {
        return true;
    }
    let Ok(edited) = effect.apply(&aircraft.document) else {
        return false;
    };
    edited.added.first().is_some_and(|added| {
        let parameter = &edited.document.parameters[&added.name];
        let lower = parameter.lower.unwrap_or(f64::NEG_INFINITY);
        let upper = parameter.upper.unwrap_or(f64::INFINITY);
        let is_lag = matches!(
            effect.kind,
            EffectKind::Edit(EditKind::SensorLag | EditKind::ActuatorLag)
        );
        (lower..upper).contains(&size) && !(is_lag && size < 0.5 * aircraft.step())
    })
}
