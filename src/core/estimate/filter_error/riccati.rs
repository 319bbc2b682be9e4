//! The steady covariance P of the prediction error: A P + P Aᵀ - P G P + Q = 0, and how it changes.

use nalgebra::{DMatrix, DVector};

use super::lyapunov::Lyapunov;

/// Doublings converge quadratically, or by halves where the filter is on the border of stability.
const MOST_DOUBLINGS: usize = 60;
/// Steps of Newton's method that take what rounding the doublings left.
const REFINEMENTS: usize = 2;
/// Residual of the equation, against its terms, above which there is no solution to speak of.
const LARGEST_RESIDUAL: f64 = 1e-9;

/// P with which A - P G is stable.
pub(super) struct SteadyCovariance {
    pub p: DMatrix<f64>,
    /// States are scaled by these: units must not decide about rounding.
    scale: DVector<f64>,
    /// Of A - P G, scaled.
    lyapunov: Lyapunov,
}

impl SteadyCovariance {
    /// `None` where there is no such P: an undamped motion that no noise drives, or that no output shows.
    pub(super) fn new(a: &DMatrix<f64>, g: &DMatrix<f64>, q: &DMatrix<f64>) -> Option<Self> {
        let scale = g.diagonal().map(|g| {
            if g > 0.0 && g.is_finite() {
                g.sqrt().recip()
            } else {
                1.0
            }
        });
        let n = a.nrows();
        let scaled = |m: &DMatrix<f64>, row: i32, column: i32| {
            DMatrix::from_fn(n, n, |i, j| {
                scale[i].powi(row) * m[(i, j)] * scale[j].powi(column)
            })
        };
        let (a, g, q) = (scaled(a, -1, 1), scaled(g, 1, 1), scaled(q, -1, -1));
        let mut p = doubling(&a, &g, &q)?;
        let residual = |p: &DMatrix<f64>| {
            let flow = &a * p;
            &flow + flow.transpose() - p * &g * p + &q
        };
        for _ in 0..REFINEMENTS {
            p += Lyapunov::new(&(&a - &p * &g))?.solve(&residual(&p));
        }
        let terms = (&a * &p).norm() + q.norm();
        let left = residual(&p).norm();
        if left.is_nan() || left > LARGEST_RESIDUAL * terms {
            return None;
        }
        let lyapunov = Lyapunov::new(&(&a - &p * &g))?;
        Some(Self {
            p: scaled(&p, 1, 1),
            scale,
            lyapunov,
        })
    }

    /// dP for dA, dG, dQ, given as `forcing` = dA P + P dAᵀ - P dG P + dQ.
    pub(super) fn change(&self, forcing: &DMatrix<f64>) -> DMatrix<f64> {
        let n = forcing.nrows();
        let scale = &self.scale;
        let scaled = DMatrix::from_fn(n, n, |i, j| forcing[(i, j)] / (scale[i] * scale[j]));
        let change = self.lyapunov.solve(&scaled);
        DMatrix::from_fn(n, n, |i, j| change[(i, j)] * scale[i] * scale[j])
    }
}

