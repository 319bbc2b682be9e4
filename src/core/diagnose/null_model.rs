//! The null model: the model as it is, which a candidate has to beat by more than noise alone would.

use super::case::Case;
use super::colour::Colour;
use super::effect::{Effect, EffectKind};
use super::fitted::Fitted;
use super::found::Accepted;
use super::projection::norm;
use super::report::{Evidence, Member, OutputGain, Refusal};
use super::screen::{Screen, Screened, critical, tail};
use super::stack::Layout;
use super::trial::{Trial, fit, starts, starts_of_delay};
use crate::estimate::Role;
use crate::model::{Added, AddedRole, EditKind, Edited, Per};

/// How often the whole family of candidates may find something where there is nothing, by its own statistics.
const FAMILY_ERROR: f64 = 0.005;

/// Sizes in parts of the data may differ like this once in so many effects that are real.
const UNLIKELY_SCATTER: f64 = 1e-4;

/// 80 % power: this many standard deviations beyond the critical value.
pub(super) const POWER: f64 = 0.84;

/// Fits whose ln L differ by less ended at the same minimum.
const SAME: f64 = 1e-3;

/// So many of the minima found are followed to where the likelihood is greatest.
const BEST: usize = 4;

/// The value that a likelihood ratio has to exceed.
pub(super) struct Threshold {
    /// Independent ones that the candidates ask.
    pub questions: f64,
}

impl Threshold {
    /// Each start from which a candidate was fitted is a question more: what has no place or frequency before it is
    /// found has many chances to be found in noise (Davies, Biometrika 74, 1987).
    pub(super) fn of(&self, freedom: usize, starts: usize) -> f64 {
        critical(FAMILY_ERROR / starts.max(1) as f64, self.questions, freedom)
    }
}

/// The model as it is, which a candidate has to beat.
pub(super) struct NullModel<'c> {
    case: &'c Case,
    base: &'c Fitted,
    orders: &'c [usize],
    ln_likelihood: f64,
    /// By output, of flights that were not fitted.
    held_out: Option<Vec<f64>>,
}

impl<'c> NullModel<'c> {
    pub(super) fn new(case: &'c Case, base: &'c Fitted, orders: &'c [usize]) -> Self {
        // both sides at the likeliest for coloured noise
        let polished = base.clone().polished(orders);
        let any = case.of_role(Role::Validation).next().is_some();
        let held_out = any
            .then(|| polished.held_out(case, Role::Validation, orders).ok())
            .flatten();
        Self {
            case,
            base,
            orders,
            ln_likelihood: polished.ln_likelihood(orders),
            held_out,
        }
    }

