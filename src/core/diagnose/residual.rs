//! Residuals on their own: colour, distribution, what they follow, and where in time they are largest.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::screen::tail;
use crate::estimate::{OutputSeries, Series, TimeHistory};
use crate::stop;

/// The residual of one output, over all segments that were fitted.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct ResidualAnalysis {
    /// The output's name.
    #[schema(example = "alpha")]
    pub output: String,
    /// SI
    pub unit: String,
    /// Samples that have a measured value.
    pub samples: usize,
    /// Root mean square, in `unit`.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub rms: f64,
    /// At lags 0, 1, 2, ... samples.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub autocorrelation: Vec<f64>,
    /// White noise stays within ± this at 95 of 100 lags.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub band: f64,
    /// Ljung and Box: whether it is white noise.
    pub portmanteau: Portmanteau,
    /// By input: the correlation with the input's rate of change, by lag.
    pub cross_correlation: Vec<CrossCorrelation>,
    /// By Welch's method, from the lowest frequency to the highest.
    pub spectrum: Vec<SpectralLine>,
    /// Its shape, beside that of a normal distribution.
    pub distribution: Distribution,
    /// Samples that are further from the mean than noise goes.
    pub outliers: Vec<Outlier>,
    /// RMS error along the time, by segment.
    pub localisation: Vec<Window>,
}

/// A test of all autocorrelations up to a lag at once.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Portmanteau {
    /// Ljung and Box's Q.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub statistic: f64,
    /// Autocorrelations in it.
    pub lags: usize,
    /// Probability of a greater statistic with white noise.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub probability: f64,
}

/// What a residual has in common with an input.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct CrossCorrelation {
    /// The input's name.
    pub input: String,
    /// Of the residual at k with the input at k − lag, lags from −`lags` to `lags`.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub values: Vec<f64>,
    /// The largest lag, samples.
    pub lags: usize,
    /// 95 % of the values of independent series are within ± this, their colours considered (Bartlett).
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub band: f64,
}

/// Power at one frequency.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct SpectralLine {
    /// Hz
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub frequency: f64,
    /// Power spectral density, SI units squared per Hz.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub density: f64,
    /// Squared coherence with the input that it is most coherent with, 0 to 1.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub coherence: f64,
}

/// The shape of a distribution.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Distribution {
    /// 0 of a symmetric distribution.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub skewness: f64,
    /// 0 of a normal distribution.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub excess_kurtosis: f64,
    /// Largest deviation from the mean in standard deviations.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub largest: f64,
}

/// A sample that is further from the mean than noise goes.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Outlier {
    /// The segment's label.
    pub segment: String,
    /// s
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub time: f64,
    /// Deviation in robust standard deviations (1.4826 times the median deviation).
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub deviation: f64,
}

/// A part of a segment.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Window {
    /// The segment's label.
    pub segment: String,
    /// s
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub from: f64,
    /// s
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub to: f64,
    /// Root mean square of the residual in it.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub rms: f64,
    /// Over the RMS of all.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub ratio: f64,
}

const MOST_LAGS: usize = 40;
const WINDOWS: usize = 12;
const MOST_OUTLIERS: usize = 200;
/// Normal noise goes beyond this once in 500 million samples.
const OUTLYING: f64 = 6.0;
/// Samples in a window of the spectrum (Welch), at most.
const SPECTRUM_WINDOW: usize = 256;

/// Analyses the residuals of every output.
pub fn analyse(histories: &[TimeHistory]) -> Vec<ResidualAnalysis> {
    let outputs = histories.first().map_or(0, |history| history.outputs.len());
    (0..outputs)
        .map(|output| of_output(histories, output))
        .collect()
}

