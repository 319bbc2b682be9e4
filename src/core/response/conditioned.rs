//! Responses of one output to all inputs, from the cross spectra at one frequency.

use num_complex::Complex64;

use crate::spectral::invert;

/// Of windows that overlap by half: how much of the error of as many independent ones is left, squared.
const OVERLAP: f64 = 0.55;

/// An input of whose power the others leave less than this share is a sum of them.
const DEPENDENT: f64 = 1e-9;

/// The response to one input.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Point {
    pub response: Complex64,
    /// Partial coherence.
    pub coherence: f64,
    /// Of all inputs with the output.
    pub multiple: f64,
    /// Relative.
    pub error: f64,
}

/// By input. `spectra` are those of all signals, inputs first; `None` where an input has no power, or is a sum of others.
pub(super) fn responses(
    spectra: &[Complex64],
    signals: usize,
    inputs: usize,
    output: usize,
    independent: f64,
) -> Option<Vec<Point>> {
    let at = |a: usize, b: usize| spectra[a * signals + b];
    let mut inverse: Vec<Complex64> = (0..inputs * inputs)
        .map(|entry| at(entry / inputs, entry % inputs))
        .collect();
    invert(&mut inverse, inputs)?;
    let of_output = at(output, output).re;
    let by_input: Vec<Complex64> = (0..inputs)
        .map(|i| {
            (0..inputs)
                .map(|j| inverse[i * inputs + j] * at(j, output))
                .sum()
        })
        .collect();
    let explained: Complex64 = (0..inputs).map(|i| at(output, i) * by_input[i]).sum();
    let left = (of_output - explained.re).max(0.0);
    let multiple = 1.0 - left / of_output;
    // each further input takes one window
    let windows = (independent - (inputs - 1) as f64).max(0.5);
    let point = |i: usize| {
        // what of the input the others do not explain, times what of the output it does
        let own = inverse[i * inputs + i].re.recip();
        let part = by_input[i].norm_sqr() * own;
        let coherence = part / (part + left);
        Point {
            response: by_input[i],
            coherence,
            multiple,
            error: (OVERLAP * (1.0 - coherence) / (coherence * 2.0 * windows)).sqrt(),
        }
    };
    let is_own = |i: usize| inverse[i * inputs + i].re.recip() > DEPENDENT * at(i, i).re;
    if !(0..inputs).all(is_own) {
        return None;
    }
    let points: Vec<Point> = (0..inputs).map(point).collect();
    let finite = |point: &Point| point.response.is_finite() && point.coherence.is_finite();
    points.iter().all(finite).then_some(points)
}
