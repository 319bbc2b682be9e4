//! Low-order equivalent systems: a transfer function of low order with a delay, fitted to a frequency response.
//!
//! ```text
//! M = (20/n) Σ_k (ΔdB_k)² + 0.01745 (Δdeg_k)²
//! ```
//!
//! over n frequencies evenly spaced on a logarithmic scale (Hodgkinson, Aircraft Handling Qualities, 1999, sec. 6; the weight
//! is that of MIL-STD-1797A and of Tischler and Remple, Aircraft and Rotorcraft System Identification). M is least by
//! Levenberg and Marquardt's method from several starts; standard errors are those of its first-order change with the
//! response.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::channel::{Channel, Response};
use super::frequency_response::{DECIBELS, logarithmic};
use crate::estimate::Measure;

/// What a squared degree counts of a squared decibel.
const PHASE_WEIGHT: f64 = 0.01745;
/// Frequencies that the fit is over.
const FREQUENCIES: usize = 20;

/// Which transfer function an equivalent system is.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum EquivalentForm {
    /// K (s + 1/T) e^(−τs)/(s² + 2ζω s + ω²)
    PitchRate,
    /// K e^(−τs)/(s + 1/T)
    RollRate,
    /// K e^(−τs)/(s² + 2ζω s + ω²)
    Sideslip,
}

/// A transfer function of low order that responds alike.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct EquivalentSystem {
    /// The input.
    #[schema(example = "de")]
    pub input: String,
    /// The output.
    #[schema(example = "q")]
    pub output: String,
    /// Which transfer function it is.
    pub form: EquivalentForm,
    /// The range of frequencies that it was fitted over, rad/s.
    #[schema(example = json!([0.1, 10.0]))]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub band: [f64; 2],
    /// K, SI
    pub gain: Measure,
    /// 1/T of the numerator, 1/s; of pitch rate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub numerator_root: Option<Measure>,
    /// T, s; of roll rate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_constant: Option<Measure>,
    /// ω, rad/s
    #[serde(skip_serializing_if = "Option::is_none")]
    pub natural_frequency: Option<Measure>,
    /// ζ
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping_ratio: Option<Measure>,
    /// τ, s; not below zero.
    pub delay: Measure,
    /// M, (20/n) Σ (dB² + 0.01745 deg²): where it is large no system of this form responds alike.
    #[schema(example = 0.8)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub mismatch: f64,
}

impl EquivalentForm {
    fn has_numerator(self) -> bool {
        self == Self::PitchRate
    }

    fn is_second_order(self) -> bool {
        self != Self::RollRate
    }

    /// ln K, then the numerator's root, a1 (of second order), a0, τ.
    fn unknowns(self) -> usize {
        3 + usize::from(self.has_numerator()) + usize::from(self.is_second_order())
    }

    /// ln H at jω and its derivatives by the unknowns.
    fn response(self, unknowns: &[f64], omega: f64) -> (Complex64, Vec<Complex64>) {
        let s = Complex64::new(0.0, omega);
        let mut value = Complex64::from(unknowns[0]);
        let mut slopes = vec![Complex64::ONE];
        if self.has_numerator() {
            let numerator = s + unknowns[1];
            value += numerator.ln();
            slopes.push(numerator.inv());
        }
        let rest = &unknowns[slopes.len()..];
        let denominator = match (self.is_second_order(), rest) {
            (true, &[a1, a0, _]) => s * s + a1 * s + a0,
            _ => s + rest[0],
        };
        if self.is_second_order() {
            slopes.push(-s / denominator);
        }
        slopes.push(-denominator.inv());
        slopes.push(-s);
        value += -denominator.ln() - s * unknowns[unknowns.len() - 1];
        (value, slopes)
    }

    /// Whether a0 and the numerator's root are above zero: with others it would be a motion of another kind.
    fn is_sensible(self, unknowns: &[f64]) -> bool {
        let root = !self.has_numerator() || unknowns[1] > 0.0;
        root && (!self.is_second_order() || unknowns[unknowns.len() - 2] > 0.0)
    }

    /// Where a search may begin, with the motion at a frequency.
    fn start(self, omega: f64) -> Vec<f64> {
        let mut unknowns = vec![0.0];
        if self.has_numerator() {
            unknowns.push(0.4 * omega);
        }
        match self.is_second_order() {
            true => unknowns.extend([1.2 * omega, omega * omega]),
            false => unknowns.push(omega),
        }
        unknowns.push(0.0);
        unknowns
    }
}

/// The equivalent system of a channel; none where a response is missing, or no fit has a finite mismatch.
pub(super) fn equivalent_system(
    channel: &Channel<'_>,
    form: EquivalentForm,
    band: (f64, f64),
) -> Option<EquivalentSystem> {
    let fitted = fitted(channel, form, band)?;
    Some(report(channel, form, band, &fitted))
}

