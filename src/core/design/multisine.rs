//! Orthogonal multisines with phases of low relative peak factor.
//!
//! ```text
//! u_j(t) = A_j/√M_j Σ_k sin(2π k t/T + φ_k),  k of the harmonics K_j;  RPF = (max u − min u)/(2 √2 rms u)
//! ```
//!
//! Harmonics of one period T are dealt out to the inputs in turn: any two inputs are then orthogonal over the period
//! whatever their phases (Morelli, IFAC SYSID 2003; Klein and Morelli, Aircraft System Identification, 2006, 9.3.4). Phases begin
//! at Schroeder's (IEEE Trans. Information Theory 16 (1970) 85) and others, and go to the least ℓ_2p norm of u, p = 2, 4, ..., by
//! Marquardt's steps (Guillaume, Schoukens, Pintelon, Kollár, IEEE Trans. IM 40 (1991) 982), where they go to a low peak.
//! All are shifted in time together until the sum begins at zero.

use std::f64::consts::{PI, SQRT_2, TAU};

use nalgebra::{Cholesky, DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Most harmonics of one input.
pub(super) const MOST_HARMONICS: usize = 60;
/// The highest harmonic.
pub(super) const HIGHEST: usize = 1_000;
/// Points over the period for each of the highest harmonic.
const POINTS: usize = 16;
/// p of the norms, one after the other.
const POWERS: [i32; 5] = [2, 4, 8, 16, 32];
/// Most starts besides Schroeder's phases, and steps for each power.
const STARTS: usize = 7;
const STEPS: usize = 40;
/// Of all starts: points times harmonics times harmonics and the simulations of a step.
const MOST_WORK: f64 = 2e9;

/// Harmonics of the period from the band, dealt out in turn.
///
/// # Errors
/// What is in the way, in words.
pub(super) fn harmonics(
    band: [f64; 2],
    period: f64,
    inputs: usize,
) -> Result<Vec<Vec<usize>>, String> {
    let [lowest, highest] = band;
    if !(lowest > 0.0 && lowest < highest && highest.is_finite()) {
        return Err("the lower frequency comes first, above 0".to_string());
    }
    let first = (lowest * period - 1e-9).ceil().max(1.0);
    let last = (highest * period + 1e-9).floor();
    if last > HIGHEST as f64 {
        return Err(format!(
            "a period of {period} s has more than {HIGHEST} harmonics up to {highest} Hz"
        ));
    }
    let all: Vec<usize> = (first as usize..=last as usize).collect();
    if all.len() < 2 * inputs {
        return Err(format!(
            "a period of {period} s has {} harmonics in the band; {inputs} inputs want two each, at least: widen the band or make the period longer",
            all.len()
        ));
    }
    if all.len() > MOST_HARMONICS * inputs {
        return Err(format!(
            "a period of {period} s has {} harmonics in the band, more than {MOST_HARMONICS} for each input: narrow the band or make the period shorter",
            all.len()
        ));
    }
    let of = |input: usize| all.iter().copied().skip(input).step_by(inputs).collect();
    Ok((0..inputs).map(of).collect())
}

/// Phases, rad, of sines of equal size whose sum begins at zero.
pub(super) fn phases(harmonics: &[usize], seed: u64) -> Vec<f64> {
    let wave = Wave::of(harmonics);
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut any = || -> Vec<f64> {
        let angle = |_: &usize| TAU * random.random::<f64>();
        harmonics.iter().map(angle).collect()
    };
    let allowed = wave.steps();
    let more = (allowed / (STEPS * POWERS.len())).min(STARTS);
    let steps = (allowed / (POWERS.len() * (more + 1))).clamp(2, STEPS);
    let starts = std::iter::once(schroeder(harmonics.len())).chain((0..more).map(|_| any()));
    let mut best = (f64::INFINITY, schroeder(harmonics.len()));
    for start in starts {
        let found = wave.flattened(start, steps);
        let factor = relative_peak_factor(&wave.sum(&found));
        if factor < best.0 {
            best = (factor, found);
        }
    }
    wave.begun_at_zero(best.1)
}

/// (max − min)/(2 √2 rms) about the mean: 1 of a sine.
pub(super) fn relative_peak_factor(samples: &[f64]) -> f64 {
    let n = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / n;
    let rms = (samples.iter().map(|u| (u - mean).powi(2)).sum::<f64>() / n).sqrt();
    let most = samples.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = samples.iter().copied().fold(f64::INFINITY, f64::min);
    (most - least) / (2.0 * SQRT_2 * rms)
}

fn schroeder(count: usize) -> Vec<f64> {
    let phase = |k: usize| -PI * (k * (k + 1)) as f64 / count as f64;
    (0..count).map(phase).collect()
}

/// Sines of equal size over one period, on a fine grid.
struct Wave<'h> {
    harmonics: &'h [usize],
    /// One turn of a sine, a whole number of quarters.
    sine: Vec<f64>,
}

impl<'h> Wave<'h> {
    fn of(harmonics: &'h [usize]) -> Self {
        let points = POINTS * harmonics.iter().copied().max().unwrap_or(1);
        let sine = |point: usize| (TAU * point as f64 / points as f64).sin();
        Self {
            harmonics,
            sine: (0..points).map(sine).collect(),
        }
    }

