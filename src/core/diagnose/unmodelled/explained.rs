//! How well a force in one equation explains the residual, with the noise that suits it then.
//!
//! The colour of a residual that holds a force is no noise's. Each hypothesis has its own: it is estimated from what is
//! left, and again, as long as the marginal likelihood grows. What is left is uncertain where θ and the force are: the
//! colour is that of the noise itself, on average over what it may be (an EM step), or it would miss just what θ and the
//! force take off it.

use std::borrow::Cow;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::flown::Samples;
use super::metric::Metric;
use super::normal::Normal;
use super::responses::Response;
use super::smoothness::{Posterior, Smoothness};
use crate::diagnose::colour::Colour;

/// Colours that follow one another, at most.
const PASSES: usize = 4;

/// The same case has the same answer.
const SEED: u64 = 1;

/// What is left of ln L to be gained is not worth a pass.
const SETTLED: f64 = 0.1;

/// The residual explained by noise alone.
pub(super) struct Noise {
    /// ln L, the orders paid for.
    pub ln_evidence: f64,
    pub colour: Colour,
}

impl Noise {
    /// `None` where something is not a number.
    pub(super) fn of(from: &Samples) -> Option<Self> {
        let mut colour = Colour::of_best_order(&from.layout, &from.residual);
        let mut chance = ChaCha8Rng::seed_from_u64(SEED);
        let mut best: Option<Self> = None;
        for _ in 0..PASSES {
            let metric = Metric::new(Cow::Borrowed(from), colour)?;
            let ln_evidence = metric.ln_evidence();
            let before = best.as_ref().map_or(f64::NEG_INFINITY, |b| b.ln_evidence);
            let noise = (metric.clear / metric.samples).sqrt();
            let draws = metric.draws(noise, None, &mut chance);
            colour = Colour::of_draws(&from.layout, &draws);
            if ln_evidence > before {
                best = Some(Self {
                    ln_evidence,
                    colour: metric.colour,
                });
            }
            if ln_evidence < before + SETTLED {
                break;
            }
        }
        best
    }
}

/// The residual explained by noise and a force in one equation.
pub(super) struct Explained<'f> {
    pub ln_evidence: f64,
    pub metric: Metric<'f>,
    pub normal: Normal,
    pub posterior: Posterior,
}

impl<'f> Explained<'f> {
    /// ln L with the noise as it is without a force, or white noise: what is quickly said of an equation, and at most as much as
    /// [`Self::by`] comes to. `None` where something is not a number.
    pub(super) fn at_first_sight(
        from: &'f Samples,
        noise: &Noise,
        responses: &[&Response],
        smoothness: &[Smoothness],
    ) -> Option<Self> {
        let white = Colour::white(&from.layout, &from.residual);
        let coloured = Self::with(from, noise.colour.clone(), responses, smoothness)?;
        let white = Self::with(from, white, responses, smoothness)?;
        let both = [coloured, white].into_iter();
        both.max_by(|a, b| a.ln_evidence.total_cmp(&b.ln_evidence))
    }

    /// `None` where something is not a number.
    pub(super) fn by(
        from: &'f Samples,
        noise: &Noise,
        responses: &[&Response],
        smoothness: &[Smoothness],
    ) -> Option<Self> {
        let white = Colour::white(&from.layout, &from.residual);
        let mut chance = ChaCha8Rng::seed_from_u64(SEED);
        let mut best: Option<Self> = None;
        for start in [noise.colour.clone(), white] {
            let mut colour = start;
            let mut before = f64::NEG_INFINITY;
            for _ in 0..PASSES {
                let explained = Self::with(from, colour, responses, smoothness)?;
                let Self {
                    metric,
                    normal,
                    posterior,
                    ..
                } = &explained;
                let force = Some((normal, responses, posterior));
                let draws = metric.draws(posterior.noise, force, &mut chance);
                colour = Colour::of_draws(&from.layout, &draws);
                let gain = explained.ln_evidence - before;
                before = explained.ln_evidence;
                if best
                    .as_ref()
                    .is_none_or(|best| explained.ln_evidence > best.ln_evidence)
                {
                    best = Some(explained);
                }
                if gain < SETTLED {
                    break;
                }
            }
        }
        best
    }

    fn with(
        from: &'f Samples,
        colour: Colour,
        responses: &[&Response],
        smoothness: &[Smoothness],
    ) -> Option<Self> {
        let metric = Metric::new(Cow::Borrowed(from), colour)?;
        let normal = metric.normal(responses);
        let posterior = Posterior::likeliest((metric.clear, metric.samples), &normal, smoothness)?;
        Some(Self {
            ln_evidence: metric.ln_whitening + posterior.ln_likelihood,
            metric,
            normal,
            posterior,
        })
    }
}
