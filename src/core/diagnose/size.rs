//! How large an effect is: what was estimated of the parameters that it added.

use super::fitted::Fitted;
use crate::estimate::{Estimate, Problem};
use crate::flight::Unit;
use crate::model::{Added, AddedRole};

/// One parameter of an effect.
pub(super) struct Size {
    pub name: String,
    pub segment: Option<String>,
    pub role: AddedRole,
    /// As the document writes it.
    pub unit: String,
    scale: Unit,
    /// SI.
    pub value: f64,
    /// In the parameter's own unit.
    pub standard_error: Option<f64>,
}

impl Size {
    /// The value in the parameter's own unit.
    pub(super) fn own_units(&self) -> f64 {
        self.scale.from_si(self.value)
    }

    pub(super) fn standard_error_si(&self) -> Option<f64> {
        self.standard_error.map(|error| error * self.scale.scale)
    }
}

/// Of the free ones among the parameters added; `estimate` has the standard errors.
pub(super) fn sizes(
    problem: &Problem,
    theta: &[f64],
    estimate: &Estimate,
    added: &[Added],
) -> Vec<Size> {
    let role = |place: usize| {
        let name = &problem.parameter(place).name;
        let found = added.iter().find(|added| added.name == *name);
        Some((place, found?.role))
    };
    let size = |(place, role): (usize, AddedRole)| {
        let info = problem.parameter(place);
        let segment = problem.unknowns.at(place).segment;
        Size {
            name: info.name.clone(),
            segment: segment.map(|segment| problem.segments[segment].label.clone()),
            role,
            unit: info.document.unit.clone(),
            scale: info.unit,
            value: theta[place],
            standard_error: estimate.parameters[problem.unknowns.free[place]].standard_error,
        }
    };
    (0..theta.len()).filter_map(role).map(size).collect()
}

impl Fitted {
    pub(super) fn sizes(&self, added: &[Added]) -> Vec<Size> {
        sizes(&self.problem, &self.theta, &self.estimate, added)
    }
}