    pub(super) fn trial(
        &self,
        effect: Effect,
        screened: Option<Screened>,
    ) -> Result<Trial, String> {
        let edited = effect
            .apply(&self.base.document)
            .map_err(|error| error.to_string())?;
        let starts = match &screened {
            Some(seen) => {
                let further = starts_of_delay(self.case, &effect, &edited.added);
                seen.starts().into_iter().chain(further).collect()
            }
            None => starts(self.case, &effect, &edited),
        };
        let Edited {
            document, added, ..
        } = edited;
        let tried = screened.as_ref().map_or(starts.len(), |seen| seen.starts);
        let mut failure = String::new();
        let mut fits: Vec<(f64, Fitted)> = Vec::new();
        for start in &starts {
            match fit(self.case, self.base, &effect, document.clone(), start) {
                Ok(fitted) => fits.push((fitted.ln_likelihood(self.orders), fitted)),
                Err(why) => failure = why.to_string(),
            }
        }
        // where noise is coloured, output error may lead away from what is likeliest
        let coloured = self.orders.iter().any(|&order| order > 0);
        if let (true, false, Some(step)) = (coloured, effect.is_noise(), starts.first()) {
            let values = self.base.values_with(step);
            if let Ok(fitted) = Fitted::at(self.case, document.clone(), &values) {
                fits.push((fitted.ln_likelihood(self.orders), fitted));
            }
        }
        fits.retain(|(likelihood, _)| !likelihood.is_nan());
        // most starts end at the same minimum
        fits.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        fits.dedup_by(|(a, _), (b, _)| (*a - *b).abs() < SAME);
        fits.truncate(BEST);
        let polished = fits.into_iter().map(|(likelihood, fitted)| {
            if effect.is_noise() {
                return (likelihood, fitted);
            }
            let fitted = fitted.polished(self.orders);
            (fitted.ln_likelihood(self.orders), fitted)
        });
        let best = polished.max_by(|(a, _), (b, _)| a.total_cmp(b));
        let (ln_likelihood, fitted) = best.ok_or(failure)?;
        let likelihood_ratio = 2.0 * (ln_likelihood - self.ln_likelihood);
        let declared = self.base.problem.unknowns.len();
        let freedom = (fitted.problem.unknowns.len() - declared).max(1);
        let (mut held_out, mut unpredictable) = (None, None);
        let repeats = !effect.is_noise() && !is_local_in_time(&effect);
        if let (Some(before), true) = (&self.held_out, repeats) {
            match fitted.held_out(self.case, Role::Validation, self.orders) {
                Ok(after) => {
                    held_out = Some(
                        after
                            .iter()
                            .zip(before)
                            .map(|(a, b)| 2.0 * (a - b))
                            .collect(),
                    )
                }
                Err(why) => unpredictable = Some(why.to_string()),
            }
        }
        Ok(Trial {
            explained: self.explained(&fitted),
            effect,
            added,
            starts: tried,
            screened,
            fitted,
            likelihood_ratio,
            freedom,
            held_out,
            unpredictable,
        })
    }

    /// The part of the whitened residual that a fit explains, of length 1.
    fn explained(&self, fitted: &Fitted) -> Vec<f64> {
        let layout = Layout::of(&self.base.problem);
        let before = &self.base.residual;
        let colour = Colour::of_orders(&layout, before, self.orders);
        let taken: Vec<f64> = before
            .iter()
            .zip(&fitted.residual)
            .map(|(b, a)| b - a)
            .collect();
        let mut taken = colour.whiten(&layout, before, &taken);
        let length = norm(&taken).max(f64::MIN_POSITIVE);
        taken.iter_mut().for_each(|value| *value /= length);
        taken
    }

    /// The objection to accepting it, if there is one.
    pub(super) fn objection(
        &self,
        trial: &Trial,
        threshold: &Threshold,
    ) -> Option<(Refusal, String)> {
        let (ratio, least) = (
            trial.likelihood_ratio,
            threshold.of(trial.freedom, trial.starts),
        );
        if ratio.is_nan() || ratio < least {
            let why = format!(
                "a likelihood ratio of {ratio:.1} is no more than noise gives among so many candidates (critical value {least:.1})"
            );
            return Some((Refusal::NotSignificant, why));
        }
        let decisive = |added: &&&Added| decides(&trial.effect, added.role);
        if let Some(added) = (trial.fitted.at_bound(&trial.added).iter()).find(decisive) {
            let name = &added.name;
            let why = format!("its estimate ends at a bound of its physical range ({name})");
            return Some((Refusal::OutOfRange, why));
        }
        if let Some(added) = self.settled_at_bound(trial).iter().find(decisive) {
            let name = &added.name;
            let why = format!(
                "output error takes its estimate to a bound of its physical range ({name})"
            );
            return Some((Refusal::OutOfRange, why));
        }
        if let Some(why) = self.scatter(trial) {
            return Some((Refusal::NotRepeatable, why));
        }
        if let Some(why) = &trial.unpredictable {
            return Some((Refusal::NotPredictive, why.clone()));
        }
        if let Some(gains) = &trial.held_out {
            let gain: f64 = gains.iter().sum();
            if gain <= 0.0 {
                let why = format!(
                    "flights that were not fitted are predicted worse with it: their log-likelihood falls by {:.1}",
                    -0.5 * gain
                );
                return Some((Refusal::NotPredictive, why));
            }
        }
        None
    }

