//! Choices about start values.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Where output error starts from.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case", tag = "kind", deny_unknown_fields)]
pub enum StartMethod {
    /// The document's start values or those of equation error, whichever has the lower output-error cost. Where both
    /// fit worse than constant outputs would, multiple shooting from the better of them is tried too, and
    /// so it is where the iteration ends `diverged` or `stalled` short of a minimum.
    Automatic {},
    /// The document's start values, or those that the job gives in their place, as they are.
    Document {},
    /// Least squares of the state equations on measured and differentiated states.
    EquationError {},
    /// Simplex search from the document's start values (Nelder and Mead, with the coefficients of Gao and Han for
    /// many parameters), as Góes, Hemerly and Maciel precede Levenberg-Marquardt.
    NelderMead {
        /// Most simulations.
        #[serde(default = "default_evaluations")]
        #[schema(example = 2000, minimum = 1, maximum = 100000)]
        max_evaluations: usize,
    },
    /// Random starts, each run to its end by the estimator; the best is kept, and how many reached it is told.
    MultiStart {
        /// How many are drawn.
        #[serde(default = "default_starts")]
        #[schema(example = 20, minimum = 1, maximum = 1000)]
        starts: usize,
        /// The same seed gives the same starts.
        #[serde(default = "default_seed")]
        #[schema(example = 1)]
        seed: u64,
        /// Parameters with both bounds are drawn evenly between these, others evenly from
        /// start ± spread |start|; those that start at zero stay there.
        #[serde(default = "default_spread")]
        #[schema(example = 1.0, exclusive_minimum = 0.0)]
        spread: f64,
    },
    /// The trajectory is cut into intervals whose initial states are unknowns too, taken from measured states; their
    /// jumps are then closed step by step (after Bock). For unstable aircraft and starts far away.
    MultipleShooting {
        /// Length of an interval, s.
        #[serde(default = "default_interval")]
        #[schema(example = 1.0, exclusive_minimum = 0.0)]
        interval: f64,
    },
}

impl Default for StartMethod {
    fn default() -> Self {
        Self::Automatic {}
    }
}

/// Length of an interval of multiple shooting, s: short beside the time in which an aircraft's motion can double
/// often, long beside a sample.
pub(crate) const INTERVAL: f64 = 1.0;

/// Most simulations of a simplex search, and most random starts.
pub(crate) const MOST_EVALUATIONS: usize = 100_000;
pub(crate) const MOST_STARTS: usize = 1_000;

fn default_evaluations() -> usize {
    2_000
}

fn default_starts() -> usize {
    20
}

fn default_seed() -> u64 {
    1
}

fn default_spread() -> f64 {
    1.0
}

fn default_interval() -> f64 {
    INTERVAL
}

impl StartMethod {
    /// Which field is out of range, and what is allowed.
    pub fn unfit(&self) -> Option<(&'static str, String)> {
        let positive = |value: f64| value > 0.0 && value.is_finite();
        match *self {
            Self::NelderMead { max_evaluations }
                if !(1..=MOST_EVALUATIONS).contains(&max_evaluations) =>
            {
                let message = format!("max_evaluations must be from 1 to {MOST_EVALUATIONS}");
                Some(("max_evaluations", message))
            }
            Self::MultiStart { starts, .. } if !(1..=MOST_STARTS).contains(&starts) => {
                Some(("starts", format!("starts must be from 1 to {MOST_STARTS}")))
            }
            Self::MultiStart { spread, .. } if !positive(spread) => {
                Some(("spread", "spread must be a number above 0".to_string()))
            }
            Self::MultipleShooting { interval } if !positive(interval) => {
                let message = "interval must be a number of seconds above 0";
                Some(("interval", message.to_string()))
            }
            _ => None,
        }
    }
}
