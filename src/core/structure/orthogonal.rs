//! Multivariate orthogonal functions: terms made orthogonal, ordered by what they explain, kept by predicted squared error.
//!
//! Each step takes the term whose part orthogonal to those before it explains most of what is left, and adds it (Gram-Schmidt).
//! Orthogonal terms do not change each other's share, so that the mean squared error falls with each, while σ²_max p/N grows:
//! where their sum, the predicted squared error, is least, the model ends; the search, once it has risen for some steps. The
//! orthogonal functions are sums of the terms themselves, so that the equation is written in these again (Morelli, J. Aircraft
//! 32, 1995; Klein and Morelli, sec. 5.4).

use nalgebra::DVector;

use super::candidates::{Candidates, DEPENDENT, first_of_largest};
use super::least_squares::Fit;
use super::options::{StructureMethod, StructureOptions};
use super::report::{STOPPED, StepVerdict, Structure, StructureStep};
use crate::stop::check;

/// Terms after the least predicted squared error, without a lesser one, after which none is looked for.
const RISES: usize = 10;

/// Chooses terms; `None` where not even the start can be fitted: no samples. `keep_going` is asked before each step; with `false`
/// the search ends with the best of the terms that it has.
pub fn orthogonal(
    candidates: &Candidates,
    options: &StructureOptions,
    keep_going: &mut dyn FnMut() -> bool,
) -> Option<Structure> {
    let most = options.most_terms.unwrap_or(usize::MAX);
    let mut search = Search::of(candidates)?;
    let mut stopped = false;
    while search.chosen.len() < most && search.rises() < RISES {
        stopped = !keep_going();
        if stopped || search.enter().is_none() {
            break;
        }
    }
    Some(search.structure(options, stopped))
}

struct Search<'a> {
    candidates: &'a Candidates,
    variation: f64,
    remainder: Remainder,
    /// In the order in which they came in.
    chosen: Vec<usize>,
    steps: Vec<StructureStep>,
    /// Number of the step of the least predicted squared error, and its fit.
    least: (usize, Fit),
}

impl<'a> Search<'a> {
    fn of(candidates: &'a Candidates) -> Option<Self> {
        let mut search = Self {
            candidates,
            variation: candidates.variation(),
            remainder: Remainder::of(candidates),
            chosen: Vec::new(),
            steps: Vec::new(),
            least: (0, Fit::of(candidates, &[])?),
        };
        let start = search.step(&search.least.1, None);
        search.steps.push(start);
        Some(search)
    }

    /// Steps since the least predicted squared error.
    fn rises(&self) -> usize {
        self.steps.len() - 1 - self.least.0
    }

    /// Lets the term in that explains most; `None` where there is none, or no sample for it.
    fn enter(&mut self) -> Option<()> {
        let (term, explained) = self.remainder.take_best()?;
        let mut with = self.chosen.clone();
        with.push(term);
        let fit = Fit::of(self.candidates, &with)?;
        self.chosen = with;
        let step = self.step(&fit, Some((term, explained)));
        if step.pse < self.steps[self.least.0].pse {
            self.least = (step.number, fit);
        }
        self.steps.push(step);
        Some(())
    }

    fn step(&self, fit: &Fit, entered: Option<(usize, f64)>) -> StructureStep {
        let samples = self.candidates.samples() as f64;
        let before = self
            .steps
            .last()
            .map_or(f64::NAN, |step| step.mse * samples);
        let last = fit.estimates.len().saturating_sub(1);
        let correlation = |share: f64| share.signum() * (share.abs() / before).min(1.0).sqrt();
        StructureStep {
            number: self.steps.len(),
            verdict: match entered {
                Some(_) => StepVerdict::Entered,
                None => StepVerdict::Start,
            },
            term: entered.map(|(term, _)| self.candidates.names[term].clone()),
            partial_f: entered.map(|_| fit.partial_f(last)),
            partial_correlation: entered.map(|(_, explained)| correlation(explained)),
            r_squared: fit.r_squared(self.variation),
            mse: fit.squares / samples,
            variance: fit.variance(),
            pse: fit.pse(self.variation),
            press: fit.press(),
            terms: fit.terms(self.candidates, &self.chosen),
        }
    }

    fn structure(self, options: &StructureOptions, stopped: bool) -> Structure {
        let reason = self.reason(stopped);
        let (kept, fit) = self.least;
        Structure {
            output: options.output.clone(),
            method: StructureMethod::Orthogonal,
            candidates: self.candidates.names.len(),
            samples: self.candidates.samples(),
            kept,
            terms: self.steps[kept].terms.clone(),
            steps: self.steps,
            equation: String::new(),
            reason,
            left_out: fit.explained(self.candidates, &self.chosen[..kept]),
        }
    }

    fn reason(&self, stopped: bool) -> String {
        let kept = self.least.0;
        let least = self.steps[kept].pse;
        let reason = match self.steps.get(kept + 1) {
            Some(next) => format!(
                "the predicted squared error is least, {least:.4e}, with {kept} terms; with {} as well it is {:.4e}",
                next.term.as_deref().unwrap_or_default(),
                next.pse
            ),
            None => format!(
                "the predicted squared error falls to the last of {kept} terms, {least:.4e}: others may be missing"
            ),
        };
        match stopped {
            true => format!("{STOPPED}; of the terms so far {reason}"),
            false => reason,
        }
    }
}

/// What is left of the terms and of the response, orthogonal to the terms that were taken.
struct Remainder {
    /// By term; none of one that was taken.
    columns: Vec<Option<DVector<f64>>>,
    /// By term: the square of its whole length.
    lengths: Vec<f64>,
    response: DVector<f64>,
    /// Samples that nothing was taken for: each term needs one, and so does the variance of what is left.
    free: usize,
}

impl Remainder {
    fn of(candidates: &Candidates) -> Self {
        let columns = || candidates.columns.column_iter();
        let samples = candidates.samples();
        let mut remainder = Self {
            lengths: columns().map(|c| c.norm_squared()).collect(),
            columns: columns().map(|c| Some(c.into_owned())).collect(),
            response: candidates.response.clone(),
            free: samples,
        };
        if candidates.constant && samples > 0 {
            let share = (samples as f64).sqrt().recip();
            remainder.take_off(&DVector::from_element(samples, share));
        }
        remainder
    }

    /// Takes the part along a direction off everything.
    fn take_off(&mut self, direction: &DVector<f64>) {
        self.free -= 1;
        // twice is enough: what is left of a first pass is rounding of it
        for _ in 0..2 {
            for left in self
                .columns
                .iter_mut()
                .flatten()
                .chain([&mut self.response])
            {
                check();
                let share = left.dot(direction);
                left.axpy(-share, direction, 1.0);
            }
        }
    }

    /// Takes the term that explains most beyond those before it, with that: the square of the response's part along it, of the
    /// sign of its parameter.
    fn take_best(&mut self) -> Option<(usize, f64)> {
        if self.free < 2 {
            return None;
        }
        let explained = self
            .columns
            .iter()
            .enumerate()
            .filter_map(|(term, column)| {
                check();
                let column = column.as_ref()?;
                let length = column.norm_squared();
                let share = column.dot(&self.response);
                (length > DEPENDENT * self.lengths[term])
                    .then(|| (term, share * share.abs() / length))
            });
        let explained: Vec<(usize, f64)> = explained.collect();
        let best = first_of_largest(&explained)?;
        let column = self.columns[best.0].take()?;
        self.take_off(&(&column / column.norm()));
        Some(best)
    }
}
