//! Alias groups: candidates that the data cannot tell apart.

use super::projection::dot;
use super::report::Member;
use super::trial::Trial;

/// Twice the difference of two log-likelihoods below which neither of two models is preferred.
pub(super) const ALIKE: f64 = 6.0;

/// Two effects whose directions have a larger cosine are one and the same, but for how they are modelled.
const PARALLEL: f64 = 0.95;

/// Beyond this the likelihood is clear even so.
const FAR: f64 = 40.0;

/// The members of the group that `best` leads, itself included, the likeliest first, with their weights.
pub(super) fn group(best: &Trial, others: &[&Trial]) -> Vec<Member> {
    let is_alike = |trial: &&&Trial| {
        let worse = best.merit() - trial.merit();
        worse < ALIKE || (worse < FAR && cosine(best, trial) > PARALLEL)
    };
    let members: Vec<&Trial> = std::iter::once(best)
        .chain(others.iter().filter(is_alike).copied())
        .collect();
    let shares: Vec<f64> = members
        .iter()
        .map(|trial| (0.5 * (trial.merit() - best.merit())).exp())
        .collect();
    let whole: f64 = shares.iter().sum();
    let member = |(trial, share): (&&Trial, &f64)| Member {
        effect: trial.effect.clone(),
        weight: share / whole,
    };
    let mut members: Vec<Member> = members.iter().zip(&shares).map(member).collect();
    members.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    members
}

/// Of what two candidates explain of the residual.
fn cosine(a: &Trial, b: &Trial) -> f64 {
    dot(&a.explained, &b.explained).abs()
}
