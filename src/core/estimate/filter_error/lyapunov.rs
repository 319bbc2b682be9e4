//! The Lyapunov equation M X + X Mᵀ + Q = 0 for one stable M and many Q.

use nalgebra::DMatrix;

/// ‖S^(2^j)‖ below which further terms of the series are rounding.
const NEGLIGIBLE: f64 = 1e-18;

/// Doublings after which M counts as not stable: the slowest motion would then have a time constant of 1e12 times
/// that of the fastest.
const MOST_DOUBLINGS: usize = 44;

/// The squared Smith iteration (R. A. Smith 1968): with S = (γI - M)⁻¹(γI + M) the solution is Σ Sᵏ B Sᵏᵀ, and its
/// first 2^j terms follow from j squarings, which all right-hand sides share.
pub(super) struct Lyapunov {
    gamma: f64,
    /// (γI - M)⁻¹
    resolvent: DMatrix<f64>,
    /// S, S², S⁴, ...
    powers: Vec<DMatrix<f64>>,
}

impl Lyapunov {
    /// `None` where M is not stable.
    pub(super) fn new(m: &DMatrix<f64>) -> Option<Self> {
        let n = m.nrows();
        let gamma = (m.norm() / (n as f64).sqrt()).max(f64::MIN_POSITIVE);
        let identity = DMatrix::identity(n, n) * gamma;
        let resolvent = (&identity - m).try_inverse()?;
        let mut power = &resolvent * (identity + m);
        let mut powers = Vec::new();
        for _ in 0..MOST_DOUBLINGS {
            let next = &power * &power;
            powers.push(power);
            let size = next.norm();
            if !size.is_finite() {
                return None;
            }
            if size < NEGLIGIBLE {
                return Some(Self {
                    gamma,
                    resolvent,
                    powers,
                });
            }
            power = next;
        }
        None
    }

    /// X for a symmetric Q.
    pub(super) fn solve(&self, q: &DMatrix<f64>) -> DMatrix<f64> {
        let mut x = &self.resolvent * q * self.resolvent.transpose() * (2.0 * self.gamma);
        for power in &self.powers {
            x += power * &x * power.transpose();
        }
        (&x + x.transpose()) * 0.5
    }
}
