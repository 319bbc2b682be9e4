//! Where the filter begins: R from the scatter of the measurements, intensities from R.

use nalgebra::DMatrix;

use super::gain::{Gain, Setting};
use crate::estimate::likelihood::weighting::Weighting;
use crate::estimate::options::{Noise, NoiseStructure};
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;

/// The share of a state's prediction error that a sample is to take away to begin with.
const START_SHARE: f64 = 0.3;

/// Steps ahead in which a state that no output shows directly may show.
const STEPS_AHEAD: usize = 20;

/// R to begin with: half the mean square of the change from value to value. This needs no simulation, which with an
/// unstable model would leave the range of numbers.
pub(super) fn gain_noise(problem: &Problem) -> Result<Weighting, Unusable> {
    let squares: Vec<f64> = (problem.counts.iter().enumerate())
        .map(|(output, &count)| scatter(problem, output) * count as f64)
        .collect();
    let sums = DMatrix::from_diagonal(&nalgebra::DVector::from_vec(squares));
    let noise = match &problem.options.noise {
        Noise::Given { variance } => Noise::Given {
            variance: variance.clone(),
        },
        Noise::Estimated { .. } => Noise::Estimated {
            structure: NoiseStructure::Diagonal,
        },
    };
    Weighting::new(&noise, &sums, &problem.counts)
}

/// Half the mean square of the change from each value of an output to the next one that is there.
fn scatter(problem: &Problem, output: usize) -> f64 {
    let mut squares = Vec::new();
    for segment in &problem.segments {
        let values = segment.measured[output].iter().filter(|z| !z.is_nan());
        let values: Vec<f64> = values.copied().collect();
        squares.extend(values.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)));
    }
    0.5 * squares.iter().sum::<f64>() / squares.len().max(1) as f64
}

/// Start values of the intensities, by state, SI: with f² Δt Σ_j C_ji²/r_j = share² a state that hardly moves by
/// itself is corrected by about that share.
pub(super) fn automatic_intensities(
    problem: &Problem,
    noise: &Weighting,
) -> Result<Vec<f64>, Unusable> {
    let states = problem.model.states.len();
    let Some(segment) = problem.segments.first() else {
        return Ok(vec![0.0; states]);
    };
    let mut parameters = Vec::new();
    let theta = problem.unknowns.start();
    problem.unknowns.parameters(0, &theta, &mut parameters);
    let undisturbed = Gain::steady(&Setting {
        model: &problem.model,
        segment,
        parameters: &parameters,
        intensities: &vec![0.0; states],
        weight: &noise.inverse,
    })
    .ok_or(Unusable::NoSteadyGain { segment: 0 })?;
    let step = segment.steps.length(0);
    let ahead = DMatrix::identity(states, states) + &undisturbed.a * step;
    let mut shown = vec![0.0_f64; states];
    let mut seen = undisturbed.c.clone();
    for _ in 0..STEPS_AHEAD {
        let information = (seen.transpose() * &noise.inverse * &seen).diagonal();
        for (shown, &now) in shown.iter_mut().zip(&information) {
            if now.is_finite() {
                *shown = shown.max(now);
            }
        }
        seen *= &ahead;
    }
    let start = |&shown: &f64| {
        if shown > 0.0 {
            START_SHARE / (shown * step).sqrt()
        } else {
            1.0
        }
    };
    Ok(shown.iter().map(start).collect())
}
