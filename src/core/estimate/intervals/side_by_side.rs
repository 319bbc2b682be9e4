//! All methods on one estimate, and what they give for each parameter.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::blocks::Blocks;
use super::fitted::Fitted;
use super::noise::Noise;
use super::profile::{Profile, profile};
use super::refit::refit;
use super::repeated::{Draws, Estimates, PARTS, Scatter, estimates};
use super::teller::Teller;
use crate::estimate::answer::Solution;
use crate::estimate::monte_carlo::percentile;
use crate::estimate::options::error_bounds::ErrorBoundsKind;
use crate::estimate::options::intervals::IntervalOptions;
use crate::estimate::problem::Problem;
use crate::estimate::report::intervals::{
    Bootstrap, ConfidenceInterval, ConfidenceIntervals, IntervalEnd, IntervalMethod,
    MonteCarloFits, ParameterIntervals,
};
use crate::estimate::report::progress::Watcher;
use crate::stop;

/// Half the width of a 95 % interval, standard deviations; its square is 3.84.
const TWO_SIDED_95: f64 = 1.959_963_984_540_054;

/// Fewer estimates tell no percentile.
const FEWEST: usize = 40;

/// Fewer blocks than these make a bootstrap too narrow.
const FEW_BLOCKS: usize = 20;

/// Errors beyond this many of those of white noise are worth a word.
const COLOURED: f64 = 1.2;

/// A profile that comes so far below the estimate has found another minimum.
const ANOTHER: f64 = 0.01;

/// None where the watcher wants no more.
pub(super) fn side_by_side(
    problem: &Problem,
    options: &IntervalOptions,
    solution: &Solution,
    watcher: &mut Watcher<'_>,
) -> Option<ConfidenceIntervals> {
    let fitted = Fitted::of(problem, solution);
    let told = |count: usize| if count > 0 { PARTS } else { 0 };
    let of = told(options.bootstrap) + told(options.monte_carlo) + usize::from(options.profile);
    let mut found = Found::default();
    let mut teller = Teller::new(watcher, of);
    if options.profile {
        found.profiles = profiles(&fitted, options, &mut teller)?;
    }
    if options.bootstrap > 0 {
        found.bootstrap(&fitted, options, &mut teller)?;
    }
    if options.monte_carlo > 0 {
        found.monte_carlo(&fitted, options, &solution.covariance, &mut teller)?;
    }
    found.say_of_colour(&fitted);
    found.say_of_profiles(&fitted);
    let parameters = (0..fitted.theta.len()).map(|place| found.of_parameter(&fitted, place));
    Some(ConfidenceIntervals {
        parameters: parameters.collect(),
        bootstrap: found.bootstrap.as_ref().map(|(made, _)| *made),
        monte_carlo: found.monte_carlo.as_ref().map(|(made, _)| *made),
        remarks: found.remarks,
    })
}

/// What z is to be for white noise, and with the colour of the residuals: θ̂_i then has the variance of the corrected bound,
/// and twice the fall of ln L is its ratio to the conventional one times a χ² variable.
fn targets(fitted: &Fitted, place: usize) -> Vec<f64> {
    let kind = fitted.problem.options.error_bounds;
    let mut targets = vec![TWO_SIDED_95];
    if kind == ErrorBoundsKind::Corrected
        && let (Some(corrected), Some(conventional)) =
            (fitted.standard_errors[place], fitted.conventional[place])
    {
        targets.push(TWO_SIDED_95 * corrected / conventional);
    }
    targets
}

/// By place; none of those that were not asked for.
fn profiles(
    fitted: &Fitted,
    options: &IntervalOptions,
    teller: &mut Teller<'_, '_>,
) -> Option<Vec<Option<Profile>>> {
    let is_wanted = |place: usize| {
        let name = &fitted.problem.parameter(place).name;
        options.parameters.is_empty() || options.parameters.contains(name)
    };
    // the estimate itself may have been found with less care than its refits
    let least = refit(&fitted.problem, fitted.theta.clone());
    let least = least.map_or(f64::NAN, |minimum| minimum.cost);
    let of_place = |place: usize| {
        let wanted = is_wanted(place) && least.is_finite();
        wanted
            .then(|| profile(fitted, place, least, &targets(fitted, place)))
            .flatten()
    };
    let found: Vec<Option<Profile>> = (0..fitted.theta.len())
        .into_par_iter()
        .map(stop::shared(of_place))
        .collect();
    let count = found.iter().flatten().count();
    teller.tell(format!("profile likelihood: {count} parameters"))?;
    Some(found)
}

