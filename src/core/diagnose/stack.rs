//! All samples of all outputs of all segments in one long column: what projections are made of.

use std::ops::Range;

use crate::estimate::{Problem, TimeHistory, Unusable};
use crate::simulate::{Columns, Sensitivities};
use crate::stop;

/// One output along one segment.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Series {
    pub segment: usize,
    pub output: usize,
    pub range: Range<usize>,
}

/// Where each series stands in a column.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Layout {
    pub outputs: usize,
    pub series: Vec<Series>,
    /// Length of a column.
    pub len: usize,
}

impl Layout {
    pub(super) fn of(problem: &Problem) -> Self {
        let lengths: Vec<usize> = problem
            .segments
            .iter()
            .map(|segment| segment.len())
            .collect();
        Self::of_lengths(&lengths, problem.model.outputs.len())
    }

    pub(super) fn of_lengths(lengths: &[usize], outputs: usize) -> Self {
        let (mut series, mut len) = (Vec::new(), 0);
        for (segment, &samples) in lengths.iter().enumerate() {
            for output in 0..outputs {
                let range = len..len + samples;
                len = range.end;
                series.push(Series {
                    segment,
                    output,
                    range,
                });
            }
        }
        Self {
            outputs,
            series,
            len,
        }
    }

    /// Σ N ln(Σ e0²/Σ e1²) over the outputs, of two columns of residuals, of samples that there are: what smaller RMS
    /// errors are worth.
    pub(super) fn plain_gain(&self, before: &[f64], after: &[f64]) -> f64 {
        let of_output = |output: usize| {
            let (mut samples, mut ahead, mut behind) = (0.0, 0.0, 0.0);
            for series in self.series.iter().filter(|s| s.output == output) {
                stop::check();
                for at in series.range.clone().filter(|&at| after[at].is_finite()) {
                    samples += 1.0;
                    ahead += before[at] * before[at];
                    behind += after[at] * after[at];
                }
            }
            samples * (ahead.max(f64::MIN_POSITIVE) / behind.max(f64::MIN_POSITIVE)).ln()
        };
        (0..self.outputs).map(of_output).sum()
    }

    /// The residuals of time histories; NaN where there is no sample.
    pub(super) fn residual(&self, histories: &[TimeHistory]) -> Vec<f64> {
        let mut column = vec![f64::NAN; self.len];
        for Series {
            segment,
            output,
            range,
        } in &self.series
        {
            column[range.clone()].copy_from_slice(&histories[*segment].outputs[*output].residual);
        }
        column
    }

    pub(super) fn of_output<'c>(&self, column: &'c [f64], output: usize) -> Vec<&'c [f64]> {
        let of = self.series.iter().filter(|series| series.output == output);
        of.map(|series| &column[series.range.clone()]).collect()
    }
}

/// A model at one θ, as columns.
pub(super) struct Linearised {
    /// Measured minus model; NaN where there is no sample.
    pub residual: Vec<f64>,
    /// ∂y/∂ψ: by parameter a column over all segments, or by segment one where each has its own.
    pub sensitivities: Vec<Vec<f64>>,
}

/// ∂y/∂ψ at θ for the parameters of the model whose indices are `parameters`.
///
/// # Errors
/// The simulation leaves the range of numbers, or a derivative is not finite.
pub(super) fn sensitivities(
    problem: &Problem,
    layout: &Layout,
    theta: &[f64],
    parameters: &[usize],
) -> Result<Vec<Vec<f64>>, Unusable> {
    linearised(problem, layout, theta, parameters).map(|model| model.sensitivities)
}

/// Residual and sensitivities at θ for the parameters of the model whose indices are `parameters`.
///
/// # Errors
/// As [`sensitivities`].
pub(super) fn linearised(
    problem: &Problem,
    layout: &Layout,
    theta: &[f64],
    parameters: &[usize],
) -> Result<Linearised, Unusable> {
    let model = &problem.model;
    let options = &problem.options;
    let columns = Columns::new(model, parameters);
    let mut machinery = Sensitivities::new(
        model,
        &columns,
        options.integrator,
        options.input_interpolation,
    );
    // by parameter, then by segment where each has its own: where its column is
    let mut places: Vec<Vec<usize>> = Vec::new();
    let mut count = 0;
    for &parameter in parameters {
        let own = model.parameters[parameter].document.per == crate::model::Per::Maneuver;
        let of_segment = |segment: usize| count + if own { segment } else { 0 };
        places.push((0..problem.segments.len()).map(of_segment).collect());
        count += if own { problem.segments.len() } else { 1 };
    }
    let mut stacked = vec![vec![0.0; layout.len]; count];
    let mut residual = vec![f64::NAN; layout.len];
    let mut values = Vec::new();
    for (index, segment) in problem.segments.iter().enumerate() {
        problem.unknowns.parameters(index, theta, &mut values);
        let starts: Vec<usize> = (layout.series.iter())
            .filter(|series| series.segment == index)
            .map(|series| series.range.start)
            .collect();
        let run = machinery.run(segment, &values, |block| {
            for (output, start) in starts.iter().enumerate() {
                let of_output = columns.of_output(output);
                let measured = &segment.measured[output][block.first..];
                let at = start + block.first..start + block.first + block.len;
                for ((e, z), y) in residual[at]
                    .iter_mut()
                    .zip(measured)
                    .zip(block.output(output))
                {
                    *e = z - y;
                }
                for k in 0..block.len {
                    for (parameter, value) in of_output.iter().zip(block.row(output, k)) {
                        if let Some(at) = parameters.iter().position(|p| p == parameter) {
                            stacked[places[at][index]][start + block.first + k] = *value;
                        }
                    }
                }
            }
        });
        run.map_err(|diverged| Unusable::LeftRange {
            segment: index,
            sample: diverged.sample,
        })?;
    }
    let is_finite = |column: &Vec<f64>| {
        stop::check();
        column.iter().all(|value| value.is_finite())
    };
    if !stacked.iter().all(is_finite) {
        return Err(Unusable::NotFinite);
    }
    Ok(Linearised {
        residual,
        sensitivities: stacked,
    })
}
