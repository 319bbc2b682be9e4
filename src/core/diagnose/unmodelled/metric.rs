//! The metric in which forces are estimated: residuals whitened by a colour, everything that is free projected out.
//!
//! With W the whitening, e the residual, A the sensitivities of what is free and S the responses to a force's shapes,
//!
//! ```text
//! G = (W S)ᵀ (I − P) W S,   b = (W S)ᵀ (I − P) W e,   P the projection onto W A
//! ```
//!
//! are all that the data say of the force's sizes c: e − S c fits as |e⊥|² − 2 bᵀc + cᵀG c.

use std::borrow::Cow;

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::flown::Samples;
use super::normal::Normal;
use super::responses::Response;
use super::smoothness::Posterior;
use crate::diagnose::colour::Colour;
use crate::diagnose::projection::products;
use crate::stop;

/// Directions of what is free that are weaker than this, relative to the strongest, are rounding.
const WEAKEST: f64 = 1e-10;

/// Pairs of draws: the colour is an average over all directions that are uncertain.
const PAIRS: usize = 3;

/// Flights in the metric of a colour.
pub(super) struct Metric<'f> {
    from: Cow<'f, Samples>,
    pub colour: Colour,
    /// ln|W| - ½ ln|(W A)ᵀ W A|, less the price of the colour's orders.
    pub ln_whitening: f64,
    /// W e
    residual: DVector<f64>,
    /// Orthonormal columns that span W A.
    span: DMatrix<f64>,
    /// From shares of those to θ.
    to_theta: DMatrix<f64>,
    /// spanᵀ W e
    shares: DVector<f64>,
    /// |e⊥|²
    pub clear: f64,
    /// Samples that there are, less what is free.
    pub samples: f64,
}

impl<'f> Metric<'f> {
    /// `None` where something is not a number.
    pub(super) fn new(from: Cow<'f, Samples>, colour: Colour) -> Option<Self> {
        let (layout, residual) = (&from.layout, &from.residual);
        let whitened = DVector::from_vec(colour.whiten(layout, residual, residual));
        let ln_whitening = colour.ln_likelihood(layout, residual) + 0.5 * whitened.norm_squared()
            - colour.price(layout, residual);
        let mut declared = DMatrix::zeros(layout.len, from.declared.ncols());
        let mut scale = vec![1.0; from.declared.ncols()];
        for (column, scale) in scale.iter_mut().enumerate() {
            let sensitivity = from.declared.column(column);
            let white = colour.whiten(layout, residual, sensitivity.as_slice());
            let white = DVector::from_vec(white);
            let length = white.norm();
            *scale = if length > 0.0 { length } else { 1.0 };
            declared.set_column(column, &(white / *scale));
        }
        let (span, to_theta, ln_determinant) = orthonormal(&declared, &scale)?;
        let ln_whitening = ln_whitening - 0.5 * ln_determinant;
        let measured = residual.iter().filter(|e| e.is_finite()).count();
        let shares = span.tr_mul(&whitened);
        Some(Self {
            clear: (whitened.norm_squared() - shares.norm_squared()).max(f64::MIN_POSITIVE),
            samples: measured.saturating_sub(span.ncols()).max(1) as f64,
            ln_whitening,
            residual: whitened,
            span,
            to_theta,
            shares,
            colour,
            from,
        })
    }

    /// ln L of the residual as noise alone, θ integrated out and the scale at its best.
    pub(super) fn ln_evidence(&self) -> f64 {
        self.ln_whitening - 0.5 * self.samples * ((self.clear / self.samples).ln() + 1.0)
    }

    /// What the flights say of a force with these responses.
    pub(super) fn normal(&self, responses: &[&Response]) -> Normal {
        let count: usize = responses.iter().map(|r| r.columns.ncols()).sum();
        let mut gram = DMatrix::zeros(count, count);
        let mut moment = DVector::zeros(count);
        let mut imitated = DMatrix::zeros(count, self.span.ncols());
        let mut first = 0;
        for response in responses {
            stop::check();
            let white = self.whiten(response);
            let (rows, columns) = (response.rows.clone(), white.ncols());
            let span = self.span.rows(rows.start, rows.len());
            // a product of matrices is far quicker than products of columns
            let turned = white.transpose();
            gram.view_mut((first, first), (columns, columns))
                .copy_from(&(&turned * &white));
            moment
                .rows_mut(first, columns)
                .copy_from(&(&turned * self.residual.rows(rows.start, rows.len())));
            imitated
                .rows_mut(first, columns)
                .copy_from(&(&turned * span));
            first += columns;
        }
        gram -= &imitated * imitated.transpose();
        moment -= &imitated * &self.shares;
        Normal {
            gram,
            moment,
            imitated,
        }
    }

    /// W S of a segment.
    fn whiten(&self, response: &Response) -> DMatrix<f64> {
        let mut white = DMatrix::zeros(response.rows.len(), response.columns.ncols());
        let rows = &response.rows;
        let inside = self.from.layout.series.iter();
        for series in inside.filter(|s| rows.start <= s.range.start && s.range.end <= rows.end) {
            let mask = &self.from.residual[series.range.clone()];
            let within = series.range.start - rows.start..series.range.end - rows.start;
            for column in 0..white.ncols() {
                let from = response.columns.column(column);
                let mut to = white.column_mut(column);
                self.colour.0[series.output].whiten(
                    mask,
                    &from.as_slice()[within.clone()],
                    &mut to.as_mut_slice()[within.clone()],
                );
            }
        }
        white
    }

