//! A step length that meets the strong Wolfe conditions (Nocedal, Wright, algorithms 3.5 and 3.6).

/// The cost must fall by at least this share of what the slope promises,
const DECREASE: f64 = 1e-4;
/// and the slope must flatten to this share.
const CURVATURE: f64 = 0.9;
/// Longest step tried, in steps.
const LONGEST: f64 = 1e3;
const MOST_TRIALS: usize = 40;

/// The cost is a sum over all samples: differences below this share of it are rounding.
const ROUNDING: f64 = 1e-13;

/// Cost and slope at one length.
#[derive(Clone, Copy)]
pub(crate) struct Probe {
    pub length: f64,
    pub cost: f64,
    pub slope: f64,
}

/// From cost and slope at 0; `probe` answers none where there is no cost. Steps no longer than `longest`, at
/// which a bound is met, so that no condition on the slope is asked there.
pub(crate) fn strong_wolfe(
    start: Probe,
    first: f64,
    longest: f64,
    mut probe: impl FnMut(f64) -> Option<Probe>,
) -> Option<Probe> {
    let longest = longest.min(LONGEST);
    let noise = ROUNDING * (1.0 + start.cost.abs());
    let falls = |p: &Probe| p.cost <= start.cost + DECREASE * p.length * start.slope + noise;
    let is_flat = |p: &Probe| p.slope.abs() <= -CURVATURE * start.slope;
    let nowhere = |length: f64| Probe {
        length,
        cost: f64::INFINITY,
        slope: f64::NAN,
    };
    let (mut low, mut length) = (start, first.min(longest));
    let mut trials = 0;
    let mut high = loop {
        trials += 1;
        let here = probe(length).unwrap_or(nowhere(length));
        if !falls(&here) || (low.length > 0.0 && here.cost > low.cost + noise) {
            break here;
        }
        if is_flat(&here) || length >= longest {
            return Some(here);
        }
        if here.slope > 0.0 {
            let before = std::mem::replace(&mut low, here);
            break before;
        }
        if trials == MOST_TRIALS {
            return Some(here);
        }
        (low, length) = (here, (3.0 * length).min(longest));
    };
    // the minimum lies between `low`, which is the best so far, and `high`
    while trials < MOST_TRIALS {
        trials += 1;
        let length = between(&low, &high);
        let here = probe(length).unwrap_or(nowhere(length));
        if !falls(&here) || here.cost > low.cost + noise {
            high = here;
        } else {
            if is_flat(&here) {
                return Some(here);
            }
            if here.slope * (high.length - low.length) >= 0.0 {
                high = low;
            }
            low = here;
        }
        if (high.length - low.length).abs() <= 1e-14 * low.length.max(high.length) {
            break;
        }
    }
    (low.length > 0.0 && low.cost <= start.cost + noise).then_some(low)
}

/// The minimum of the cubic through both ends, kept away from them; the middle where there is none.
fn between(low: &Probe, high: &Probe) -> f64 {
    let width = high.length - low.length;
    let middle = low.length + 0.5 * width;
    if !high.cost.is_finite() || !high.slope.is_finite() {
        return low.length + 0.2 * width;
    }
    let d1 = low.slope + high.slope - 3.0 * (high.cost - low.cost) / width;
    let square = d1 * d1 - low.slope * high.slope;
    if square < 0.0 {
        return middle;
    }
    let d2 = square.sqrt().copysign(width);
    let minimum =
        high.length - width * (high.slope + d2 - d1) / (high.slope - low.slope + 2.0 * d2);
    let (a, b) = (low.length + 0.1 * width, low.length + 0.9 * width);
    let (least, most) = (a.min(b), a.max(b));
    if minimum.is_finite() {
        minimum.clamp(least, most)
    } else {
        middle
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn search(
        f: impl Fn(f64) -> f64,
        slope: impl Fn(f64) -> f64,
        first: f64,
        longest: f64,
    ) -> Probe {
        let probe = |length: f64| Probe {
            length,
            cost: f(length),
            slope: slope(length),
        };
        strong_wolfe(probe(0.0), first, longest, |l| {
            probe(l).cost.is_finite().then(|| probe(l))
        })
        .expect("a step")
    }

    #[test]
    fn both_conditions_hold_from_steps_too_long_and_too_short() {
        let (f, g) = (
            |x: f64| (x - 1.0).powi(4) - x,
            |x: f64| 4.0 * (x - 1.0).powi(3) - 1.0,
        );
        for first in [1e-6, 0.1, 1.0, 50.0] {
            let found = search(f, g, first, f64::INFINITY);
            assert!(
                found.cost <= f(0.0) + DECREASE * found.length * g(0.0),
                "{first}"
            );
            assert!(found.slope.abs() <= CURVATURE * g(0.0).abs(), "{first}");
        }
    }

    #[test]
    fn it_stops_at_a_bound_and_keeps_out_of_where_there_is_no_cost() {
        let found = search(|x| -x, |_| -1.0, 1.0, 7.0);
        assert_eq!(found.length, 7.0);
        let found = search(
            |x| -(1.0 - x).ln() - 3.0 * x,
            |x| 1.0 / (1.0 - x) - 3.0,
            5.0,
            f64::INFINITY,
        );
        assert!(found.length < 1.0 && found.slope.abs() < 1.8);
    }
}
