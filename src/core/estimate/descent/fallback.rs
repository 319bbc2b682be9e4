//! Which of the two methods steps: the one that was asked for, and the other where that leads nowhere.

use crate::estimate::options::{Method, Options};

/// Fewer iterations than this are not divided between the methods.
const LEAST_SHARED: usize = 40;

/// Whether both methods have a share of the budget.
pub(crate) fn is_divided(options: &Options) -> bool {
    options.max_iterations >= LEAST_SHARED
}

pub(crate) struct Fallback {
    method: Method,
    asked: Method,
    /// The iteration at which the other method's turn is; none where the budget is too small.
    half: Option<usize>,
}

impl Fallback {
    pub(crate) fn new(options: &Options) -> Self {
        let budget = options.max_iterations;
        Self {
            method: options.method,
            asked: options.method,
            half: is_divided(options).then_some(budget / 2),
        }
    }

    pub(crate) fn method(&self) -> Method {
        self.method
    }

    /// Before an iteration; whether the method changes here.
    pub(crate) fn turns_at(&mut self, iteration: usize) -> bool {
        let is_half = self.half.take_if(|half| iteration >= *half).is_some();
        let turns = is_half && self.method == self.asked;
        if turns {
            self.turn();
        }
        turns
    }

    /// The other method, which steps from here on.
    pub(crate) fn turn(&mut self) -> Method {
        self.method = self.method.other();
        self.method
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fallback(budget: usize) -> Fallback {
        Fallback::new(&Options {
            max_iterations: budget,
            ..Options::default()
        })
    }

    #[test]
    fn the_other_method_has_the_second_half_of_a_budget_worth_dividing() {
        let turns = |budget: usize| {
            let mut fallback = fallback(budget);
            let turns: Vec<usize> = (0..budget).filter(|&i| fallback.turns_at(i)).collect();
            (turns, fallback.method())
        };
        assert_eq!(turns(50), (vec![25], Method::GaussNewton));
        assert_eq!(turns(19), (vec![], Method::LevenbergMarquardt));
    }
}
