//! Identifiability of the parameters, from the sensitivities alone: before an estimation, at the start values, and
//! after it.
//!
//! Sensitivities are weighted by R^(-1/2) and their columns scaled to length 1, so that units do not count. Singular
//! values that are zero to rounding mean exact redundancy; small ones near collinearity, which is traced to
//! parameters by variance-decomposition proportions (Belsley, Kuh, Welsch 1980, ch. 3).

use nalgebra::{DMatrix, DVector};

use crate::estimate::linear::spectrum::Spectrum;
use crate::estimate::problem::Problem;
use crate::estimate::report::collinear::CollinearSet;
use crate::estimate::report::identifiability::{
    CorrelatedPair, DataInformation, NearlyCollinearSet,
};

/// Condition indices above this are a strong near dependency (Belsley, Kuh, Welsch: 30 to 100).
const STRONG_CONDITION_INDEX: f64 = 30.0;

/// Two parameters are part of a near dependency when it makes up this share of their variances.
const LARGE_PROPORTION: f64 = 0.5;

/// Correlations above this are worth a name.
const HIGH_CORRELATION: f64 = 0.99;

/// From the information matrix over all free unknowns; `None` where it cannot be decomposed.
pub(crate) fn data_information(
    problem: &Problem,
    information: &DMatrix<f64>,
) -> Option<DataInformation> {
    let spectrum = Spectrum::of(information, &information.diagonal())?;
    let mut singular_values: Vec<f64> = spectrum.values.iter().map(|v| v.max(0.0).sqrt()).collect();
    singular_values.sort_by(|a, b| b.total_cmp(a));
    let seen = (0..spectrum.values.len()).all(|i| spectrum.is_seen(i));
    let condition_number = match (singular_values.first(), singular_values.last()) {
        (Some(largest), Some(smallest)) if seen => largest / smallest,
        (None, _) => 1.0,
        _ => f64::NAN,
    };
    let (single, redundant): (Vec<_>, Vec<_>) =
        (spectrum.collinear().into_iter()).partition(|set| set.len() == 1);
    Some(DataInformation {
        singular_values,
        condition_number,
        unseen: single.iter().map(|set| problem.name(set[0].0)).collect(),
        redundant: redundant
            .iter()
            .map(|set| CollinearSet::named(set, |place| problem.name_and_scale(place)))
            .collect(),
        nearly_collinear: nearly_collinear(problem, &spectrum),
        highly_correlated: highly_correlated(problem, &spectrum),
    })
}

/// Near dependencies: directions of a high condition index that make up most of at least two variances. Where
/// several compete for the same parameters, so that none has most of them, they are taken together.
fn nearly_collinear(problem: &Problem, spectrum: &Spectrum) -> Vec<NearlyCollinearSet> {
    let unknowns = spectrum.values.len();
    let largest = spectrum.values.iter().copied().fold(0.0, f64::max);
    let seen: Vec<usize> = (0..unknowns).filter(|&k| spectrum.is_seen(k)).collect();
    let part = |j: usize, k: usize| spectrum.vectors[(j, k)].powi(2) / spectrum.values[k];
    let variance: Vec<f64> = (0..unknowns)
        .map(|j| seen.iter().map(|&k| part(j, k)).sum())
        .collect();
    let index = |k: usize| (largest / spectrum.values[k]).sqrt();
    let set = |directions: &[usize]| -> Option<NearlyCollinearSet> {
        let share = |j: usize| directions.iter().map(|&k| part(j, k)).sum::<f64>() / variance[j];
        let members: Vec<usize> = (0..unknowns)
            .filter(|&j| spectrum.scale[j] > 0.0 && share(j) > LARGE_PROPORTION)
            .collect();
        (members.len() > 1).then(|| NearlyCollinearSet {
            parameters: members.iter().map(|&j| problem.name(j)).collect(),
            condition_index: directions.iter().map(|&k| index(k)).fold(0.0, f64::max),
            variance_proportions: members.iter().map(|&j| share(j)).collect(),
        })
    };
    let mut weak: Vec<usize> = seen
        .iter()
        .copied()
        .filter(|&k| index(k) > STRONG_CONDITION_INDEX)
        .collect();
    weak.sort_by(|&a, &b| spectrum.values[a].total_cmp(&spectrum.values[b]));
    let (alone, competing): (Vec<usize>, Vec<usize>) =
        weak.into_iter().partition(|&k| set(&[k]).is_some());
    let sets = alone.iter().filter_map(|&k| set(&[k]));
    sets.chain(set(&competing)).collect()
}

fn highly_correlated(problem: &Problem, spectrum: &Spectrum) -> Vec<CorrelatedPair> {
    let covariance = spectrum.inverse();
    let deviation: DVector<f64> = covariance.diagonal().map(f64::sqrt);
    let redundant = spectrum.collinear();
    let is_redundant = |i: usize| redundant.iter().flatten().any(|member| member.0 == i);
    let unknowns: Vec<usize> = (0..deviation.len()).filter(|&i| !is_redundant(i)).collect();
    let mut pairs = Vec::new();
    for (a, &i) in unknowns.iter().enumerate() {
        for &j in &unknowns[a + 1..] {
            let correlation = covariance[(i, j)] / (deviation[i] * deviation[j]);
            if correlation.abs() > HIGH_CORRELATION {
                pairs.push(CorrelatedPair {
                    parameters: [problem.name(i), problem.name(j)],
                    correlation,
                });
            }
        }
    }
    pairs
}