/// a0 over the numerator's root, times a factor, of a pitch rate's equivalent system.
pub(super) fn anticipation(
    channel: &Channel<'_>,
    band: (f64, f64),
    factor: f64,
) -> Option<Measure> {
    let fitted = fitted(channel, EquivalentForm::PitchRate, band)?;
    let (root, a0) = (fitted.fit.unknowns[1], fitted.fit.unknowns[3]);
    let value = factor * a0 / root;
    let by = [(1, -value / root), (3, factor / root)];
    (value.is_finite() && value > 0.0).then(|| fitted.measure(channel, value, &by))
}

/// A fit to the response of a channel.
struct Fitted {
    /// Of the gain.
    sign: f64,
    fit: Fit,
    /// The derivatives of the unknowns by each place of θ.
    by_place: Vec<DVector<f64>>,
}

fn fitted(channel: &Channel<'_>, form: EquivalentForm, band: (f64, f64)) -> Option<Fitted> {
    let omegas = logarithmic(band.0, band.1, FREQUENCIES);
    let responses: Option<Vec<Response>> = omegas.iter().map(|&o| channel.response(o)).collect();
    let responses = responses?;
    let (sign, turned) = match channel.gain < 0.0 {
        true => (-1.0, std::f64::consts::PI),
        false => (1.0, 0.0),
    };
    let turned = Complex64::new(0.0, turned + std::f64::consts::TAU * channel.turns());
    let target: Vec<Complex64> = responses.iter().map(|r| r.value - turned).collect();
    let fit = best(form, &omegas, &target)?;
    Some(Fitted {
        sign,
        by_place: slopes(&fit, &responses),
        fit,
    })
}

impl Fitted {
    /// Something with these derivatives by some of the unknowns.
    fn measure(&self, channel: &Channel<'_>, value: f64, by: &[(usize, f64)]) -> Measure {
        let chain = |slopes: &DVector<f64>| by.iter().map(|&(i, d)| d * slopes[i]).sum();
        let slopes: Vec<f64> = self.by_place.iter().map(chain).collect();
        Measure {
            value,
            standard_error: channel.linear.estimated.standard_error(&slopes),
        }
    }
}

/// A fit with the derivatives of its unknowns by the residuals.
struct Fit {
    unknowns: Vec<f64>,
    mismatch: f64,
    /// (JᵀJ)⁻¹Jᵀ; zero for a delay that is held at zero.
    by_residuals: DMatrix<f64>,
}

fn best(form: EquivalentForm, omegas: &[f64], target: &[Complex64]) -> Option<Fit> {
    let starts = logarithmic(omegas[0], *omegas.last()?, 7);
    let fits = |holds_delay: bool| {
        let fits = starts.iter().filter_map(move |&omega| {
            descend(form, omegas, target, form.start(omega), holds_delay)
        });
        let sensible = fits.filter(|fit| form.is_sensible(&fit.unknowns));
        sensible.min_by(|a, b| a.mismatch.total_cmp(&b.mismatch))
    };
    let free = fits(false)?;
    match free.unknowns.last() {
        Some(&delay) if delay < 0.0 => fits(true),
        _ => Some(free),
    }
}

fn descend(
    form: EquivalentForm,
    omegas: &[f64],
    target: &[Complex64],
    mut unknowns: Vec<f64>,
    holds_delay: bool,
) -> Option<Fit> {
    const ITERATIONS: usize = 200;
    let count = form.unknowns() - usize::from(holds_delay);
    let mut damping = 1e-2;
    let mut at = Residuals::at(form, omegas, target, &unknowns);
    for _ in 0..ITERATIONS {
        let jacobian = at.jacobian.columns(0, count);
        let mut equations = jacobian.tr_mul(&jacobian);
        (0..count).for_each(|i| equations[(i, i)] *= 1.0 + damping);
        let step = equations.lu().solve(&-jacobian.tr_mul(&at.residuals))?;
        let mut next = unknowns.clone();
        next.iter_mut()
            .zip(step.iter())
            .for_each(|(to, step)| *to += step);
        let then = Residuals::at(form, omegas, target, &next);
        let is_better = then.mismatch < at.mismatch;
        let is_done = at.mismatch - then.mismatch < 1e-14 * at.mismatch.max(1e-20);
        if is_better {
            (unknowns, at) = (next, then);
            damping = (0.2 * damping).max(1e-12);
        } else {
            damping *= 10.0;
        }
        if damping > 1e12 || is_better && is_done {
            break;
        }
    }
    let jacobian = at.jacobian.columns(0, count).into_owned();
    let inverse = jacobian.tr_mul(&jacobian).try_inverse()?;
    let solved = -inverse * jacobian.transpose();
    let mut by_residuals = DMatrix::zeros(form.unknowns(), solved.ncols());
    by_residuals.rows_mut(0, count).copy_from(&solved);
    at.mismatch.is_finite().then_some(Fit {
        unknowns,
        mismatch: at.mismatch,
        by_residuals,
    })
}

