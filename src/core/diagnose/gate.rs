//! The gate: what speaks against accepting a candidate that was tried.
//!
//! Whether an effect is there at all is asked of the likelihood with coloured noise. What an engineer is then shown, its
//! size, its bound and the errors, is the estimate by output error: it must say the same.

use super::case::Case;
use super::effect::{Effect, EffectKind};
use super::fitted::Fitted;
use super::heard::{Heard, plain_gain, predictive};
use super::null_model::NullModel;
use super::passed::Passed;
use super::refused::{Objection, differs};
use super::repeats::disagreement;
use super::report::Refusal;
use super::sentence;
use super::size::Size;
use super::swapped;
use super::threshold::Threshold;
use super::trial::Trial;
use crate::estimate::Bound;
use crate::model::{Added, AddedRole, EditKind};

/// A size within so many standard errors of nothing is nothing that one can tell an engineer of.
const LEAST_ERRORS: f64 = 2.0;

/// A flow about an aircraft, and the downwash on its way to the tail, form while it flies some ten chords or the length of
/// its tail (Wagner's function; l/V): with margin within this time, s, of aircraft from gliders to transports.
const SLOWEST_FLOW: f64 = 0.6;

/// A frequency or a time that is told is at least so many of its standard errors.
const LEAST_TOLD: f64 = 4.0;

/// Two sizes of a larger correlation are one.
const TIED: f64 = 0.97;

/// Lets a candidate pass, or says what speaks against it.
///
/// # Errors
/// The first objection.
pub(super) fn pass(
    null: &NullModel<'_>,
    trial: Trial,
    threshold: Threshold,
) -> Result<Passed, Box<(Trial, Objection)>> {
    match judge(null, &trial, threshold) {
        Ok((settled, Heard { gains, again })) => Ok(Passed {
            plain_gain: again.or_else(|| plain_gain(null, &trial.effect, &settled, &gains)),
            trial,
            settled,
            gains,
        }),
        Err(objection) => Err(Box::new((trial, objection))),
    }
}

fn judge(
    null: &NullModel<'_>,
    trial: &Trial,
    threshold: Threshold,
) -> Result<(Fitted, Heard), Objection> {
    let least = threshold.of(trial.freedom, trial.starts);
    significant(trial, least)?;
    within_range(&trial.effect, &trial.likeliest, &trial.added)?;
    is_of_its_kind(&trial.effect, &trial.likeliest, &trial.added)?;
    let settled = settle(null.case, trial)?;
    holds(&trial.effect, &settled, &trial.added)?;
    told_from_earlier(null, &settled, &trial.added)?;
    repeats(trial, &settled)?;
    let heard = predictive(null, trial, &settled, least)?;
    Ok((settled, heard))
}

fn significant(trial: &Trial, least: f64) -> Result<(), Objection> {
    let ratio = trial.likelihood_ratio;
    if ratio >= least {
        return Ok(());
    }
    if let Some(screened) = trial
        .screened
        .as_ref()
        .filter(|screened| screened.differs())
    {
        return Err((Refusal::NotRepeatable, differs(ratio, screened.own)));
    }
    let why = format!(
        "a likelihood ratio of {ratio:.1} is no more than noise gives among so many candidates (critical value {least:.1})"
    );
    Err((Refusal::NotSignificant, why))
}

/// Whether the size in a settled fit is one that can be told of: inside its range, and clearly not nothing.
///
/// # Errors
/// What speaks against it.
pub(super) fn holds(effect: &Effect, settled: &Fitted, added: &[Added]) -> Result<(), Objection> {
    within_range(effect, settled, added)?;
    is_of_its_kind(effect, settled, added)?;
    told_from_nothing(effect, settled, added)
}

fn within_range(effect: &Effect, fitted: &Fitted, added: &[Added]) -> Result<(), Objection> {
    let mut at_bound = fitted.at_bound(added);
    at_bound.retain(|(added, bound)| decides(effect, added.role, *bound));
    match at_bound.first() {
        None => Ok(()),
        Some((added, _)) => Err((
            Refusal::OutOfRange,
            format!(
                "its estimate ends at a bound of its physical range ({})",
                at_bound_of(fitted, added)
            ),
        )),
    }
}

/// A parameter that stands at a bound, with its value.
fn at_bound_of(fitted: &Fitted, added: &Added) -> String {
    match fitted.sizes(std::slice::from_ref(added)).first() {
        Some(size) => sentence::written(size),
        None => added.name.clone(),
    }
}

/// Whether the numbers that make it what it is called are those of such an effect: a flow forms in a time that the
/// aircraft takes to fly some lengths of its own, and a mode has a frequency.
fn is_of_its_kind(effect: &Effect, fitted: &Fitted, added: &[Added]) -> Result<(), Objection> {
    let error_of = |size: &Size| size.standard_error_si().unwrap_or(0.0);
    let of = |role: AddedRole| {
        let added = added.iter().find(|added| added.role == role)?;
        let sizes = fitted.sizes(std::slice::from_ref(added));
        sizes.into_iter().next()
    };
    match effect.kind {
        EffectKind::Edit(EditKind::UnsteadyAero) => match of(AddedRole::TimeConstant) {
            Some(time) if is_too_slow(time.value, error_of(&time)) => Err((
                Refusal::OutOfRange,
                format!(
                    "a flow that follows {:.2} s late is none: it forms within {SLOWEST_FLOW} s",
                    time.value
                ),
            )),
            _ => Ok(()),
        },
        EffectKind::Edit(EditKind::StructuralMode) => match of(AddedRole::Frequency) {
            Some(mode) if is_not_told(mode.value, error_of(&mode)) => Err((
                Refusal::OutOfRange,
                "the data do not tell its frequency: what swings so is no mode".into(),
            )),
            _ => Ok(()),
        },
        EffectKind::Edit(EditKind::SwappedChannels) => match of(AddedRole::Size) {
            Some(share) if !swapped::is_whole(share.value) => Err((
                Refusal::OutOfRange,
                format!(
                    "exchanged channels are exchanged in whole, not by {:.2}",
                    share.value
                ),
            )),
            _ => Ok(()),
        },
        _ => Ok(()),
    }
}

