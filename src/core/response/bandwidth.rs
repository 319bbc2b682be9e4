//! Bandwidth and phase delay of a response (ADS-33E-PRF, sec. 3.3.2; Tischler and Remple, ch. 7).

use std::f64::consts::TAU;

use super::report::Bandwidth;

/// Degrees to radians as the definition of the phase delay has them.
const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// From frequencies in Hz, magnitudes in dB and phases in degrees; `None` where the phase does not pass -180°.
pub(super) fn bandwidth(frequency: &[f64], magnitude: &[f64], phase: &[f64]) -> Option<Bandwidth> {
    let crossing = crossed(frequency, phase, -180.0, 0..frequency.len())?;
    let at_crossing = value_at(frequency, magnitude, crossing)?;
    let below = frequency.iter().filter(|f| **f < crossing).count();
    let double = value_at(frequency, phase, 2.0 * crossing);
    Some(Bandwidth {
        crossing: TAU * crossing,
        phase: crossed(
            frequency,
            phase,
            -135.0,
            0..(below + 1).min(frequency.len()),
        )
        .map(|f| TAU * f),
        gain: last_crossed(frequency, magnitude, at_crossing + 6.0, below).map(|f| TAU * f),
        phase_delay: double.map(|phase| -(phase + 180.0) / (DEGREES * 2.0 * TAU * crossing)),
    })
}

/// Where a falling curve first passes a level, on straight lines.
fn crossed(x: &[f64], y: &[f64], level: f64, range: std::ops::Range<usize>) -> Option<f64> {
    let mut pairs = range.clone().zip(range.skip(1));
    let (a, b) = pairs.find(|&(a, b)| y[a] > level && y[b] <= level)?;
    Some(x[a] + (x[b] - x[a]) * (y[a] - level) / (y[a] - y[b]))
}

/// Where a curve last falls through a level, before the place `end`.
fn last_crossed(x: &[f64], y: &[f64], level: f64, end: usize) -> Option<f64> {
    let mut pairs = (0..end.min(x.len().saturating_sub(1))).rev();
    let a = pairs.find(|&a| y[a] > level && y[a + 1] <= level)?;
    Some(x[a] + (x[a + 1] - x[a]) * (y[a] - level) / (y[a] - y[a + 1]))
}

fn value_at(x: &[f64], y: &[f64], at: f64) -> Option<f64> {
    let b = x.iter().position(|x| *x >= at)?;
    let a = b.checked_sub(1)?;
    Some(y[a] + (y[b] - y[a]) * (at - x[a]) / (x[b] - x[a]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// e^(-τs)/s: the phase is -90° - τω, so that ω_180 = π/(2τ), the phase delay is τ, and the 45° margin at π/(4τ); the
    /// magnitude falls by 6 dB from half of the crossing on.
    #[test]
    fn an_integrator_with_delay_has_its_own() {
        let tau = 0.2;
        let frequency: Vec<f64> = (1..4000).map(|k| f64::from(k) * 0.001).collect();
        let omega = |f: &f64| TAU * f;
        let magnitude: Vec<f64> = frequency.iter().map(|f| -20.0 * omega(f).log10()).collect();
        let phase: Vec<f64> = frequency
            .iter()
            .map(|f| -90.0 - DEGREES * tau * omega(f))
            .collect();
        let found = bandwidth(&frequency, &magnitude, &phase).unwrap();
        let crossing = std::f64::consts::FRAC_PI_2 / tau;
        assert!((found.crossing - crossing).abs() < 1e-3);
        assert!((found.phase.unwrap() - 0.5 * crossing).abs() < 1e-3);
        assert!((found.gain.unwrap() - crossing / 10.0_f64.powf(0.3)).abs() < 1e-3);
        assert!((found.phase_delay.unwrap() - tau * (1.0 - 0.5)).abs() < tau);
        let exact = (90.0 + DEGREES * tau * 2.0 * crossing - 180.0) / (DEGREES * 2.0 * crossing);
        assert!((found.phase_delay.unwrap() - exact).abs() < 1e-6);
        assert_eq!(
            bandwidth(&frequency[..100], &magnitude[..100], &phase[..100]),
            None
        );
    }
}
