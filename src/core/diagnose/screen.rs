//! The screen: what each candidate would explain, had it to be decided by one linear step.
//!
//! With A the whitened sensitivities of everything that is free in the declared model, S those of a candidate at no
//! effect, and e the whitened residual, the declared model is projected out: S⊥ = (I − P_A) S. The score
//!
//! ```text
//! LM = eᵀ S⊥ (S⊥ᵀ S⊥)⁻¹ S⊥ᵀ e ~ χ²(d)
//! ```
//!
//! is that of Rao. Whitening takes what is slow out of the residual, a missing bias included: the step is therefore
//! worked out with white noise too, and of both that counts which leaves the greater colour-aware likelihood.

use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::case::{Case, Values};
use super::colour::Colour;
use super::fitted::Fitted;
use super::projection::{Basis, dot, least_squares, norm};
use super::stack::{Layout, sensitivities};
use crate::model::{Edited, Per};
use crate::stop;

/// One way to weigh the residual, with the declared model projected out.
struct Metric {
    colour: Colour,
    declared: Basis,
    /// e⊥
    residual: Vec<f64>,
    /// Orders of the colour that is left.
    orders: Vec<usize>,
    ln_likelihood: f64,
}

/// Everything about the declared model that the screen of each candidate needs.
pub(super) struct Screen<'c> {
    pub case: &'c Case,
    pub base: &'c Fitted,
    layout: Layout,
    metrics: Vec<Metric>,
}

/// A candidate, as the screen sees it.
#[derive(Clone, Debug)]
pub(super) struct Screened {
    /// Where a fit of it begins: the one step.
    start: Values,
    /// From where that step was made.
    before: Values,
    /// From how many starts it was screened.
    pub starts: usize,
    /// ‖S⊥‖/‖S‖: what the declared parameters cannot imitate.
    pub visible: f64,
    pub score: f64,
    /// Twice the gain of the log-likelihood that one linear step promises.
    pub promise: f64,
    /// N ln(σ0²/σ1²) over all outputs: what one linear step of plain least squares promises of the errors themselves.
    pub plain: f64,
    /// What it promises with a size of its own in each flight; 0 where that asks nothing else.
    pub own: f64,
    /// One-step sizes, SI, of what has influence.
    sizes: Vec<f64>,
    /// Standard error of the first parameter's one step, SI.
    pub one_sigma: f64,
    /// S⊥ ψ, of length 1.
    pub direction: Vec<f64>,
}

type Key = (String, Option<String>);

/// What a size in each flight must promise, and by how much more than one for all, to say that an effect differs.
const OWN: f64 = 40.0;
const BEYOND: f64 = 30.0;

impl Screened {
    /// Whether it is clearly there in some flights, and not as such in all.
    pub(super) fn differs(&self) -> bool {
        self.own > OWN && self.own - self.promise.max(self.score) > BEYOND
    }

    /// Where fits of it begin. Of what the declared parameters imitate closely, the whole step without theirs leads far
    /// astray: then a small share of it too.
    pub(super) fn starts(&self) -> Vec<Values> {
        let mut starts = vec![self.start.clone()];
        if self.visible < IMITATED {
            starts.push(self.share(self.visible));
        }
        starts
    }

    /// Close to no effect: from here a fit goes wrong only where the effect is none.
    pub(super) fn close_start(&self) -> Values {
        self.share(CLOSE)
    }

    /// A share of the one step.
    fn share(&self, share: f64) -> Values {
        let of = |(key, value): (&Key, &f64)| {
            let before = self.before.get(key).copied().unwrap_or(*value);
            (key.clone(), before + share * (value - before))
        };
        self.start.iter().map(of).collect()
    }
}

/// After whitening little colour is left: what this order takes.
const ORDER_LEFT: usize = 2;

/// How long after an input a residual may follow it, s.
const AFTER: [f64; 6] = [0.0, 0.1, 0.25, 0.5, 1.0, 2.0];

/// A share of the one step that is close to no effect.
const CLOSE: f64 = 0.05;

/// Below this share of its own an effect is closely imitated.
const IMITATED: f64 = 0.2;

impl<'c> Screen<'c> {
    /// `None` where the simulation leaves the range of numbers.
    pub(super) fn new(case: &'c Case, base: &'c Fitted) -> Option<Self> {
        let layout = Layout::of(&base.problem);
        let colour = Colour::of_best_order(&layout, &base.residual);
        let mut free: Vec<usize> = (0..base.problem.unknowns.len())
            .map(|place| base.problem.unknowns.at(place).parameter)
            .collect();
        free.dedup();
        free.sort_unstable();
        free.dedup();
        let declared = sensitivities(&base.problem, &layout, &base.theta, &free).ok()?;
        let metric = |colour: Colour, orders: Vec<usize>| {
            let whiten = |column: &Vec<f64>| colour.whiten(&layout, &base.residual, column);
            let declared = Basis::of(declared.iter().map(whiten));
            let mut residual = whiten(&base.residual);
            declared.remove_from(&mut residual);
            let marked = marked(&residual, &base.residual);
            let ln_likelihood =
                Colour::of_orders(&layout, &marked, &orders).ln_likelihood(&layout, &marked);
            Metric {
                colour,
                declared,
                residual,
                orders,
                ln_likelihood,
            }
        };
        let left = vec![ORDER_LEFT; layout.outputs];
        let mut metrics = vec![metric(colour.clone(), left)];
        if colour.orders().iter().any(|&order| order > 0) {
            let white = Colour::white(&layout, &base.residual);
            metrics.push(metric(white, colour.orders()));
        }
        Some(Self {
            case,
            base,
            layout,
            metrics,
        })
    }

