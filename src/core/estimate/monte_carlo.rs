//! Monte Carlo over the covariance of the parameters: θ is drawn from N(θ̂, P), the model simulated with each draw, and
//! each quantity has the range of the middle 95 of 100 draws, sample by sample.
//!
//! Where a model is far from linear in its parameters this range is not that of 2 standard errors.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::accuracy::covariance::Estimated;
use super::problem::Problem;
use super::trajectory::{AT_ONCE, Quantity, seen};
use crate::model::Model;
use crate::simulate::{Outputs, Segment, path_out_of_bounds};

/// Draws that a question may ask for.
pub const DRAWS: std::ops::RangeInclusive<usize> = 40..=10_000;

/// Values of all draws of one segment, at most: they are in memory together.
pub(crate) const MOST_DRAWN: usize = 20_000_000;

/// Values of all draws of all segments, at most: seconds, not minutes.
pub(crate) const MOST_DRAWN_IN_ALL: usize = 100_000_000;

/// How many draws, and of which numbers.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct MonteCarlo {
    /// From 40 to 10000.
    #[serde(default = "draws")]
    #[schema(example = 500, minimum = 40, maximum = 10000)]
    pub draws: usize,
    /// The same seed gives the same numbers.
    #[serde(default)]
    #[schema(example = 1)]
    pub seed: u64,
}

fn draws() -> usize {
    500
}

/// The range of one quantity along one segment: the 2.5 and the 97.5 percentile of the draws at each sample.
#[derive(Clone, PartialEq, Debug, Default)]
pub(crate) struct Range {
    pub lower: Vec<f64>,
    pub upper: Vec<f64>,
}

/// Of each segment: the range of each quantity, and how many draws the simulation could not follow, which do not count.
pub(crate) fn ranges(
    problem: &Problem,
    at: &Estimated,
    quantities: &[Quantity],
    question: MonteCarlo,
) -> Vec<(Vec<Range>, usize)> {
    let drawn = drawn(at, question);
    let mut all = vec![(Vec::new(), 0); problem.segments.len()];
    for some in quantities.chunks(AT_ONCE) {
        // the document was compiled before: with other outputs it cannot fail
        let Ok(model) = Model::compile(&seen(&problem.model.document, some)) else {
            continue;
        };
        for (index, (ranges, lost)) in all.iter_mut().enumerate() {
            let (found, without) = of_segment(problem, &model, at, index, &drawn);
            ranges.extend(found);
            *lost = without.max(*lost);
        }
    }
    all
}

/// θ of each draw, within the bounds of the parameters.
fn drawn(at: &Estimated, question: MonteCarlo) -> Vec<Vec<f64>> {
    let mut random = ChaCha8Rng::seed_from_u64(question.seed);
    let root = at.covariance_root();
    let draw = |_| {
        let normal: Vec<f64> = (0..root.ncols())
            .map(|_| StandardNormal.sample(&mut random))
            .collect();
        let change = &root * nalgebra::DVector::from_vec(normal);
        let moved = at.theta.iter().zip(change.iter()).enumerate();
        moved
            .map(|(place, (value, change))| {
                let unknown = at.unknowns.at(place);
                (value + change).clamp(unknown.lower, unknown.upper)
            })
            .collect()
    };
    (0..question.draws).map(draw).collect()
}

fn of_segment(
    problem: &Problem,
    model: &Model,
    at: &Estimated,
    index: usize,
    drawn: &[Vec<f64>],
) -> (Vec<Range>, usize) {
    let segment = Segment {
        measured: Vec::new(),
        ..problem.segments[index].clone()
    };
    let options = &problem.options;
    let mut machinery = Outputs::new(model, options.integrator, options.input_interpolation);
    let outputs = model.outputs.len();
    // by output and sample: the values of all draws
    let mut values = vec![vec![Vec::with_capacity(drawn.len()); segment.len()]; outputs];
    let mut parameters = Vec::new();
    let mut lost = 0;
    for theta in drawn {
        at.unknowns.parameters(index, theta, &mut parameters);
        let mut run = vec![Vec::with_capacity(segment.len()); outputs];
        let is_possible = path_out_of_bounds(model, &segment, &parameters).is_none();
        let followed = is_possible
            && machinery
                .run(&segment, &parameters, |_, y| {
                    let series = run.iter_mut().zip(y);
                    series.for_each(|(series, y): (&mut Vec<f64>, _)| series.extend_from_slice(y));
                })
                .is_ok();
        if !followed || run.iter().flatten().any(|value| !value.is_finite()) {
            lost += 1;
            continue;
        }
        for (output, series) in run.iter().enumerate() {
            for (sample, value) in series.iter().enumerate() {
                values[output][sample].push(*value);
            }
        }
    }
    (
        values.iter_mut().map(|samples| range(samples)).collect(),
        lost,
    )
}

/// The percentiles at each sample; empty where fewer draws are left than tell them.
fn range(samples: &mut [Vec<f64>]) -> Range {
    let mut range = Range::default();
    for drawn in samples {
        if drawn.len() < *DRAWS.start() {
            return Range::default();
        }
        drawn.sort_by(f64::total_cmp);
        range.lower.push(percentile(drawn, 0.025));
        range.upper.push(percentile(drawn, 0.975));
    }
    range
}

/// Between the two order statistics at its sides (Hyndman and Fan's definition 7, which numpy has).
pub(super) fn percentile(sorted: &[f64], share: f64) -> f64 {
    let at = share * (sorted.len() - 1) as f64;
    let (below, above) = (at.floor() as usize, at.ceil() as usize);
    sorted[below] + (at - at.floor()) * (sorted[above] - sorted[below])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// numpy.percentile(range(41), [2.5, 97.5])
    #[test]
    fn percentiles_are_those_of_numpy() {
        let sorted: Vec<f64> = (0..41).map(f64::from).collect();
        assert_eq!(percentile(&sorted, 0.025), 1.0);
        assert_eq!(percentile(&sorted, 0.975), 39.0);
        let few: Vec<f64> = vec![0.0, 1.0, 4.0];
        assert!((percentile(&few, 0.975) - 3.85).abs() < 1e-12);
    }
}
