//! Measurement noise: white, or with the colour of real residuals.

use crate::random::Random;

/// Lag-1 autocorrelation of what output error leaves of real flights.
const LEAST: f64 = 0.8;
const MOST: f64 = 0.96;

#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub(crate) enum Colour {
    White,
    Coloured,
}

impl Colour {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::White => "white",
            Self::Coloured => "coloured",
        }
    }
}

/// A first-order process and a share of white noise on top, of unit variance together: x_k = s_k + v_k,
/// s_k = pole s_(k−1) + w_k. Pole 0 is white.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Noise {
    pole: f64,
    /// Share of the variance that is white.
    floor: f64,
}

impl Noise {
    pub(crate) const WHITE: Self = Self {
        pole: 0.0,
        floor: 0.0,
    };

    /// Of one output in one case. Every other recording has a floor of white noise beneath its colour.
    pub(crate) fn of(colour: Colour, random: &mut Random) -> Self {
        if colour == Colour::White {
            return Self::WHITE;
        }
        let lag_1 = random.between(LEAST, MOST);
        let floor = if random.chance(0.5) {
            random.between(0.0, 0.9 * (1.0 - lag_1))
        } else {
            0.0
        };
        Self {
            pole: lag_1 / (1.0 - floor),
            floor,
        }
    }

    pub(crate) fn is_coloured(&self) -> bool {
        self.pole != 0.0
    }

    pub(crate) fn series(&self, count: usize, random: &mut Random) -> Vec<f64> {
        let drive = (1.0 - self.pole * self.pole).sqrt();
        let (slow, white) = ((1.0 - self.floor).sqrt(), self.floor.sqrt());
        let mut last = random.normal();
        (0..count)
            .map(|_| {
                let now = last;
                last = self.pole * last + drive * random.normal();
                slow * now + white * random.normal()
            })
            .collect()
    }

    /// Innovations of unit variance that a series of this colour is made of: (1 − pole L) x = (1 − b L) w.
    pub(crate) fn whitened(&self, series: &[f64]) -> Vec<f64> {
        let (a, white) = (self.pole, self.floor);
        let own = (1.0 - white) * (1.0 - a * a) + white * (1.0 + a * a);
        let next = a * white / own;
        let b = if next > 0.0 {
            (1.0 - (1.0 - 4.0 * next * next).sqrt()) / (2.0 * next)
        } else {
            0.0
        };
        let deviation = (own / (1.0 + b * b)).sqrt();
        let mut before = None;
        (series.iter())
            .map(|&x| {
                // the first sample has the variance of the whole
                let w = before.map_or(x * deviation, |(x_before, w_before)| {
                    x - a * x_before + b * w_before
                });
                before = Some((x, w));
                w / deviation
            })
            .collect()
    }
}
