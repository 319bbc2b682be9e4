//! Terms proposed from what a force depends on.
//!
//! Terms are chosen one after another, each for what it explains of the force besides those before it (their parts
//! orthogonal to one another, in the metric of the outputs with the declared model projected out), as long as the
//! predicted squared error falls: PSE = MSFE + σ²_max p/N (Klein and Morelli, Aircraft System Identification, 2006, 5.4).
//! N is what the force is worth in independent numbers, not the number of samples.

use nalgebra::{DMatrix, DVector};

use super::curve::in_time;
use super::dependence::{Dependence, Evidence};
use super::normal::Normal;
use super::parts::stacked;
use super::quantities::Quantity;
use super::smoothness::Posterior;
use crate::diagnose::candidates::{Draft, Ingredients};
use crate::diagnose::effect::Effect;

/// Proposals, at most.
const MOST: usize = 8;

/// Quantities that terms are made of, at most, and the share that each must explain.
const QUANTITIES: usize = 4;
const LEAST_SHARE: f64 = 0.1;

/// Steps begin where so much of the samples lies below.
const BREAKS: [f64; 5] = [0.2, 0.4, 0.6, 0.8, 0.9];

/// Time constants of a quantity's history, s.
const LAGS: [f64; 3] = [0.1, 0.3, 1.0];

/// A term that may make a force.
#[derive(Clone, Debug)]
pub(super) struct Proposal {
    pub effect: Effect,
    /// Of the force where it has to hold.
    pub share: f64,
}

/// A term, and what it is as a force.
struct Term {
    effect: Effect,
    share: f64,
    /// By flight: sizes of the shapes in time, one column.
    sizes: Vec<DMatrix<f64>>,
}

/// Terms that may make a force, those first that explain it best together.
pub(super) fn proposals(
    evidence: &Evidence<'_>,
    force: &Posterior,
    dependences: &[Dependence],
    ingredients: &Ingredients<'_>,
    target: &str,
) -> Vec<Proposal> {
    let terms = terms(evidence, dependences, ingredients, target);
    let fitted: Vec<usize> = (0..evidence.fitted).collect();
    let all: Vec<DVector<f64>> = (terms.iter())
        .map(|term| stacked(&term.sizes, &fitted).column(0).into_owned())
        .collect();
    let chosen = chosen(evidence.normal, force, &all);
    // what is not chosen beside others may be right alone
    let alone = |at: &usize| {
        let moment = evidence.normal.moment.dot(&all[*at]);
        let length = (&evidence.normal.gram * &all[*at]).dot(&all[*at]);
        moment * moment / length.max(f64::MIN_POSITIVE)
    };
    let mut others: Vec<usize> = (0..terms.len()).filter(|at| !chosen.contains(at)).collect();
    others.sort_by(|a, b| alone(b).total_cmp(&alone(a)));
    let mut proposals: Vec<Proposal> = Vec::new();
    for &at in chosen.iter().chain(&others) {
        let Term { effect, share, .. } = &terms[at];
        let is_new = !proposals.iter().any(|p| p.effect == *effect);
        if proposals.len() < MOST && is_new {
            proposals.push(Proposal {
                effect: effect.clone(),
                share: *share,
            });
        }
    }
    proposals
}

/// Indices of terms, as long as the predicted squared error falls.
fn chosen(normal: &Normal, force: &Posterior, terms: &[DVector<f64>]) -> Vec<usize> {
    let count = force.freedom.max(1.0);
    let whole = normal.moment.dot(&force.sizes).max(f64::MIN_POSITIVE);
    let mut left = normal.moment.clone();
    let mut orthogonal: Vec<DVector<f64>> = terms.to_vec();
    let mut chosen = Vec::new();
    let mut unexplained = whole;
    loop {
        let gain = |at: usize| {
            let term = &orthogonal[at];
            let length = (&normal.gram * term).dot(term);
            let before = (&normal.gram * &terms[at]).dot(&terms[at]);
            let moment = left.dot(term);
            // of a term that those before it imitate only rounding is left
            if length > 1e-6 * before {
                moment * moment / length
            } else {
                0.0
            }
        };
        let rest = (0..terms.len()).filter(|at| !chosen.contains(at));
        let best = rest
            .map(|at| (at, gain(at)))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((at, gain)) = best else { break };
        // of PSE N: the fit's error falls by the gain, the price of one more term is σ²_max
        if gain < whole / count || chosen.len() >= MOST {
            break;
        }
        let unit = orthogonal[at].clone();
        let seen = &normal.gram * &unit;
        let length = seen.dot(&unit);
        for term in &mut orthogonal {
            let share = seen.dot(term) / length;
            *term -= &unit * share;
        }
        left -= &seen * (left.dot(&unit) / length);
        unexplained -= gain;
        chosen.push(at);
        if unexplained <= 0.0 {
            break;
        }
    }
    chosen
}