/// Whether a flow that follows after a `time` ± `error` is none: slower than any, or not told.
fn is_too_slow(time: f64, error: f64) -> bool {
    let at_least = time - LEAST_ERRORS * error;
    time > SLOWEST_FLOW && (at_least > SLOWEST_FLOW || is_not_told(time, error))
}

/// Whether the error of a frequency or a time is so large that it is none.
fn is_not_told(value: f64, error: f64) -> bool {
    value.abs() < LEAST_TOLD * error
}

/// The fit that is reported: converged, by output error.
fn settle(case: &Case, trial: &Trial) -> Result<Fitted, Objection> {
    if trial.effect.is_noise() {
        return Ok(trial.likeliest.clone());
    }
    let document = trial.likeliest.document.clone();
    let settled = Fitted::settled(case, document, &trial.likeliest.values());
    let settled = settled.map_err(|why| (Refusal::NotFitted, why.to_string()))?;
    if settled.is_settled() {
        Ok(settled)
    } else {
        let why = format!(
            "the fit with it does not converge: {}",
            settled.estimate.reason
        );
        Err((Refusal::NotFitted, why))
    }
}

/// Some size that it adds is clearly not nothing.
fn told_from_nothing(effect: &Effect, fitted: &Fitted, added: &[Added]) -> Result<(), Objection> {
    if !effect.vanishes_at_zero() {
        return Ok(());
    }
    let Some(size) = added.first() else {
        return Ok(());
    };
    let sizes = fitted.sizes(std::slice::from_ref(size));
    let told = sizes.iter().any(|size| {
        size.standard_error
            .is_none_or(|error| size.own_units().abs() > LEAST_ERRORS * error)
    });
    match sizes.first() {
        Some(size) if !told => {
            let error = size.standard_error.unwrap_or(f64::NAN);
            let why = format!(
                "its size is within {LEAST_ERRORS} standard errors of nothing: {:.2e} ± {error:.1e} {}",
                size.own_units(),
                size.unit
            );
            Err((Refusal::NotSignificant, why))
        }
        _ => Ok(()),
    }
}

/// Its size is not tied to that of an effect that is in the model already: two that nearly cancel (all outputs late, and
/// the input early) are each significant, and together next to nothing.
fn told_from_earlier(
    null: &NullModel<'_>,
    fitted: &Fitted,
    added: &[Added],
) -> Result<(), Objection> {
    let names: Vec<&str> = (fitted.estimate.parameters.iter())
        .filter(|row| !row.fixed)
        .map(|row| row.name.as_str())
        .collect();
    let places = |of: &[Added]| -> Vec<usize> {
        (0..names.len())
            .filter(|&place| of.iter().any(|added| added.name == names[place]))
            .collect()
    };
    let (new, earlier) = (places(added), places(null.earlier));
    let correlation = &fitted.estimate.correlation;
    for &i in &new {
        for &j in &earlier {
            let tied = correlation.get(i).and_then(|row| row.get(j));
            if tied.is_some_and(|r| r.abs() > TIED) {
                let why = format!(
                    "the data cannot tell it from {}, which is in the model already (correlation {:.3})",
                    names[j], correlation[i][j]
                );
                return Err((Refusal::Outdone, why));
            }
        }
    }
    Ok(())
}

/// Each of its sizes is the same in all parts of the data.
fn repeats(trial: &Trial, settled: &Fitted) -> Result<(), Objection> {
    if trial.effect.is_local_in_time() {
        return Ok(());
    }
    let is_size = |(place, added): &(usize, &Added)| *place == 0 || added.role == AddedRole::Size;
    let mut sizes = trial.added.iter().enumerate().filter(is_size);
    match sizes.find_map(|(_, size)| disagreement(settled, &size.name)) {
        Some(why) => Err((Refusal::NotRepeatable, why)),
        None => Ok(()),
    }
}

/// Whether a parameter at its bound speaks against the effect: how steeply and how late the flow separates is hardly seen
/// in many a stall, at which angle it does is; and how lightly a mode is damped is not seen in a short flight, while one
/// that is damped heavily is none.
fn decides(effect: &Effect, role: AddedRole, bound: Bound) -> bool {
    use AddedRole::{Damping, Delay, Steepness, TimeConstant};
    match effect.kind {
        EffectKind::Edit(EditKind::StallHysteresis) => {
            !matches!(role, Steepness | TimeConstant | Delay)
        }
        EffectKind::Edit(EditKind::StructuralMode) => (role, bound) != (Damping, Bound::Lower),
        _ => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two standard errors below the limit is no flow that is too slow; one that is told by less than four is none at all.
    #[test]
    fn a_flow_is_as_fast_as_its_error_lets_it_be() {
        for (time, error, too_slow) in [
            (0.5, 0.2, false),
            (0.7, 0.1, false),
            (2.0, 0.1, true),
            (4.0, 2.0, true),
        ] {
            assert_eq!(is_too_slow(time, error), too_slow, "{time} ± {error} s");
        }
    }
}
