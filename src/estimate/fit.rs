//! How well each output is reproduced, and the time histories to look at.

use super::problem::Problem;
use super::report::{OutputFit, OutputSeries, Series, TimeHistory};
use crate::simulate::Outputs;

/// Measured and modelled time histories of all segments for θ.
pub(super) fn histories(problem: &Problem, theta: &[f64]) -> Vec<TimeHistory> {
    let model = &problem.model;
    let options = &problem.options;
    let mut parameters = Vec::new();
    let mut machinery = Outputs::new(model, options.integrator, options.input_interpolation);
    let history = |(index, segment): (usize, &crate::simulate::Segment)| {
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
        });
        TimeHistory {
            segment: segment.label.clone(),
            time: segment.time.clone(),
            inputs: inputs.collect(),
            outputs: outputs.collect(),
        }
    };
    problem.segments.iter().enumerate().map(history).collect()
}

/// The fit of each output over all segments.
pub(super) fn fits(problem: &Problem, histories: &[TimeHistory]) -> Vec<OutputFit> {
    let fit = |(i, output): (usize, &crate::model::Quantity)| {
        let all = |pick: fn(&OutputSeries) -> &Vec<f64>| -> Vec<f64> {
            histories
                .iter()
                .flat_map(|history| pick(&history.outputs[i]).iter().copied())
                .collect()
        };
        let (measured, model, residual) = (
            all(|s| &s.measured),
            all(|s| &s.model),
            all(|s| &s.residual),
        );
        let n = measured.len() as f64;
        let mean = |values: &[f64]| values.iter().sum::<f64>() / n;
        let rms = |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / n).sqrt();
        let middle = mean(&measured);
        let spread = rms(&measured.iter().map(|z| z - middle).collect::<Vec<_>>());
        let error = rms(&residual);
        OutputFit {
            name: output.name.clone(),
            unit: output.si.clone(),
            rms: error,
            bias: mean(&residual),
            r_squared: if spread > 0.0 {
                1.0 - (error / spread).powi(2)
            } else {
                0.0
            },
            theil: if error > 0.0 {
                error / (rms(&measured) + rms(&model))
            } else {
                0.0
            },
        }
    };
    problem.model.outputs.iter().enumerate().map(fit).collect()
}
