//! A recorded signal on its way to the equations, with its derivatives by the sizes of the elements it has passed.
//!
//! Each element passes a signal sample by sample and starts at its first value. At the size of no effect what comes
//! out is what went in, to the last bit.

use super::interpolation::Axis;
use super::lag::Lag;
use super::method::InputInterpolation;
use crate::model::Element;

pub(super) struct Signal<'a> {
    axis: &'a Axis,
    interpolation: InputInterpolation,
    pub samples: Vec<f64>,
    /// ∂/∂ψ of the samples, by element passed.
    pub slopes: Vec<Vec<f64>>,
}

impl<'a> Signal<'a> {
    pub(super) fn new(axis: &'a Axis, interpolation: InputInterpolation, samples: &[f64]) -> Self {
        Self {
            axis,
            interpolation,
            samples: samples.to_vec(),
            slopes: Vec::new(),
        }
    }

    pub(super) fn pass(&mut self, element: Element, size: f64) {
        match element {
            Element::Play => self.play(size),
            Element::RateLimit => self.limit_rate(size),
            Element::Lag => self.lag(size),
            Element::Delay => self.delay(size),
        }
    }

    /// y_k = y_(k-1), but not below u_k - b nor above u_k + b. Below 0 it is y = u - (y(-b) - u), so that there are
    /// derivatives to both sides of 0. It comes first in a path: no other size has a part in what it moves.
    fn play(&mut self, half_width: f64) {
        let (b, mirrored) = (half_width.abs(), half_width < 0.0);
        let mut at = self.samples.first().copied().unwrap_or(0.0);
        let mut slope = 0.0;
        let passed = |u: &mut f64| {
            if at > *u + b {
                (at, slope) = (*u + b, 1.0);
            } else if at < *u - b {
                (at, slope) = (*u - b, -1.0);
            }
            *u = if mirrored { 2.0 * *u - at } else { at };
            slope
        };
        let own = self.samples.iter_mut().map(passed).collect();
        self.slopes.push(own);
    }

    /// y goes to u, but no faster than r: exact along the straight line from one sample to the next, also where that meets
    /// y on its way and parts from it again. A held signal is followed as far as the step goes.
    fn limit_rate(&mut self, limit: f64) {
        let recorded = self.samples.clone();
        let earlier = self.slopes.clone();
        let mut own = vec![0.0; recorded.len()];
        for k in 1..recorded.len() {
            let (h, before) = (self.axis.length(k - 1), self.samples[k - 1]);
            let (change, way) = (recorded[k] - recorded[k - 1], recorded[k] - before);
            let steep = match self.interpolation {
                InputInterpolation::Linear => change.abs() / h > limit,
                InputInterpolation::Hold => false,
            };
            if !steep && way.abs() / h <= limit {
                continue;
            }
            let direction = if steep { change } else { way }.signum();
            let gap = direction * (before - recorded[k - 1]);
            let closing = limit + change.abs() / h;
            // how long they go towards each other
            let meet = if steep {
                (gap / closing).clamp(0.0, h)
            } else {
                0.0
            };
            let met = 0.0 < meet && meet < h;
            self.samples[k] = before + direction * limit * (h - 2.0 * meet);
            let later = |change: f64| {
                if met {
                    -2.0 * direction * limit * change / closing
                } else {
                    0.0
                }
            };
            own[k] =
                own[k - 1] + direction * (h - 2.0 * meet) + later(direction * own[k - 1] - meet);
            for (slopes, of_recorded) in self.slopes.iter_mut().zip(&earlier) {
                let of_gap = direction * (slopes[k - 1] - of_recorded[k - 1]);
                let of_rate = direction * (of_recorded[k] - of_recorded[k - 1]) / h;
                slopes[k] = slopes[k - 1] + later(of_gap - meet * of_rate);
            }
        }
        self.slopes.push(own);
    }

