//! Attitude bandwidth and phase delay (Hoh, Mitchell and Hodgkinson, AIAA 82-1617; the definitions of MIL-STD-1797A and
//! ADS-33): how fast a pilot can close a loop around the attitude, and how soon it then swings.
//!
//! ```text
//! ω_phase: φ = −135°      ω_gain: |H| = |H(ω180)| + 6 dB      τ_p = −(φ(2 ω180) + 180°)/(2 ω180)
//! ```

use num_complex::Complex64;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::channel::{Channel, Response};
use super::frequency_response::{DECIBELS, logarithmic};
use crate::estimate::Measure;

const DEGREE: f64 = std::f64::consts::PI / 180.0;
/// rad/s, in which crossings are looked for.
const RANGE: (f64, f64) = (0.05, 200.0);
const POINTS: usize = 800;

/// Bandwidth and phase delay of an attitude.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Bandwidth {
    /// The input.
    #[schema(example = "de")]
    pub input: String,
    /// The output that the attitude was taken from: an angle, or its rate, which is integrated.
    #[schema(example = "theta")]
    pub output: String,
    /// Where the phase is −135°, rad/s; absent where it never is.
    pub phase: Option<Measure>,
    /// Where the magnitude is 6 dB above that at −180°, rad/s; absent where the phase never is −180°.
    pub gain: Option<Measure>,
    /// The lower of the two, rad/s.
    pub bandwidth: Option<Measure>,
    /// Where the phase is −180°, rad/s.
    pub neutral_frequency: Option<Measure>,
    /// τ_p, s; absent where the phase never is −180°.
    pub phase_delay: Option<Measure>,
}

/// A number with its derivatives by place of θ.
#[derive(Clone)]
struct Slope {
    value: f64,
    by: Vec<f64>,
}

/// The bandwidth of the attitude that a channel's output is, or is the rate of.
pub(super) fn bandwidth(channel: &Channel<'_>, is_rate: bool) -> Bandwidth {
    let attitude = Attitude { channel, is_rate };
    let phase = attitude.crossing(-135.0 * DEGREE);
    let neutral = attitude.crossing(-180.0 * DEGREE);
    let gain = neutral
        .as_ref()
        .and_then(|neutral| attitude.gain_margin(neutral));
    let delay = neutral
        .as_ref()
        .and_then(|neutral| attitude.phase_delay(neutral));
    let both = [&phase, &gain].into_iter().flatten();
    let lower = both.min_by(|a, b| a.value.total_cmp(&b.value)).cloned();
    let measure = |slope: Option<Slope>| {
        slope.map(|slope| Measure {
            value: slope.value,
            standard_error: channel.linear.estimated.standard_error(&slope.by),
        })
    };
    Bandwidth {
        input: channel.input.name.clone(),
        output: channel.output.name.clone(),
        bandwidth: measure(lower),
        phase: measure(phase),
        gain: measure(gain),
        neutral_frequency: measure(neutral),
        phase_delay: measure(delay),
    }
}

/// The response of the attitude to the control, with the sign that makes it positive at first.
struct Attitude<'a, 'l> {
    channel: &'a Channel<'l>,
    is_rate: bool,
}

impl Attitude<'_, '_> {
    /// ln H
    fn at(&self, omega: f64) -> Option<Response> {
        let mut response = self.channel.response(omega)?;
        if self.channel.gain < 0.0 {
            response.value.im -= std::f64::consts::PI;
        }
        if self.is_rate {
            response.value -= Complex64::new(omega.ln(), std::f64::consts::FRAC_PI_2);
        }
        Some(response)
    }

    /// d ln H/dω
    fn slope(&self, omega: f64) -> Option<Complex64> {
        let step = 1e-5 * omega;
        let (above, below) = (self.at(omega + step)?, self.at(omega - step)?);
        Some((above.value - below.value) / (2.0 * step))
    }

    /// The first frequency at which the phase falls through a value, by bisection.
    fn crossing(&self, phase: f64) -> Option<Slope> {
        let over = |omega: f64| Some(self.at(omega)?.value.im - phase);
        let omega = first_fall(over)?;
        // φ(ω(θ), θ) stays: dω = −φ_θ/φ_ω
        let slope = self.slope(omega)?.im;
        let at = self.at(omega)?;
        let by = at.derivatives.iter().map(|d| -d.im / slope);
        Some(Slope {
            value: omega,
            by: by.collect(),
        })
    }

    /// The frequency below ω180 at which the magnitude is 6 dB above that at ω180.
    fn gain_margin(&self, neutral: &Slope) -> Option<Slope> {
        let at_neutral = self.at(neutral.value)?;
        let level = at_neutral.value.re + 6.0 / DECIBELS;
        // from ω180 downwards, the first that is as large
        let over = |omega: f64| Some(level - self.at(omega)?.value.re);
        let grid = logarithmic(RANGE.0, neutral.value, POINTS);
        let above = (grid.iter().rev()).position(|&omega| over(omega).is_some_and(|d| d <= 0.0))?;
        let low = grid.len() - 1 - above;
        let omega = bisect(
            |omega| over(omega).map(|d| -d),
            grid[low],
            *grid.get(low + 1)?,
        )?;
        let (slope, at) = (self.slope(omega)?.re, self.at(omega)?);
        let slope_there = self.slope(neutral.value)?.re;
        let all = at_neutral
            .derivatives
            .iter()
            .zip(&at.derivatives)
            .zip(&neutral.by);
        let by =
            all.map(|((there, here), moved)| (there.re + slope_there * moved - here.re) / slope);
        Some(Slope {
            value: omega,
            by: by.collect(),
        })
    }

    fn phase_delay(&self, neutral: &Slope) -> Option<Slope> {
        let twice = 2.0 * neutral.value;
        let at = self.at(twice)?;
        let beyond = at.value.im + std::f64::consts::PI;
        let slope = self.slope(twice)?.im;
        let by = (at.derivatives.iter().zip(&neutral.by)).map(|(d, moved)| {
            -(d.im + 2.0 * slope * moved) / twice + 2.0 * beyond / (twice * twice) * moved
        });
        Some(Slope {
            value: -beyond / twice,
            by: by.collect(),
        })
    }
}

/// The first frequency at which something falls through zero.
fn first_fall(of: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    let grid = logarithmic(RANGE.0, RANGE.1, POINTS);
    let values: Vec<Option<f64>> = grid.iter().map(|&omega| of(omega)).collect();
    let falls = |pair: &[Option<f64>]| matches!(pair, [Some(before), Some(after)] if *before > 0.0 && *after <= 0.0);
    let at = values.windows(2).position(falls)?;
    bisect(of, grid[at], grid[at + 1])
}

/// Where something that is above zero at `low` and not at `high` is zero.
fn bisect(of: impl Fn(f64) -> Option<f64>, mut low: f64, mut high: f64) -> Option<f64> {
    const HALVINGS: usize = 60;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        match of(middle)? > 0.0 {
            true => low = middle,
            false => high = middle,
        }
    }
    Some(0.5 * (low + high))
}
