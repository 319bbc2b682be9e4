//! How many integration steps lie between two samples: as many as are asked for, or as the fastest motion needs.

use super::unknowns::Unknowns;
use crate::estimate::options::Options;
use crate::estimate::options::steps::StepsPerSample;
use crate::model::Model;
use crate::simulate::{Integrator, Rates, Segment, StateMatrixAt, Steps, Substeps, initial_state};

/// Largest |λ| h of a step that is not looked at more closely: there the classical method errs by less than a hundredth
/// of λ. It becomes unstable at 2.8.
pub(crate) const REACH: f64 = 1.0;

/// Whether the number of steps is for us to choose.
pub(crate) fn is_automatic(options: &Options) -> bool {
    matches!(options.steps_per_sample, StepsPerSample::Auto(_))
        && options.integrator == Integrator::Rk4
}

/// The steps of a segment to begin with, for start values: all parameters of the model, SI. Where the segment has finer
/// ones already, an automatic choice leaves it those.
pub(super) fn chosen(
    model: &Model,
    segment: &Segment,
    parameters: &[f64],
    options: &Options,
) -> Substeps {
    if let StepsPerSample::Number(count) = options.steps_per_sample {
        return Substeps::Each(count);
    }
    if !is_automatic(options) || segment.is_empty() {
        return segment.substeps;
    }
    let rates = StateMatrixAt::new(model, parameters).rates_at_start(segment, parameters);
    let needed = within_reach(segment, rates);
    if rates.stay_in_range(segment.duration())
        && needed.within(segment.steps.longest()) > segment.most_substeps()
    {
        needed
    } else {
        segment.substeps
    }
}

/// Steps with which the fastest motion is within reach.
pub(crate) fn within_reach(segment: &Segment, rates: Rates) -> Substeps {
    let longest = segment.steps.longest();
    if rates.fastest * longest <= REACH {
        return Substeps::Each(1);
    }
    no_longer(segment, REACH / rates.fastest)
}

/// Steps of at most this length, as far as there may be so many.
pub(crate) fn no_longer(segment: &Segment, length: f64) -> Substeps {
    let longest = segment.steps.longest();
    let length = length.max(longest / StepsPerSample::MOST as f64);
    match segment.steps {
        Steps::Even(step) => Substeps::Each(Substeps::NoLonger(length).within(step)),
        Steps::Uneven(_) => Substeps::NoLonger(length),
    }
}

/// Steps that are shorter by a factor; at least one more between the samples that are farthest apart.
pub(crate) fn shortened(segment: &Segment, factor: f64) -> Substeps {
    let most = segment.most_substeps();
    let count = ((most as f64 * factor).ceil() as usize).max(most + 1);
    match segment.substeps {
        Substeps::Each(_) => Substeps::Each(count.min(StepsPerSample::MOST)),
        Substeps::NoLonger(_) => no_longer(segment, segment.steps.longest() / count as f64),
    }
}

/// Steps of half the length, in number twice as many.
pub(crate) fn halved(segment: &Segment) -> Substeps {
    match segment.substeps {
        Substeps::Each(count) => Substeps::Each(2 * count.max(1)),
        Substeps::NoLonger(length) => Substeps::NoLonger(0.5 * length),
    }
}

/// A motion that no number of steps that may be taken can follow.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct TooStiff {
    /// Index of the segment.
    pub segment: usize,
    /// Index of the state that decays fastest by itself.
    pub state: usize,
    /// The largest |λ|, 1/s.
    pub rate: f64,
    /// Steps from one sample to the next that it would take.
    pub steps: f64,
}

/// Most integration steps of an evaluation that the choice may lead to.
const MOST_IN_ALL: f64 = 1e8;

/// The first segment whose motion at the start values is too fast for the steps that may be chosen.
pub(super) fn too_stiff(
    model: &Model,
    segments: &[Segment],
    unknowns: &Unknowns,
    options: &Options,
) -> Option<TooStiff> {
    if !is_automatic(options) {
        return None;
    }
    let (theta, mut parameters) = (unknowns.start(), Vec::new());
    let mut all = 0.0;
    for (index, segment) in segments.iter().enumerate() {
        unknowns.parameters(index, &theta, &mut parameters);
        let mut matrix = StateMatrixAt::new(model, &parameters);
        let rates = matrix.rates_at_start(segment, &parameters);
        if !rates.stay_in_range(segment.duration()) {
            // the simulation itself tells where it ends
            continue;
        }
        let rate = rates.fastest;
        let steps = rate * segment.steps.longest() / REACH;
        all += steps.max(1.0) * segment.len() as f64;
        if steps > StepsPerSample::MOST as f64 || all > MOST_IN_ALL {
            let state = initial_state(model, &parameters);
            let matrix = matrix.at(segment, 0, &state);
            return Some(TooStiff {
                segment: index,
                state: matrix.diagonal().icamax(),
                rate,
                steps,
            });
        }
    }
    None
}