/// The structure-preserving doubling algorithm (Chu, Fan, Lin 2005), for the equation with A transposed.
fn doubling(a: &DMatrix<f64>, g: &DMatrix<f64>, q: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let n = a.nrows();
    let identity = DMatrix::<f64>::identity(n, n);
    let gamma = a.norm() + (g.norm() * q.norm()).sqrt() + f64::MIN_POSITIVE;
    let shifted = a.transpose() - &identity * gamma;
    let inverse = shifted.clone().try_inverse()?;
    let w = (shifted.transpose() + q * &inverse * g).try_inverse()?;
    let mut a = &identity + w.transpose() * (2.0 * gamma);
    let mut g = &inverse * g * &w * (2.0 * gamma);
    let mut p = &w * q * &inverse * (2.0 * gamma);
    for _ in 0..MOST_DOUBLINGS {
        let between = (&identity + &g * &p).try_inverse()?;
        let gain = a.transpose() * &p * &between * &a;
        let next_g = &g + &a * &between * &g * a.transpose();
        a = &a * &between * &a;
        g = (&next_g + next_g.transpose()) * 0.5;
        p += (&gain + gain.transpose()) * 0.5;
        let (size, change) = (p.norm(), gain.norm());
        if !size.is_finite() || !change.is_finite() {
            return None;
        }
        if change <= f64::EPSILON * size {
            return Some(p);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scatter(seed: usize) -> impl FnMut(usize, usize) -> f64 {
        let mut k = seed * 1000;
        move |_, _| {
            k += 1;
            ((k as f64 * 12.9898).sin() * 43_758.547).fract()
        }
    }

    /// One state: P = (a + √(a² + g q)) / g, and dP by differentiating the equation; stable, unstable and neutral.
    #[test]
    fn one_state_has_a_closed_form() {
        for (a, g, q) in [(-2.0, 3.0, 0.5), (1.5, 2e6, 1e-9), (0.0, 40.0, 1e-6)] {
            let one = |value: f64| DMatrix::from_element(1, 1, value);
            let steady = SteadyCovariance::new(&one(a), &one(g), &one(q)).expect("a solution");
            let root = f64::sqrt(a * a + g * q);
            let p = steady.p[(0, 0)];
            assert!((p / ((a + root) / g) - 1.0).abs() < 1e-12, "{a}: {p:e}");
            // dP/dq = 1 / (2 (g P - a)) = 1 / (2 root)
            let change = steady.change(&one(1.0))[(0, 0)];
            assert!((change * 2.0 * root - 1.0).abs() < 1e-12);
        }
    }

    /// Random systems up to ten states, half of them unstable, with units six orders of magnitude apart.
    #[test]
    fn random_systems_are_solved_to_rounding() {
        let mut unstable = 0;
        for seed in 0..200 {
            let n = 1 + seed % 10;
            let mut random = scatter(seed);
            let a = DMatrix::from_fn(n, n, &mut random) * 3.0 - DMatrix::identity(n, n) * 3.0;
            let c = DMatrix::from_fn(n, n, &mut random);
            let f = DMatrix::from_fn(n, n, |i, j| if i == j { random(i, j) + 1.1 } else { 0.0 });
            let units = DVector::from_fn(n, |i, _| 10f64.powi((i % 4) as i32 * 2 - 3));
            let unit = |m: &DMatrix<f64>, row: i32, column: i32| {
                DMatrix::from_fn(n, n, |i, j| {
                    units[i].powi(row) * m[(i, j)] * units[j].powi(column)
                })
            };
            unstable += usize::from(Lyapunov::new(&a).is_none());
            let (a, g, q) = (
                unit(&a, 1, -1),
                unit(
                    &(c.transpose() * &c + DMatrix::identity(n, n) * 0.01),
                    -1,
                    -1,
                ),
                unit(&(&f * &f), 1, 1),
            );
            let p = SteadyCovariance::new(&a, &g, &q).expect("a solution").p;
            let residual = &a * &p + &p * a.transpose() - &p * &g * &p + &q;
            let residual = unit(&residual, -1, -1);
            let terms = unit(&(&a * &p), -1, -1).norm() + unit(&q, -1, -1).norm();
            assert!(
                residual.norm() < 1e-12 * terms,
                "{seed}: {:e}",
                residual.norm() / terms
            );
            assert!(
                Lyapunov::new(&unit(&(&a - &p * &g), -1, 1)).is_some(),
                "{seed}: not stable"
            );
        }
        assert!((50..150).contains(&unstable), "{unstable}");
    }

    /// A constant that nothing drives: the gain would fade away for ever.
    #[test]
    fn a_filter_without_a_steady_state_is_refused() {
        let zero = DMatrix::zeros(1, 1);
        let one = DMatrix::from_element(1, 1, 1.0);
        assert!(SteadyCovariance::new(&zero, &one, &zero).is_none());
        assert!(SteadyCovariance::new(&one, &zero, &one).is_none());
    }
}