fn of_output(histories: &[TimeHistory], output: usize) -> ResidualAnalysis {
    let all: Vec<&OutputSeries> = histories
        .iter()
        .map(|history| &history.outputs[output])
        .collect();
    let finite: Vec<f64> = all
        .iter()
        .flat_map(|s| &s.residual)
        .copied()
        .filter(|e| e.is_finite())
        .collect();
    let n = finite.len().max(1) as f64;
    let mean = finite.iter().sum::<f64>() / n;
    stop::check();
    let moment = |power: i32| finite.iter().map(|e| (e - mean).powi(power)).sum::<f64>() / n;
    let deviation = moment(2).sqrt().max(f64::MIN_POSITIVE);
    let centred: Vec<Vec<f64>> = all
        .iter()
        .map(|s| s.residual.iter().map(|e| e - mean).collect())
        .collect();
    let lags = MOST_LAGS.min(finite.len() / 4);
    let autocorrelation: Vec<f64> = (0..=lags)
        .map(|lag| {
            centred.iter().map(|e| lagged(e, e, lag)).sum::<f64>() / (n * deviation * deviation)
        })
        .collect();
    let statistic = n
        * (n + 2.0)
        * (1..=lags)
            .map(|lag| autocorrelation[lag].powi(2) / (n - lag as f64))
            .sum::<f64>();
    let inputs = histories.first().map_or(0, |history| history.inputs.len());
    let cross = |input: usize| {
        let series: Vec<&Series> = histories
            .iter()
            .map(|history| &history.inputs[input])
            .collect();
        cross_correlation(&centred, &series, &autocorrelation, lags)
    };
    let cross_correlation = (0..inputs).map(cross).collect();
    let rms = (finite.iter().map(|e| e * e).sum::<f64>() / n).sqrt();
    let last = all.first();
    ResidualAnalysis {
        output: last.map_or(String::new(), |s| s.name.clone()),
        unit: last.map_or(String::new(), |s| s.unit.clone()),
        samples: finite.len(),
        rms,
        band: 1.96 / n.sqrt(),
        portmanteau: Portmanteau {
            statistic,
            lags,
            probability: tail(statistic, lags),
        },
        autocorrelation,
        cross_correlation,
        spectrum: spectrum(histories, &centred),
        distribution: Distribution {
            skewness: moment(3) / deviation.powi(3),
            excess_kurtosis: moment(4) / deviation.powi(4) - 3.0,
            largest: finite.iter().map(|e| (e - mean).abs()).fold(0.0, f64::max) / deviation,
        },
        outliers: outliers(histories, output, &finite),
        localisation: localisation(histories, output, rms),
    }
}

/// Σ a_(k+lag) b_k over the samples that both have.
fn lagged(a: &[f64], b: &[f64], lag: usize) -> f64 {
    stop::check();
    a.iter()
        .skip(lag)
        .zip(b)
        .map(|(a, b)| a * b)
        .filter(|v| v.is_finite())
        .sum()
}

fn cross_correlation(
    residual: &[Vec<f64>],
    inputs: &[&Series],
    own: &[f64],
    lags: usize,
) -> CrossCorrelation {
    let n = inputs.iter().map(|s| s.values.len()).sum::<usize>().max(1) as f64;
    let mean = inputs.iter().flat_map(|s| &s.values).sum::<f64>() / n;
    let centred: Vec<Vec<f64>> = inputs
        .iter()
        .map(|s| s.values.iter().map(|u| u - mean).collect())
        .collect();
    let power = |series: &[Vec<f64>]| -> f64 {
        series
            .iter()
            .flatten()
            .filter(|v| v.is_finite())
            .map(|v| v * v)
            .sum::<f64>()
            .max(f64::MIN_POSITIVE)
    };
    let scale = (power(residual) * power(&centred)).sqrt();
    let sum = |a: &[Vec<f64>], b: &[Vec<f64>], lag: usize| -> f64 {
        a.iter().zip(b).map(|(a, b)| lagged(a, b, lag)).sum::<f64>() / scale
    };
    let before = (1..=lags).rev().map(|lag| sum(&centred, residual, lag));
    let behind = (0..=lags).map(|lag| sum(residual, &centred, lag));
    // Bartlett: the variance of a cross-correlation of independent series is Σ ρ_e ρ_u over N
    let of_input =
        |lag: usize| centred.iter().map(|u| lagged(u, u, lag)).sum::<f64>() / power(&centred);
    let variance = 1.0 + 2.0 * (1..=lags).map(|lag| own[lag] * of_input(lag)).sum::<f64>();
    CrossCorrelation {
        input: inputs.first().map_or(String::new(), |s| s.name.clone()),
        values: before.chain(behind).collect(),
        lags,
        band: 1.96 * (variance.max(1.0) / n).sqrt(),
    }
}