    fn lag(&mut self, time: f64) {
        let (axis, lag) = (self.axis, Lag::new(time, self.axis));
        let own = match self.interpolation {
            InputInterpolation::Linear => lag.slope(axis, &self.samples),
            InputInterpolation::Hold => lag.held_slope(axis, &self.samples),
        };
        for series in std::iter::once(&mut self.samples).chain(&mut self.slopes) {
            match self.interpolation {
                InputInterpolation::Linear => lag.pass(axis, series, 0.0),
                InputInterpolation::Hold => lag.pass_held(axis, series),
            }
        }
        self.slopes.push(own);
    }

    fn delay(&mut self, delay: f64) {
        let (axis, samples) = (self.axis, &self.samples);
        let instants = || (0..samples.len()).map(|k| axis.before(k, delay));
        let (values, own) = instants()
            .map(|at| {
                let (value, rate) = axis.recorded(samples, at);
                (value, -rate)
            })
            .unzip();
        for slopes in &mut self.slopes {
            let change = |at| axis.recorded_change(samples, slopes, at);
            *slopes = instants().map(change).collect();
        }
        self.samples = values;
        self.slopes.push(own);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::{Segment, Steps, Substeps};

    const COUNT: usize = 120;
    const STEP: f64 = 0.04;

    fn axes() -> [Axis; 2] {
        let uneven = (0..COUNT - 1).map(|k| 0.02 + 0.013 * (k % 4) as f64);
        [Steps::Even(STEP), Steps::Uneven(uneven.collect())].map(|steps| {
            Axis::new(&Segment {
                label: String::new(),
                time: vec![0.0; COUNT],
                steps,
                substeps: Substeps::default(),
                inputs: Vec::new(),
                measured: Vec::new(),
            })
        })
    }

    /// A wave with an edge in it and a stretch at rest.
    fn recorded() -> Vec<f64> {
        let at = |k: usize| match k {
            0..60 => 0.2 + (0.21 * k as f64).sin() + f64::from(u8::from(k > 20)),
            60..70 => 0.9,
            _ => 0.9 + 0.5 * (0.3 * (k - 70) as f64).sin(),
        };
        (0..COUNT).map(at).collect()
    }

    fn passed(axis: &Axis, hold: bool, path: &[(Element, f64)]) -> (Vec<f64>, Vec<Vec<f64>>) {
        let interpolation = if hold {
            InputInterpolation::Hold
        } else {
            InputInterpolation::Linear
        };
        let mut signal = Signal::new(axis, interpolation, &recorded());
        for &(element, size) in path {
            signal.pass(element, size);
        }
        (signal.samples, signal.slopes)
    }

    /// A continuous element walks along the straight lines between samples in a thousand steps to each.
    fn walked(axis: &Axis, mut follow: impl FnMut(f64, f64, f64) -> f64) -> Vec<f64> {
        const FINE: usize = 1000;
        let u = recorded();
        let mut y = vec![u[0]];
        for k in 0..COUNT - 1 {
            let mut at = y[k];
            for i in 1..=FINE {
                let share = i as f64 / FINE as f64;
                let h = axis.length(k) / FINE as f64;
                at = follow(at, u[k] + share * (u[k + 1] - u[k]), h);
            }
            y.push(at);
        }
        y
    }

    #[test]
    fn what_has_no_size_changes_nothing() {
        for axis in axes() {
            let u = recorded();
            let rates = (1..COUNT).map(|k| ((u[k] - u[k - 1]) / axis.length(k - 1)).abs());
            let largest = rates.fold(0.0, f64::max);
            let path = [
                (Element::Play, 0.0),
                (Element::RateLimit, largest),
                (Element::Lag, 0.0),
                (Element::Delay, 0.0),
            ];
            for hold in [false, true] {
                let (samples, slopes) = passed(&axis, hold, &path);
                assert_eq!(samples, u);
                assert!(slopes.iter().flatten().all(|slope| slope.is_finite()));
                assert!(slopes[1].iter().all(|slope| *slope == 0.0));
            }
        }
    }

    /// Between its samples the signal is monotone: play is exact at them.
    #[test]
    fn play_is_a_dead_band_with_memory() {
        for axis in axes() {
            for b in [0.01, 0.3, 5.0] {
                let wanted = walked(&axis, |at, u, _| at.max(u - b).min(u + b));
                let (found, _) = passed(&axis, false, &[(Element::Play, b)]);
                for (found, wanted) in found.iter().zip(&wanted) {
                    assert!((found - wanted).abs() < 1e-12, "{b}: {found} {wanted}");
                }
            }
        }
    }

    /// The walk turns at most a thousandth of a step late.
    #[test]
    fn a_limited_rate_follows_as_fast_as_it_may() {
        for axis in axes() {
            for r in [0.5, 2.0, 8.0] {
                let wanted = walked(&axis, |at, u, h| at + (u - at).clamp(-r * h, r * h));
                let (found, _) = passed(&axis, false, &[(Element::RateLimit, r)]);
                let step = (0..COUNT - 1).map(|k| axis.length(k)).fold(0.0, f64::max);
                let mut limited = 0;
                for k in 1..COUNT {
                    let rate = (found[k] - found[k - 1]).abs() / axis.length(k - 1);
                    assert!(rate <= r * (1.0 + 1e-12));
                    limited += usize::from(rate > 0.99 * r);
                    let apart = (found[k] - wanted[k]).abs();
                    assert!(apart <= 2e-3 * r * step, "{r} {k}: {apart}");
                }
                assert!(limited >= 2, "{r} is no limit");
            }
        }
    }

    #[test]
    fn a_held_signal_is_followed_as_far_as_the_step_goes() {
        let axis = &axes()[0];
        let u = recorded();
        let (found, _) = passed(axis, true, &[(Element::RateLimit, 2.0)]);
        for k in 1..COUNT {
            let way = (u[k] - found[k - 1]).clamp(-2.0 * STEP, 2.0 * STEP);
            assert!((found[k] - found[k - 1] - way).abs() < 1e-12);
        }
    }

    /// Of all four in a row, each by its own size, against central differences; they agree but where a difference
    /// goes over the edge of what pushes or limits.
    #[test]
    fn slopes_go_through_what_follows() {
        let sizes = [0.05, 1.7, 0.07, 0.03];
        let elements = [
            Element::Play,
            Element::RateLimit,
            Element::Lag,
            Element::Delay,
        ];
        for (axis, hold) in axes().iter().flat_map(|axis| [(axis, false), (axis, true)]) {
            let of = |sizes: [f64; 4]| {
                let path: Vec<(Element, f64)> = elements.into_iter().zip(sizes).collect();
                passed(axis, hold, &path)
            };
            let (_, slopes) = of(sizes);
            for (i, slopes) in slopes.iter().enumerate() {
                let moved = |step: f64| {
                    let mut sizes = sizes;
                    sizes[i] += step;
                    of(sizes).0
                };
                let (above, below) = (moved(1e-7), moved(-1e-7));
                let mut seen = 0;
                for k in 0..COUNT {
                    let wanted = (above[k] - below[k]) / 2e-7;
                    assert!(
                        (slopes[k] - wanted).abs() < 1e-5 * wanted.abs().max(1.0),
                        "{:?} {k}: {} {wanted}",
                        elements[i],
                        slopes[k]
                    );
                    seen += usize::from(wanted.abs() > 1e-3);
                }
                assert!(seen > 20, "{:?} is hardly there", elements[i]);
            }
        }
    }

    /// Where nothing but the size is 0, the derivative is that to both sides.
    #[test]
    fn slopes_at_no_effect() {
        for axis in axes() {
            for element in [Element::Play, Element::Lag, Element::Delay] {
                let (_, slopes) = passed(&axis, false, &[(element, 0.0)]);
                let (above, _) = passed(&axis, false, &[(element, 1e-8)]);
                let (below, _) = passed(&axis, false, &[(element, -1e-8)]);
                for k in 0..COUNT {
                    let wanted = (above[k] - below[k]) / 2e-8;
                    assert!(
                        (slopes[0][k] - wanted).abs() < 1e-4 * wanted.abs().max(1.0),
                        "{element:?} {k}: {} {wanted}",
                        slopes[0][k]
                    );
                }
            }
        }
    }
}
