//! Stepwise regression: terms come in and go out one at a time, by their partial F.
//!
//! In each step the term comes in whose part that the model does not explain is correlated most with what is left of the
//! output, if its partial F is above the bound; then each term goes out whose partial F has fallen below the other (Klein and
//! Morelli, sec. 5.3.1; Draper and Smith, Applied Regression Analysis, ch. 15).

use super::candidates::{Candidates, DEPENDENT};
use super::least_squares::Fit;
use super::options::{StructureMethod, StructureOptions};
use super::report::{Structure, StructureStep, Verdict};

/// Chooses terms; `None` where not even the start can be fitted: no samples.
pub fn stepwise(candidates: &Candidates, options: &StructureOptions) -> Option<Structure> {
    let variation = candidates.variation();
    let mut search = Search {
        candidates,
        options,
        variation,
        chosen: Vec::new(),
        steps: Vec::new(),
    };
    let mut fit = Fit::of(candidates, &[])?;
    search.tell(&fit, Verdict::Start, None);
    let reason = loop {
        let most = options.most_terms.unwrap_or(usize::MAX);
        if search.chosen.len() >= most {
            break format!("{most} terms are as many as were allowed");
        }
        let (next, entered) = match search.enter(&fit) {
            Ok(found) => found,
            Err(reason) => break reason,
        };
        fit = next;
        search.tell(&fit, Verdict::Entered, Some(entered));
        match search.remove(fit, entered.term) {
            Removed::Settled(next) => fit = next,
            Removed::Circle(next, term) => {
                fit = next;
                break format!(
                    "the term {} would come in and go out again",
                    candidates.names[term]
                );
            }
        }
    };
    let terms = fit.terms(candidates, &search.chosen);
    Some(Structure {
        output: options.output.clone(),
        method: StructureMethod::Stepwise,
        candidates: candidates.names.len(),
        samples: candidates.samples(),
        kept: search.steps.len() - 1,
        steps: search.steps,
        terms,
        equation: String::new(),
        reason,
        left_out: Vec::new(),
    })
}

struct Search<'a> {
    candidates: &'a Candidates,
    options: &'a StructureOptions,
    variation: f64,
    /// In the order in which they came in.
    chosen: Vec<usize>,
    steps: Vec<StructureStep>,
}

/// The term of a step.
#[derive(Clone, Copy)]
struct Moved {
    term: usize,
    partial_f: f64,
    correlation: Option<f64>,
}

/// How the removal of terms ended.
enum Removed {
    Settled(Fit),
    /// The term that has just come in went out.
    Circle(Fit, usize),
}

impl Search<'_> {
    fn tell(&mut self, fit: &Fit, verdict: Verdict, moved: Option<Moved>) {
        let samples = self.candidates.samples() as f64;
        let step = StructureStep {
            number: self.steps.len(),
            verdict,
            term: moved.map(|moved| self.candidates.names[moved.term].clone()),
            partial_f: moved.map(|moved| moved.partial_f),
            partial_correlation: moved.and_then(|moved| moved.correlation),
            r_squared: fit.r_squared(self.variation),
            mse: fit.squares / samples,
            variance: fit.variance(),
            pse: fit.pse(self.variation),
            press: fit.press(),
            terms: fit.terms(self.candidates, &self.chosen),
        };
        self.steps.push(step);
    }

    /// Lets the term of the largest partial correlation in; why not, where it is not worth it.
    fn enter(&mut self, fit: &Fit) -> Result<(Fit, Moved), String> {
        let outside = (0..self.candidates.names.len()).filter(|term| !self.chosen.contains(term));
        let correlated = outside.filter_map(|term| {
            let column = self.candidates.columns.column(term).into_owned();
            let left = fit.left_of(&column);
            let length = left.norm_squared();
            let is_own = length > DEPENDENT * column.norm_squared() && fit.squares > 0.0;
            let correlation = left.dot(&fit.residual) / (length * fit.squares).sqrt();
            (is_own && correlation.is_finite()).then_some((term, correlation))
        });
        let best = correlated.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        let Some((term, correlation)) = best else {
            return Err("no term is left that the others do not explain".to_string());
        };
        let name = &self.candidates.names[term];
        let mut with = self.chosen.clone();
        with.push(term);
        let Some(next) = Fit::of(self.candidates, &with) else {
            return Err(format!(
                "with {name} there are more terms than samples, or dependent ones"
            ));
        };
        let last = next.estimates.len() - 1;
        let partial_f = next.partial_f(last);
        if partial_f < self.options.f_to_enter {
            return Err(format!(
                "of the terms that are left {name} has the largest partial F, {partial_f:.3}, below {}",
                self.options.f_to_enter
            ));
        }
        let gain = next.r_squared(self.variation) - fit.r_squared(self.variation);
        if gain < self.options.least_r_squared {
            return Err(format!(
                "of the terms that are left {name} explains most, {gain:.2e} of the variation, less than {}",
                self.options.least_r_squared
            ));
        }
        self.chosen = with;
        let moved = Moved {
            term,
            partial_f,
            correlation: Some(correlation),
        };
        Ok((next, moved))
    }

    /// Lets terms out, the one of the least partial F first, until each is worth it.
    fn remove(&mut self, mut fit: Fit, entered: usize) -> Removed {
        let constant = usize::from(self.candidates.constant);
        loop {
            let places =
                (0..self.chosen.len()).map(|place| (place, fit.partial_f(place + constant)));
            let least = places.min_by(|a, b| a.1.total_cmp(&b.1));
            let Some((place, partial_f)) = least.filter(|least| least.1 < self.options.f_to_remove)
            else {
                return Removed::Settled(fit);
            };
            let mut without = self.chosen.clone();
            let term = without.remove(place);
            // fewer of independent terms are independent
            let Some(next) = Fit::of(self.candidates, &without) else {
                return Removed::Settled(fit);
            };
            fit = next;
            self.chosen = without;
            let moved = Moved {
                term,
                partial_f,
                correlation: None,
            };
            self.tell(&fit, Verdict::Removed, Some(moved));
            if term == entered {
                return Removed::Circle(fit, term);
            }
        }
    }
}
