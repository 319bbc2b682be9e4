//! The picture of an unmodelled force: over time, over what it depends on, and what may make it.

use std::ops::Range;

use super::dependence::{Dependence, Evidence};
use super::equations;
use super::explained::{Explained, Noise};
use super::flown::Flown;
use super::left_over::{LeftOver, left_over};
use super::parts::{self, Parted};
use super::proposals::{Proposal, proposals};
use super::quantities;
use super::report::{ForceDependence, ForceHistory, Unmodelled};
use super::responses::{Response, Responses};
use super::sentence;
use super::shapes::{Knots, Shapes};
use super::smoothness::{Posterior, Smoothness};
use super::spectrum::{Force, spectrum, strongest};
use crate::diagnose::candidates::Ingredients;
use crate::diagnose::case::Case;
use crate::diagnose::effect::Effect;
use crate::diagnose::fitted::Fitted;
use crate::estimate::Role;

/// Finer than where it was only asked whether there is a force.
const KNOTS: Knots = Knots {
    spacing: 0.25,
    most: 100,
};

/// Samples of a history, and dependences with and without a curve, at most.
const MOST_SAMPLES: usize = 300;
const MOST_DEPENDENCES: usize = 12;
const MOST_CURVES: usize = 4;

/// Two standard deviations to either side: 95 %.
const BAND: f64 = 2.0;

/// An unmodelled force with what may make it.
pub(in crate::diagnose) struct Picture {
    pub unmodelled: Unmodelled,
    proposals: Vec<Proposal>,
    /// Whether flights were held out to say how far a dependence holds.
    held_out: bool,
}

/// A term that explains less than this of the force in flights that were not fitted is told of, and not tried: the worst
/// answer is a wrong name.
const TRIED_FROM: f64 = 0.5;

impl Picture {
    /// Terms to be tried that a catalogue does not have, the most promising first: those that make at least half of the force
    /// in flights that were held out.
    pub(in crate::diagnose) fn beyond(&self, catalogue: &[Effect]) -> Vec<Effect> {
        let is_new = |effect: &Effect| !catalogue.iter().any(|other| other.name() == effect.name());
        let is_firm = self.held_out && self.unmodelled.is_clear();
        let good = |proposal: &&Proposal| is_firm && proposal.share > TRIED_FROM;
        let proposed = self.proposals.iter().filter(good);
        let effects = proposed.map(|proposal| &proposal.effect);
        effects.filter(|effect| is_new(effect)).cloned().collect()
    }
}

/// The picture of what a fit by output error leaves. `None` where noise alone would leave as much, and where the
/// simulation leaves the range of numbers.
pub(in crate::diagnose) fn found(case: &Case, fitted: &Fitted) -> Option<Picture> {
    found_beyond(case, fitted, |_| true)
}

/// As [`found`], where the force's likelihood ratio is also one that is `asked_for`.
pub(in crate::diagnose) fn found_beyond(
    case: &Case,
    fitted: &Fitted,
    asked_for: impl Fn(f64) -> bool,
) -> Option<Picture> {
    if fitted.estimate.filter.is_some() {
        return None;
    }
    let left = left_over(case, fitted).filter(LeftOver::is_significant)?;
    if !asked_for(left.likelihood_ratio) {
        return None;
    }
    picture(case, fitted, &left)
}

fn picture(case: &Case, fitted: &Fitted, left: &LeftOver) -> Option<Picture> {
    let ingredients = Ingredients::new(case, &fitted.document);
    let equation = (equations::of(&ingredients, &fitted.document).into_iter())
        .find(|equation| equation.name == left.equation && equation.force_in == left.force_in)?;
    let flown = Flown::all(case, fitted)?;
    let outputs = flown.problem.model.outputs.len();
    let shapes = Shapes::along(&flown.problem.segments, outputs, KNOTS)?;
    let responses = Responses::new(&flown, &shapes, std::slice::from_ref(&equation))?;
    let responses = responses.to(&equation)?;
    let fit = Flown::fitted(fitted)?;
    let counts: Vec<usize> = shapes[..flown.fitted].iter().map(|s| s.count).collect();
    let seen: Vec<&Response> = responses[..flown.fitted].iter().collect();
    let noise = Noise::of(&fit.samples)?;
    let explained = Explained::by(&fit.samples, &noise, &seen, &Smoothness::all(&counts)?)?;
    let Explained {
        metric,
        normal,
        posterior,
        ..
    } = &explained;
    let parts = parts::all(&flown, &responses, &metric.colour)?;
    let evidence = Evidence {
        responses: &responses,
        shapes: &shapes,
        normal,
        clear: metric.clear,
        samples: metric.samples,
        fitted: flown.fitted,
        parts: &parts,
    };
    let dependences = evidence.dependences(&quantities::all(case, &flown, &ingredients));
    let mut proposals = proposals(
        &evidence,
        posterior,
        &dependences,
        &ingredients,
        &equation.name,
    );
    proposals.retain(|proposal| case.knowledge.allows(&proposal.effect));
    let flights = histories(&flown, &shapes, posterior, &parts);
    let forces = forces(&flown, &shapes, posterior);
    let mut unmodelled = Unmodelled {
        equation: equation.name.clone(),
        force_in: equation.force_in,
        unit: equation.unit.clone(),
        likelihood_ratio: left.likelihood_ratio,
        threshold: left.threshold,
        freedom: left.freedom,
        elsewhere: left.elsewhere.clone(),
        rms: rms(&forces),
        largest: largest(&forces),
        spectrum: spectrum(&forces),
        strongest: strongest(&flights[..flown.fitted]),
        flights,
        depends_on: shown(dependences),
        proposals: proposals.iter().map(|p| p.effect.name()).collect(),
        sentence: String::new(),
    };
    if !is_finite(&unmodelled) {
        return None;
    }
    unmodelled.sentence = sentence::of(&equation, &unmodelled);
    Some(Picture {
        unmodelled,
        proposals,
        held_out: flown.fitted < flown.problem.segments.len(),
    })
}