#[derive(Default)]
struct Found {
    profiles: Vec<Option<Profile>>,
    bootstrap: Option<(Bootstrap, Estimates)>,
    monte_carlo: Option<(MonteCarloFits, Estimates)>,
    remarks: Vec<String>,
}

impl Found {
    fn bootstrap(
        &mut self,
        fitted: &Fitted,
        options: &IntervalOptions,
        teller: &mut Teller<'_, '_>,
    ) -> Option<()> {
        let blocks = Blocks::new(fitted, options.block);
        let draws = Draws {
            name: "bootstrap",
            count: options.bootstrap,
            seed: options.seed,
            stream: 0,
        };
        let found = self.repeated(fitted, &blocks, &draws, teller)?;
        if blocks.count() < FEW_BLOCKS {
            self.remarks.push(format!(
                "the recordings hold {} blocks of {} samples: the bootstrap has little to draw from and is too narrow",
                blocks.count(),
                blocks.length
            ));
        }
        let made = Bootstrap {
            replicates: options.bootstrap,
            failed: found.failed,
            block: blocks.length,
        };
        self.bootstrap = Some((made, found));
        Some(())
    }

    fn monte_carlo(
        &mut self,
        fitted: &Fitted,
        options: &IntervalOptions,
        covariance: &DMatrix<f64>,
        teller: &mut Teller<'_, '_>,
    ) -> Option<()> {
        let kind = fitted.problem.options.error_bounds;
        let noise = Noise::new(fitted, kind, covariance);
        let draws = Draws {
            name: "Monte Carlo",
            count: options.monte_carlo,
            seed: options.seed,
            stream: 1 << 32,
        };
        let found = self.repeated(fitted, &noise, &draws, teller)?;
        let made = MonteCarloFits {
            recordings: options.monte_carlo,
            failed: found.failed,
            noise: kind,
        };
        self.monte_carlo = Some((made, found));
        Some(())
    }

    fn repeated(
        &mut self,
        fitted: &Fitted,
        scatter: &dyn Scatter,
        draws: &Draws,
        teller: &mut Teller<'_, '_>,
    ) -> Option<Estimates> {
        let found = estimates(fitted, scatter, draws, teller)?;
        if found.failed > 0 {
            let rest = match found.found.len() {
                FEWEST.. => "they do not count",
                _ => "too few are left for an interval",
            };
            self.remarks.push(format!(
                "{}: {} of {} fits found no minimum; {rest}",
                draws.name, found.failed, draws.count
            ));
        }
        Some(found)
    }

    /// Which of the intervals hold for white noise alone, where that matters.
    fn say_of_colour(&mut self, fitted: &Fitted) {
        let errors = fitted.standard_errors.iter().zip(&fitted.conventional);
        let ratios = errors.filter_map(|(corrected, white)| Some((*corrected)? / (*white)?));
        let most = ratios.fold(1.0, f64::max);
        if most > COLOURED {
            self.remarks.push(format!(
                "the residuals are coloured: corrected standard errors are up to {most:.1} times the conventional ones; those and the profile likelihood without correction are too narrow"
            ));
        }
    }

    fn say_of_profiles(&mut self, fitted: &Fitted) {
        for (place, profile) in self.profiles.iter().enumerate() {
            if let Some(profile) = profile.as_ref().filter(|profile| profile.below > ANOTHER) {
                self.remarks.push(format!(
                    "the profile of {} comes to a -ln L that is {:.2} below that of the estimate: there is a lower minimum; try other start values",
                    fitted.problem.name(place),
                    profile.below
                ));
            }
        }
    }

