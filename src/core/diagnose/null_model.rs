//! The null model: the model as it is, which a candidate has to beat.

use std::sync::OnceLock;

use super::case::{Case, Unfit};
use super::colour::Colour;
use super::elsewhere::Elsewhere;
use super::fitted::Fitted;
use super::predicted::Predicted;
use super::projection::norm;
use super::stack::Layout;
use crate::estimate::Role;
use crate::model::Added;

pub(super) struct NullModel<'c> {
    pub case: &'c Case,
    /// Fitted by output error.
    pub base: &'c Fitted,
    /// Parameters of the effects that are in it already.
    pub earlier: &'c [Added],
    /// ln L with the noise that suits it, where that is greatest.
    pub ln_evidence: f64,
    /// Of flights that were not fitted; `None` where there are none.
    pub predicted: Option<Predicted>,
    /// The model without any effect, fitted to those flights alone, once that is asked for.
    elsewhere: OnceLock<Option<Elsewhere>>,
    colour: Colour,
    layout: Layout,
}

impl<'c> NullModel<'c> {
    /// # Errors
    /// The flights that were not fitted cannot be predicted.
    pub(super) fn new(
        case: &'c Case,
        base: &'c Fitted,
        earlier: &'c [Added],
    ) -> Result<Self, Unfit> {
        let layout = Layout::of(&base.problem);
        Ok(Self {
            case,
            base,
            earlier,
            ln_evidence: base.clone().likeliest().ln_evidence(),
            predicted: Predicted::of(base, case, Role::Validation)?,
            elsewhere: OnceLock::new(),
            colour: Colour::of_best_order(&layout, &base.residual),
            layout,
        })
    }

    /// What an effect is worth to the flights that were not fitted, were they fitted themselves: twice the gain of ln L.
    /// `None` where it is not clearly there, or has another size.
    pub(super) fn shown_again(
        &self,
        settled: &Fitted,
        added: &[Added],
        freedom: usize,
    ) -> Option<f64> {
        let elsewhere = self
            .elsewhere
            .get_or_init(|| Elsewhere::of(self.case, self.base));
        elsewhere.as_ref()?.shows(settled, added, freedom)
    }

    /// What a fit takes off the whitened residual, of length 1.
    pub(super) fn explained_by(&self, fitted: &Fitted) -> Vec<f64> {
        let before = &self.base.residual;
        let pairs = before.iter().zip(&fitted.residual);
        let taken: Vec<f64> = pairs.map(|(before, after)| before - after).collect();
        let mut taken = self.colour.whiten(&self.layout, before, &taken);
        let length = norm(&taken).max(f64::MIN_POSITIVE);
        taken.iter_mut().for_each(|value| *value /= length);
        taken
    }
}
