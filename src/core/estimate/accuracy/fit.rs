//! How well each output is reproduced, and the time histories to look at.

use super::autoregression::Autoregression;
use super::coloured_residuals::Colour;
use crate::estimate::options::role::Role;
use crate::estimate::problem::Problem;
use crate::estimate::report::fit::{OutputFit, TheilShares};
use crate::estimate::report::history::{OutputSeries, Series, TimeHistory};
use crate::model::Quantity;
use crate::simulate::{Outputs, Segment};

/// Measured and modelled time histories of all segments for θ.
pub(crate) fn histories(problem: &Problem, theta: &[f64]) -> Vec<TimeHistory> {
    let model = &problem.model;
    let options = &problem.options;
    let mut parameters = Vec::new();
    let mut machinery = Outputs::new(model, options.integrator, options.input_interpolation);
    let simulated = |index: usize, segment: &Segment| {
        problem.unknowns.parameters(index, theta, &mut parameters);
        let mut modelled = vec![Vec::with_capacity(segment.len()); model.outputs.len()];
        let run = machinery.run(segment, &parameters, |_, y| {
            modelled
                .iter_mut()
                .zip(y)
                .for_each(|(series, y)| series.extend_from_slice(y));
        });
        if run.is_err() {
            // an estimate has been simulated before; should it not be, what is missing is told apart
            modelled
                .iter_mut()
                .for_each(|series| series.resize(segment.len(), f64::NAN));
        }
        modelled
    };
    histories_of(problem, simulated)
}

/// Time histories of all segments, `modelled` giving the outputs of each: by output, then sample.
pub(crate) fn histories_of(
    problem: &Problem,
    mut modelled: impl FnMut(usize, &Segment) -> Vec<Vec<f64>>,
) -> Vec<TimeHistory> {
    let model = &problem.model;
    let history = |(index, segment): (usize, &Segment)| {
        let modelled = modelled(index, segment);
        let inputs = model.inputs.iter().zip(&segment.inputs);
        let inputs = inputs.map(|(input, values)| Series {
            name: input.name.clone(),
            unit: input.si.clone(),
            values: values.clone(),
        });
        let outputs = model.outputs.iter().zip(&segment.measured).zip(modelled);
        let outputs = outputs.map(|((output, measured), model)| OutputSeries {
            name: output.name.clone(),
            unit: output.si.clone(),
            residual: measured.iter().zip(&model).map(|(z, y)| z - y).collect(),
            measured: measured.clone(),
            model,
            declared: Vec::new(),
        });
        TimeHistory {
            segment: segment.label.clone(),
            role: Role::Estimation,
            time: segment.time.clone(),
            inputs: inputs.collect(),
            outputs: outputs.collect(),
        }
    };
    problem.segments.iter().enumerate().map(history).collect()
}

/// The fit of each output over all segments; missing samples (NaN) do not count.
pub(crate) fn fits(
    problem: &Problem,
    histories: &[TimeHistory],
    colour: &Colour,
) -> Vec<OutputFit> {
    let fit = |(i, output): (usize, &Quantity)| {
        let series = histories.iter().map(|history| &history.outputs[i]);
        let pairs = series.flat_map(|s| s.measured.iter().copied().zip(s.model.iter().copied()));
        let pairs: Vec<(f64, f64)> = pairs.filter(|(z, y)| (z - y).is_finite()).collect();
        output_fit(output, &pairs, &colour.models[i])
    };
    problem.model.outputs.iter().enumerate().map(fit).collect()
}

/// From pairs of measured and modelled values.
fn output_fit(output: &Quantity, pairs: &[(f64, f64)], colour: &Autoregression) -> OutputFit {
    let n = pairs.len().max(1) as f64;
    let mean =
        |value: &dyn Fn(f64, f64) -> f64| pairs.iter().map(|&(z, y)| value(z, y)).sum::<f64>() / n;
    let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
    let error = mean(&|z, y| (z - y).powi(2));
    let (measured, model) = (mean(&|z, _| z), mean(&|_, y| y));
    let spread = mean(&|z, _| (z - measured).powi(2));
    let model_spread = mean(&|_, y| (y - model).powi(2));
    let common = mean(&|z, y| (z - measured) * (y - model));
    let spreads = (spread * model_spread).sqrt();
    let bias = mean(&|z, y| z - y);
    OutputFit {
        name: output.name.clone(),
        unit: output.si.clone(),
        rms: error.sqrt(),
        bias,
        r_squared: if spread > 0.0 {
            1.0 - error / spread
        } else {
            0.0
        },
        theil: share(
            error.sqrt(),
            mean(&|z, _| z * z).sqrt() + mean(&|_, y| y * y).sqrt(),
        ),
        theil_shares: TheilShares {
            bias: share(bias * bias, error),
            variance: share((spread.sqrt() - model_spread.sqrt()).powi(2), error),
            covariance: share(2.0 * (spreads - common), error),
        },
        autocorrelation: colour.lag_one,
        samples: pairs.len(),
        effective_samples: (pairs.len() as f64 * colour.effective_share()).max(1.0),
    }
}