    fn of_parameter(&self, fitted: &Fitted, place: usize) -> ParameterIntervals {
        let problem = &fitted.problem;
        let unknown = problem.unknowns.at(place);
        let parameter = problem.parameter(place);
        let at = Place {
            fitted,
            place,
            estimate: problem.unit(place).from_si(fitted.theta[place]),
        };
        let mut intervals = at.of_bounds();
        let repeated = |found: &Estimates, method| at.percentiles(found, method);
        if let Some((_, found)) = &self.bootstrap {
            intervals.extend(repeated(found, IntervalMethod::Bootstrap));
        }
        if let Some(Some(profile)) = self.profiles.get(place) {
            let methods = [IntervalMethod::Profile, IntervalMethod::ProfileCorrected];
            let ends = profile.ends.iter().zip(methods);
            intervals.extend(ends.map(|(ends, method)| {
                let end = |at_end: usize| {
                    let end = ends[at_end];
                    (end.value.map(|v| problem.unit(place).from_si(v)), end.kind)
                };
                at.interval(method, [end(0), end(1)], None)
            }));
        }
        if let Some((_, found)) = &self.monte_carlo {
            intervals.extend(repeated(found, IntervalMethod::MonteCarlo));
        }
        ParameterIntervals {
            name: parameter.name.clone(),
            segment: (unknown.segment).map(|segment| problem.segments[segment].label.clone()),
            unit: parameter.document.unit.clone(),
            estimate: at.estimate,
            intervals,
        }
    }
}

/// The unknown at a place of θ, in its own unit.
struct Place<'f> {
    fitted: &'f Fitted,
    place: usize,
    estimate: f64,
}

impl Place<'_> {
    fn of_bounds(&self) -> Vec<ConfidenceInterval> {
        let scale = self.fitted.problem.unit(self.place).scale.abs();
        let one = |method, error: Option<f64>| {
            let error = error? / scale;
            let end = |sign: f64| {
                (
                    Some(self.estimate + sign * TWO_SIDED_95 * error),
                    IntervalEnd::Found,
                )
            };
            Some(self.interval(method, [end(-1.0), end(1.0)], Some(error)))
        };
        let kind = self.fitted.problem.options.error_bounds;
        let corrected = self.fitted.standard_errors[self.place];
        let corrected = corrected.filter(|_| kind == ErrorBoundsKind::Corrected);
        let both = [
            (
                IntervalMethod::Conventional,
                self.fitted.conventional[self.place],
            ),
            (IntervalMethod::Corrected, corrected),
        ];
        both.into_iter()
            .filter_map(|(method, error)| one(method, error))
            .collect()
    }

    /// The 2.5 and the 97.5 percentile of estimates, and their standard deviation.
    fn percentiles(&self, found: &Estimates, method: IntervalMethod) -> Option<ConfidenceInterval> {
        if found.found.len() < FEWEST {
            return None;
        }
        let unit = self.fitted.problem.unit(self.place);
        let of_place = found
            .found
            .iter()
            .map(|theta| unit.from_si(theta[self.place]));
        let mut values: Vec<f64> = of_place.collect();
        values.sort_by(f64::total_cmp);
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let deviation = (squares / (count - 1.0)).sqrt();
        let end = |share: f64| (Some(percentile(&values, share)), IntervalEnd::Found);
        Some(self.interval(method, [end(0.025), end(0.975)], Some(deviation)))
    }

    fn interval(
        &self,
        method: IntervalMethod,
        [(lower, lower_end), (upper, upper_end)]: [(Option<f64>, IntervalEnd); 2],
        standard_deviation: Option<f64>,
    ) -> ConfidenceInterval {
        let whole = [lower_end, upper_end] == [IntervalEnd::Found; 2];
        let asymmetry = lower
            .zip(upper)
            .filter(|_| whole)
            .map(|(lower, upper)| (upper - self.estimate) / (self.estimate - lower));
        ConfidenceInterval {
            method,
            lower,
            lower_end,
            upper,
            upper_end,
            standard_deviation,
            asymmetry: asymmetry.filter(|ratio| ratio.is_finite() && *ratio > 0.0),
        }
    }
}
