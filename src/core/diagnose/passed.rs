//! A candidate that passed the gate, and by what it is chosen among the others that did.

use super::fitted::Fitted;
use super::report::OutputGain;
use super::trial::Trial;

/// The price of a size of which nothing is known,
const UNKNOWN: f64 = 4.0;

/// and the most that a known one may cost: the data have the last word.
const SURPRISING: f64 = 12.0;

/// What is left of the residual once the likeliest candidate is in the model.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Noise {
    /// Plain errors are twice a log-likelihood, of other flights than were fitted: what both say is their sum.
    White,
    /// Each can mislead: whitening discards what is slow, and plain errors take colour for signal. What both say is twice
    /// their geometric mean, for white noise would make them alike.
    Coloured,
}

impl Noise {
    /// As the likeliest of some candidates leaves it.
    pub(super) fn left_by(passed: &[Passed]) -> Self {
        let likeliest = passed.iter().max_by(|a, b| {
            a.trial
                .likelihood_ratio
                .total_cmp(&b.trial.likelihood_ratio)
        });
        match likeliest {
            Some(likeliest) if !likeliest.settled.is_coloured() => Self::White,
            _ => Self::Coloured,
        }
    }
}

/// A candidate with nothing against it.
#[derive(Clone, Debug)]
pub(super) struct Passed {
    pub trial: Trial,
    /// What is reported of it: converged, by output error.
    pub settled: Fitted,
    /// By output, N ln(σ0²/σ1²) on flights that were not fitted; empty where there are none.
    pub gains: Vec<OutputGain>,
    /// Their sum; where all flights were fitted, that of these. `None` of what no flight can tell: process noise, and a gust
    /// of flights that were not fitted.
    pub plain_gain: Option<f64>,
}

impl Passed {
    /// By what candidates are chosen: what the data say for it, less the price of its parameters (Schwarz) and of a size that
    /// is not usual.
    pub(super) fn merit(&self, noise: Noise) -> f64 {
        let samples = self.settled.problem.samples().max(1) as f64;
        let price = self.trial.freedom as f64 * samples.ln();
        self.said(noise) - price - self.surprise()
    }

    /// What two gains say together: of the likelihood with coloured noise, and of the plain errors that an engineer is
    /// shown.
    fn said(&self, noise: Noise) -> f64 {
        let ratio = self.trial.likelihood_ratio;
        let both = |plain: f64| match noise {
            Noise::White => ratio + plain,
            Noise::Coloured => 2.0 * (ratio.max(0.0) * plain.max(0.0)).sqrt(),
        };
        match self.plain_gain.map(both) {
            // it may be in the flights that were fitted alone
            Some(both) if self.trial.effect.is_local_in_time() => both.max(ratio),
            Some(both) => both,
            None => ratio,
        }
    }

    /// Twice the logarithm of how usual its size is, where that is known of its instrument: of candidates that the data
    /// cannot tell apart the more usual one comes first.
    fn surprise(&self) -> f64 {
        let Some(plausible) = self.trial.effect.plausible else {
            return UNKNOWN;
        };
        let size = (self.trial.added.first())
            .map(|size| self.settled.sizes(std::slice::from_ref(size)))
            .and_then(|sizes| sizes.first().map(|size| size.value));
        match size {
            Some(size) if plausible.sd > 0.0 && self.trial.effect.vanishes_at_zero() => {
                (size / plausible.sd).powi(2).min(SURPRISING)
            }
            _ => UNKNOWN,
        }
    }

    /// What a linear step promised of it: of the likelihood, and of plain errors. What was tried outright has kept it.
    pub(super) fn promise(&self) -> (f64, f64) {
        let reached = (
            self.trial.likelihood_ratio,
            self.plain_gain
                .unwrap_or(0.0)
                .max(self.trial.likelihood_ratio),
        );
        (self.trial.screened.as_ref()).map_or(reached, |seen| {
            let promised = (seen.promise.max(seen.score), seen.plain);
            (promised.0.min(reached.0), promised.1.min(reached.1))
        })
    }
}