    /// The residual as it was given.
    pub(super) fn residual(&self) -> DVector<f64> {
        DVector::from_column_slice(&self.from.residual)
    }

    /// |(I - P) W x|² of a column.
    pub(super) fn length(&self, column: &[f64]) -> f64 {
        let (layout, residual) = (&self.from.layout, &self.from.residual);
        let white = DVector::from_vec(self.colour.whiten(layout, residual, column));
        let shares = self.span.tr_mul(&white);
        white.norm_squared() - shares.norm_squared()
    }

    /// By how much θ moves where there is no force.
    pub(super) fn moved_alone(&self) -> DVector<f64> {
        &self.to_theta * &self.shares
    }

    /// By how much θ moves beside a force with these sizes.
    pub(super) fn moved(&self, normal: &Normal, sizes: &DVector<f64>) -> DVector<f64> {
        &self.to_theta * (&self.shares - normal.imitated.tr_mul(sizes))
    }

    /// The noise as it may be beside a force with these sizes: the residual that is left, and about it draws of what is
    /// uncertain, θ by `noise` and the sizes by `uncertain`, in pairs that lie opposite each other.
    pub(super) fn draws(
        &self,
        noise: f64,
        force: Option<(&Normal, &[&Response], &Posterior)>,
        chance: &mut ChaCha8Rng,
    ) -> Vec<Vec<f64>> {
        let none = DVector::zeros(0);
        let middle = match force {
            None => self.less(&self.moved_alone(), &[], &none),
            Some((normal, responses, posterior)) => {
                let theta = self.moved(normal, &posterior.sizes);
                self.less(&theta, responses, &posterior.sizes)
            }
        };
        let mut draws = Vec::new();
        for _ in 0..PAIRS {
            stop::check();
            let mut theta = normal_vector(self.span.ncols(), chance) * noise;
            let (responses, sizes) = match force {
                None => (&[][..], none.clone()),
                Some((normal, responses, posterior)) => {
                    let sizes = posterior.draw(normal_vector(posterior.sizes.len(), chance));
                    theta -= normal.imitated.tr_mul(&sizes);
                    (responses, sizes)
                }
            };
            let off = self.response(&(&self.to_theta * theta), responses, &sizes);
            let both = |sign: f64| middle.iter().zip(&off).map(|(e, d)| e + sign * d).collect();
            draws.extend([both(1.0), both(-1.0)]);
        }
        draws
    }

    fn less(
        &self,
        theta: &DVector<f64>,
        responses: &[&Response],
        sizes: &DVector<f64>,
    ) -> Vec<f64> {
        let response = self.response(theta, responses, sizes);
        let residual = self.from.residual.iter();
        residual.zip(&response).map(|(e, y)| e - y).collect()
    }

    /// By how much the outputs move with θ and a force.
    fn response(
        &self,
        theta: &DVector<f64>,
        responses: &[&Response],
        sizes: &DVector<f64>,
    ) -> Vec<f64> {
        let mut outputs = &self.from.declared * theta;
        let mut first = 0;
        for response in responses {
            let count = response.columns.ncols();
            let mut rows = outputs.rows_mut(response.rows.start, response.rows.len());
            rows += &response.columns * sizes.rows(first, count);
            first += count;
        }
        outputs.as_slice().to_vec()
    }
}

fn normal_vector(count: usize, chance: &mut ChaCha8Rng) -> DVector<f64> {
    DVector::from_fn(count, |_, _| StandardNormal.sample(chance))
}

/// An orthonormal basis Q of columns A = C diag(scale), C of length 1; T with Q = A T; and ln|AᵀA|.
fn orthonormal(columns: &DMatrix<f64>, scale: &[f64]) -> Option<(DMatrix<f64>, DMatrix<f64>, f64)> {
    let gram = products(columns, columns);
    if !gram.iter().all(|value| value.is_finite()) {
        return None;
    }
    if gram.is_empty() {
        return Some((
            DMatrix::zeros(columns.nrows(), 0),
            DMatrix::zeros(0, 0),
            0.0,
        ));
    }
    let eigen = SymmetricEigen::try_new(gram, f64::EPSILON, 10_000)?;
    let least = WEAKEST * eigen.eigenvalues.max();
    let kept: Vec<usize> = (0..scale.len())
        .filter(|&i| eigen.eigenvalues[i] > least)
        .collect();
    let mut basis = DMatrix::from_fn(scale.len(), kept.len(), |row, i| {
        eigen.eigenvectors[(row, kept[i])] / eigen.eigenvalues[kept[i]].sqrt()
    });
    stop::check();
    let span = columns * &basis;
    stop::check();
    for (mut row, scale) in basis.row_iter_mut().zip(scale) {
        row /= *scale;
    }
    let scales: f64 = scale.iter().map(|scale| scale.ln()).sum();
    let eigenvalues = eigen.eigenvalues.iter();
    let ln_determinant = eigenvalues.map(|value| value.max(least).ln()).sum::<f64>() + 2.0 * scales;
    Some((span, basis, ln_determinant))
}
