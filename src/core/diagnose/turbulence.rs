//! The end of the rounds in turbulence: what it disturbs, and what is there beside it.

use super::accepted::Accepted;
use super::beside_noise::beside_noise;
use super::case::Case;
use super::disturbed::{Pushed, disturbed_elsewhere, disturbed_throughout};
use super::fitted::Fitted;
use super::found::Found;
use super::passed::Passed;
use super::round::MOST_ROUNDS;
use super::threshold::Threshold;
use super::watch::{Stopped, Watcher, ask};

/// The round in which process noise was accepted.
pub(super) struct Disturbed<'c> {
    pub case: &'c Case,
    /// The fit before it.
    pub calm: &'c Fitted,
    pub accepted: Accepted,
    /// What passed beside it.
    pub others: Vec<Passed>,
    pub threshold: Threshold,
    pub number: usize,
}

/// The fit by filter error that the rounds end with: of a rate that is pushed, or of all states that are disturbed, with
/// what is clearly there beside that.
///
/// # Errors
/// The watcher stopped it.
pub(super) fn settle(
    disturbed: Disturbed<'_>,
    found: &mut Found,
    watcher: &mut Watcher<'_>,
) -> Result<Fitted, Stopped> {
    let Disturbed {
        case,
        calm,
        mut accepted,
        mut others,
        threshold,
        mut number,
    } = disturbed;
    let mut base = match disturbed_elsewhere(case, calm, &accepted.fitted) {
        Some(Pushed { rate, fitted, gain }) => {
            accepted = accepted.of_rate(&rate, &fitted, gain);
            found.pushed = Some(rate);
            fitted
        }
        None => disturbed_throughout(case, calm, accepted.fitted.clone()),
    };
    found.accept(accepted, number, watcher)?;
    while number < MOST_ROUNDS
        && let Some(further) = beside_noise(case, &base, &others, threshold)
    {
        ask(watcher)?;
        number += 1;
        others.retain(|other| !further.effect.rules_out(&other.trial.effect));
        base = further.fitted.clone();
        found.accept(further, number, watcher)?;
    }
    Ok(base)
}
