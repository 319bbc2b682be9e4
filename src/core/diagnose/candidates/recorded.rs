//! What was recorded: what each channel is, how far it moves, and which ones the model does not use.

use crate::diagnose::case::Case;
use crate::estimate::Role;
use crate::flight::{Dimension, Family, PhysicalQuantity, by_name};
use crate::model::{Input, ModelDocument, Quantities};

/// A recorded channel that the model does not use.
pub(super) struct Channel {
    pub name: String,
    pub quantity: PhysicalQuantity,
    /// As an input of the model.
    pub input: Input,
    pub movement: Movement,
}

/// How a channel moves over all flights that are fitted, SI.
#[derive(Clone, Copy, Debug)]
pub(super) struct Movement {
    /// The median: a control that is pulsed spends most of its time where the aircraft is trimmed.
    pub middle: f64,
    pub least: f64,
    pub most: f64,
}

/// Below this an angle or a rate is still: 0.1 deg, 0.3 deg/s.
const STILL_ANGLE: f64 = 2e-3;
const STILL_RATE: f64 = 5e-3;

/// A speed and the like are still if they move by less than this share.
const STILL_SHARE: f64 = 0.01;

impl Movement {
    fn of<'v>(values: impl Iterator<Item = &'v f64>) -> Option<Self> {
        let finite = values.copied().filter(|value| value.is_finite());
        let mut values: Vec<f64> = finite.collect();
        values.sort_by(f64::total_cmp);
        Some(Self {
            middle: *values.get(values.len() / 2)?,
            least: *values.first()?,
            most: *values.last()?,
        })
    }

    pub(super) fn is_constant(&self) -> bool {
        self.most - self.least <= 1e-9 * self.most.abs().max(self.least.abs())
    }

    /// Whether it moves so far that products with it are more than a constant.
    pub(super) fn moves(&self, quantity: PhysicalQuantity) -> bool {
        let range = self.most - self.least;
        match quantity.family() {
            _ if self.is_constant() => false,
            Family::Gyro => range > STILL_RATE,
            Family::Attitude | Family::Control if quantity != PhysicalQuantity::Thrust => {
                range > STILL_ANGLE
            }
            Family::AirData if quantity.is_flow_angle() => range > STILL_ANGLE,
            _ => range > STILL_SHARE * self.middle.abs(),
        }
    }
}

/// Recorded in all flights, of a known quantity, moving, and neither in the model nor used up by the job's formulas.
pub(super) fn channels(
    case: &Case,
    document: &ModelDocument,
    quantities: &Quantities,
) -> Vec<Channel> {
    let Some(first) = case.flights.first() else {
        return Vec::new();
    };
    let is_used = |name: &str| {
        document.inputs.contains_key(name)
            || document.outputs.contains_key(name)
            || quantities.get(name).is_some()
            || case.consumed.iter().any(|consumed| consumed == name)
    };
    let is_everywhere = |name: &String, dimension: Dimension| {
        case.flights.iter().all(|flight| {
            let channel = flight.channels.get(name);
            channel.is_some_and(|(values, found)| {
                *found == dimension && values.iter().all(|value| value.is_finite())
            })
        })
    };
    let of = |(name, (_, dimension)): (&String, &(Vec<f64>, Dimension))| {
        let quantity = quantity(case, name, *dimension)?;
        let movement = movement(case, name)?;
        let offered = !is_used(name)
            && is_everywhere(name, *dimension)
            && !movement.is_constant()
            && quantity != PhysicalQuantity::Other;
        offered.then(|| Channel {
            name: name.clone(),
            quantity,
            input: Input {
                unit: unit(*dimension, quantity),
                quantity: Some(quantity),
                description: "recorded".to_string(),
                ..Input::default()
            },
            movement,
        })
    };
    first.channels.iter().filter_map(of).collect()
}

/// SI, with the radian where it is one.
fn unit(dimension: Dimension, quantity: PhysicalQuantity) -> String {
    let is_angle = quantity.is_flow_angle()
        || quantity.family() == Family::Attitude
        || (quantity.is_control() && quantity != PhysicalQuantity::Thrust);
    match quantity.family() {
        Family::Gyro => "rad/s".to_string(),
        Family::AngularAcceleration => "rad/s^2".to_string(),
        _ if is_angle && dimension.is_none() => "rad".to_string(),
        _ => dimension.to_string(),
    }
}

pub(super) fn movement(case: &Case, channel: &str) -> Option<Movement> {
    let flights = case.of_role(Role::Estimation);
    let values = flights.filter_map(|flight| flight.channels.get(channel));
    Movement::of(values.flat_map(|(values, _)| values))
}

/// What a recorded channel is.
fn quantity(case: &Case, channel: &str, dimension: Dimension) -> Option<PhysicalQuantity> {
    let told = case.knowledge.quantities.get(channel).copied();
    told.or_else(|| by_name(channel, dimension))
}
