//! D-optimal inputs: steps to plus or minus an amplitude, or to trim, that make the determinant of the covariance least.
//!
//! Full deflections at whole multiples of a pulse are the candidates that dynamic programming takes as well (Morelli and Klein, AIAA
//! 90-2801; Morelli, J. Aircraft 36 (1999) 389). The search is by coordinate exchange (Meyer and Nachtsheim, Technometrics 37 (1995)
//! 60): one interval of one input after the other goes to the level that is best while the others stay, until none moves;
//! from a 3-2-1-1 of the pulses first, then from other patterns while the budget lasts. The best that was seen is no proof
//! that there is no better one.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::bounds::ln_det_covariance;
use super::flight::Flight;
use crate::simulate::{InputDesign, Scenario};

/// What is searched.
pub(super) struct Search<'s> {
    /// Inputs that move: by place in the model, with amplitudes in the unit of the scenario.
    pub moved: &'s [(usize, f64)],
    pub pulse: f64,
    pub start: f64,
    pub intervals: usize,
    /// Places in θ that matter.
    pub of: &'s [usize],
    pub simulations: usize,
}

/// The best pattern.
pub(super) struct Found {
    pub scenario: Scenario,
    /// ln det of the covariance; none where no pattern tells all parameters within the limits.
    pub ln_det: Option<f64>,
    pub simulations: usize,
}

/// By moved input, then interval: −1, 0 or 1.
type Pattern = Vec<Vec<i8>>;

/// Patterns are compared by this: one that leaves a limit is worse than any that does not, and then one that tells less.
const LEAVES: f64 = 1e9;
const TELLS_NOT_ALL: f64 = 1e6;

impl Search<'_> {
    pub(super) fn run(&self, flight: &mut Flight) -> Found {
        let mut random = ChaCha8Rng::seed_from_u64(flight.scenario.seed);
        let mut left = self.simulations;
        let mut best = (f64::INFINITY, self.multistep());
        let mut start = self.multistep();
        while left > 0 {
            let mut pattern = start;
            let value = self.exchange(flight, &mut pattern, &mut left);
            if value < best.0 {
                best = (value, pattern);
            }
            let mut level = |_: usize| if random.random::<bool>() { 1 } else { -1 };
            start = (self.moved.iter())
                .map(|_| (0..self.intervals).map(&mut level).collect())
                .collect();
        }
        Found {
            scenario: self.scenario(flight, &best.1),
            ln_det: (best.0 < TELLS_NOT_ALL).then_some(best.0),
            simulations: self.simulations - left,
        }
    }

    /// Until no interval gains, or the budget is used up: what the pattern is worth then.
    fn exchange(&self, flight: &mut Flight, pattern: &mut Pattern, left: &mut usize) -> f64 {
        let mut value = self.value(flight, pattern, left);
        loop {
            let before = value;
            for input in 0..self.moved.len() {
                for interval in 0..self.intervals {
                    let level = pattern[input][interval];
                    let mut chosen = level;
                    for other in [-1, 0, 1].into_iter().filter(|&other| other != level) {
                        if *left == 0 {
                            pattern[input][interval] = chosen;
                            return value;
                        }
                        pattern[input][interval] = other;
                        let worth = self.value(flight, pattern, left);
                        if worth < value - 1e-9 * value.abs().max(1.0) {
                            (value, chosen) = (worth, other);
                        }
                    }
                    pattern[input][interval] = chosen;
                }
            }
            if value >= before {
                return value;
            }
        }
    }

    fn value(&self, flight: &mut Flight, pattern: &Pattern, left: &mut usize) -> f64 {
        *left = left.saturating_sub(1);
        let scenario = self.scenario(flight, pattern);
        let Ok(inputs) = flight.inputs(&scenario) else {
            return f64::INFINITY;
        };
        let Ok(flown) = flight.fly(inputs) else {
            return f64::INFINITY;
        };
        let excess = flight.excess(&flown.outputs);
        if excess > 1.0 {
            return LEAVES * excess;
        }
        ln_det_covariance(&flown.information, self.of).unwrap_or(TELLS_NOT_ALL)
    }

    /// 3-2-1-1 of the pulses, one input after the other, over and over.
    fn multistep(&self) -> Pattern {
        const UNITS: [i8; 7] = [1, 1, 1, -1, -1, 1, -1];
        let turns = self.moved.len() * UNITS.len();
        let level = |input: usize, interval: usize| {
            let place = interval % turns;
            match place / UNITS.len() == input {
                true => UNITS[place % UNITS.len()],
                false => 0,
            }
        };
        (0..self.moved.len())
            .map(|input| (0..self.intervals).map(|k| level(input, k)).collect())
            .collect()
    }

    /// The scenario with the pattern as steps.
    fn scenario(&self, flight: &Flight, pattern: &Pattern) -> Scenario {
        let mut scenario = flight.scenario.clone();
        for (levels, (input, amplitude)) in pattern.iter().zip(self.moved) {
            let mut steps = Vec::new();
            let mut before = 0;
            for (interval, &level) in levels.iter().chain([&0]).enumerate() {
                if level != before {
                    let time = self.start + interval as f64 * self.pulse;
                    steps.push([time, f64::from(level) * amplitude]);
                    before = level;
                }
            }
            let name = &flight.model().inputs[*input].name;
            if let Some(designed) = scenario.inputs.get_mut(name) {
                designed.design = InputDesign::Steps { steps };
            }
        }
        scenario
    }
}
