//! Why an estimation cannot even begin, as faults of the spec.

use crate::estimate::{Estimator, Problem, Unusable};
use crate::flight::Fault;
use crate::model::Element;
use crate::simulate::{MOST_DELAY, Segment};

/// Why the start values lead nowhere.
pub(super) fn no_start(problem: &Problem, why: Unusable) -> Fault {
    match why {
        Unusable::LeftRange { segment, sample } => {
            let segment = &problem.segments[segment];
            let time = segment.time[sample.min(segment.len() - 1)];
            let message = format!(
                "with the start values the simulation leaves the range of numbers in segment {} at {time:.3} s (sample {}); give other \"start\" values, or a shorter stretch of \"rows\"",
                segment.label,
                sample + 1
            );
            Fault::new("/parameters", "diverged_at_start", message)
        }
        Unusable::NotFinite => {
            let message = "with the start values an output or its derivative by a parameter is not a finite number at some sample (a root, logarithm, power or quotient at zero?); give other \"start\" values, or guard the expression with if(...)";
            Fault::new("/parameters", "diverged_at_start", message)
        }
        Unusable::NoSteadyGain { segment } => no_gain(problem, segment),
        Unusable::Path { segment, place } => path_fault(problem, segment, place),
        Unusable::SingularNoise => {
            let message = "the residuals of some outputs are not independent, so that their full covariance is singular; use the structure \"diagonal\", or leave one of these outputs out";
            Fault::new("/options/noise", "singular_noise", message)
        }
        Unusable::NoMeasuredState => no_measured_state(problem),
        Unusable::NoBand => no_band(&problem.segments, problem.options.estimator),
    }
}

/// Why the filter has no steady gain at the start values.
fn no_gain(problem: &Problem, segment: usize) -> Fault {
    let message = format!(
        "with the start values the Kalman filter has no steady gain in segment {}: some motion is not damped and no noise drives it, or no output shows it; give its states process noise, leave out what no output shows, or give other \"start\" values",
        problem.segments[segment].label
    );
    Fault::new("/options/process_noise", "no_steady_gain", message)
}

/// Why an estimator of the frequency domain has nothing to look at.
pub(super) fn no_band(segments: &[Segment], estimator: Estimator) -> Fault {
    let longest = segments.iter().map(Segment::duration);
    let longest = longest.fold(0.0, f64::max);
    let message = format!(
        "the estimator \"{}\" needs a band of frequencies: say \"frequency\": {{\"band_hz\": [from, to]}}, from no less than some {:.2} Hz, of which the record has two periods, to where the motion ends, some 1 to 2 Hz for a rigid aircraft",
        estimator.name(),
        2.0 / longest
    );
    Fault::new("/options/frequency", "no_band", message)
}

/// Why equation error has no equation.
pub(super) fn no_measured_state(problem: &Problem) -> Fault {
    let pointer = match problem.options.estimator {
        estimator if estimator.is_equation_error() => "/options/estimator",
        _ => "/options/start",
    };
    let message = "equation error needs an output that measures a state: its equation is the state, possibly with a bias, scale or drift parameter; add such an output, or choose another";
    Fault::new(pointer, "no_measured_state", message)
}

/// The start values give an element of a path a size that it cannot have.
fn path_fault(problem: &Problem, segment: usize, place: usize) -> Fault {
    let (model, passed) = (&problem.model, problem.model.paths.elements()[place]);
    let (what, signal) = if model.paths.is_of_input(place) {
        ("input", &model.inputs[passed.signal])
    } else {
        ("output", &model.outputs[passed.signal])
    };
    let label = &problem.segments[segment].label;
    let (code, is) = match passed.element {
        Element::Delay => {
            let is = format!("more than {MOST_DELAY} samples of segment {label}");
            ("delay_too_long", is)
        }
        Element::RateLimit => ("path_out_of_bounds", "below 0, or no number".to_string()),
        Element::Play | Element::Lag => ("path_out_of_bounds", "no number".to_string()),
    };
    let message = format!(
        "with the start values the {} of the {what} '{}' is {is}; give other \"start\" values, or \"lower\" and \"upper\" bounds",
        passed.element.words(),
        signal.name
    );
    Fault::new("/parameters", code, message)
}
