//! Effects in sentences that an engineer can read.

use super::effect::{Effect, EffectKind, Treatment};
use super::size::Size;
use crate::flight::{Shown, five_digits, shown_in, with_error};
use crate::model::{AddedRole, EditKind};

/// An effect in words, with its size.
pub(super) fn of(effect: &Effect, sizes: &[Size]) -> String {
    if let [size] = sizes
        && let Some(sized) = sized(effect, size)
    {
        let segment = (size.segment.as_ref()).map_or(String::new(), |label| format!(" in {label}"));
        return format!("{sized}{segment} ({})", size.name);
    }
    let written: Vec<String> = sizes.iter().map(written).collect();
    let words = words(effect, sizes.first());
    match written.is_empty() {
        true => words,
        false => format!("{words} ({})", written.join(", ")),
    }
}

/// An effect that has one size and is told by it.
fn sized(effect: &Effect, size: &Size) -> Option<String> {
    let target = effect.target.as_str();
    let EffectKind::Edit(kind) = effect.kind else {
        return None;
    };
    let plain = measured(size.value.signum(), size);
    let signed = measured(1.0, size);
    let is_negative = size.value < 0.0;
    let text = match kind {
        EditKind::SensorBias | EditKind::InputBias => {
            format!("{target} is recorded with a bias of {signed}")
        }
        EditKind::SensorDrift => format!("{target} drifts by {signed}"),
        EditKind::SensorDelay if is_negative => format!("{target} is recorded {plain} early"),
        EditKind::SensorDelay => format!("{target} is recorded {plain} late"),
        EditKind::InputDelay if is_negative => {
            format!("{target} is recorded {plain} late: the aircraft follows earlier")
        }
        EditKind::InputDelay => {
            format!("{target} is recorded {plain} early: the aircraft follows later")
        }
        EditKind::SensorLag => format!("{target} is recorded with a lag of {plain}"),
        EditKind::ActuatorLag => {
            format!("the aircraft follows the recorded {target} with a lag of {plain}")
        }
        EditKind::Backlash => {
            format!("there is play (backlash) behind {target}: half its dead band is {plain}")
        }
        _ => return None,
    };
    Some(text)
}

/// A size by itself, times a sign: short times in milliseconds.
fn measured(sign: f64, size: &Size) -> String {
    let (value, error, unit) = shown(size);
    let is_short = unit == "s" && value.abs() < 1.0;
    let (scale, unit) = if is_short {
        (1e3, "ms")
    } else {
        (1.0, unit.as_str())
    };
    let text = match error {
        Some(error) => with_error(sign * scale * value, scale * error),
        None => five_digits(sign * scale * value),
    };
    if unit == "-" {
        text
    } else {
        format!("{text} {unit}")
    }
}

/// A size with its bound: angles in degrees, frequencies in Hz.
pub(super) fn written(size: &Size) -> String {
    let (value, error, unit) = shown(size);
    let value = match error {
        Some(error) => with_error(value, error),
        None => five_digits(value),
    };
    let unit = if unit == "-" {
        String::new()
    } else {
        format!(" {unit}")
    };
    let segment = (size.segment.as_ref()).map_or(String::new(), |label| format!(" in {label}"));
    format!("{} = {value}{unit}{segment}", size.name)
}

/// Value, standard error and unit as people read them.
fn shown(size: &Size) -> (f64, Option<f64>, String) {
    match size.role {
        AddedRole::Frequency => {
            let turns = |rate: f64| rate / std::f64::consts::TAU;
            let error = size.standard_error_si().map(turns);
            (turns(size.value), error, "Hz".to_string())
        }
        _ => {
            let Shown { scale, unit } = shown_in(&size.unit);
            let error = size.standard_error.map(|error| error * scale);
            (size.own_units() * scale, error, unit)
        }
    }
}

/// An effect in words; `first` is the size that it is called after.
fn words(effect: &Effect, first: Option<&Size>) -> String {
    let is_negative = first.is_some_and(|size| size.value < 0.0);
    let target = effect.target.as_str();
    let term = effect.term.as_deref().unwrap_or_default();
    let kind = match effect.kind {
        EffectKind::Treatment(Treatment::ProcessNoise) => {
            return format!(
                "{target} is disturbed by a force that nothing recorded tells of, such as turbulence (process noise)"
            );
        }
        EffectKind::Treatment(Treatment::SensorOutliers) => {
            return format!("{target} has samples that are no measurements (outliers)");
        }
        EffectKind::Treatment(Treatment::Own) => {
            return format!("the candidate '{target}' is there");
        }
        EffectKind::Edit(kind) => kind,
    };
    match kind {
        EditKind::FixedParameter => format!("{target} is not what the model holds it at"),
        EditKind::SensorBias | EditKind::InputBias => format!("{target} is recorded with a bias"),
        EditKind::SensorScale | EditKind::InputScale => {
            format!("{target} is recorded with a wrong scale")
        }
        EditKind::SensorDrift => format!("{target} drifts"),
        EditKind::SensorDelay if is_negative => format!("{target} is recorded early"),
        EditKind::SensorDelay => format!("{target} is recorded late"),
        EditKind::InputDelay if is_negative => {
            format!("{target} is recorded late: the aircraft follows earlier")
        }
        EditKind::InputDelay => format!("{target} is recorded early: the aircraft follows later"),
        EditKind::MissingTerm => format!("the equation of {target} lacks a term in {term}"),
        EditKind::SensorLag => format!("{target} is recorded with a lag"),
        EditKind::SensorCrossAxis => format!("the sensor of {target} sees {term} too (cross-axis)"),
        EditKind::SwappedChannels => match target.split_once('+') {
            Some((one, other)) => format!("{one} and {other} are recorded under each other's name"),
            None => format!("{target} are recorded under each other's name"),
        },
        EditKind::SensorPosition => {
            format!("the sensor of {target} is not where the model has it along {term}")
        }
        EditKind::ActuatorLag => format!("the aircraft follows the recorded {target} with a lag"),
        EditKind::ActuatorRateLimit => format!("the actuator behind {target} is limited in rate"),
        EditKind::Backlash => format!("there is play (backlash) behind {target}"),
        EditKind::UnrecordedInput => {
            format!("the equation of {target} lacks the input {term}, which is recorded")
        }
        EditKind::UnsteadyAero => {
            format!("{target} follows {term} with a lag of the flow (unsteady aerodynamics)")
        }
        EditKind::StallHysteresis => {
            format!(
                "the flow separates, and comes back late (stall hysteresis), which {target} shows"
            )
        }
        EditKind::Gust if term.is_empty() => format!("{target} meets a gust in each maneuver"),
        EditKind::Gust => format!("{target} meets a gust in {term}"),
        EditKind::Wind => format!("there is wind along {target} ({term})"),
        EditKind::InitialState => format!("{target} does not begin where the model has it"),
        EditKind::StructuralMode => {
            format!("{target} swings with a structural mode that {term} excites")
        }
    }
}
