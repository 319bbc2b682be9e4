//! Whether an effect has the same size in all parts of the data.

use super::colour::Colour;
use super::fitted::Fitted;
use super::projection::Basis;
use super::screen::tail;
use super::stack::{Layout, sensitivities};
use crate::model::Per;

/// Sizes in parts of the data may differ like this once in so many effects that are real.
const UNLIKELY_SCATTER: f64 = 1e-4;

/// Parts of a lone segment in which an effect must show alike.
const PARTS: usize = 3;

/// How far a part of the data would pull a size, all else adjusted, and the standard error of that: SI.
struct Pull {
    by: f64,
    error: f64,
}

/// Why the sizes of a parameter in parts of the data do not agree, judged by the noise that is left with the effect
/// in the model; `None` where they do, or where each maneuver has its own.
pub(super) fn disagreement(fitted: &Fitted, parameter: &str) -> Option<String> {
    let parameters = &fitted.problem.model.parameters;
    let index = parameters.iter().position(|info| info.name == parameter)?;
    if parameters[index].document.per == Per::Maneuver {
        return None;
    }
    let pulls = pulls(fitted, index)?;
    let size = fitted.values();
    let size = size.get(&(parameter.to_string(), None))?;
    let weight: f64 = pulls.iter().map(|p| p.error.powi(-2)).sum();
    let middle = pulls.iter().map(|p| p.by * p.error.powi(-2)).sum::<f64>() / weight;
    let chi_squared: f64 = (pulls.iter())
        .map(|p| ((p.by - middle) / p.error).powi(2))
        .sum();
    let freedom = pulls.len().saturating_sub(1);
    if freedom == 0 || tail(chi_squared, freedom) > UNLIKELY_SCATTER {
        return None;
    }
    // large effects show second-order differences: sizes that agree within a third are the same effect
    let off = pulls.iter().map(|p| (p.by - middle).abs());
    let spread = off.fold(0.0, f64::max);
    if spread < size.abs() / 3.0 {
        return None;
    }
    let sizes: Vec<String> = pulls
        .iter()
        .map(|p| format!("{:.3e} ± {:.1e}", size + p.by, p.error))
        .collect();
    Some(format!(
        "{parameter} differs between parts of the data: {} (SI)",
        sizes.join(", ")
    ))
}

/// By segment, or by parts of the only one.
fn pulls(fitted: &Fitted, index: usize) -> Option<Vec<Pull>> {
    let problem = &fitted.problem;
    let layout = Layout::of(problem);
    let colour = Colour::of_best_order(&layout, &fitted.residual);
    let whiten = |column: &Vec<f64>| colour.whiten(&layout, &fitted.residual, column);
    let mut free: Vec<usize> = (0..problem.unknowns.len())
        .map(|place| problem.unknowns.at(place).parameter)
        .filter(|&other| other != index)
        .collect();
    free.sort_unstable();
    free.dedup();
    let theta = &fitted.theta;
    let others = sensitivities(problem, &layout, theta, &free).ok()?;
    let others = Basis::of(others.iter().map(whiten));
    let own = sensitivities(problem, &layout, theta, &[index]).ok()?;
    let [own] = own.as_slice() else { return None };
    let mut clear = whiten(own);
    others.remove_from(&mut clear);
    let mut residual = whiten(&fitted.residual);
    others.remove_from(&mut residual);
    let segments = problem.segments.len();
    let parts = if segments == 1 { PARTS } else { 1 };
    let mut sums = vec![(0.0, 0.0); segments * parts];
    for series in &layout.series {
        let len = series.range.len();
        for (k, at) in series.range.clone().enumerate() {
            let fold = &mut sums[series.segment * parts + k * parts / len];
            fold.0 += clear[at] * residual[at];
            fold.1 += clear[at] * clear[at];
        }
    }
    let known = sums.into_iter().filter(|(_, square)| *square > 0.0);
    let pull = |(product, square): (f64, f64)| Pull {
        by: product / square,
        error: square.sqrt().recip(),
    };
    Some(known.map(pull).collect())
}
