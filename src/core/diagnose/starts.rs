//! Where the fit of a candidate begins: from several starts where a linear step cannot tell.

use super::case::{Case, Values};
use super::effect::{Effect, EffectKind};
use super::flight::Flight;
use super::swapped;
use crate::estimate::Role;
use crate::flight::Unit;
use crate::model::{Added, AddedRole, EditKind, Edited, Start};

/// A gust is looked for from no more starts.
const MOST_STARTS: usize = 200;

/// Frequencies of a mode, as shares of that of its edit: so near each other that any mode between them lies about within
/// the resonance (half width ζ) of one that is damped as the fit begins, ζ = 0.1.
const MODES: [f64; 12] = [
    0.36, 0.45, 0.56, 0.7, 0.88, 1.1, 1.37, 1.72, 2.15, 2.7, 3.4, 4.2,
];

/// Whether a kind has no derivative at no effect, so that a screen cannot see it.
pub(super) fn is_tried_outright(kind: EffectKind) -> bool {
    use EditKind::{
        ActuatorLag, ActuatorRateLimit, Backlash, InputDelay, SensorLag, StallHysteresis,
        SwappedChannels,
    };
    matches!(
        kind,
        EffectKind::Edit(
            SensorLag
                | ActuatorLag
                | ActuatorRateLimit
                | Backlash
                | InputDelay
                | StallHysteresis
                | SwappedChannels
        )
    )
}

/// Start values for what an effect adds, where one start is not enough.
pub(super) fn starts(case: &Case, effect: &Effect, edited: &Edited) -> Vec<Values> {
    let EffectKind::Edit(kind) = effect.kind else {
        return vec![Values::new()];
    };
    let factors: &[f64] = match kind {
        EditKind::Backlash => return first_at(&edited.added, &plays(case, effect)),
        EditKind::ActuatorRateLimit => return first_at(&edited.added, &rate_limits(case, effect)),
        EditKind::SensorLag | EditKind::ActuatorLag => return first_at(&edited.added, &lags(case)),
        // a recorded input that jumps has no slope at its samples, and so its delay none at whole samples
        EditKind::InputDelay => {
            let late = [-1.5, -0.5, 0.5, 1.5, 3.5, 6.5];
            return first_at(&edited.added, &in_samples(case, &late));
        }
        EditKind::UnsteadyAero | EditKind::StallHysteresis => &[0.4, 1.0, 2.5],
        EditKind::StructuralMode => &MODES,
        EditKind::SwappedChannels => return vec![swapped::start(edited)],
        EditKind::Gust => return gust_starts(case, effect, &edited.added),
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

/// A start for each of these values, SI, of the parameter that an effect is called after.
fn first_at(added: &[Added], values: &[f64]) -> Vec<Values> {
    let of = |value: &f64| {
        let first = added.first();
        Values::from_iter(first.map(|added| ((added.name.clone(), None), *value)))
    };
    values.iter().map(of).collect()
}

fn in_samples(case: &Case, counts: &[f64]) -> Vec<f64> {
    let first = case.flights.first();
    let step = first.map_or(0.0, Flight::step);
    counts.iter().map(|count| count * step).collect()
}

/// What is recorded of a channel in the flights to be fitted, with its time.
fn recorded<'c>(case: &'c Case, channel: &'c str) -> impl Iterator<Item = (&'c [f64], &'c [f64])> {
    let flights = case.of_role(Role::Estimation);
    flights.filter_map(move |flight| {
        let (values, _) = flight.channels.get(channel)?;
        Some((flight.time.as_slice(), values.as_slice()))
    })
}

/// Shares of how far the input moves.
fn plays(case: &Case, effect: &Effect) -> Vec<f64> {
    let values = recorded(case, &effect.target).flat_map(|(_, values)| values);
    let (least, most) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), v| {
        (least.min(*v), most.max(*v))
    });
    [0.002, 0.02, 0.1]
        .map(|share| share * (most - least))
        .to_vec()
}

/// Shares of how fast the input moves.
fn rate_limits(case: &Case, effect: &Effect) -> Vec<f64> {
    let rates = recorded(case, &effect.target).flat_map(|(time, values)| {
        let pairs = time.windows(2).zip(values.windows(2));
        pairs.map(|(t, u)| ((u[1] - u[0]) / (t[1] - t[0])).abs())
    });
    let largest = rates.fold(0.0, f64::max);
    [0.9, 0.6, 0.35].map(|share| share * largest).to_vec()
}

/// Of some samples, and such as instruments and actuators have.
fn lags(case: &Case) -> Vec<f64> {
    let mut lags = in_samples(case, &[0.5, 1.0, 3.0]);
    lags.extend([0.1, 0.3]);
    lags
}

/// A delay of many samples is far from what one linear step tells: further starts of it.
pub(super) fn starts_of_delay(case: &Case, effect: &Effect, added: &[Added]) -> Vec<Values> {
    match effect.kind {
        EffectKind::Edit(EditKind::SensorDelay) => first_at(added, &in_samples(case, &[2.0, 5.0])),
        _ => Vec::new(),
    }
}

/// A gust may come at any time: every half length of one, of two lengths.
fn gust_starts(case: &Case, effect: &Effect, added: &[Added]) -> Vec<Values> {
    let of_role = |role: AddedRole| {
        let found = added.iter().find(|added| added.role == role);
        found.map(|added| added.name.clone())
    };
    let (Some(time), Some(length)) = (of_role(AddedRole::Onset), of_role(AddedRole::Duration))
    else {
        return vec![Values::new()];
    };
    let flights: Vec<&Flight> = case.of_role(Role::Estimation).collect();
    let meets = |flight: &&&Flight| {
        effect
            .term
            .as_ref()
            .is_none_or(|term| *term == flight.label)
    };
    let mut starts = Vec::new();
    for flight in flights.iter().filter(meets) {
        let duration = flight.step() * flight.time.len() as f64;
        for seconds in [1.0, 3.0] {
            let mut at = 0.0;
            while at + seconds < duration && starts.len() < MOST_STARTS {
                // in the other flights it is out of sight, behind the end
                let of = |other: &&Flight| {
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