/// Welch's averaged periodograms, and the coherence with the inputs.
fn spectrum(histories: &[TimeHistory], residual: &[Vec<f64>]) -> Vec<SpectralLine> {
    let shortest = residual.iter().map(Vec::len).min().unwrap_or(0);
    let window = SPECTRUM_WINDOW.min(shortest / 2);
    let gappy = residual.iter().flatten().any(|e| !e.is_finite());
    let step = histories
        .first()
        .and_then(|h| Some((h.time.last()? - h.time.first()?) / (h.time.len() - 1) as f64));
    let (Some(step), true, false) = (step, window >= 8, gappy) else {
        return Vec::new();
    };
    let inputs = histories[0].inputs.len();
    let lines = window / 2;
    let mut own = vec![0.0; lines];
    let mut of_input = vec![vec![0.0; lines]; inputs];
    let mut cross = vec![vec![num_complex::Complex64::new(0.0, 0.0); lines]; inputs];
    let hann: Vec<f64> = (0..window)
        .map(|k| {
            (std::f64::consts::PI * k as f64 / window as f64)
                .sin()
                .powi(2)
        })
        .collect();
    let energy: f64 = hann.iter().map(|w| w * w).sum();
    let mut planner = rustfft::FftPlanner::new();
    let plan = planner.plan_fft_forward(window);
    let transformed = |values: &[f64]| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let mut buffer: Vec<num_complex::Complex64> = values
            .iter()
            .zip(&hann)
            .map(|(v, w)| num_complex::Complex64::new((v - mean) * w, 0.0))
            .collect();
        plan.process(&mut buffer);
        buffer
    };
    let mut windows = 0.0;
    for (history, residual) in histories.iter().zip(residual) {
        let mut from = 0;
        while from + window <= residual.len() {
            stop::check();
            let e = transformed(&residual[from..from + window]);
            windows += 1.0;
            (own.iter_mut().zip(&e)).for_each(|(sum, e)| *sum += e.norm_sqr());
            for (i, input) in history.inputs.iter().enumerate() {
                let u = transformed(&input.values[from..from + window]);
                for line in 0..lines {
                    of_input[i][line] += u[line].norm_sqr();
                    cross[i][line] += e[line] * u[line].conj();
                }
            }
            from += window / 2;
        }
    }
    let coherence = |line: usize| {
        // of fewer windows than a few it is 1 by construction
        if windows < 4.0 {
            return 0.0;
        }
        let of = |i: usize| {
            let whole = own[line] * of_input[i][line];
            if whole > 0.0 {
                cross[i][line].norm_sqr() / whole
            } else {
                0.0
            }
        };
        (0..inputs).map(of).fold(0.0, f64::max)
    };
    (1..lines)
        .map(|line| SpectralLine {
            frequency: line as f64 / (window as f64 * step),
            density: 2.0 * own[line] * step / (energy * windows),
            coherence: coherence(line),
        })
        .collect()
}

fn outliers(histories: &[TimeHistory], output: usize, finite: &[f64]) -> Vec<Outlier> {
    let median = |values: &mut Vec<f64>| {
        stop::check();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied().unwrap_or(0.0)
    };
    let middle = median(&mut finite.to_vec());
    let scale = 1.4826 * median(&mut finite.iter().map(|e| (e - middle).abs()).collect());
    if scale <= 0.0 {
        return Vec::new();
    }
    let mut found = Vec::new();
    for history in histories {
        for (time, e) in history.time.iter().zip(&history.outputs[output].residual) {
            let deviation = (e - middle) / scale;
            if deviation.abs() > OUTLYING && found.len() < MOST_OUTLIERS {
                found.push(Outlier {
                    segment: history.segment.clone(),
                    time: *time,
                    deviation,
                });
            }
        }
    }
    found
}

fn localisation(histories: &[TimeHistory], output: usize, rms: f64) -> Vec<Window> {
    let mut windows = Vec::new();
    for history in histories {
        let residual = &history.outputs[output].residual;
        let length = residual.len().div_ceil(WINDOWS).max(1);
        for (part, times) in residual.chunks(length).zip(history.time.chunks(length)) {
            let finite = part.iter().filter(|e| e.is_finite());
            let square = finite.clone().map(|e| e * e).sum::<f64>() / finite.count().max(1) as f64;
            windows.push(Window {
                segment: history.segment.clone(),
                from: times[0],
                to: times[times.len() - 1],
                rms: square.sqrt(),
                ratio: if rms > 0.0 { square.sqrt() / rms } else { 0.0 },
            });
        }
    }
    windows
}