    fn points(&self) -> usize {
        self.sine.len()
    }

    /// Steps that take no longer than anybody waits.
    fn steps(&self) -> usize {
        let (points, count) = (self.points() as f64, self.harmonics.len() as f64);
        (MOST_WORK / (points * count * (count + 7.0))) as usize
    }

    /// Sine and cosine of a harmonic at a point.
    fn at(&self, harmonic: usize, point: usize) -> (f64, f64) {
        let points = self.points();
        let place = (harmonic * point) % points;
        (self.sine[place], self.sine[(place + points / 4) % points])
    }

    fn sum(&self, phases: &[f64]) -> Vec<f64> {
        let turned: Vec<(f64, f64)> = phases.iter().map(|phase| phase.sin_cos()).collect();
        let value = |point: usize| {
            let sines = self.harmonics.iter().zip(&turned);
            let sine = |(&k, (s, c)): (&usize, &(f64, f64))| {
                let (sine, cosine) = self.at(k, point);
                sine * c + cosine * s
            };
            sines.map(sine).sum()
        };
        (0..self.points()).map(value).collect()
    }

    /// From a start to a low ℓ_2p norm, p growing, by so many steps for each.
    fn flattened(&self, mut phases: Vec<f64>, steps: usize) -> Vec<f64> {
        for power in POWERS {
            self.descend(&mut phases, power, steps);
        }
        phases
    }

    /// Marquardt's steps for the residuals u^p, u over its peak.
    fn descend(&self, phases: &mut Vec<f64>, power: i32, steps: usize) {
        let mut damping = 1e-2;
        for _ in 0..steps {
            let (gram, gradient, norm) = self.equations(phases, power);
            let mut better = false;
            for _ in 0..6 {
                let damped = DMatrix::from_fn(gram.nrows(), gram.ncols(), |i, j| {
                    gram[(i, j)] * if i == j { 1.0 + damping } else { 1.0 }
                        + if i == j { 1e-12 } else { 0.0 }
                });
                let Some(step) = Cholesky::new(damped).map(|factor| factor.solve(&gradient)) else {
                    damping *= 10.0;
                    continue;
                };
                let moved: Vec<f64> = phases.iter().zip(step.iter()).map(|(p, d)| p - d).collect();
                if self.norm(&moved, power) < norm * (1.0 - 1e-9) {
                    *phases = moved;
                    damping = (damping / 5.0).max(1e-9);
                    better = true;
                    break;
                }
                damping *= 10.0;
            }
            if !better {
                return;
            }
        }
    }

    /// JᵀJ, Jᵀr and ‖u‖_2p of r = (u/peak)^p.
    fn equations(&self, phases: &[f64], power: i32) -> (DMatrix<f64>, DVector<f64>, f64) {
        let count = phases.len();
        let sum = self.sum(phases);
        let peak = sum.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
        let mut gram = DMatrix::zeros(count, count);
        let mut gradient = DVector::zeros(count);
        let mut row = DVector::zeros(count);
        let turned: Vec<(f64, f64)> = phases.iter().map(|phase| phase.sin_cos()).collect();
        for (point, u) in sum.iter().enumerate() {
            let share = u / peak;
            let below = share.powi(power - 1);
            // what is far below the peak has no part in it
            if below.abs() < 1e-9 {
                continue;
            }
            for (place, &k) in self.harmonics.iter().enumerate() {
                let ((sine, cosine), (s, c)) = (self.at(k, point), turned[place]);
                let slope = (cosine * c - sine * s) / peak;
                row[place] = f64::from(power) * below * slope;
            }
            gradient.axpy(below * share, &row, 1.0);
            gram.ger(1.0, &row, &row, 1.0);
        }
        let norm = norm(&sum, power);
        (gram, gradient, norm)
    }

    fn norm(&self, phases: &[f64], power: i32) -> f64 {
        norm(&self.sum(phases), power)
    }

    /// The same sum, begun where it goes through zero upwards.
    fn begun_at_zero(&self, phases: Vec<f64>) -> Vec<f64> {
        let value = |time: f64| -> f64 {
            let sines = self.harmonics.iter().zip(&phases);
            sines
                .map(|(&k, phase)| (TAU * k as f64 * time + phase).sin())
                .sum()
        };
        let sum = self.sum(&phases);
        let crossing = (1..sum.len()).find(|&k| sum[k - 1] < 0.0 && sum[k] >= 0.0);
        let Some(after) = crossing else {
            return phases;
        };
        let at = |point: usize| point as f64 / self.points() as f64;
        let (mut low, mut high) = (at(after - 1), at(after));
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            match value(middle) < 0.0 {
                true => low = middle,
                false => high = middle,
            }
        }
        let shifted = self.harmonics.iter().zip(&phases);
        shifted
            .map(|(&k, phase)| (phase + TAU * k as f64 * low).rem_euclid(TAU))
            .collect()
    }
}

/// ‖u‖_2p, each over the peak so that nothing leaves the range.
fn norm(sum: &[f64], power: i32) -> f64 {
    let peak = sum.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
    let mean: f64 = sum.iter().map(|u| (u / peak).powi(2 * power)).sum::<f64>() / sum.len() as f64;
    peak * mean.powf(0.5 / f64::from(power))
}
