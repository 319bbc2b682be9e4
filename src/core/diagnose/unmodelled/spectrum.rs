//! Where the power of a force lies, and when it acts.

use num_complex::Complex64;

use super::report::{ForceHistory, ForceInterval, ForceSpectrum};

/// Shares of the power below and above which it counts as outside.
const OUTSIDE: f64 = 0.1;

/// Points of the finest frequency grid: flights of different lengths have different ones.
const LINES: usize = 256;

/// A force at the samples of one flight.
pub(super) struct Force {
    /// s
    pub step: f64,
    pub values: Vec<f64>,
}

pub(super) fn spectrum(flights: &[Force]) -> ForceSpectrum {
    let highest = flights.iter().map(|f| 0.5 / f.step.max(f64::MIN_POSITIVE));
    let highest = highest.fold(f64::INFINITY, f64::min);
    let mut power = [0.0; LINES];
    for flight in flights.iter().filter(|flight| !flight.values.is_empty()) {
        let count = flight.values.len();
        let mean = flight.values.iter().sum::<f64>() / count.max(1) as f64;
        let mut buffer: Vec<Complex64> = (flight.values.iter().enumerate())
            .map(|(k, value)| {
                let window = (std::f64::consts::PI * (k as f64 + 0.5) / count as f64).sin();
                Complex64::new((value - mean) * window, 0.0)
            })
            .collect();
        rustfft::FftPlanner::new()
            .plan_fft_forward(count)
            .process(&mut buffer);
        for (k, value) in buffer.iter().enumerate().take(count / 2).skip(1) {
            let frequency = k as f64 / (count as f64 * flight.step);
            let line = (frequency / highest * LINES as f64) as usize;
            power[line.min(LINES - 1)] += value.norm_sqr() * flight.step;
        }
    }
    let whole: f64 = power.iter().sum();
    let at = |line: usize| (line as f64 + 0.5) / LINES as f64 * highest;
    let below = |share: f64| {
        let mut sum = 0.0;
        let reached = power.iter().position(|p| {
            sum += p;
            sum >= share * whole
        });
        at(reached.unwrap_or(0))
    };
    let peak = (0..LINES).max_by(|&a, &b| power[a].total_cmp(&power[b]));
    ForceSpectrum {
        peak: at(peak.unwrap_or(0)),
        lower: below(OUTSIDE),
        upper: below(1.0 - OUTSIDE),
    }
}

/// The shortest time that holds half of a flight's energy, in the flight where that energy is largest.
pub(super) fn strongest(flights: &[ForceHistory]) -> ForceInterval {
    let energy = |flight: &ForceHistory| -> f64 { flight.value.iter().map(|w| w * w).sum() };
    let mean = |flight: &&ForceHistory| energy(flight) / flight.value.len().max(1) as f64;
    let Some(flight) = flights.iter().max_by(|a, b| mean(a).total_cmp(&mean(b))) else {
        return ForceInterval::default();
    };
    let half = 0.5 * energy(flight);
    let (mut sum, mut first) = (0.0, 0);
    let mut best = (0, flight.value.len().saturating_sub(1));
    for last in 0..flight.value.len() {
        sum += flight.value[last].powi(2);
        while sum - flight.value[first].powi(2) >= half && first < last {
            sum -= flight.value[first].powi(2);
            first += 1;
        }
        if sum >= half && last - first < best.1 - best.0 {
            best = (first, last);
        }
    }
    let time = |at: usize| flight.time.get(at).copied().unwrap_or(0.0);
    ForceInterval {
        segment: flight.segment.clone(),
        from: time(best.0),
        to: time(best.1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::Role;

    #[test]
    fn a_burst_is_found_where_and_as_quick_as_it_is() {
        let time: Vec<f64> = (0..500).map(|k| f64::from(k) * 0.04).collect();
        let burst = |t: &f64| {
            let envelope = (-((t - 12.0) / 1.0).powi(2)).exp();
            envelope * (std::f64::consts::TAU * 1.5 * t).sin()
        };
        let values: Vec<f64> = time.iter().map(burst).collect();
        let found = spectrum(&[Force {
            step: 0.04,
            values: values.clone(),
        }]);
        assert!((found.peak - 1.5).abs() < 0.15, "{found:?}");
        assert!(found.lower > 1.0 && found.upper < 2.0, "{found:?}");
        let quiet = ForceHistory {
            segment: "quiet".into(),
            role: Role::Estimation,
            value: vec![0.01; 500],
            lower: Vec::new(),
            upper: Vec::new(),
            time: time.clone(),
        };
        let loud = ForceHistory {
            segment: "loud".into(),
            value: values,
            ..quiet.clone()
        };
        let when = strongest(&[quiet, loud]);
        assert_eq!(when.segment, "loud");
        assert!(when.from > 11.0 && when.to < 13.0, "{when:?}");
    }
}
