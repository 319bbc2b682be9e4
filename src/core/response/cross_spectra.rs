//! Cross spectra of some signals over windows of one length.

use num_complex::Complex64;

use crate::spectral::ChirpZ;

/// G_ab by frequency, then a, then b: power per Hz, of one side; the first index is that of the conjugate.
#[derive(Clone, Debug)]
pub(super) struct CrossSpectra {
    pub by_frequency: Vec<Vec<Complex64>>,
    /// Seconds of record over seconds of a window: how many windows there would be without overlap.
    pub independent: f64,
}

/// How windows are laid over a record.
#[derive(Clone, Copy)]
pub(super) struct Layout {
    /// Of the samples, s.
    pub step: f64,
    /// The lowest frequency and the distance of the others, Hz.
    pub first: f64,
    pub spacing: f64,
    pub count: usize,
}

impl CrossSpectra {
    /// Over Hann windows of `length` samples that overlap by half, in all stretches; a window in which a signal lacks a value does
    /// not count. `None` where no window does.
    pub(super) fn of(stretches: &[Vec<Vec<f64>>], length: usize, layout: Layout) -> Option<Self> {
        let signals = stretches.first()?.len();
        let transform = ChirpZ::new(
            length,
            layout.first * layout.step,
            layout.spacing * layout.step,
            layout.count,
        );
        let taper: Vec<f64> = (0..length)
            .map(|k| {
                let turn = std::f64::consts::TAU * (k as f64 + 0.5) / length as f64;
                0.5 - 0.5 * turn.cos()
            })
            .collect();
        let power: f64 = taper.iter().map(|w| w * w).sum();
        let mut sums = vec![vec![Complex64::ZERO; signals * signals]; layout.count];
        let (mut windows, mut covered) = (0, 0.0);
        let hop = (length / 2).max(1);
        for stretch in stretches {
            let samples = stretch[0].len();
            let mut first = 0;
            let before = windows;
            while first + length <= samples {
                let part: Vec<&[f64]> = stretch.iter().map(|s| &s[first..first + length]).collect();
                first += hop;
                if part.iter().any(|s| s.iter().any(|x| !x.is_finite())) {
                    continue;
                }
                let transforms: Vec<Vec<Complex64>> = (part.iter())
                    .map(|s| transform.of(&tapered(s, &taper)))
                    .collect();
                for (k, sums) in sums.iter_mut().enumerate() {
                    for a in 0..signals {
                        for b in 0..signals {
                            sums[a * signals + b] += transforms[a][k].conj() * transforms[b][k];
                        }
                    }
                }
                windows += 1;
            }
            // each window but the first of a stretch adds half of itself
            let own = windows - before;
            covered += if own > 0 { 0.5 * (own + 1) as f64 } else { 0.0 };
        }
        if windows == 0 {
            return None;
        }
        let scale = 2.0 * layout.step / (power * f64::from(windows));
        for sums in &mut sums {
            sums.iter_mut().for_each(|sum| *sum *= scale);
        }
        Some(Self {
            by_frequency: sums,
            independent: covered,
        })
    }
}

/// Less its mean under the taper, times it.
fn tapered(samples: &[f64], taper: &[f64]) -> Vec<f64> {
    let both = samples.iter().zip(taper);
    let mean = both.map(|(x, w)| x * w).sum::<f64>() / taper.iter().sum::<f64>();
    let both = samples.iter().zip(taper);
    both.map(|(x, w)| (x - mean) * w).collect()
}
