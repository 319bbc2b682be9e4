//! The parameter table: every unknown in its own unit, with what is known of its accuracy.

use nalgebra::DMatrix;

use crate::estimate::accuracy::error_bounds::ErrorBounds;
use crate::estimate::accuracy::prior_shares::shares;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unknowns::{Unknown, Unknowns};
use crate::estimate::report::parameter::{Bound, ParameterEstimate};

/// The accuracy of each unknown, SI, by place of θ.
pub(crate) struct Accuracy {
    standard_errors: Vec<Option<f64>>,
    conventional: Vec<Option<f64>>,
    prior_shares: Vec<Option<f64>>,
    at_bound: Vec<Option<Bound>>,
}

impl Accuracy {
    pub(crate) fn new(
        unknowns: &Unknowns,
        information: &DMatrix<f64>,
        at_bound: &[Option<Bound>],
        bounds: &ErrorBounds,
    ) -> Self {
        let shares = shares(unknowns, information, at_bound);
        let of_known =
            |(share, error): (Option<f64>, &Option<f64>)| share.filter(|_| error.is_some());
        Self {
            prior_shares: (shares.into_iter().zip(&bounds.standard_errors))
                .map(of_known)
                .collect(),
            standard_errors: bounds.standard_errors.clone(),
            conventional: bounds.conventional.clone(),
            at_bound: at_bound.to_vec(),
        }
    }

    /// The accuracy of the unknowns of another problem: `place` says which of these each of them is.
    pub(crate) fn seen_from(
        &self,
        unknowns: usize,
        place: impl Fn(usize) -> Option<usize>,
    ) -> Self {
        fn picked<T: Copy>(all: &[Option<T>], places: &[Option<usize>]) -> Vec<Option<T>> {
            places.iter().map(|place| all[(*place)?]).collect()
        }
        let places: Vec<Option<usize>> = (0..unknowns).map(place).collect();
        Self {
            standard_errors: picked(&self.standard_errors, &places),
            conventional: picked(&self.conventional, &places),
            prior_shares: picked(&self.prior_shares, &places),
            at_bound: picked(&self.at_bound, &places),
        }
    }
}

/// All parameters, fixed ones too, in the order of the document.
pub(crate) fn table(
    problem: &Problem,
    theta: &[f64],
    accuracy: &Accuracy,
) -> Vec<ParameterEstimate> {
    let unknowns = &problem.unknowns;
    let row = |(index, unknown): (usize, &Unknown)| {
        let info = &problem.model.parameters[unknown.parameter];
        let place = unknowns.free.iter().position(|&i| i == index);
        let in_own_unit = |errors: &[Option<f64>]| {
            let error = place.and_then(|place| errors[place]);
            error.map(|error| error / info.unit.scale)
        };
        ParameterEstimate {
            name: info.name.clone(),
            unit: info.document.unit.clone(),
            segment: unknown
                .segment
                .map(|segment| problem.segments[segment].label.clone()),
            start: info.unit.from_si(unknown.start),
            estimate: info
                .unit
                .from_si(place.map_or(unknown.start, |place| theta[place])),
            standard_error: in_own_unit(&accuracy.standard_errors),
            conventional_standard_error: in_own_unit(&accuracy.conventional),
            prior_share: place.and_then(|place| accuracy.prior_shares[place]),
            fixed: unknown.fixed,
            at_bound: place.and_then(|place| accuracy.at_bound[place]),
            provisional: false,
        }
    };
    unknowns.all.iter().enumerate().map(row).collect()
}
