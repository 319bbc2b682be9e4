//! The answer of an estimation in the frequency domain, put together at its last iterate.

use super::evaluator::FrequencyEvaluator;
use super::reduced::{Known, known};
use crate::estimate::accuracy::coloured_residuals::Colour;
use crate::estimate::accuracy::fit::histories_of;
use crate::estimate::accuracy::identifiability::data_information;
use crate::estimate::answer::table::{Accuracy, table};
use crate::estimate::answer::{Asked, Ending, Solution};
use crate::estimate::descent::Descent;
use crate::estimate::descent::iterate::Iterate;
use crate::estimate::evaluation::evaluate::Evaluate;
use crate::estimate::options::error_bounds::ErrorBoundsKind;
use crate::estimate::problem::Problem;
use crate::estimate::report::estimate::Estimate;
use crate::estimate::report::frequency::{FrequencyEstimate, FrequencyFit, SegmentBand};
use crate::estimate::report::history::TimeHistory;
use crate::estimate::report::identifiability::Identifiability;
use crate::spectral::Frequencies;

/// At the end of a descent in what was transformed of `base`: `asked` gives places in this, and `shown` is what is seen of it in the
/// time domain.
pub(super) fn answer(
    base: &Problem,
    descent: Descent<FrequencyEvaluator<'_>>,
    asked: Asked<'_>,
    shown: Vec<TimeHistory>,
) -> Solution {
    let Descent {
        mut evaluator,
        first_information,
        last: at,
        iterations,
        stopped,
    } = descent;
    let transformed = evaluator.transformed();
    let parameters = transformed.shared();
    let corrected = base.options.error_bounds == ErrorBoundsKind::Corrected;
    let (frequency, all) = (
        frequency(&mut evaluator, &at),
        known(&mut evaluator, &at, corrected),
    );
    let Known {
        information,
        bounds,
    } = all.unwrap_or_else(|| Known::nothing(parameters, &at.held));
    let held = &at.held[..parameters];
    let own = base.unknowns.with_held(|unknown| {
        let place = base
            .unknowns
            .place(unknown.segment.unwrap_or(0), unknown.parameter);
        place.is_none_or(|place| transformed.place(place).is_none())
    });
    // the problem whose θ is what the frequency response sees
    let seen = Problem {
        unknowns: own,
        ..base.clone()
    };
    let data = |matrix: &nalgebra::DMatrix<f64>| data_information(&seen, matrix);
    let before = (first_information.as_ref())
        .and_then(|first| super::reduced::information(first, parameters))
        .and_then(|first| data(&first));
    let estimates = base.options.max_iterations > 0;
    let accuracy = Accuracy::new(&seen.unknowns, &information, held, &bounds);
    let of_base = asked.solved;
    let asked = Asked {
        solved: &|place: usize| of_base(place).and_then(|of| transformed.place(of)),
        ..asked
    };
    let accuracy = accuracy.seen_from(asked.theta.len(), asked.solved);
    // what no simulation follows, as an unstable aircraft, has no time histories
    let is_shown = (shown.iter().flat_map(|history| &history.outputs))
        .all(|output| output.model.iter().all(|y| y.is_finite()));
    let fitted = match is_shown {
        true => shown,
        false => histories_of(base, |_, segment| segment.measured.clone()),
    };
    let distance = stopped.distance();
    let ending = Ending {
        problem: &seen,
        theta: &at.theta[..parameters],
        stopped,
        iterations,
        evaluations: evaluator.evaluations,
        simulations: evaluator.simulations,
        weighting: &at.weighting,
        held,
        bounds: &bounds,
        histories: &fitted,
        colour: &Colour::of(&fitted),
    };
    let mut estimate = Estimate {
        parameters: table(asked.problem, &asked.theta, &accuracy),
        correlation: asked.correlation(&seen, &bounds),
        identifiability: before.map(|before| Identifiability {
            before,
            after: estimates.then(|| data(&information)).flatten(),
        }),
        frequency: Some(frequency),
        ..ending.estimate(|place| seen.name_and_scale(place))
    };
    if !is_shown {
        estimate.outputs.clear();
        estimate.reason += "; with these parameters a simulation leaves the range of numbers, so that there are no time histories";
    }
    Solution {
        covariance: at.weighting.covariance.clone(),
        distance,
        theta: asked.theta,
        histories: if is_shown { fitted } else { Vec::new() },
        estimate,
    }
}

/// What was compared, and how well it is reproduced.
fn frequency(evaluator: &mut FrequencyEvaluator<'_>, at: &Iterate) -> FrequencyEstimate {
    let transformed = evaluator.transformed();
    let problem = &transformed.problem;
    let outputs = problem.model.outputs.len();
    let mut measured = vec![0.0; outputs];
    for spectra in &transformed.spectra {
        for (sum, transform) in measured.iter_mut().zip(&spectra.outputs) {
            *sum += transform.iter().map(|z| z.norm_sqr()).sum::<f64>();
        }
    }
    // the last iterate was looked at before: what fails here failed there
    let left = evaluator.residuals(&at.theta).ok();
    let fit = |(i, output): (usize, &crate::model::Quantity)| {
        let left = left.as_ref().map_or(f64::NAN, |sums| sums[(i, i)]);
        FrequencyFit {
            name: output.name.clone(),
            r_squared: if measured[i] > 0.0 {
                1.0 - left / measured[i]
            } else {
                0.0
            },
            noise: (left / problem.counts[i] as f64).sqrt(),
        }
    };
    let bands = problem.segments.iter().zip(&transformed.spectra);
    FrequencyEstimate {
        outputs: problem.model.outputs.iter().enumerate().map(fit).collect(),
        segments: bands
            .map(|(segment, spectra)| {
                let Frequencies { first, step, count } = spectra.frequencies;
                SegmentBand {
                    segment: segment.label.clone(),
                    first_hz: first,
                    step_hz: step,
                    frequencies: count,
                    independent: spectra.independent,
                }
            })
            .collect(),
        ends_and_trends: problem.unknowns.len() - transformed.shared(),
        linear: problem.model.is_linear(),
    }
}
