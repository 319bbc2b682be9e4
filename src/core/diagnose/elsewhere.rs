//! Whether flights that were not fitted show an effect by themselves.
//!
//! A prediction takes all parameters as they are, and is judged by plain errors: with coloured noise an effect that is
//! clearly there may predict no better. Fitted with it and without it, such flights say whether it is there in the same
//! way as those that it was found in, and how large.

use super::case::Case;
use super::fitted::Fitted;
use super::screen::critical;
use super::size::Size;
use crate::estimate::Role;
use crate::model::{Added, AddedRole};

/// One effect is asked of, not a catalogue.
const ERROR: f64 = 1e-3;

/// Two sizes of one effect differ by no more than so many standard errors of their difference,
const AGREE: f64 = 3.0;

/// or by this share of it, where both are told very well.
const SHARE: f64 = 0.33;

/// The flights that were not fitted, as if they were, and the model without any effect fitted to them.
pub(super) struct Elsewhere {
    case: Case,
    ln_evidence: f64,
}

impl Elsewhere {
    /// `None` where there are none, or they cannot be fitted alone.
    pub(super) fn of(case: &Case, base: &Fitted) -> Option<Self> {
        let mut case = case.clone();
        case.flights
            .retain(|flight| flight.role == Role::Validation);
        (case.flights.iter_mut()).for_each(|flight| flight.role = Role::Estimation);
        if case.flights.is_empty() {
            return None;
        }
        let fitted = Fitted::trial(&case, base.document.clone(), &base.values()).ok()?;
        let ln_evidence = fitted.likeliest().ln_evidence();
        Some(Self { case, ln_evidence })
    }

    /// What an effect with parameters `added` is worth to them: twice the gain of ln L. `None` where it is not clearly there,
    /// or is another one: of another size, frequency or time. What each flight has of its own is asked for no likeness.
    pub(super) fn shows(&self, settled: &Fitted, added: &[Added], freedom: usize) -> Option<f64> {
        let document = settled.document.clone();
        let fitted = Fitted::settled(&self.case, document, &settled.values()).ok()?;
        let agree = added.iter().all(|added| {
            let of = |fitted: &Fitted| {
                let sizes = fitted.sizes(std::slice::from_ref(added));
                sizes.into_iter().find(|size| size.segment.is_none())
            };
            match (of(settled), of(&fitted)) {
                (Some(here), Some(there)) if added.role == AddedRole::Size => {
                    are_alike(&here, &there)
                }
                (Some(here), Some(there)) => are_within_chance(&here, &there),
                _ => true,
            }
        });
        let ratio = 2.0 * (fitted.likeliest().ln_evidence() - self.ln_evidence);
        (agree && ratio > critical(ERROR, 1.0, freedom)).then_some(ratio)
    }
}

fn are_alike(here: &Size, there: &Size) -> bool {
    let differ = (here.value - there.value).abs();
    let least = here.value.abs();
    here.value * there.value > 0.0 && differ < chance(here, there).min(least).max(SHARE * least)
}

fn are_within_chance(here: &Size, there: &Size) -> bool {
    let differ = (here.value - there.value).abs();
    differ < chance(here, there).max(SHARE * here.value.abs())
}

/// By how much two estimates of one size may differ.
fn chance(here: &Size, there: &Size) -> f64 {
    let error = |size: &Size| size.standard_error_si().unwrap_or(f64::INFINITY);
    AGREE * error(here).hypot(error(there))
}
