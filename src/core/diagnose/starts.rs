//! Where the fit of a candidate begins: from several starts where a linear step cannot tell.

use super::case::{Case, Values};
use super::effect::{Effect, EffectKind};
use crate::estimate::Role;
use crate::flight::Unit;
use crate::model::{Added, AddedRole, EditKind, Edited, Start};

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
