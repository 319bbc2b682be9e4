//! What a likelihood ratio has to pass, so many candidates being asked at once.

use super::screen::critical;

/// How often the whole family of candidates may find something where there is nothing, by its own statistics.
const FAMILY_ERROR: f64 = 0.005;

/// 80 % power: this many standard deviations beyond the critical value.
const POWER: f64 = 0.84;

#[derive(Clone, Copy, Debug)]
pub(super) struct Threshold {
    /// Independent ones that the candidates ask.
    pub questions: f64,
}

impl Threshold {
    /// Each start from which a candidate was fitted is a question more: what has no place or frequency before it is
    /// found has many chances to be found in noise (Davies, Biometrika 74, 1987).
    pub(super) fn of(self, freedom: usize, starts: usize) -> f64 {
        critical(FAMILY_ERROR / starts.max(1) as f64, self.questions, freedom)
    }

    /// The smallest size that would have been seen with 80 % power, given its standard error.
    pub(super) fn smallest_seen(self, standard_error: f64) -> f64 {
        standard_error * (self.of(1, 1).sqrt() + POWER)
    }
}
