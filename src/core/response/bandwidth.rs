//! Bandwidth and phase delay of a response (ADS-33E-PRF, sec. 3.3.2; Tischler and Remple, ch. 7).

use std::f64::consts::TAU;

use super::report::RecordedBandwidth;

/// Degrees to radians as the definition of the phase delay has them.
const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// Where the phase of a response with a positive gain is at the lowest frequency, degrees: that of a gain is 0°, that of an
/// integrator -90°.
const START: std::ops::RangeInclusive<f64> = -135.0..=45.0;

/// From frequencies in Hz, magnitudes in dB and phases in degrees; `None` where the phase does not pass -180°.
pub(super) fn bandwidth(
    frequency: &[f64],
    magnitude: &[f64],
    phase: &[f64],
) -> Option<RecordedBandwidth> {
    let (phase, negative_gain) = from_start(phase)?;
    let phase = phase.as_slice();
    let crossing = crossed(frequency, phase, -180.0, 0..frequency.len())?;
    let at_crossing = value_at(frequency, magnitude, crossing)?;
    let below = frequency.iter().filter(|f| **f < crossing).count();
    let double = value_at(frequency, phase, 2.0 * crossing);
    Some(RecordedBandwidth {
        negative_gain,
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

/// Phases that begin as those of a positive gain, and whether half a turn was taken off for it.
fn from_start(phase: &[f64]) -> Option<(Vec<f64>, bool)> {
    let first = *phase.first()?;
    let half_turns = ((first - START.end()) / 180.0).ceil();
    let from_start = phase.iter().map(|phase| phase - 180.0 * half_turns);
    Some((from_start.collect(), half_turns.rem_euclid(2.0) > 0.5))
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

    /// ±e^(-τs)/s: the phase of the positive one is -90° - τω, so that ω_180 = π/(2τ), the 45° margin is at π/(4τ), and the phase
    /// delay (90° + 2 τ ω_180 - 180°)/(2 ω_180) = τ/2; the magnitude is 6 dB above that at the crossing at ω_180/10^0.3.
    #[test]
    fn an_integrator_with_delay_has_its_own_whatever_its_sign() {
        let tau = 0.2;
        let frequency: Vec<f64> = (1..4000).map(|k| f64::from(k) * 0.001).collect();
        let omega = |f: &f64| TAU * f;
        let magnitude: Vec<f64> = frequency.iter().map(|f| -20.0 * omega(f).log10()).collect();
        let crossing = std::f64::consts::FRAC_PI_2 / tau;
        // half a turn more, as principal values and whole turns have it
        for (turned, negative) in [(0.0, false), (180.0, true), (-180.0, true), (360.0, false)] {
            let phase: Vec<f64> = frequency
                .iter()
                .map(|f| -90.0 - DEGREES * tau * omega(f) + turned)
                .collect();
            let found = bandwidth(&frequency, &magnitude, &phase).unwrap();
            assert_eq!(found.negative_gain, negative, "{turned}");
            assert!((found.crossing - crossing).abs() < 1e-3, "{turned}");
            assert!((found.phase.unwrap() - 0.5 * crossing).abs() < 1e-3);
            assert!((found.gain.unwrap() - crossing / 10.0_f64.powf(0.3)).abs() < 1e-3);
            assert!((found.phase_delay.unwrap() - 0.5 * tau).abs() < 1e-6);
            assert_eq!(
                bandwidth(&frequency[..100], &magnitude[..100], &phase[..100]),
                None
            );
        }
    }

    /// -9/(s² + 2.4 s + 9), an attitude by a control that is positive the other way: the phase starts at 180°, or a little above
    /// -180°, where noise would have it pass.
    #[test]
    fn a_negative_gain_at_rest_does_not_pass_at_its_start() {
        let frequency: Vec<f64> = (1..200).map(|k| f64::from(k) * 0.02).collect();
        let (magnitude, phase): (Vec<f64>, Vec<f64>) = frequency
            .iter()
            .map(|f| {
                let s = num_complex::Complex64::new(0.0, TAU * f);
                let response = 9.0 / (s * s + 2.4 * s + 9.0) * (-0.1 * s).exp();
                let turned = response.arg().to_degrees();
                let phase = if turned > 1.0 { turned - 360.0 } else { turned };
                (20.0 * response.norm().log10(), phase)
            })
            .unzip();
        let positive = bandwidth(&frequency, &magnitude, &phase).unwrap();
        assert!(positive.crossing > 3.0 && !positive.negative_gain);
        for turned in [180.0, -180.0] {
            let phase: Vec<f64> = phase.iter().map(|phase| phase + turned).collect();
            let found = bandwidth(&frequency, &magnitude, &phase).unwrap();
            assert!(found.negative_gain);
            assert!((found.crossing - positive.crossing).abs() < 1e-9);
        }
    }
}
