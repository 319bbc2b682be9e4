//! The estimate that intervals are about: the problem as it was stepped, its outputs, its residuals and their colour.

use crate::estimate::accuracy::absorbed::absorbed;
use crate::estimate::accuracy::coloured_residuals::Colour;
use crate::estimate::accuracy::covariance::Estimated;
use crate::estimate::accuracy::fit::histories;
use crate::estimate::answer::Solution;
use crate::estimate::evaluation::evaluator::Evaluator;
use crate::estimate::options::Method;
use crate::estimate::options::technique::Derivatives;
use crate::estimate::problem::Problem;
use crate::estimate::problem::substeps::no_longer;
use crate::estimate::report::history::{OutputSeries, TimeHistory};

/// Refits end where a further step would be shorter than this, standard errors: its square is what it costs in -ln L.
const TOLERANCE: f64 = 0.01;

pub(super) struct Fitted {
    /// Its unknowns start at the estimate.
    pub problem: Problem,
    pub theta: Vec<f64>,
    /// By place, SI: conventional standard errors, and those of the kind that the job asked for.
    pub conventional: Vec<Option<f64>>,
    pub standard_errors: Vec<Option<f64>>,
    pub histories: Vec<TimeHistory>,
    /// Of the noise that left these residuals, with what the fit absorbed of it.
    pub colour: Colour,
    /// By output: by how much the fit made residuals smaller than the noise, as a factor above 1.
    pub shrunk: Vec<f64>,
}

impl Fitted {
    pub(super) fn of(problem: &Problem, solution: &Solution) -> Self {
        let estimated = Estimated::of(problem, &solution.estimate);
        let stepped = as_stepped(problem, solution, &estimated);
        let theta = estimated.theta.clone();
        let row = |place: usize| solution.row(&problem.unknowns, place);
        let places: Vec<usize> = (0..theta.len()).collect();
        let in_si = |place: usize, error: Option<f64>| {
            let error = error? * problem.unit(place).scale.abs();
            (error.is_finite() && error > 0.0).then_some(error)
        };
        let histories = histories(&stepped, &theta);
        let covariance = estimated.among(&places);
        let absorbed = absorbed(&mut Evaluator::new(&stepped), &theta, &covariance);
        let absorbed = absorbed.unwrap_or_default();
        Self {
            colour: Colour::of_noise(&histories, &absorbed),
            shrunk: shrunk(&histories, &absorbed),
            conventional: (places.iter())
                .map(|&place| in_si(place, row(place).conventional_standard_error))
                .collect(),
            standard_errors: (places.iter())
                .map(|&place| in_si(place, row(place).standard_error))
                .collect(),
            problem: stepped,
            theta,
            histories,
        }
    }

    /// y(θ̂) of a segment, by output.
    pub(super) fn modelled(&self, segment: usize) -> impl Iterator<Item = &[f64]> {
        let outputs = self.histories[segment].outputs.iter();
        outputs.map(|output| output.model.as_slice())
    }

    /// Samples of an output that have a value, over all segments.
    pub(super) fn count(&self, output: usize) -> usize {
        self.problem.counts[output]
    }
}

/// The problem with the integration steps of the estimate, to be fitted quickly from there.
fn as_stepped(problem: &Problem, solution: &Solution, at: &Estimated) -> Problem {
    let mut own = problem.clone();
    own.unknowns = at.unknowns.clone();
    own.options.confidence_intervals = None;
    own.options.tolerance = TOLERANCE;
    // so near to the minimum there is nothing to damp
    own.options.method = Method::GaussNewton;
    if matches!(own.options.derivatives, Derivatives::Adjoint { .. }) {
        own.options.derivatives = Derivatives::default();
    }
    let integration = solution.estimate.integration.iter();
    let counts = integration.flat_map(|integration| &integration.steps_per_sample);
    for (segment, &count) in own.segments.iter_mut().zip(counts) {
        if count > segment.most_substeps() {
            segment.substeps = no_longer(segment, segment.steps.longest() / count as f64);
        }
    }
    own
}

/// √(1 + what was absorbed over what is left), by output.
fn shrunk(histories: &[TimeHistory], absorbed: &[Vec<f64>]) -> Vec<f64> {
    let outputs = histories.first().map_or(0, |history| history.outputs.len());
    let left = |output: usize| {
        let series = histories.iter().map(|h: &TimeHistory| &h.outputs[output]);
        let residuals = series.flat_map(|series: &OutputSeries| &series.residual);
        let finite = residuals.filter(|e| e.is_finite());
        finite.map(|e| e * e).sum::<f64>()
    };
    let factor = |output: usize| {
        let gone = absorbed.get(output).and_then(|lags| lags.first());
        let factor = (1.0 + gone.copied().unwrap_or(0.0) / left(output)).sqrt();
        if factor.is_finite() { factor } else { 1.0 }
    };
    (0..outputs).map(factor).collect()
}
