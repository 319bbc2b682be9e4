//! The colour of residuals, and the likelihood that takes it into account.
//!
//! An autoregressive model per output (Burg's recursion: the order's prediction errors forwards and backwards are
//! least). Output-error residuals of real flights are coloured (lag-1 autocorrelation 0.8 to 0.96 is usual), and
//! what is tested as if they were white is nearly always "significant".

use super::stack::{Layout, Series};
use crate::stop;

/// e_k = Σ_m a_m e_(k−m) + w_k for every order up to the model's own, so that the first samples of a segment, and
/// those behind a gap, are predicted from what there is.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Autoregression {
    /// By order, from 0: the predictor's coefficients, the nearest sample's first.
    predictors: Vec<Vec<f64>>,
    /// By order: variance of the prediction error.
    variances: Vec<f64>,
}

/// A reflection coefficient beyond this is rounding, or a series that is no noise at all.
const MOST_REFLECTION: f64 = 0.999_999;

/// The highest order worth a look: noise of measuring systems is not more complicated, and an effect that is missing
/// must not be taken for colour.
pub(super) const MOST_ORDER: usize = 12;

impl Autoregression {
    /// Of the order of least Schwarz criterion N ln σ² + order ln N.
    pub(super) fn of_best_order(series: &[&[f64]]) -> Self {
        Self::of_copies(series, 1)
    }

    /// As [`Self::of_best_order`], of series that are so many draws of the same noise.
    fn of_copies(series: &[&[f64]], copies: usize) -> Self {
        let full = Self::of_order(series, MOST_ORDER);
        let finite = series.iter().flat_map(|s| s.iter());
        let n = finite.filter(|e| e.is_finite()).count() as f64 / copies.max(1) as f64;
        let criterion = |order: &usize| n * full.variances[*order].ln() + *order as f64 * n.ln();
        let orders = 0..full.variances.len();
        let best = orders
            .min_by(|a, b| criterion(a).total_cmp(&criterion(b)))
            .unwrap_or(0);
        full.truncated(best)
    }

    /// Of one order, or as near to it as the series are long. Samples that are not finite do not count.
    pub(super) fn of_order(series: &[&[f64]], order: usize) -> Self {
        stop::check();
        let finite = || {
            series
                .iter()
                .flat_map(|s| s.iter())
                .filter(|e| e.is_finite())
        };
        let power = finite().map(|e| e * e).sum::<f64>() / finite().count().max(1) as f64;
        let mut model = Self {
            predictors: vec![Vec::new()],
            variances: vec![power.max(f64::MIN_POSITIVE)],
        };
        let mut forward: Vec<Vec<f64>> = series.iter().map(|s| s.to_vec()).collect();
        let mut backward = forward.clone();
        let order = order.min(finite().count() / 8);
        for m in 0..order {
            stop::check();
            let (mut product, mut energy) = (0.0, 0.0);
            for (f, b) in forward.iter().zip(&backward) {
                for k in m + 1..f.len() {
                    let (f, b) = (f[k], b[k - 1]);
                    if f.is_finite() && b.is_finite() {
                        product += f * b;
                        energy += f * f + b * b;
                    }
                }
            }
            if energy <= 0.0 {
                break;
            }
            let reflection = (2.0 * product / energy).clamp(-MOST_REFLECTION, MOST_REFLECTION);
            stop::check();
            for (f, b) in forward.iter_mut().zip(&mut backward) {
                for k in (m + 1..f.len()).rev() {
                    let (before, behind) = (f[k], b[k - 1]);
                    f[k] = before - reflection * behind;
                    b[k] = behind - reflection * before;
                }
            }
            let last = &model.predictors[m];
            let mirrored = last.iter().rev();
            let mut next: Vec<f64> = last
                .iter()
                .zip(mirrored)
                .map(|(a, b)| a - reflection * b)
                .collect();
            next.push(reflection);
            model.predictors.push(next);
            let variance = model.variances[m] * (1.0 - reflection * reflection);
            model.variances.push(variance);
        }
        model
    }

    /// The predictor's coefficients, the nearest sample's first.
    pub(super) fn coefficients(&self) -> &[f64] {
        self.predictors.last().map_or(&[], Vec::as_slice)
    }

    /// Standard deviation of the prediction error.
    pub(super) fn deviation(&self) -> f64 {
        self.variances
            .last()
            .map_or(0.0, |variance| variance.sqrt())
    }

    pub(super) fn order(&self) -> usize {
        self.predictors.len() - 1
    }

    fn truncated(mut self, order: usize) -> Self {
        self.predictors.truncate(order + 1);
        self.variances.truncate(order + 1);
        self
    }

    /// Prediction errors over their standard deviations: `w = (x_k − Σ a_m x_(k−m))/σ`, of the order that the finite
    /// samples of `mask` before k allow; 0 where `mask` is not finite. Returns the sum of ln σ².
    pub(super) fn whiten(&self, mask: &[f64], x: &[f64], to: &mut [f64]) -> f64 {
        stop::check();
        let scales: Vec<f64> = self.variances.iter().map(|v| v.sqrt().recip()).collect();
        let ln_variances: Vec<f64> = self.variances.iter().map(|v| v.ln()).collect();
        let mut ln_variance = 0.0;
        let mut known = 0;
        for k in 0..x.len() {
            if !mask[k].is_finite() {
                (known, to[k]) = (0, 0.0);
                continue;
            }
            let order = known.min(self.order());
            let predicted: f64 = (self.predictors[order].iter().enumerate())
                .map(|(m, a)| a * x[k - 1 - m])
                .sum();
            to[k] = (x[k] - predicted) * scales[order];
            ln_variance += ln_variances[order];
            known += 1;
        }
        ln_variance
    }
}

