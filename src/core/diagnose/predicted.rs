//! Flights that were not fitted, predicted with a fit: the error that an engineer is shown.

use super::case::{Case, Unfit};
use super::fitted::Fitted;
use super::report::OutputGain;
use crate::estimate::{ErrorBoundsKind, Role, predict};

/// What belongs to a flight (its initial states, its biases) is estimated on the flight itself, to the end: a
/// prediction from initial states that have not converged would refuse what is true.
const ITERATIONS: usize = 50;

/// Errors of a prediction, by output.
#[derive(Clone, Debug)]
pub(super) struct Predicted {
    outputs: Vec<Errors>,
}

#[derive(Clone, Debug)]
struct Errors {
    name: String,
    /// e by sample, flight by flight; NaN where nothing was measured.
    residual: Vec<f64>,
}

impl Errors {
    fn squares(&self) -> f64 {
        let finite = self.residual.iter().filter(|e| e.is_finite());
        finite.map(|e| e * e).sum::<f64>().max(f64::MIN_POSITIVE)
    }

    fn samples(&self) -> f64 {
        self.residual.iter().filter(|e| e.is_finite()).count() as f64
    }
}

impl Predicted {
    /// Predicts the flights of a role; `None` where there are none.
    ///
    /// # Errors
    /// A prediction leaves the range of numbers.
    pub(super) fn of(fitted: &Fitted, case: &Case, role: Role) -> Result<Option<Self>, Unfit> {
        let flights = case.held_out(role, &fitted.problem)?;
        if flights.is_empty() {
            return Ok(None);
        }
        let mut problem = fitted.problem.clone();
        problem.options.error_bounds = ErrorBoundsKind::Conventional;
        problem.options.max_iterations = ITERATIONS;
        let names = problem.model.outputs.iter().map(|output| &output.name);
        let mut outputs: Vec<Errors> = names
            .map(|name| Errors {
                name: name.clone(),
                residual: Vec::new(),
            })
            .collect();
        for flight in &flights {
            let (prediction, history) =
                predict(&problem, &fitted.theta, &fitted.covariance, flight);
            let history = history.ok_or(Unfit(prediction.reason))?;
            for (errors, output) in outputs.iter_mut().zip(&history.outputs) {
                errors.residual.extend(&output.residual);
            }
        }
        Ok(Some(Self { outputs }))
    }

    /// By output N ln(σ0²/σ1²): twice the gain of the likelihood of plain, white errors over those of another model,
    /// which is what a smaller RMS error is worth. Negative: this output got worse.
    pub(super) fn gains_over(&self, before: &Self) -> Vec<OutputGain> {
        let pairs = self.outputs.iter().zip(&before.outputs);
        let gain = |(now, before): (&Errors, &Errors)| OutputGain {
            output: now.name.clone(),
            gain: now.samples() * (before.squares() / now.squares()).ln(),
        };
        pairs.map(gain).collect()
    }

    /// The gain that is to be expected of the better of two predictions: Σ N ln(1 + Σ d²/Σ e²), d by how much they
    /// differ, e the errors of this one.
    pub(super) fn gain_expected_over(&self, before: &Self) -> f64 {
        let pairs = self.outputs.iter().zip(&before.outputs);
        let of = |(now, before): (&Errors, &Errors)| {
            let differences = now.residual.iter().zip(&before.residual);
            let squares: f64 = differences
                .map(|(a, b)| (a - b).powi(2))
                .filter(|square| square.is_finite())
                .sum();
            now.samples() * (squares / now.squares()).ln_1p()
        };
        pairs.map(of).sum()
    }

    /// The first output whose RMS error grew clearly, and by which factor.
    pub(super) fn clearly_worse_than(&self, before: &Self) -> Option<(String, f64)> {
        let gains = self.gains_over(before);
        gains.iter().zip(&self.outputs).find_map(|(gain, errors)| {
            let ratio = (-0.5 * gain.gain / errors.samples().max(1.0)).exp();
            (ratio > WORSE && -gain.gain > WORSE_GAIN).then(|| (gain.output.clone(), ratio))
        })
    }
}

/// An RMS error that grew by this factor is clearly worse,
const WORSE: f64 = 1.1;

/// where that is no chance of a few samples either.
const WORSE_GAIN: f64 = 20.0;