/// Weighted differences of model and target: decibels, then degrees.
struct Residuals {
    residuals: DVector<f64>,
    jacobian: DMatrix<f64>,
    mismatch: f64,
}

impl Residuals {
    fn at(form: EquivalentForm, omegas: &[f64], target: &[Complex64], unknowns: &[f64]) -> Self {
        let n = omegas.len();
        let mut residuals = DVector::zeros(2 * n);
        let mut jacobian = DMatrix::zeros(2 * n, unknowns.len());
        for (k, (&omega, target)) in omegas.iter().zip(target).enumerate() {
            let (value, slopes) = form.response(unknowns, omega);
            (residuals[k], residuals[n + k]) = weighted(value - target);
            for (i, &slope) in slopes.iter().enumerate() {
                (jacobian[(k, i)], jacobian[(n + k, i)]) = weighted(slope);
            }
        }
        Self {
            mismatch: 20.0 / n as f64 * residuals.norm_squared(),
            residuals,
            jacobian,
        }
    }
}

/// What a difference of ln H counts in the mismatch.
fn weighted(difference: Complex64) -> (f64, f64) {
    let degrees = difference.im.to_degrees();
    (DECIBELS * difference.re, PHASE_WEIGHT.sqrt() * degrees)
}

fn report(
    channel: &Channel<'_>,
    form: EquivalentForm,
    band: (f64, f64),
    fitted: &Fitted,
) -> EquivalentSystem {
    let measure = |value, by: &[(usize, f64)]| fitted.measure(channel, value, by);
    let unknowns = &fitted.fit.unknowns;
    let last = unknowns.len() - 1;
    let gain = fitted.sign * unknowns[0].exp();
    let a0 = unknowns[last - 1];
    let (mut frequency, mut damping, mut time_constant) = (None, None, None);
    if form.is_second_order() && a0 > 0.0 {
        let omega = a0.sqrt();
        let zeta = unknowns[last - 2] / (2.0 * omega);
        frequency = Some(measure(omega, &[(last - 1, 0.5 / omega)]));
        let by = [(last - 2, 0.5 / omega), (last - 1, -0.5 * zeta / a0)];
        damping = Some(measure(zeta, &by));
    } else if !form.is_second_order() {
        time_constant = Some(measure(a0.recip(), &[(last - 1, -a0.powi(-2))]));
    }
    EquivalentSystem {
        input: channel.input.name.clone(),
        output: channel.output.name.clone(),
        form,
        band: [band.0, band.1],
        gain: measure(gain, &[(0, gain)]),
        numerator_root: (form.has_numerator()).then(|| measure(unknowns[1], &[(1, 1.0)])),
        time_constant,
        natural_frequency: frequency,
        damping_ratio: damping,
        // of no delay rounding leaves some attoseconds
        delay: measure((unknowns[last] * 1e12).round() / 1e12, &[(last, 1.0)]),
        mismatch: fitted.fit.mismatch,
    }
}

/// The derivatives of the unknowns by each place of θ.
fn slopes(fit: &Fit, responses: &[Response]) -> Vec<DVector<f64>> {
    let n = responses.len();
    let places = responses.first().map_or(0, |r| r.derivatives.len());
    let of_place = |place: usize| {
        let mut residuals = DVector::zeros(2 * n);
        for (k, response) in responses.iter().enumerate() {
            (residuals[k], residuals[n + k]) = weighted(-response.derivatives[place]);
        }
        &fit.by_residuals * residuals
    };
    (0..places).map(of_place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What has the form is found again, delay included.
    #[test]
    fn a_system_of_low_order_is_its_own_equivalent() {
        for (form, truth) in [
            (EquivalentForm::PitchRate, vec![1.5, 0.8, 2.1, 4.0, 0.12]),
            (EquivalentForm::RollRate, vec![2.0, 1.6, 0.05]),
            (EquivalentForm::Sideslip, vec![-1.0, 0.4, 2.2, 0.08]),
        ] {
            let omegas = logarithmic(0.1, 10.0, FREQUENCIES);
            let target: Vec<Complex64> =
                omegas.iter().map(|&o| form.response(&truth, o).0).collect();
            let fit = best(form, &omegas, &target).expect("a fit");
            assert!(fit.mismatch < 1e-12, "{form:?}: {}", fit.mismatch);
            for (found, truth) in fit.unknowns.iter().zip(&truth) {
                assert!((found - truth).abs() < 1e-6, "{form:?}: {:?}", fit.unknowns);
            }
        }
    }

    /// A lead cannot be a delay.
    #[test]
    fn a_delay_is_not_below_zero() {
        let form = EquivalentForm::RollRate;
        let omegas = logarithmic(0.1, 10.0, FREQUENCIES);
        let target: Vec<Complex64> = (omegas.iter())
            .map(|&o| form.response(&[0.0, 1.0, -0.2], o).0)
            .collect();
        let fit = best(form, &omegas, &target).expect("a fit");
        assert_eq!(fit.unknowns[2], 0.0);
        assert!(fit.mismatch > 1.0);
    }
}
