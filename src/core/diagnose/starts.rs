//! Where the fit of a candidate begins: from several starts where a linear step cannot tell.

use super::case::{Case, Values};
use super::effect::{Effect, EffectKind};
use crate::estimate::Role;
use crate::model::{Added, EditKind, ModelDocument, Start};

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
pub(super) fn starts(
    case: &Case,
    effect: &Effect,
    document: &ModelDocument,
    base: &ModelDocument,
) -> Vec<Values> {
    let EffectKind::Edit(kind) = effect.kind else {
        return vec![Values::new()];
    };
    let factors: &[f64] = match kind {
        EditKind::Backlash => return backlash_starts(case, effect, document, base),
        EditKind::InputDelay => return delay_starts(case, document, base),

        EditKind::SensorLag | EditKind::ActuatorLag => &[0.5, 2.0],
        EditKind::ActuatorRateLimit => &[0.03, 0.1, 0.3, 1.0],
        EditKind::UnsteadyAero | EditKind::StallHysteresis => &[0.4, 1.0, 2.5],
        EditKind::StructuralMode => &[0.6, 0.8, 1.0, 1.3, 1.7, 2.2, 2.9],
        EditKind::Gust => return gust_starts(case, document, base),
        _ => return vec![Values::new()],
    };
    let scaled = |factor: &f64| {
        let added = document
            .parameters
            .iter()
            .filter(|(name, p)| !p.fixed && !base.parameters.contains_key(*name));
        let of = added.filter_map(|(name, parameter)| match parameter.start {
            Start::Value(value) if value != 0.0 => {
                let unit = crate::flight::Unit::parse(&parameter.unit).ok()?;
                // damping and shape constants are not where the uncertainty is
                let factor = if parameter.unit == "-" || parameter.unit.is_empty() {
                    1.0
                } else {
                    *factor
                };
                Some(((name.clone(), None), unit.to_si(value * factor)))
            }
            _ => None,
        });
        of.collect()
    };
    factors.iter().map(scaled).collect()
}

/// Shares of how far the input moves.
fn backlash_starts(
    case: &Case,
    effect: &Effect,
    document: &ModelDocument,
    base: &ModelDocument,
) -> Vec<Values> {
    let moved = case
        .of_role(Role::Estimation)
        .filter_map(|flight| flight.channels.get(&effect.target));
    let (least, most) = (moved.flat_map(|(values, _)| values))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), v| {
            (least.min(*v), most.max(*v))
        });
    let added = Added::between(base, document).parameters;
    let of = |share: f64| {
        Values::from_iter(
            added
                .first()
                .map(|name| ((name.clone(), None), share * (most - least))),
        )
    };
    [0.02, 0.1].into_iter().map(of).collect()
}

/// A recorded input that jumps has no slope at its samples, and so its delay none at whole samples: starts are between.
fn delay_starts(case: &Case, document: &ModelDocument, base: &ModelDocument) -> Vec<Values> {
    let added = Added::between(base, document).parameters;
    samples_late(case, &added, &[-1.5, -0.5, 0.5, 1.5, 3.5, 6.5])
}

/// A delay of many samples is far from what one linear step tells: further starts of it.
pub(super) fn starts_of_delay(case: &Case, effect: &Effect, added: &[String]) -> Vec<Values> {
    match effect.kind {
        EffectKind::Edit(EditKind::SensorDelay) => samples_late(case, added, &[2.0, 5.0]),
        _ => Vec::new(),
    }
}

fn samples_late(case: &Case, added: &[String], samples: &[f64]) -> Vec<Values> {
    let step = case
        .flights
        .first()
        .map_or(0.0, super::flight::Flight::step);
    let of = |samples: &f64| {
        Values::from_iter(
            added
                .first()
                .map(|name| ((name.clone(), None), samples * step)),
        )
    };
    samples.iter().map(of).collect()
}

/// A gust may come at any time: every half length of one, of two lengths.
fn gust_starts(case: &Case, document: &ModelDocument, base: &ModelDocument) -> Vec<Values> {
    let added: Vec<&String> = document
        .parameters
        .keys()
        .filter(|name| !base.parameters.contains_key(*name))
        .collect();
    let named = |part: &str| {
        added
            .iter()
            .find(|name| name.contains(part))
            .map(|name| (*name).clone())
    };
    let (Some(time), Some(length)) = (named("time"), named("length")) else {
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
