//! Trials: the most promising candidates are fitted, from several starts where a linear step cannot tell.

use std::ops::ControlFlow;

use super::case::{Case, Unfit, Values};
use super::effect::{Effect, EffectKind, Treatment};
use super::fitted::Fitted;
use super::screen::{Screened, critical};
use crate::estimate::{Estimator, Outcome, ProcessNoise, Role, filter_error};
use crate::flight::Unit;
use crate::model::{Added, AddedRole, EditKind, Edited, ModelDocument, Start};

/// A candidate, fitted.
#[derive(Clone, Debug)]
pub(super) struct Trial {
    pub effect: Effect,
    /// Parameters that it adds.
    pub added: Vec<Added>,
    /// From how many starts it was looked for.
    pub starts: usize,
    pub screened: Option<Screened>,
    pub fitted: Fitted,
    /// The part of the whitened residual that it explains, of length 1.
    pub explained: Vec<f64>,
    /// Twice the gain of the colour-aware log-likelihood.
    pub likelihood_ratio: f64,
    /// Unknowns that it adds.
    pub freedom: usize,
    /// By output, twice the gain on flights that were not fitted; absent where there are none.
    pub held_out: Option<Vec<f64>>,
    /// Why the flights that were not fitted could not be predicted.
    pub unpredictable: Option<String>,
}

impl Trial {
    /// Twice the gain on all flights, each parameter of the effect counted as two (Akaike).
    pub(super) fn merit(&self) -> f64 {
        let held_out: f64 = self.held_out.iter().flatten().sum();
        self.likelihood_ratio + held_out - 2.0 * self.freedom as f64
    }
}

/// Whether a kind has no derivative at no effect, so that a screen cannot see it.
pub(super) fn is_tried_outright(kind: EffectKind) -> bool {
    use EditKind::{
        ActuatorLag, ActuatorRateLimit, Backlash, InputDelay, SensorLag, StallHysteresis,
    };
    matches!(
        kind,
        EffectKind::Edit(
            SensorLag | ActuatorLag | ActuatorRateLimit | Backlash | InputDelay | StallHysteresis
        )
    )
}

/// Start values for what an effect adds, where one start is not enough.
pub(super) fn starts(case: &Case, effect: &Effect, edited: &Edited) -> Vec<Values> {
    let EffectKind::Edit(kind) = effect.kind else {
        return vec![Values::new()];
    };
    let factors: &[f64] = match kind {
        EditKind::Backlash => return backlash_starts(case, effect, &edited.added),
        EditKind::InputDelay => return delay_starts(case, &edited.added),

        EditKind::SensorLag | EditKind::ActuatorLag => &[0.5, 2.0],
        EditKind::ActuatorRateLimit => &[0.03, 0.1, 0.3, 1.0],
        EditKind::UnsteadyAero | EditKind::StallHysteresis => &[0.4, 1.0, 2.5],
        EditKind::StructuralMode => &[0.6, 0.8, 1.0, 1.3, 1.7, 2.2, 2.9],
        EditKind::Gust => return gust_starts(case, &edited.added),
        _ => return vec![Values::new()],
    };
    let scaled = |factor: &f64| {
        let of = |added: &Added| {
            let parameter = &edited.document.parameters[&added.name];
            let start = match parameter.start {
                Start::Value(value) if value != 0.0 && !parameter.fixed => value,
                _ => return None,
            };
            let unit = Unit::parse(&parameter.unit).ok()?;
            let factor = match added.role {
                // these are not where the uncertainty is
                AddedRole::Damping | AddedRole::Steepness => 1.0,
                _ => *factor,
            };
            Some(((added.name.clone(), None), unit.to_si(start * factor)))
        };
        edited.added.iter().filter_map(of).collect()
    };
    factors.iter().map(scaled).collect()
}

/// Shares of how far the input moves.
fn backlash_starts(case: &Case, effect: &Effect, added: &[Added]) -> Vec<Values> {
    let moved = case
        .of_role(Role::Estimation)
        .filter_map(|flight| flight.channels.get(&effect.target));
    let (least, most) = (moved.flat_map(|(values, _)| values))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), v| {
            (least.min(*v), most.max(*v))
        });
    let of = |share: f64| at_first(added, share * (most - least));
    [0.02, 0.1].into_iter().map(of).collect()
}

/// A recorded input that jumps has no slope at its samples, and so its delay none at whole samples: starts are between.
fn delay_starts(case: &Case, added: &[Added]) -> Vec<Values> {
    samples_late(case, added, &[-1.5, -0.5, 0.5, 1.5, 3.5, 6.5])
}

