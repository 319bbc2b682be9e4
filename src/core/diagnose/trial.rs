//! Trials: a candidate is fitted from each of its starts, and followed to where it is likeliest.

use super::case::{Case, Unfit, Values};
use super::disturbed::disturbed;
use super::effect::Effect;
use super::fitted::Fitted;
use super::null_model::NullModel;
use super::screen::Screened;
use super::starts::{starts, starts_of_delay};
use crate::model::{Added, ModelDocument};

/// Fits whose ln L differ by less ended at the same minimum.
const SAME: f64 = 1e-3;

/// So many of the minima found are followed to where the likelihood is greatest.
const BEST: usize = 3;

/// A candidate, fitted.
#[derive(Clone, Debug)]
pub(super) struct Trial {
    pub effect: Effect,
    /// From how many starts it was looked for.
    pub starts: usize,
    pub screened: Option<Screened>,
    /// The parameters that it adds, its size first.
    pub added: Vec<Added>,
    /// Where the likelihood with coloured noise is greatest.
    pub likeliest: Fitted,
    /// What it takes off the whitened residual, of length 1.
    pub explained: Vec<f64>,
    /// Twice the gain of the colour-aware log-likelihood over the model without it, each with the noise that suits it.
    pub likelihood_ratio: f64,
    /// Unknowns that it adds.
    pub freedom: usize,
}

impl Trial {
    /// Fits a candidate.
    ///
    /// # Errors
    /// Why it came to nothing.
    pub(super) fn of(
        null: &NullModel<'_>,
        effect: Effect,
        screened: Option<Screened>,
    ) -> Result<Self, String> {
        let (case, base) = (null.case, null.base);
        let edited = effect
            .apply(&base.document)
            .map_err(|error| error.to_string())?;
        let starts = match &screened {
            Some(seen) => {
                let further = starts_of_delay(case, &effect, &edited.added);
                seen.starts().into_iter().chain(further).collect()
            }
            None => starts(case, &effect, &edited),
        };
        let tried = screened.as_ref().map_or(starts.len(), |seen| seen.starts);
        let fitted_from = |starts: &[Values]| {
            let fits = fits(case, base, &effect, &edited.document, starts)?;
            Ok::<_, String>(likeliest(fits))
        };
        let mut best = fitted_from(&starts)?;
        // a model that holds the one without the effect explains no less: the step had led astray
        if let (true, Some(seen)) = (best.0 < null.ln_evidence, &screened)
            && let Ok(closer) = fitted_from(&[seen.close_start()])
            && closer.0 > best.0
        {
            best = closer;
        }
        let (ln_evidence, likeliest) = best;
        let declared = base.problem.unknowns.len();
        Ok(Self {
            added: edited.added,
            explained: null.explained_by(&likeliest),
            freedom: (likeliest.problem.unknowns.len().saturating_sub(declared)).max(1),
            likelihood_ratio: 2.0 * (ln_evidence - null.ln_evidence),
            effect,
            starts: tried,
            screened,
            likeliest,
        })
    }
}

/// Each start's fit with its evidence, the likeliest first, each minimum once.
fn fits(
    case: &Case,
    base: &Fitted,
    effect: &Effect,
    document: &ModelDocument,
    starts: &[Values],
) -> Result<Vec<(f64, Fitted)>, String> {
    let mut failure = String::new();
    let mut fits: Vec<(f64, Fitted)> = Vec::new();
    let mut keep = |fitted: Result<Fitted, Unfit>| match fitted {
        Ok(fitted) => fits.push((fitted.ln_evidence(), fitted)),
        Err(why) => failure = why.to_string(),
    };
    if effect.is_noise() {
        keep(disturbed(case, base, &effect.target));
    } else {
        for start in starts {
            let values = base.values_with(start);
            keep(Fitted::trial(case, document.clone(), &values));
        }
        // where noise is coloured, output error may lead away from what is likeliest
        if let (true, Some(step)) = (base.is_coloured(), starts.first()) {
            keep(Fitted::at(case, document.clone(), &base.values_with(step)));
        }
    }
    fits.retain(|(evidence, _)| !evidence.is_nan());
    if fits.is_empty() {
        return Err(failure);
    }
    fits.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    fits.dedup_by(|(a, _), (b, _)| (*a - *b).abs() < SAME);
    Ok(fits)
}

/// The likeliest of some fits once each has moved to where the likelihood with coloured noise is greatest.
fn likeliest(fits: Vec<(f64, Fitted)>) -> (f64, Fitted) {
    let moved = fits.into_iter().take(BEST).map(|(evidence, fitted)| {
        let fitted = fitted.likeliest();
        (fitted.ln_evidence().max(evidence), fitted)
    });
    moved
        .max_by(|(a, _), (b, _)| a.total_cmp(b))
        .expect("at least one fit")
}
