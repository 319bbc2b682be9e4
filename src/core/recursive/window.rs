//! The last samples of all signals, smoothed and differentiated by a local cubic about one of them.

use crate::estimate::LocalFit;

/// As many samples as a window has; the newest replaces the oldest.
pub(super) struct Window {
    half: usize,
    filled: usize,
    time: Vec<f64>,
    /// By signal.
    values: Vec<Vec<f64>>,
}

impl Window {
    /// Of 2 `half` + 1 samples.
    pub(super) fn new(half: usize, signals: usize) -> Self {
        let width = 2 * half + 1;
        Self {
            half,
            filled: 0,
            time: vec![0.0; width],
            values: vec![vec![0.0; width]; signals],
        }
    }

    pub(super) fn push(&mut self, time: f64, values: impl Iterator<Item = f64>) {
        let width = self.time.len();
        let at = if self.filled < width {
            self.filled += 1;
            self.filled - 1
        } else {
            self.time.rotate_left(1);
            self.values
                .iter_mut()
                .for_each(|values| values.rotate_left(1));
            width - 1
        };
        self.time[at] = time;
        for (to, value) in self.values.iter_mut().zip(values) {
            to[at] = value;
        }
    }

    pub(super) fn is_full(&self) -> bool {
        self.filled == self.time.len()
    }

    /// The place of the sample in the middle.
    pub(super) fn middle(&self) -> usize {
        self.half
    }

    pub(super) fn len(&self) -> usize {
        self.time.len()
    }

    /// The time at a place, s.
    pub(super) fn time(&self, place: usize) -> f64 {
        self.time[place]
    }

    /// Values and slopes of all signals at a place of the full window; whether there are any. What was not measured there is not made
    /// up; what was not measured beside it is left out.
    pub(super) fn smoothed(&self, place: usize, values: &mut [f64], slopes: &mut [f64]) -> bool {
        let whole = LocalFit::of(&self.time, place, |_| true);
        for ((signal, value), slope) in self.values.iter().zip(values).zip(slopes) {
            let own = if signal.iter().all(|x| x.is_finite()) {
                None
            } else if signal[place].is_finite() {
                LocalFit::of(&self.time, place, |j| signal[j].is_finite())
            } else {
                return false;
            };
            let fit = match &own {
                Some(own) => own,
                None if signal.iter().all(|x| x.is_finite()) => match &whole {
                    Some(whole) => whole,
                    None => return false,
                },
                None => return false,
            };
            let near = self.time.iter().copied().zip(signal.iter().copied());
            (*value, *slope) = fit.value_and_slope(near);
        }
        true
    }
}
