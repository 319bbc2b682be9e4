//! Alias groups: candidates that the data cannot tell apart.

use super::effect::Effect;
use super::passed::{Noise, Passed};
use super::projection::dot;
use super::report::Member;

/// Twice the difference of two log-likelihoods below which neither of two models is preferred.
const ALIKE: f64 = 6.0;

/// Difference of the gains on flights that were not fitted that chance makes between two such models.
const CHANCE: f64 = 12.0;

/// Two effects whose directions have a larger cosine are one and the same, but for how they are modelled.
const PARALLEL: f64 = 0.95;

/// Beyond this the likelihood is clear even so.
const FAR: f64 = 40.0;

/// An effect that no other can be taken for.
pub(super) fn alone(effect: &Effect) -> Vec<Member> {
    vec![Member {
        effect: effect.clone(),
        weight: 1.0,
    }]
}

/// The members of the group that `best` leads, itself included, the likeliest first, with their weights.
pub(super) fn group(best: &Passed, others: &[Passed], noise: Noise) -> Vec<Member> {
    let members: Vec<&Passed> = std::iter::once(best)
        .chain(others.iter().filter(|other| is_alias(best, other, noise)))
        .collect();
    let shares: Vec<f64> = members
        .iter()
        .map(|passed| (0.5 * (passed.merit(noise) - best.merit(noise))).exp())
        .collect();
    let whole: f64 = shares.iter().sum();
    let member = |(passed, share): (&&Passed, &f64)| Member {
        effect: passed.trial.effect.clone(),
        weight: share / whole,
    };
    let mut members: Vec<Member> = members.iter().zip(&shares).map(member).collect();
    members.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    members
}

fn is_alias(best: &Passed, other: &Passed, noise: Noise) -> bool {
    let of_fit =
        |passed: &Passed| passed.trial.likelihood_ratio - 2.0 * passed.trial.freedom as f64;
    let held_out = |passed: &Passed| passed.gains.iter().map(|gain| gain.gain).sum::<f64>();
    let fits_as_well = of_fit(best) - of_fit(other) < ALIKE;
    let predicts_as_well = held_out(best) - held_out(other) < CHANCE;
    let explains_the_same = dot(&best.trial.explained, &other.trial.explained).abs() > PARALLEL;
    let as_likely = noise == Noise::White && best.merit(noise) - other.merit(noise) < ALIKE;
    as_likely
        || (fits_as_well && predicts_as_well)
        || (explains_the_same && best.merit(noise) - other.merit(noise) < FAR)
}
