//! Effects in sentences that an engineer can read.

use super::effect::{Effect, EffectKind, Treatment};
use super::size::Size;
use crate::flight::{Shown, five_digits, shown_in};
use crate::model::EditKind;

/// An effect in words, with its size; angles in degrees.
pub(super) fn of(effect: &Effect, sizes: &[Size]) -> String {
    let size = |size: &Size| {
        let Shown { scale, unit } = shown_in(&size.unit);
        let unit = if unit == "-" { "" } else { &unit };
        let error = size
            .standard_error
            .map_or(String::new(), |e| format!(" ± {}", five_digits(e * scale)));
        let segment = size
            .segment
            .as_ref()
            .map_or(String::new(), |s| format!(" in {s}"));
        let estimate = five_digits(size.own_units() * scale);
        format!("{} = {estimate}{error} {unit}", size.name)
            .trim_end()
            .to_string()
            + &segment
    };
    let sizes: Vec<String> = sizes.iter().map(size).collect();
    let sizes = if sizes.is_empty() {
        String::new()
    } else {
        format!(" ({})", sizes.join(", "))
    };
    format!("{}{sizes}", words(effect))
}

/// An effect in words, without its size.
pub(super) fn words(effect: &Effect) -> String {
    let target = effect.target.as_str();
    let term = effect.term.as_deref().unwrap_or_default();
    let kind = match effect.kind {
        EffectKind::Treatment(Treatment::ProcessNoise) => {
            return format!("{target} is disturbed by turbulence (process noise)");
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
        EditKind::SensorDelay | EditKind::InputDelay => {
            format!("{target} is recorded with a time shift")
        }
        EditKind::MissingTerm => format!("the equation of {target} lacks a term in {term}"),
        EditKind::SensorLag => format!("{target} is recorded with a lag"),
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
        EditKind::Gust => format!("{target} meets a gust"),
        EditKind::Wind => format!("there is wind along {target} ({term})"),
        EditKind::InitialState => format!("{target} does not begin where the model has it"),
        EditKind::StructuralMode => {
            format!("{target} swings with a structural mode that {term} excites")
        }
    }
}
