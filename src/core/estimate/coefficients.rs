//! Nondimensional coefficients from an estimate's dimensional derivatives, error bounds carried over.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::estimate::report::estimate::Estimate;
use crate::estimate::report::parameter::ParameterEstimate;
use crate::flight::{self, Aircraft, Faults, Unit, WeightedSum};

/// A nondimensional stability or control derivative.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Coefficient {
    /// Its name, in the field's symbols.
    #[schema(example = "Cma")]
    pub name: String,
    /// The parameters of the model that it comes from.
    #[schema(example = json!(["Ma"]))]
    pub from: Vec<String>,
    /// A pure number.
    #[schema(example = -0.683)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub value: f64,
    /// From the error bounds of the parameters, correlations included; the aircraft's constants count as known.
    /// Absent where those are not known, or all are fixed.
    #[schema(example = 0.004)]
    pub standard_error: Option<f64>,
}

/// The coefficients of all derivatives among the parameters; see [`flight::coefficients`].
///
/// # Errors
/// Constants of the aircraft that are out of range, or needed and not given.
pub fn coefficients(estimate: &Estimate, aircraft: &Aircraft) -> Result<Vec<Coefficient>, Faults> {
    let faults = aircraft.faults();
    if !faults.is_empty() {
        return Err(faults.into());
    }
    let parameters = &estimate.parameters;
    let units: Vec<Unit> = (parameters.iter())
        .map(|parameter| Unit::parse(&parameter.unit).unwrap_or(Unit::NONE))
        .collect();
    let named: Vec<(&str, Unit)> = (parameters.iter().zip(&units))
        .map(|(parameter, &unit)| (parameter.name.as_str(), unit))
        .collect();
    let values: Vec<f64> = (parameters.iter().zip(&units))
        .map(|(parameter, unit)| unit.to_si(parameter.estimate))
        .collect();
    let sums = flight::coefficients(&named, aircraft)?;
    let coefficient = |sum: WeightedSum| Coefficient {
        from: (sum.terms.iter())
            .map(|&(i, _)| parameters[i].name.clone())
            .collect(),
        value: sum.value(&values),
        standard_error: deviation(estimate, &units, &sum.terms),
        name: sum.name,
    };
    Ok(sums.into_iter().map(coefficient).collect())
}

/// Standard error of a weighted sum of parameters; none where a free one has none.
fn deviation(estimate: &Estimate, units: &[Unit], terms: &[(usize, f64)]) -> Option<f64> {
    let parameters = &estimate.parameters;
    let place = |index: usize| {
        let is_free = |parameter: &&ParameterEstimate| !parameter.fixed;
        parameters[..index].iter().filter(is_free).count()
    };
    let free: Vec<(usize, f64)> = (terms.iter().copied())
        .filter(|&(i, _)| !parameters[i].fixed)
        .collect();
    let errors: Option<Vec<f64>> = (free.iter())
        .map(|&(i, weight)| Some(weight * units[i].scale * parameters[i].standard_error?))
        .collect();
    let errors = errors.filter(|errors| !errors.is_empty())?;
    let mut variance = 0.0;
    for (a, &(i, _)) in free.iter().enumerate() {
        for (b, &(j, _)) in free.iter().enumerate() {
            let correlation = if a == b {
                1.0
            } else {
                *estimate.correlation.get(place(i))?.get(place(j))?
            };
            variance += errors[a] * errors[b] * correlation;
        }
    }
    Some(variance.max(0.0).sqrt())
}