/// The force along each flight that was fitted, at every sample.
fn forces(flown: &Flown, shapes: &[Shapes], posterior: &Posterior) -> Vec<Force> {
    let mut first = 0;
    let of = |shapes: &Shapes| {
        let sizes = posterior.sizes.rows(first, shapes.count);
        first += shapes.count;
        let samples = shapes.elapsed.len();
        let duration = shapes.elapsed.last().copied().unwrap_or(0.0);
        Force {
            step: duration / samples.saturating_sub(1).max(1) as f64,
            values: shapes.force(sizes.into_owned().as_slice()),
        }
    };
    shapes[..flown.fitted].iter().map(of).collect()
}

/// JSON has no word for what is not a number.
fn is_finite(found: &Unmodelled) -> bool {
    let histories = (found.flights.iter()).flat_map(|f| [&f.time, &f.value, &f.lower, &f.upper]);
    let curves = found.depends_on.iter().filter_map(|d| d.curve.as_ref());
    let curves = curves.flat_map(|curve| [&curve.x, &curve.y, &curve.lower, &curve.upper]);
    let shares = found.depends_on.iter().map(|d| d.share);
    (histories.chain(curves).flatten().copied())
        .chain(shares)
        .all(f64::is_finite)
}

fn rms(forces: &[Force]) -> f64 {
    let values = || forces.iter().flat_map(|force| &force.values);
    (values().map(|w| w * w).sum::<f64>() / values().count().max(1) as f64).sqrt()
}

fn largest(forces: &[Force]) -> f64 {
    let values = forces.iter().flat_map(|force| &force.values);
    values.fold(0.0, |largest, w| w.abs().max(largest))
}

/// Along the flights that were fitted, and along those held out as it is estimated there.
fn histories(
    flown: &Flown,
    shapes: &[Shapes],
    posterior: &Posterior,
    parts: &[Parted],
) -> Vec<ForceHistory> {
    let flights = shapes.len();
    let mut all = of_flights(flown, shapes, 0..flown.fitted, posterior, Role::Estimation);
    if let (true, [part]) = (flown.fitted < flights, parts) {
        let held_out = flown.fitted..flights;
        all.extend(of_flights(
            flown,
            shapes,
            held_out,
            &part.held_out,
            Role::Validation,
        ));
    }
    all
}

fn of_flights(
    flown: &Flown,
    shapes: &[Shapes],
    flights: Range<usize>,
    posterior: &Posterior,
    role: Role,
) -> Vec<ForceHistory> {
    let covariance = posterior.covariance();
    let mut first = 0;
    let of = |flight: usize| {
        let (shapes, segment) = (&shapes[flight], &flown.problem.segments[flight]);
        let count = shapes.count;
        let sizes = posterior.sizes.rows(first, count).into_owned();
        let block = covariance.view((first, first), (count, count)).into_owned();
        first += count;
        let value = shapes.force(sizes.as_slice());
        let band: Vec<f64> = (shapes.variance(&block).iter())
            .map(|variance| BAND * variance.sqrt())
            .collect();
        let side = |sign: f64| -> Vec<f64> {
            value
                .iter()
                .zip(&band)
                .map(|(w, band)| w + sign * band)
                .collect()
        };
        let every = segment.len().div_ceil(MOST_SAMPLES).max(1);
        let some = |all: &[f64]| all.iter().step_by(every).copied().collect();
        ForceHistory {
            segment: segment.label.clone(),
            role,
            time: some(&segment.time),
            lower: some(&side(-1.0)),
            upper: some(&side(1.0)),
            value: some(&value),
        }
    };
    flights.map(of).collect()
}

/// The best few dependences, the very best with their curves.
fn shown(dependences: Vec<Dependence>) -> Vec<ForceDependence> {
    let best = dependences.into_iter().take(MOST_DEPENDENCES).enumerate();
    let of = |(rank, dependence): (usize, Dependence)| ForceDependence {
        quantity: dependence.quantity.name,
        unit: dependence.quantity.unit,
        share: dependence.share,
        curve: (rank < MOST_CURVES && !dependence.curve.x.is_empty()).then_some(dependence.curve),
    };
    best.map(of).collect()
}
