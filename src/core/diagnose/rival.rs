//! The rival of all names: a force of no form, in one equation of the declared model.
//!
//! It has a size and a smoothness and no idea. A name that explains hardly more than it may be that of something else that
//! moves the aircraft alike: the true form leaves it far behind.

use super::case::Case;
use super::effect::{EffectKind, Treatment};
use super::fitted::Fitted;
use super::found::Found;
use super::unmodelled::{self, Picture};

/// By so much of 2 ln L a name must be better than no name.
const BETTER: f64 = 6.0;

/// Several names together must be better by this factor: one force hardly has two forms.
const OF_SEVERAL: f64 = 1.5;

/// Turbulence has no form either: where it is told from a smooth force, it explains at least this share.
const AS_TURBULENCE: f64 = 0.8;

/// A force that explains what the declared model leaves as well as the effects that were named.
pub(super) struct Rival {
    pub picture: Picture,
    /// What the effects explain: twice their gain of ln L.
    pub named: f64,
}

impl Rival {
    /// `start` is the declared model as the rounds began, `last` that with all effects. `None` where these are clearly better,
    /// or there are none.
    pub(super) fn of(case: &Case, start: &Fitted, last: &Fitted, found: &Found) -> Option<Self> {
        let outliers = EffectKind::Treatment(Treatment::SensorOutliers);
        let is_form = |kind: EffectKind| kind != outliers;
        let names = found.accepted.iter().filter(|a| is_form(a.effect.kind));
        let names = names.count();
        if names == 0 {
            return None;
        }
        let named = 2.0 * (evidence(last) - evidence(start));
        let is_noise = found.accepted.iter().any(|a| a.effect.is_noise());
        let exceeds = |force: f64| match is_noise {
            true => named < AS_TURBULENCE * force,
            false if names > 1 => named < OF_SEVERAL * force,
            false => named < force + BETTER,
        };
        let picture = unmodelled::found_beyond(case, start, exceeds)?;
        Some(Self { picture, named })
    }
}

/// ln L where it is greatest; that of innovations is there already.
fn evidence(fitted: &Fitted) -> f64 {
    match fitted.estimate.filter {
        Some(_) => fitted.ln_evidence(),
        None => fitted.clone().likeliest().ln_evidence(),
    }
}
