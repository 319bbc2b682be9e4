//! Levenberg-Marquardt damping λ, relative to the scaled information matrix; 0 is a Gauss-Newton step.

use crate::estimate::options::Method;

/// Where it starts, ...
pub(crate) const START: f64 = 1e-3;
/// ... and below what it is none.
const NONE: f64 = 1e-10;

fn knob(name: &str, default: f64) -> f64 {
    std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(default)
}

/// The damping of a descent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Damping {
    value: f64,
    growth: f64,
    failed: bool,
}

impl Damping {
    pub(crate) fn start(method: Method) -> Self {
        Self {
            value: match method {
                Method::LevenbergMarquardt => knob("LM_START", START),
                Method::GaussNewton => 0.0,
            },
            growth: 2.0,
            failed: false,
        }
    }

    pub(crate) fn value(&self) -> f64 {
        self.value
    }

    /// After a step that did not lower the cost.
    pub(crate) fn raise(&mut self) {
        let mode = knob("LM_MODE", 1.0) as usize;
        if mode == 0 {
            self.value = (self.value * 10.0).max(START);
            return;
        }
        self.value = (self.value * self.growth).max(knob("LM_FIRST", 1e-6));
        self.growth *= knob("LM_GROWTH", 2.0);
        self.failed = true;
    }

    /// After a step that did; `gain` is the share of what the quadratic model promised.
    pub(crate) fn ease(&mut self, gain: f64) {
        let mode = knob("LM_MODE", 1.0) as usize;
        let share = match mode {
            0 => 1e-2,
            1 => (1.0 - (2.0 * gain - 1.0).powi(3)).max(knob("LM_LEAST", 1.0 / 3.0)),
            _ => {
                let least = if self.failed { knob("LM_CAREFUL", 1.0 / 3.0) } else { knob("LM_LEAST", 1e-2) };
                if gain > 0.75 { least } else if gain > 0.25 { knob("LM_MIDDLE", 0.5) } else { 2.0 }
            }
        };
        self.value *= share;
        self.growth = knob("LM_NU", 2.0);
        self.failed = false;
        if self.value < NONE {
            self.value = 0.0;
        }
    }
}