    /// Screens a candidate as it stands in its document, what it adds at `start` or else where the document says.
    ///
    /// # Errors
    /// Why it cannot be screened.
    pub(super) fn of(&self, edited: &Edited, start: &Values) -> Result<Screened, String> {
        let values = self.base.values_with(start);
        let problem = self
            .case
            .problem(&edited.document, &values)
            .map_err(|e| e.to_string())?;
        let model = &problem.model;
        let is_added = |index: &usize| {
            let info = &model.parameters[*index];
            !info.document.fixed && edited.added.iter().any(|added| added.name == info.name)
        };
        let added: Vec<usize> = (0..model.parameters.len()).filter(is_added).collect();
        let theta = problem.unknowns.start();
        let columns =
            sensitivities(&problem, &self.layout, &theta, &added).map_err(|why| why.to_string())?;
        let places = added.iter().flat_map(|&index| {
            let count = match model.parameters[index].document.per {
                Per::Job => 1,
                Per::Maneuver => problem.segments.len(),
            };
            (0..count).map(move |segment| (index, segment))
        });
        // a parameter without influence at no effect (a time constant) waits for the trial
        let counts = |((index, segment), column): &((usize, usize), Vec<f64>)| {
            problem.unknowns.place(*segment, *index).is_some() && column.iter().any(|v| *v != 0.0)
        };
        let key = |(index, segment): (usize, usize)| {
            let info = &model.parameters[index];
            let own = info.document.per == Per::Maneuver;
            let label = own.then(|| problem.segments[segment].label.clone());
            (info.name.clone(), label)
        };
        let (keys, columns): (Vec<Key>, Vec<Vec<f64>>) = places
            .zip(columns)
            .filter(counts)
            .map(|(place, column)| (key(place), column))
            .unzip();
        if columns.is_empty() {
            return Err("it has no influence at no effect".into());
        }
        let mut best: Option<Screened> = None;
        for metric in &self.metrics {
            let mut seen = self.in_metric(metric, &columns);
            seen.start = start.clone();
            for (key, size) in keys.iter().zip(std::mem::take(&mut seen.sizes)) {
                let before = values.get(key).copied().unwrap_or(0.0);
                seen.before.insert(key.clone(), before);
                seen.start.insert(key.clone(), before + size);
            }
            match &mut best {
                Some(best) if best.promise >= seen.promise => {
                    best.visible = best.visible.max(seen.visible);
                    best.plain = seen.plain;
                }
                Some(best) => {
                    // what is said of the sizes is that of the better step; score and fractions are the whitened ones
                    seen.score = best.score;
                    seen.visible = seen.visible.max(best.visible);
                    seen.one_sigma = best.one_sigma;
                    *best = seen;
                }
                None => best = Some(seen),
            }
        }
        let own = self.own(&columns);
        best.map(|seen| Screened { own, ..seen })
            .ok_or_else(|| "it cannot be screened".into())
    }

    /// What a single size promises if each flight has its own.
    fn own(&self, columns: &[Vec<f64>]) -> f64 {
        let flights = self.base.problem.segments.len();
        let ([one], [metric, ..], 2..) = (columns, self.metrics.as_slice(), flights) else {
            return 0.0;
        };
        let of_flight = |flight: usize| {
            let mut column = vec![0.0; self.layout.len];
            for series in self.layout.series.iter().filter(|s| s.segment == flight) {
                let range = series.range.clone();
                column[range.clone()].copy_from_slice(&one[range]);
            }
            column
        };
        let each: Vec<Vec<f64>> = (0..flights).map(of_flight).collect();
        let seen = self.in_metric(metric, &each);
        seen.promise.min(seen.score)
    }