/// The colour of all outputs' residuals.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Colour(pub Vec<Autoregression>);

impl Colour {
    pub(super) fn of_best_order(layout: &Layout, residual: &[f64]) -> Self {
        let of = |output| Autoregression::of_best_order(&layout.of_output(residual, output));
        Self((0..layout.outputs).map(of).collect())
    }

    /// Of noise that is known but for some uncertainty, of which each of `draws` is as likely as the others.
    pub(super) fn of_draws(layout: &Layout, draws: &[Vec<f64>]) -> Self {
        let of = |output| {
            let series = draws.iter().flat_map(|draw| layout.of_output(draw, output));
            Autoregression::of_copies(&series.collect::<Vec<_>>(), draws.len())
        };
        Self((0..layout.outputs).map(of).collect())
    }

    /// Of given orders, by output: so that two models of the same data are compared on equal terms.
    pub(super) fn of_orders(layout: &Layout, residual: &[f64], orders: &[usize]) -> Self {
        let of = |(output, &order): (usize, &usize)| {
            Autoregression::of_order(&layout.of_output(residual, output), order)
        };
        Self(orders.iter().enumerate().map(of).collect())
    }

    /// No colour: each output by its own variance.
    pub(super) fn white(layout: &Layout, residual: &[f64]) -> Self {
        Self::of_orders(layout, residual, &vec![0; layout.outputs])
    }

    pub(super) fn orders(&self) -> Vec<usize> {
        self.0.iter().map(Autoregression::order).collect()
    }

    /// Whitens a column, series by series; `residual` says which samples there are.
    pub(super) fn whiten(&self, layout: &Layout, residual: &[f64], column: &[f64]) -> Vec<f64> {
        let mut whitened = vec![0.0; column.len()];
        for Series { output, range, .. } in &layout.series {
            let range = range.clone();
            let model = &self.0[*output];
            model.whiten(
                &residual[range.clone()],
                &column[range.clone()],
                &mut whitened[range],
            );
        }
        whitened
    }

    /// ln L of the residual, but for a constant: −½ Σ (ln σ² + w²).
    pub(super) fn ln_likelihood(&self, layout: &Layout, residual: &[f64]) -> f64 {
        (0..layout.outputs)
            .map(|output| self.ln_likelihood_of(layout, residual, output))
            .sum()
    }

    /// ln L of a residual with the noise that suits it best, each output's order taken by Schwarz's criterion and paid
    /// for by it: −½ order ln N. Each hypothesis has its own: orders chosen on a residual that still holds an effect
    /// would take the effect for noise.
    pub(super) fn ln_evidence(layout: &Layout, residual: &[f64]) -> f64 {
        let own = Self::of_best_order(layout, residual);
        own.ln_likelihood(layout, residual) - own.price(layout, residual)
    }

    /// What its orders cost by Schwarz's criterion: ½ order ln N.
    pub(super) fn price(&self, layout: &Layout, residual: &[f64]) -> f64 {
        let of_output = |output: usize| {
            let samples = layout.of_output(residual, output);
            let count = samples.iter().flat_map(|s| s.iter());
            let count = count.filter(|e| e.is_finite()).count().max(1) as f64;
            0.5 * self.0[output].order() as f64 * count.ln()
        };
        (0..layout.outputs).map(of_output).sum()
    }

    /// The share of one output.
    pub(super) fn ln_likelihood_of(&self, layout: &Layout, residual: &[f64], output: usize) -> f64 {
        let mut sum = 0.0;
        for series in layout
            .series
            .iter()
            .filter(|series| series.output == output)
        {
            let e = &residual[series.range.clone()];
            let mut w = vec![0.0; e.len()];
            sum += self.0[output].whiten(e, e, &mut w);
            sum += w.iter().map(|w| w * w).sum::<f64>();
        }
        -0.5 * sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x_k = 0.9 x_(k-1) + w from a small generator.
    fn coloured(a: f64, n: usize) -> Vec<f64> {
        let (mut seed, mut x) = (1_u64, 0.0);
        let mut uniform = move || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        (0..n)
            .map(|_| {
                let w: f64 = (0..12).map(|_| uniform()).sum();
                x = a * x + w;
                x
            })
            .collect()
    }

    #[test]
    fn a_first_order_process_is_found_and_whitened() {
        let x = coloured(0.9, 4000);
        let model = Autoregression::of_best_order(&[&x]);
        assert!((1..=2).contains(&model.order()), "{}", model.order());
        assert!((model.predictors[1][0] - 0.9).abs() < 0.02);
        let mut w = vec![0.0; x.len()];
        model.whiten(&x, &x, &mut w);
        let power = w.iter().map(|w| w * w).sum::<f64>() / w.len() as f64;
        let lag: f64 = w.windows(2).map(|p| p[0] * p[1]).sum::<f64>() / w.len() as f64;
        assert!(
            (power - 1.0).abs() < 0.05 && lag.abs() < 0.05,
            "{power} {lag}"
        );
    }

    #[test]
    fn white_noise_has_order_0_and_a_gap_is_no_sample() {
        let mut x = coloured(0.0, 2000);
        assert_eq!(Autoregression::of_best_order(&[&x]).order(), 0);
        x[700] = f64::NAN;
        let model = Autoregression::of_order(&[&x], 3);
        let mut w = vec![1.0; x.len()];
        model.whiten(&x, &x, &mut w);
        assert!(w[700] == 0.0 && w.iter().all(|w| w.is_finite()));
    }
}
