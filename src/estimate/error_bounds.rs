//! What the data say of the estimate's accuracy: Cramér-Rao bounds, correlations, and what they cannot tell.

use nalgebra::DMatrix;

use super::information::Spectrum;
use super::report::{Bound, CollinearSet};

/// Accuracy at an estimate, by place of θ.
pub(super) struct ErrorBounds {
    /// Square root of the diagonal of F⁻¹; none where held at a bound or not determined.
    pub standard_errors: Vec<Option<f64>>,
    /// Empty when some unknowns cannot be told apart, or errors are out of the range of numbers.
    pub correlation: Vec<Vec<f64>>,
    /// Sets of places of which the data see only some combinations, with a direction in which nothing changes.
    collinear: Vec<Vec<(usize, f64)>>,
}

impl ErrorBounds {
    /// From the information matrix; places held at a bound count as known.
    pub fn new(information: &DMatrix<f64>, held: &[Option<Bound>]) -> Self {
        let unknowns = held.len();
        let moving: Vec<usize> = (0..unknowns).filter(|&i| held[i].is_none()).collect();
        let own = information.select_rows(&moving).select_columns(&moving);
        let mut bounds = Self {
            standard_errors: vec![None; unknowns],
            correlation: Vec::new(),
            collinear: Vec::new(),
        };
        let Some(spectrum) = Spectrum::of(&own, &own.diagonal()) else {
            return bounds;
        };
        let in_places = |set: Vec<(usize, f64)>| {
            set.into_iter()
                .map(|(i, component)| (moving[i], component))
                .collect()
        };
        bounds.collinear = spectrum.collinear().into_iter().map(in_places).collect();
        let covariance = spectrum.inverse();
        let error = |i: usize| covariance[(i, i)].sqrt();
        for (i, &place) in moving.iter().enumerate() {
            let undetermined = bounds
                .collinear
                .iter()
                .flatten()
                .any(|&(member, _)| member == place);
            bounds.standard_errors[place] =
                Some(error(i)).filter(|e| !undetermined && e.is_finite());
        }
        if bounds.collinear.is_empty() {
            bounds.correlation = vec![vec![0.0; unknowns]; unknowns];
            (0..unknowns).for_each(|i| bounds.correlation[i][i] = 1.0);
            for (a, &i) in moving.iter().enumerate() {
                for (b, &j) in moving.iter().enumerate().filter(|&(b, _)| b != a) {
                    bounds.correlation[i][j] = covariance[(a, b)] / (error(a) * error(b));
                }
            }
        }
        if bounds
            .correlation
            .iter()
            .flatten()
            .any(|value| !value.is_finite())
        {
            bounds.correlation.clear();
        }
        bounds
    }

    /// The collinear sets by name; `name` gives an unknown's name and the SI value of its unit.
    pub fn collinear(&self, name: impl Fn(usize) -> (String, f64)) -> Vec<CollinearSet> {
        let named = |members: &Vec<(usize, f64)>| {
            let own = |&(place, component): &(usize, f64)| {
                let (name, scale) = name(place);
                (name, component / scale)
            };
            let (parameters, mut direction): (Vec<String>, Vec<f64>) =
                members.iter().map(own).unzip();
            let largest = direction
                .iter()
                .fold(0.0, |a: f64, b| if b.abs() > a.abs() { *b } else { a });
            direction
                .iter_mut()
                .for_each(|component| *component /= largest);
            CollinearSet {
                parameters,
                direction,
            }
        };
        self.collinear.iter().map(named).collect()
    }
}
