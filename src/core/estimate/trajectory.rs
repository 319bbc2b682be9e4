//! Everything along the trajectory: states, definitions and outputs at an estimate, with the standard errors that those of
//! the parameters carry over to them.
//!
//! With P the covariance of θ, y any quantity of the model: σ²(t) = ∂y/∂θ(t) P ∂y/∂θ(t)ᵀ, the derivatives by forward
//! sensitivities (Maine and Iliff, NASA RP 1168, 1986, chapter 11, for outputs). A quantity is an output of the model
//! compiled once more: there is one way to write models, and one to simulate them.

use nalgebra::DVector;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::accuracy::covariance::Estimated;
use super::problem::Problem;
use super::problem::unusable::Unusable;
use super::report::estimate::Estimate;
use crate::flight::Unit;
use crate::model::{Model, ModelDocument, Output};
use crate::simulate::{Columns, Segment, Sensitivities};

/// What a quantity is in the model.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum QuantityKind {
    /// x
    State,
    /// A named intermediate quantity: a coefficient, a flow angle, a dynamic pressure.
    Definition,
    /// y, delays and lags of its path included.
    Output,
}

/// One quantity along one segment.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct TrajectorySeries {
    /// As the model calls it.
    #[schema(example = "CL")]
    pub name: String,
    /// What it is in the model.
    pub kind: QuantityKind,
    /// SI
    #[schema(example = "-")]
    pub unit: String,
    /// At each sample, in `unit`.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub values: Vec<f64>,
    /// One standard error of `values`, from the covariance of the parameters; inputs count as known. Empty where it depends
    /// on a parameter that has no standard error, and where the estimate is singular: then the parameters have no covariance.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub standard_errors: Vec<f64>,
}

/// States, definitions and outputs along one segment.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Trajectory {
    /// The segment's label.
    #[schema(example = "elevator")]
    pub segment: String,
    /// Seconds of the recording.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub time: Vec<f64>,
    /// States, then definitions, then outputs, in the order of the model.
    pub quantities: Vec<TrajectorySeries>,
}

/// Outputs of a model that is compiled to see quantities.
pub(super) const AT_ONCE: usize = 60;

/// All quantities of a problem's model along its segments, at an estimate of the problem.
///
/// # Errors
/// The simulation leaves the range of numbers.
pub fn trajectories(problem: &Problem, estimate: &Estimate) -> Result<Vec<Trajectory>, Unusable> {
    let at = Estimated::of(problem, estimate);
    along_all(problem, &at, &quantities(&problem.model.document))
}

/// Some quantities along all segments of a problem.
pub(super) fn along_all(
    problem: &Problem,
    at: &Estimated,
    wanted: &[Quantity],
) -> Result<Vec<Trajectory>, Unusable> {
    let mut trajectories: Vec<Trajectory> = (problem.segments.iter())
        .map(|segment| Trajectory {
            segment: segment.label.clone(),
            time: segment.time.clone(),
            quantities: Vec::new(),
        })
        .collect();
    for some in wanted.chunks(AT_ONCE) {
        let document = seen(&problem.model.document, some);
        // the document was compiled before: with other outputs it cannot fail, and there is nothing to show if it did
        let Ok(model) = Model::compile(&document) else {
            continue;
        };
        for (index, trajectory) in trajectories.iter_mut().enumerate() {
            let series = at.along(problem, &model, some, index)?;
            trajectory.quantities.extend(series);
        }
    }
    Ok(trajectories)
}

/// A quantity to be seen.
pub(super) struct Quantity {
    pub name: String,
    kind: QuantityKind,
    output: Output,
}

pub(super) fn quantities(document: &ModelDocument) -> Vec<Quantity> {
    let plain = |name: &String, unit: &String, kind: QuantityKind| Quantity {
        name: name.clone(),
        kind,
        output: Output {
            unit: unit.clone(),
            equation: name.clone(),
            ..Output::default()
        },
    };
    let states =
        (document.states.iter()).map(|(name, state)| plain(name, &state.unit, QuantityKind::State));
    let definitions = (document.definitions.iter())
        .map(|(name, definition)| plain(name, &definition.unit, QuantityKind::Definition));
    let outputs = document.outputs.iter().map(|(name, output)| Quantity {
        name: name.clone(),
        kind: QuantityKind::Output,
        output: output.clone(),
    });
    states.chain(definitions).chain(outputs).collect()
}

/// The document with quantities as its outputs.
pub(super) fn seen(document: &ModelDocument, quantities: &[Quantity]) -> ModelDocument {
    let mut document = document.clone();
    let outputs = quantities.iter().enumerate();
    document.outputs = outputs
        .map(|(number, quantity)| (format!("quantity_{number}"), quantity.output.clone()))
        .collect();
    document
}

impl Estimated {
    fn along(
        &self,
        problem: &Problem,
        model: &Model,
        quantities: &[Quantity],
        index: usize,
    ) -> Result<Vec<TrajectorySeries>, Unusable> {
        let unknowns = &self.unknowns;
        let free: Vec<usize> = (0..model.parameters.len())
            .filter(|&parameter| unknowns.place(index, parameter).is_some())
            .collect();
        let columns = Columns::new(model, &free);
        let options = &problem.options;
        let mut machinery = Sensitivities::new(
            model,
            &columns,
            options.integrator,
            options.input_interpolation,
        );
        let segment = Segment {
            measured: vec![vec![f64::NAN; problem.segments[index].len()]; quantities.len()],
            ..problem.segments[index].clone()
        };
        let mut series: Vec<TrajectorySeries> = quantities.iter().map(empty).collect();
        let mut parameters = Vec::new();
        unknowns.parameters(index, &self.theta, &mut parameters);
        // a quantity that depends on what has no standard error has none
        let mut is_told = vec![true; quantities.len()];
        let run = machinery.run(&segment, &parameters, |block| {
            for (output, series) in series.iter_mut().enumerate() {
                series.values.extend_from_slice(block.output(output));
                let places: Vec<usize> = (columns.of_output(output).iter())
                    .filter_map(|&parameter| unknowns.place(index, parameter))
                    .collect();
                let among = self.among(&places);
                for k in 0..block.len {
                    let row = block.row(output, k);
                    is_told[output] &= self.is_known(&places, row);
                    let row = DVector::from_column_slice(row);
                    let variance = row.dot(&(&among * &row));
                    series.standard_errors.push(variance.max(0.0).sqrt());
                }
            }
        });
        run.map_err(|diverged| Unusable::LeftRange {
            segment: index,
            sample: diverged.sample,
        })?;
        for (series, _) in series
            .iter_mut()
            .zip(is_told)
            .filter(|(_, is_told)| !is_told)
        {
            series.standard_errors.clear();
        }
        Ok(series)
    }
}

fn empty(quantity: &Quantity) -> TrajectorySeries {
    TrajectorySeries {
        name: quantity.name.clone(),
        kind: quantity.kind,
        unit: Unit::si_name(&quantity.output.unit),
        values: Vec::new(),
        standard_errors: Vec::new(),
    }
}
