//! An estimate along other recordings: simulated with their inputs, with the bounds that the covariance of the parameters
//! carries over, and compared with what they have of the outputs.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::accuracy::coloured_residuals::Colour;
use super::accuracy::covariance::Estimated;
use super::accuracy::fit::{fits, histories};
use super::monte_carlo::{MOST_DRAWN, MOST_DRAWN_IN_ALL, MonteCarlo, Range, ranges};
use super::problem::Problem;
use super::problem::unusable::Unusable;
use super::report::estimate::Estimate;
use super::report::fit::OutputFit;
use super::report::history::TimeHistory;
use super::trajectory::{Quantity, QuantityKind, TrajectorySeries, along_all, quantities};

/// One quantity along one segment, with its bounds.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct SimulatedQuantity {
    /// As the model calls it.
    #[schema(example = "alpha")]
    pub name: String,
    /// What it is in the model.
    pub kind: QuantityKind,
    /// SI
    #[schema(example = "rad")]
    pub unit: String,
    /// At each sample, in `unit`.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub values: Vec<f64>,
    /// One standard error of `values`, from the covariance of the parameters to first order; inputs and what belongs to a
    /// maneuver count as known. Empty where it depends on a parameter that has no standard error.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub standard_errors: Vec<f64>,
    /// The 2.5 percentile of the draws; empty where none were asked for, or too few could be followed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub lower: Vec<f64>,
    /// The 97.5 percentile of the draws.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub upper: Vec<f64>,
}

/// One segment, simulated.
#[derive(Clone, PartialEq, Debug)]
pub struct SimulatedSegment {
    /// States, then definitions, then outputs, in the order of the model, as far as they are wanted.
    pub quantities: Vec<SimulatedQuantity>,
    /// By output of the model, then sample, SI.
    pub outputs: Vec<Vec<f64>>,
    /// Of the outputs that have measured values, with their places in the model.
    pub fits: Vec<(usize, OutputFit)>,
    /// Draws that the simulation could not follow, where there were any draws.
    pub draws_lost: Option<usize>,
}

/// Why an estimate cannot be simulated.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum NoSimulation {
    /// At the estimate itself.
    #[error("at the estimate {0}")]
    Unusable(Unusable),
    /// More than fits into memory.
    #[error(
        "{drawn} values of all draws of {of}, at most {most}; ask for fewer draws, for some quantities by name, or for fewer recordings at once"
    )]
    TooManyDrawn {
        /// Draws by quantities by samples.
        drawn: usize,
        /// One recording, or all.
        of: &'static str,
        /// As many may be.
        most: usize,
    },
}

/// Simulates an estimate along the segments of a problem of the same model whose shared parameters are those of the
/// estimate. `names` choose quantities; empty: all.
///
/// # Errors
/// The simulation leaves the range of numbers, or draws are too many.
pub fn simulate_estimate(
    problem: &Problem,
    estimate: &Estimate,
    names: &[String],
    monte_carlo: Option<MonteCarlo>,
) -> Result<Vec<SimulatedSegment>, NoSimulation> {
    let at = Estimated::carried(problem, estimate);
    let is_wanted = |quantity: &Quantity| names.is_empty() || names.contains(&quantity.name);
    let wanted: Vec<Quantity> = (quantities(&problem.model.document).into_iter())
        .filter(is_wanted)
        .collect();
    if let Some(question) = monte_carlo {
        check_drawn(problem, question.draws * wanted.len())?;
    }
    let simulated = along_all(problem, &at, &wanted).map_err(NoSimulation::Unusable)?;
    let drawn = monte_carlo.map(|question| ranges(problem, &at, &wanted, question));
    let histories = histories(problem, &at.theta);
    let segment = |(index, history): (usize, TimeHistory)| {
        let drawn = drawn.as_ref().map(|drawn| &drawn[index]);
        let series = simulated[index].quantities.iter().enumerate();
        SimulatedSegment {
            quantities: series
                .map(|(place, series)| quantity(series, drawn.and_then(|(r, _)| r.get(place))))
                .collect(),
            fits: compared(problem, &history),
            outputs: history
                .outputs
                .into_iter()
                .map(|output| output.model)
                .collect(),
            draws_lost: drawn.map(|(_, lost)| *lost),
        }
    };
    Ok(histories.into_iter().enumerate().map(segment).collect())
}

/// Whether so many values at each sample are not too many.
fn check_drawn(problem: &Problem, at_each: usize) -> Result<(), NoSimulation> {
    let lengths = || problem.segments.iter().map(|segment| segment.len());
    let longest = lengths().max().unwrap_or_default();
    for (of, samples, most) in [
        ("one recording", longest, MOST_DRAWN),
        ("all recordings", lengths().sum(), MOST_DRAWN_IN_ALL),
    ] {
        let drawn = at_each * samples;
        if drawn > most {
            return Err(NoSimulation::TooManyDrawn { drawn, of, most });
        }
    }
    Ok(())
}

/// What has no standard error because a parameter behind it has none has no range either: draws do not move that parameter.
fn quantity(series: &TrajectorySeries, range: Option<&Range>) -> SimulatedQuantity {
    let range = range.filter(|_| !series.standard_errors.is_empty());
    SimulatedQuantity {
        name: series.name.clone(),
        kind: series.kind,
        unit: series.unit.clone(),
        values: series.values.clone(),
        standard_errors: series.standard_errors.clone(),
        lower: range.map(|range| range.lower.clone()).unwrap_or_default(),
        upper: range.map(|range| range.upper.clone()).unwrap_or_default(),
    }
}

fn compared(problem: &Problem, history: &TimeHistory) -> Vec<(usize, OutputFit)> {
    let history = std::slice::from_ref(history);
    let fits = fits(problem, history, &Colour::of(history));
    let fits = fits.into_iter().enumerate();
    fits.filter(|(_, fit)| fit.samples > 0).collect()
}
