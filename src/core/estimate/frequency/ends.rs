//! What is estimated of the ends and the trend of a segment, and where it acts.
//!
//! A lag is a state of its own: (1 + iωT) W = B - T (w(T) exp(-iωT) - w(0)), with B the transform of what goes into it. What comes
//! out of a delay τ has at the end of the record not yet what went in last, and at its start what went in before: the difference is
//! ∫_0^τ (b(0) - b(T - τ + s) exp(-iωT)) exp(-iωs) ds, with b the signal, here a straight line over these τ seconds. Of an input both
//! starts are known, and what a delay does to its end, too (`path`).

use crate::estimate::options::frequency::{Ends, FrequencyOptions};
use crate::model::{Element, Model};

/// What an estimated quantity adds to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Target {
    /// The right side of a state equation.
    State(usize),
    /// What goes into the lag of an input.
    LaggedInput(usize),
    /// What goes into the lag of an output.
    LaggedOutput(usize),
    /// What comes out of the delay of an output: the integral of s^p, p the second number, over the delay.
    Delayed(usize, usize),
    /// An output, as it is recorded.
    Output(usize),
}

/// The end of a segment at which it acts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum End {
    First,
    Last,
}

/// Powers of a straight line.
pub(super) const POWERS: usize = 2;

/// What is estimated of lags and of delays of outputs, in each segment.
pub(super) fn of_paths(model: &Model, options: &FrequencyOptions) -> Vec<(Target, End)> {
    let mut all = Vec::new();
    if options.ends == Ends::AtRest {
        return all;
    }
    // at multiples of 1/T both ends cannot be told from one another
    let (last, both) = match options.step_hz {
        None => (End::First, vec![End::First]),
        Some(_) => (End::Last, vec![End::First, End::Last]),
    };
    let inputs = model.paths.of_inputs().iter();
    for at in inputs.filter(|at| at.element == Element::Lag) {
        all.push((Target::LaggedInput(at.signal), last));
    }
    for at in model.paths.of_outputs() {
        if at.element == Element::Lag {
            let lagged = Target::LaggedOutput(at.signal);
            all.extend(both.iter().map(|&end| (lagged, end)));
        }
        if at.element == Element::Delay {
            all.extend((0..POWERS).map(|power| (Target::Delayed(at.signal, power), last)));
            if last == End::Last {
                all.push((Target::Delayed(at.signal, 0), End::First));
            }
        }
    }
    all
}

/// How many that are.
pub(crate) fn path_ends(model: &Model, options: &FrequencyOptions) -> usize {
    of_paths(model, options).len()
}