    /// The likelihood weighs fast residuals, output error slow ones: an effect that is real stands before both.
    fn settled_at_bound<'t>(&self, trial: &'t Trial) -> Vec<&'t Added> {
        let coloured = self.orders.iter().any(|&order| order > 0);
        if !coloured || trial.effect.is_noise() {
            return Vec::new();
        }
        let document = trial.fitted.document.clone();
        // where output error comes to nothing it speaks neither for nor against
        Fitted::trial(self.case, document, &trial.fitted.values())
            .map(|settled| settled.at_bound(&trial.added))
            .unwrap_or_default()
    }

    /// Why the sizes in parts of the data do not agree; by the noise that is left with the effect in the model.
    fn scatter(&self, trial: &Trial) -> Option<String> {
        trial.screened.as_ref()?;
        let parameters = &trial.fitted.problem.model.parameters;
        let info = trial.added.iter().find_map(|added| {
            let mut free = parameters.iter().filter(|info| !info.document.fixed);
            free.find(|info| info.name == added.name)
        })?;
        if info.document.per == Per::Maneuver || is_local_in_time(&trial.effect) {
            return None;
        }
        // from the fit with the effect: how far each part would still pull it
        let layout = Layout::of(&trial.fitted.problem);
        let colour = Colour::of_orders(&layout, &trial.fitted.residual, self.orders);
        let screen = Screen::new(self.case, &trial.fitted, &colour)?;
        let folds = screen.pulls(&info.name)?;
        let size = *trial.fitted.values().get(&(info.name.clone(), None))?;
        let chi_squared: f64 = folds
            .iter()
            .map(|(pull, error)| (pull / error).powi(2))
            .sum();
        let freedom = folds.len().saturating_sub(1);
        if freedom == 0 || tail(chi_squared, freedom) > UNLIKELY_SCATTER {
            return None;
        }
        // large effects show second-order differences: sizes that agree within a third are the same effect
        let spread = folds.iter().map(|(pull, _)| pull.abs()).fold(0.0, f64::max);
        if spread < size.abs() / 3.0 {
            return None;
        }
        let sizes: Vec<String> = folds
            .iter()
            .map(|(pull, error)| format!("{:.3e} ± {error:.1e}", size + pull))
            .collect();
        Some(format!(
            "its size differs between parts of the data: {} (SI)",
            sizes.join(", ")
        ))
    }

    pub(super) fn accepted(
        &self,
        best: Trial,
        group: Vec<Member>,
        threshold: &Threshold,
    ) -> Accepted {
        let outputs = self.base.problem.model.outputs.iter();
        let gains = best.held_out.iter().flatten();
        let screened = best.screened.as_ref();
        Accepted {
            group,
            evidence: Evidence {
                likelihood_ratio: best.likelihood_ratio,
                threshold: threshold.of(best.freedom, best.starts),
                score: screened.map(|s| s.score),
                visible_fraction: screened.map(|s| s.visible),
                smallest_seen: screened.map(|s| s.one_sigma * (threshold.of(1, 1).sqrt() + POWER)),
                held_out: best.held_out.as_ref().map(|gains| gains.iter().sum()),
                held_out_by_output: (outputs.zip(gains))
                    .map(|(output, &gain)| OutputGain {
                        output: output.name.clone(),
                        gain,
                    })
                    .collect(),
            },
            added: best.added,
            effect: best.effect,
            fitted: best.fitted,
        }
    }
}

/// Whether a parameter at its bound speaks against the effect: how steeply and how late the flow separates is hardly seen
/// in many a stall, at which angle it does is.
fn decides(effect: &Effect, role: AddedRole) -> bool {
    use AddedRole::{Delay, Steepness, TimeConstant};
    let is_stall = effect.kind == EffectKind::Edit(EditKind::StallHysteresis);
    !(is_stall && matches!(role, Steepness | TimeConstant | Delay))
}

/// Effects that stand at one place in time repeat in no other part.
fn is_local_in_time(effect: &Effect) -> bool {
    use EditKind::{Gust, InitialState};
    matches!(effect.kind, EffectKind::Edit(Gust | InitialState))
}
