//! A case: a declared model, what was flown, and how a fit of any edited model is made of them.

use indexmap::IndexMap;

use super::effect::Effect;
use super::flight::Flight;
use super::knowledge::Knowledge;
use crate::estimate::{Options, Problem, Role, Unknown, Unknowns, Validation};
use crate::flight::Dimension;
use crate::model::{ChannelFormula, Model, ModelDocument, Start};

/// Everything that a diagnosis is made from.
#[derive(Clone, Debug)]
pub struct Case {
    /// The declared model, as it would be estimated.
    pub document: ModelDocument,
    /// What was flown, of all roles.
    pub flights: Vec<Flight>,
    /// How every model of the diagnosis is estimated.
    pub options: Options,
    /// Candidates of the user's own, tried beside the catalogue's.
    pub candidates: Vec<Effect>,
    /// What is known before the data.
    pub knowledge: Knowledge,
    /// Recorded channels that formulas have made into inputs and outputs of the model: there for start values, and no
    /// inputs that the model lacks.
    pub consumed: Vec<String>,
}

/// Values of parameters, SI: by name, and by segment where each has its own.
pub(super) type Values = IndexMap<(String, Option<String>), f64>;

/// A state that is faster than this many samples an explicit integrator cannot follow.
const SHORTEST_LAG: f64 = 0.45;

/// Why a model cannot be fitted to the case.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[error("{0}")]
pub struct Unfit(pub String);

impl Case {
    /// The flights that play a role.
    pub fn of_role(&self, role: Role) -> impl Iterator<Item = &Flight> {
        self.flights
            .iter()
            .filter(move |flight| flight.role == role)
    }

    /// The estimation problem of a model that is an edit of the declared one. Parameters start at `values`, those
    /// that have none where the document says.
    ///
    /// # Errors
    /// The model cannot be compiled, or needs a channel that is not recorded.
    pub fn problem(&self, document: &ModelDocument, values: &Values) -> Result<Problem, Unfit> {
        let flights: Vec<&Flight> = self.of_role(Role::Estimation).collect();
        let model = compile(document)?;
        let segments = flights.iter().map(|flight| flight.segment(&model));
        let segments = segments.collect::<Result<_, _>>().map_err(Unfit)?;
        let mut unknowns = unknowns(&model, &flights, values)?;
        let step = flights
            .iter()
            .map(|flight| flight.step())
            .fold(0.0, f64::max);
        let is_lag = |unknown: &Unknown| {
            let info = &model.parameters[unknown.parameter];
            let is_added = !self.document.parameters.contains_key(&info.name);
            is_added && info.unit.dimension == Dimension::SECOND && unknown.lower > 0.0
        };
        unknowns.raise_lower(SHORTEST_LAG * step, is_lag);
        Ok(Problem::new(
            model,
            segments,
            unknowns,
            self.options.clone(),
        ))
    }

    /// Flights of a role, to be predicted with a model's estimate.
    ///
    /// # Errors
    /// As [`Self::problem`].
    pub fn held_out(&self, role: Role, problem: &Problem) -> Result<Vec<Validation>, Unfit> {
        let model = &problem.model;
        let validation = |flight: &Flight| {
            Ok(Validation {
                segment: flight.segment(model).map_err(Unfit)?,
                unknowns: unknowns(model, &[flight], &Values::new())?,
            })
        };
        self.of_role(role).map(validation).collect()
    }
}

pub(super) fn compile(document: &ModelDocument) -> Result<Model, Unfit> {
    Model::compile(document).map_err(|faults| {
        let faults: Vec<String> = faults.iter().map(ToString::to_string).collect();
        Unfit(faults.join("; "))
    })
}

fn unknowns(model: &Model, flights: &[&Flight], values: &Values) -> Result<Unknowns, Unfit> {
    let unknowns = Unknowns::new(model, flights.len(), |parameter, segment| {
        let info = &model.parameters[parameter];
        let of_segment = || values.get(&(info.name.clone(), Some(flights[segment].label.clone())));
        if let Some(value) = values.get(&(info.name.clone(), None)).or_else(of_segment) {
            return Ok(*value);
        }
        let own = flights[segment].own.get(&info.name);
        match own.unwrap_or(&info.document.start) {
            Start::Value(value) => Ok(info.unit.to_si(*value)),
            Start::FromData(text) => ChannelFormula::parse(text)
                .and_then(|formula| formula.number(flights[segment]))
                .map_err(|error| Unfit(format!("start of {}: {error}", info.name))),
        }
    })?;
    Ok(unknowns.held_elsewhere(model, |segment, label| flights[segment].label == label))
}

/// The values of all parameters at a θ, for another fit to start from.
pub(super) fn values(problem: &Problem, theta: &[f64]) -> Values {
    let mut places = theta.iter();
    let of = |unknown: &Unknown| {
        let name = problem.model.parameters[unknown.parameter].name.clone();
        let label = |segment: usize| problem.segments[segment].label.clone();
        let free = if unknown.fixed { None } else { places.next() };
        let value = free.copied().unwrap_or(unknown.start);
        ((name, unknown.segment.map(label)), value)
    };
    problem.unknowns.all.iter().map(of).collect()
}