/// Terms in the quantities that the force depends on, which hold where they were not learned.
fn terms(
    evidence: &Evidence<'_>,
    dependences: &[Dependence],
    ingredients: &Ingredients<'_>,
    target: &str,
) -> Vec<Term> {
    let mut terms = Vec::new();
    let good = dependences.iter().filter(|d| d.share > LEAST_SHARE);
    for dependence in good.take(QUANTITIES) {
        let quantity = &dependence.quantity;
        let of = |name: &String| {
            let mut all = dependences.iter().map(|d| &d.quantity);
            let factor = all.find(|q| q.name == *name)?;
            Some((name.clone(), factor.mean(evidence.fitted)))
        };
        let Some(names) = quantity.factors.iter().map(of).collect::<Option<Vec<_>>>() else {
            continue;
        };
        let drafts = drafts(quantity, &names, evidence.fitted);
        terms.extend(drafts.into_iter().filter_map(|(text, from, history)| {
            let effect = ingredients.term(&Draft {
                target,
                text: &text,
                names: &names,
                from,
            })?;
            term(evidence, effect, history)
        }));
        if let Some(effect) = ingredients.lagged(target, &quantity.name) {
            let lagged = LAGS.iter().map(|&lag| behind(evidence, quantity, lag));
            terms.extend(lagged.filter_map(|history| term(evidence, effect.clone(), history)));
        }
    }
    let linear = |term: &Term| {
        let name = term.effect.term.as_deref().unwrap_or_default();
        ingredients.holds(target, name)
    };
    terms.retain(|term| !linear(term));
    terms
}

type History = Vec<Vec<f64>>;

/// Texts of terms in one quantity, from where they are taken, and their histories.
fn drafts(
    quantity: &Quantity,
    names: &[(String, f64)],
    fitted: usize,
) -> Vec<(String, Option<f64>, History)> {
    let name = &quantity.name;
    let mean = quantity.mean(fitted);
    let history = |of: &dyn Fn(f64) -> f64| -> History {
        let flight = |values: &Vec<f64>| values.iter().map(|&x| of(x)).collect();
        quantity.values.iter().map(flight).collect()
    };
    if names.len() > 1 {
        return vec![(name.clone(), None, quantity.values.clone())];
    }
    let mut drafts = vec![
        (name.clone(), None, quantity.values.clone()),
        (format!("{name}^2"), None, history(&|x| (x - mean).powi(2))),
        (format!("{name}^3"), None, history(&|x| (x - mean).powi(3))),
        (
            format!("{name}*abs({name})"),
            None,
            history(&|x| (x - mean) * (x - mean).abs()),
        ),
    ];
    for from in quantity.quantiles(fitted, BREAKS) {
        let step = history(&|x| (x - from).max(0.0));
        drafts.push((format!("max(0, {name})"), Some(from), step));
    }
    drafts
}

/// What a quantity is ahead of itself, followed with a lag.
fn behind(evidence: &Evidence<'_>, quantity: &Quantity, lag: f64) -> History {
    let flights = quantity.values.iter().zip(evidence.shapes);
    let of = |(values, shapes): (&Vec<f64>, &super::shapes::Shapes)| {
        let mut slow = values.first().copied().unwrap_or(0.0);
        let times = &shapes.elapsed;
        (values.iter().enumerate())
            .map(|(k, &value)| {
                let step = if k == 0 { 0.0 } else { times[k] - times[k - 1] };
                slow += (value - slow) * (1.0 - (-step / lag).exp());
                value - slow
            })
            .collect()
    };
    flights.map(of).collect()
}

/// A term that holds where it was not learned.
fn term(evidence: &Evidence<'_>, effect: Effect, history: History) -> Option<Term> {
    let sizes = in_time(&[history], evidence.shapes)?;
    let learn = |_: (f64, f64), normal: &Normal| {
        let gram = normal.gram[(0, 0)];
        (gram > 0.0).then(|| &normal.moment / gram)
    };
    let share = evidence.share(&sizes, learn)?;
    (share > LEAST_SHARE).then_some(Term {
        effect,
        share,
        sizes,
    })
}