    fn in_metric(&self, metric: &Metric, columns: &[Vec<f64>]) -> Screened {
        let layout = &self.layout;
        let whitened: Vec<Vec<f64>> = (columns.iter())
            .map(|column| metric.colour.whiten(layout, &self.base.residual, column))
            .collect();
        let mut clear = whitened.clone();
        clear
            .iter_mut()
            .for_each(|column| metric.declared.remove_from(column));
        let share = |(clear, whole): (&Vec<f64>, &Vec<f64>)| {
            norm(clear) / norm(whole).max(f64::MIN_POSITIVE)
        };
        let visible = clear.iter().zip(&whitened).map(share).fold(0.0, f64::max);
        // rounding is not to be taken for what can be seen
        let scale: Vec<f64> = whitened
            .iter()
            .map(|column| norm(column).max(f64::MIN_POSITIVE))
            .collect();
        let count = clear.len();
        let gram = DMatrix::from_fn(count, count, |i, j| {
            stop::check();
            dot(&clear[i], &clear[j]) / (scale[i] * scale[j])
        });
        let moment = DVector::from_fn(count, |i, _| dot(&clear[i], &metric.residual) / scale[i]);
        let sizes = least_squares(gram, &moment, 1e-10).unwrap_or_else(|| DVector::zeros(count));
        let score = sizes.dot(&moment).max(0.0);
        let mut explained = vec![0.0; layout.len];
        for (i, column) in clear.iter().enumerate() {
            let size = sizes[i] / scale[i];
            explained
                .iter_mut()
                .zip(column)
                .for_each(|(to, s)| *to += size * s);
        }
        let left: Vec<f64> = metric
            .residual
            .iter()
            .zip(&explained)
            .map(|(e, s)| e - s)
            .collect();
        let left = marked(&left, &self.base.residual);
        let colour = Colour::of_orders(layout, &left, &metric.orders);
        let promise = 2.0 * (colour.ln_likelihood(layout, &left) - metric.ln_likelihood);
        let length = norm(&explained).max(f64::MIN_POSITIVE);
        let plain = layout.plain_gain(&metric.residual, &left);
        Screened {
            start: Values::new(),
            before: Values::new(),
            starts: 1,
            visible,
            score,
            promise,
            own: 0.0,
            plain,
            sizes: (0..count).map(|i| sizes[i] / scale[i]).collect(),
            one_sigma: norm(&clear[0]).max(f64::MIN_POSITIVE).recip(),
            direction: explained.iter().map(|value| value / length).collect(),
        }
    }

    /// Whether what is left of an output follows an input, with any shape over the next seconds: tested at a
    /// probability of false alarm.
    pub(super) fn follows(&self, output: usize, input: usize, probability: f64) -> bool {
        let Some(metric) = self.metrics.first() else {
            return false;
        };
        let problem = &self.base.problem;
        let columns: Vec<Vec<f64>> = (AFTER.iter())
            .map(|seconds| {
                let mut column = vec![0.0; self.layout.len];
                for series in self
                    .layout
                    .series
                    .iter()
                    .filter(|series| series.output == output)
                {
                    let segment = &problem.segments[series.segment];
                    let values = &segment.inputs[input];
                    let duration = segment.time[segment.len() - 1] - segment.time[0];
                    let step = duration / (segment.len() - 1).max(1) as f64;
                    let lag = (seconds / step).round() as usize;
                    for (k, at) in series.range.clone().enumerate() {
                        column[at] = values[k.saturating_sub(lag)] - values[0];
                    }
                }
                column
            })
            .filter(|column| column.iter().any(|v| *v != 0.0))
            .collect();
        if columns.is_empty() {
            return false;
        }
        let seen = self.in_metric(metric, &columns);
        seen.promise.min(seen.score) > critical(probability, 1.0, columns.len())
    }
}

/// The column with what is not there marked as such.
fn marked(column: &[f64], mask: &[f64]) -> Vec<f64> {
    let mark = |(value, mask): (&f64, &f64)| if mask.is_finite() { *value } else { f64::NAN };
    column.iter().zip(mask).map(mark).collect()
}

/// How many independent questions a set of directions asks: from the eigenvalues of their correlation (Li and Ji,
/// Heredity 95, 2005).
pub(super) fn independent_questions(directions: &[&[f64]]) -> f64 {
    let count = directions.len();
    if count < 2 {
        return count as f64;
    }
    let correlation = DMatrix::from_fn(count, count, |i, j| {
        stop::check();
        dot(directions[i], directions[j])
    });
    let Some(eigen) = nalgebra::SymmetricEigen::try_new(correlation, f64::EPSILON, 10_000) else {
        return count as f64;
    };
    let one = |value: &f64| {
        if *value >= 1.0 {
            1.0 + value.fract()
        } else {
            value.max(0.0)
        }
    };
    eigen.eigenvalues.iter().map(one).sum()
}

/// The likelihood ratio that noise alone exceeds in one of `questions` with a given probability.
pub(super) fn critical(probability: f64, questions: f64, freedom: usize) -> f64 {
    let Ok(chi_squared) = ChiSquared::new(freedom.max(1) as f64) else {
        return f64::INFINITY;
    };
    chi_squared.inverse_cdf(1.0 - probability / questions.max(1.0))
}

/// Probability that noise alone gives a χ² beyond this.
pub(super) fn tail(chi_squared: f64, freedom: usize) -> f64 {
    ChiSquared::new(freedom.max(1) as f64).map_or(1.0, |law| law.sf(chi_squared))
}
