//! Why a solver ended, and what to say of it.

use crate::estimate::report::collinear::CollinearSet;
use crate::estimate::report::iteration::Outcome;

/// Why the loop ended.
pub(crate) enum Stopped {
    Minimum {
        distance: f64,
    },
    Budget {
        distance: f64,
    },
    Stalled {
        distance: f64,
    },
    /// Step after step came to next to nothing of what it promised.
    Corner {
        distance: f64,
    },
    Diverged,
    NoDirection,
    OnRequest,
}

impl Stopped {
    /// How far a further step would move the estimate, standard errors.
    pub(crate) fn distance(&self) -> Option<f64> {
        match *self {
            Self::Minimum { distance }
            | Self::Budget { distance }
            | Self::Stalled { distance }
            | Self::Corner { distance } => Some(distance),
            Self::Diverged | Self::NoDirection | Self::OnRequest => None,
        }
    }

    /// The outcome, and what to say of it.
    pub(crate) fn say(
        &self,
        iterations: usize,
        held: &[String],
        collinear: &[CollinearSet],
    ) -> (Outcome, String) {
        match *self {
            Self::Minimum { distance } => minimum(held, collinear, distance),
            Self::Budget { .. } if iterations == 0 => {
                let reason =
                    "no iteration was asked for: this is what the data say at the start values";
                (Outcome::Budget, reason.to_string())
            }
            Self::Budget { distance } => {
                let reason = format!(
                    "the budget of {iterations} iterations is used up; a further step would move the estimate by {distance:.1e} standard errors"
                );
                (Outcome::Budget, reason)
            }
            Self::Stalled { distance } => {
                let reason = format!(
                    "no step lowers the cost any more, though the next one would be {distance:.1e} standard errors long; try other start values"
                );
                (Outcome::Stalled, reason)
            }
            Self::Corner { distance } => {
                let reason = format!(
                    "steps come to nothing, though the next one would be {distance:.1e} standard errors long: the cost has a corner here, as a limit or a play makes it, or the floor of a narrow bend; try other start values, or hold the parameter that limits"
                );
                (Outcome::Stalled, reason)
            }
            Self::Diverged => {
                let reason = "every step tried leads to a simulation that leaves the range of numbers; start closer, or set bounds";
                (Outcome::Diverged, reason.to_string())
            }
            Self::NoDirection => (
                Outcome::Stalled,
                "the information matrix gives no direction to go on in".to_string(),
            ),
            Self::OnRequest => (
                Outcome::Cancelled,
                format!("stopped on request after {iterations} iteration(s)"),
            ),
        }
    }
}

/// A point from which no step of any length leads further down: what kind of one.
fn minimum(held: &[String], collinear: &[CollinearSet], distance: f64) -> (Outcome, String) {
    if !collinear.is_empty() {
        let sets: Vec<String> = collinear
            .iter()
            .map(|set| set.parameters.join(" + "))
            .collect();
        let reason = format!(
            "the data cannot tell apart, or cannot see: {}; fix one of each set, or fly a maneuver that separates them",
            sets.join("; ")
        );
        return (Outcome::Singular, reason);
    }
    let reason = format!(
        "converged: a further step would move the estimate by {distance:.1e} standard errors"
    );
    if held.is_empty() {
        (Outcome::Converged, reason)
    } else {
        (
            Outcome::AtBound,
            format!("{reason}; held at a bound: {}", held.join(", ")),
        )
    }
}