/// A delay of many samples is far from what one linear step tells: further starts of it.
pub(super) fn starts_of_delay(case: &Case, effect: &Effect, added: &[Added]) -> Vec<Values> {
    match effect.kind {
        EffectKind::Edit(EditKind::SensorDelay) => samples_late(case, added, &[2.0, 5.0]),
        _ => Vec::new(),
    }
}

fn samples_late(case: &Case, added: &[Added], samples: &[f64]) -> Vec<Values> {
    let step = case
        .flights
        .first()
        .map_or(0.0, super::flight::Flight::step);
    let of = |samples: &f64| at_first(added, samples * step);
    samples.iter().map(of).collect()
}

/// A value, SI, of the parameter that an effect is called after.
fn at_first(added: &[Added], value: f64) -> Values {
    let first = added.first();
    Values::from_iter(first.map(|added| ((added.name.clone(), None), value)))
}

/// A gust may come at any time: every half length of one, of two lengths.
fn gust_starts(case: &Case, added: &[Added]) -> Vec<Values> {
    let of_role = |role: AddedRole| {
        let found = added.iter().find(|added| added.role == role);
        found.map(|added| added.name.clone())
    };
    let (Some(time), Some(length)) = (of_role(AddedRole::Onset), of_role(AddedRole::Duration))
    else {
        return vec![Values::new()];
    };
    let flights: Vec<_> = case.of_role(Role::Estimation).collect();
    let mut starts = Vec::new();
    for flight in &flights {
        let duration = flight.step() * flight.time.len() as f64;
        for seconds in [1.0, 3.0] {
            let mut at = 0.0;
            while at + seconds < duration && starts.len() < 200 {
                // in the other flights it is out of sight, behind the end
                let of = |other: &&super::flight::Flight| {
                    let begin = if other.label == flight.label { at } else { 1e6 };
                    [
                        ((time.clone(), Some(other.label.clone())), begin),
                        ((length.clone(), Some(other.label.clone())), seconds),
                    ]
                };
                starts.push(flights.iter().flat_map(of).collect());
                at += 0.5 * seconds;
            }
        }
    }
    starts
}

/// Fits a candidate.
///
/// # Errors
/// It came to nothing.
pub(super) fn fit(
    case: &Case,
    base: &Fitted,
    effect: &Effect,
    document: ModelDocument,
    start: &Values,
) -> Result<Fitted, Unfit> {
    if let EffectKind::Treatment(Treatment::ProcessNoise) = effect.kind {
        let held = |state: &str| state != effect.target;
        return filtered(case, base, &held);
    }
    Fitted::trial(case, document, &base.values_with(start))
}

/// Turbulence that disturbs one state disturbs others: the same model with process noise on all of them, where the likelihood says
/// so. `calm` is the fit without any.
pub(super) fn disturbed_throughout(case: &Case, calm: &Fitted, one: Fitted) -> Fitted {
    const ERROR: f64 = 0.01;
    let Ok(all) = filtered(case, calm, &|_| false) else {
        return one;
    };
    // both are filters, whose innovations should be white: their costs are their likelihoods
    let gain = 2.0 * (one.estimate.cost - all.estimate.cost);
    let others = one.problem.model.states.len() - 1;
    if gain > critical(ERROR, 1.0, others) {
        all
    } else {
        one
    }
}

/// The declared model fitted by filter error, without process noise on the states that are `held`.
fn filtered(case: &Case, base: &Fitted, held: &dyn Fn(&str) -> bool) -> Result<Fitted, Unfit> {
    let mut problem = case.problem(&base.document, &base.values())?;
    problem.options.estimator = Estimator::FilterError;
    problem.options.tolerance = problem.options.tolerance.max(1e-3);
    problem.options.process_noise = (problem.model.states.iter())
        .filter(|state| held(&state.name))
        .map(|state| {
            (
                state.name.clone(),
                ProcessNoise {
                    start: Some(0.0),
                    fixed: true,
                },
            )
        })
        .collect();
    let solution = filter_error(&problem, &mut |_| ControlFlow::Continue(()))
        .map_err(|why| Unfit(why.to_string()))?;
    if solution.estimate.outcome == Outcome::Diverged {
        return Err(Unfit(solution.estimate.reason));
    }
    Ok(Fitted::of(base.document.clone(), problem, &solution))
}
