//! Multivariate orthogonal functions: terms made orthogonal, ordered by what they explain, kept by predicted squared error.
//!
//! Each step takes the term whose part orthogonal to those before it explains most of what is left, and adds it (Gram-Schmidt).
//! Orthogonal terms do not change each other's share, so that the mean squared error falls with each, while σ²_max p/N grows:
//! where their sum, the predicted squared error, is least, the model ends. The orthogonal functions are sums of the terms
//! themselves, so that the equation is written in these again (Morelli, J. Aircraft 32, 1995; Klein and Morelli, sec. 5.4).

use nalgebra::DVector;

use super::candidates::{Candidates, DEPENDENT};
use super::least_squares::Fit;
use super::options::{StructureMethod, StructureOptions};
use super::report::{Structure, StructureStep, Verdict};

/// Chooses terms; `None` where not even the start can be fitted: no samples.
pub fn orthogonal(candidates: &Candidates, options: &StructureOptions) -> Option<Structure> {
    let variation = candidates.variation();
    let order = ordered(candidates, options.most_terms.unwrap_or(usize::MAX));
    let mut steps = Vec::new();
    let mut before = f64::NAN;
    for count in 0..=order.len() {
        let chosen: Vec<usize> = order[..count].iter().map(|(term, _)| *term).collect();
        let Some(fit) = Fit::of(candidates, &chosen) else {
            break;
        };
        let entered = count.checked_sub(1).map(|last| order[last]);
        let last = fit.estimates.len().saturating_sub(1);
        steps.push(StructureStep {
            number: count,
            verdict: match entered {
                Some(_) => Verdict::Entered,
                None => Verdict::Start,
            },
            term: entered.map(|(term, _)| candidates.names[term].clone()),
            partial_f: entered.map(|_| fit.partial_f(last)),
            partial_correlation: entered.map(|(_, explained)| {
                explained.signum() * (explained.abs() / before).min(1.0).sqrt()
            }),
            r_squared: fit.r_squared(variation),
            mse: fit.squares / candidates.samples() as f64,
            variance: fit.variance(),
            pse: fit.pse(variation),
            press: fit.press(),
            terms: fit.terms(candidates, &chosen),
        });
        before = fit.squares;
    }
    let least = steps.iter().min_by(|a, b| a.pse.total_cmp(&b.pse))?;
    let (kept, terms) = (least.number, least.terms.clone());
    let reason = match steps.get(kept + 1) {
        Some(next) => format!(
            "the predicted squared error is least, {:.4e}, with {kept} terms; with {} as well it is {:.4e}",
            least.pse,
            next.term.as_deref().unwrap_or_default(),
            next.pse
        ),
        None => format!(
            "the predicted squared error falls to the last of {kept} terms, {:.4e}: others may be missing",
            least.pse
        ),
    };
    Some(Structure {
        output: options.output.clone(),
        method: StructureMethod::Orthogonal,
        candidates: candidates.names.len(),
        samples: candidates.samples(),
        steps,
        kept,
        terms,
        equation: String::new(),
        reason,
        left_out: Vec::new(),
    })
}

/// Terms in the order of what each explains beyond those before it, with that: the square of the response's part along it, of
/// the sign of its parameter.
fn ordered(candidates: &Candidates, most: usize) -> Vec<(usize, f64)> {
    let samples = candidates.samples();
    let mut left: Vec<Option<DVector<f64>>> = (candidates.columns.column_iter())
        .map(|column| Some(column.into_owned()))
        .collect();
    let lengths: Vec<f64> = candidates
        .columns
        .column_iter()
        .map(|c| c.norm_squared())
        .collect();
    let mut residual = candidates.response.clone();
    let mut take_off = |direction: &DVector<f64>, left: &mut Vec<Option<DVector<f64>>>| {
        // twice is enough: what is left of a first pass is rounding of it
        for _ in 0..2 {
            let share = residual.dot(direction);
            residual.axpy(-share, direction, 1.0);
            for column in left.iter_mut().flatten() {
                let share = column.dot(direction);
                column.axpy(-share, direction, 1.0);
            }
        }
        residual.clone()
    };
    let mut rest = candidates.response.clone();
    if candidates.constant && samples > 0 {
        let constant = DVector::from_element(samples, (samples as f64).sqrt().recip());
        rest = take_off(&constant, &mut left);
    }
    let mut order = Vec::new();
    // each term needs a sample, and so does the variance of what is left
    while order.len() < most && order.len() + usize::from(candidates.constant) + 1 < samples {
        let explained = left.iter().enumerate().filter_map(|(term, column)| {
            let column = column.as_ref()?;
            let length = column.norm_squared();
            let share = column.dot(&rest);
            (length > DEPENDENT * lengths[term]).then(|| (term, share * share.abs() / length))
        });
        let Some(best) = explained.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())) else {
            break;
        };
        let Some(column) = left[best.0].take() else {
            break;
        };
        let direction = &column / column.norm();
        rest = take_off(&direction, &mut left);
        order.push(best);
    }
    order
}
