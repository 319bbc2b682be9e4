//! A recording as an estimate has it: what the model says of the motion in place of what sensors recorded of it, and all else
//! as it was recorded.
//!
//! Of a flight path reconstruction these are the corrected air data, rates, accelerations, attitudes and the wind (Góes,
//! Hemerly, Maciel, figures 4 and 5), from which aerodynamics are estimated in a second step.

use std::sync::Arc;

use indexmap::IndexMap;

use super::plan::Plan;
use super::trajectories::{NoTrajectory, trajectories_of};
use crate::estimate::{Estimate, ParameterEstimate, QuantityKind, Trajectory, TrajectorySeries};
use crate::flight::{Channel, Maneuver, PhysicalQuantity, Unit};
use crate::model::Quantities;

/// A recording that an estimate has corrected.
#[derive(Clone, Debug)]
pub struct Corrected {
    /// The label of the segment.
    pub segment: String,
    /// The recording that it is a part of, by its place among the job's maneuvers.
    pub of: usize,
    /// As it is now.
    pub maneuver: Maneuver,
}

/// One recording for each segment that was fitted. A quantity has the name that the model's input or output
/// has of it, else its own.
///
/// # Errors
/// As [`trajectories_of`]; the model is no reconstruction: it has controls.
pub fn corrected(
    plan: &Plan,
    estimate: &Estimate,
    maneuvers: &[Arc<Maneuver>],
) -> Result<Vec<Corrected>, NoTrajectory> {
    let document = &plan.problem.model.document;
    let quantities = Quantities::of(document);
    let mut inputs = document.inputs.keys();
    let is_control = |name: &&String| {
        quantities
            .get(name)
            .is_some_and(PhysicalQuantity::is_control)
    };
    if let Some(control) = inputs.find(is_control) {
        return Err(NoTrajectory::NoReconstruction(control.clone()));
    }
    let trajectories = trajectories_of(plan, estimate)?;
    let of_segment = |(index, trajectory): (usize, &Trajectory)| {
        let of = *plan.from.get(index)?;
        let recorded = &maneuvers[of];
        let rows = Rows::of(recorded, trajectory);
        let mut channels = IndexMap::new();
        for (name, series) in motion(trajectory, &quantities) {
            let unit = Unit::parse(&series.unit).unwrap_or(Unit::NONE);
            let channel =
                Channel::from_recorded(&series.unit, unit, rows.of_samples(&series.values));
            channels.insert(name, channel);
        }
        channels.extend(wind(plan, estimate, &trajectory.segment, rows.0.len()));
        for (name, channel) in recorded.channels() {
            let values = rows.of_recording(&channel.values);
            let as_recorded = || Channel {
                values,
                ..channel.clone()
            };
            channels.entry(name.clone()).or_insert_with(as_recorded);
        }
        let maneuver = Maneuver::new(rows.of_samples(&trajectory.time), channels).ok()?;
        Some(Corrected {
            segment: trajectory.segment.clone(),
            of,
            maneuver,
        })
    };
    Ok(trajectories
        .iter()
        .enumerate()
        .filter_map(of_segment)
        .collect())
}

/// What the model says of the motion, definitions before states, each quantity once.
fn motion<'t>(
    trajectory: &'t Trajectory,
    quantities: &Quantities,
) -> Vec<(String, &'t TrajectorySeries)> {
    let mut all: Vec<_> = (trajectory.quantities.iter())
        .filter(|series| series.kind != QuantityKind::Output)
        .filter_map(|series| {
            let quantity = quantities.get(&series.name).filter(|q| q.is_motion())?;
            Some((quantity, series))
        })
        .collect();
    all.sort_by_key(|(_, series)| series.kind == QuantityKind::State);
    let mut seen: Vec<PhysicalQuantity> = Vec::new();
    all.retain(|(quantity, _)| {
        let is_new = !seen.contains(quantity);
        seen.push(*quantity);
        is_new
    });
    let named = |(quantity, series): (PhysicalQuantity, &'t TrajectorySeries)| {
        let output = quantities
            .outputs_of(quantity)
            .next()
            .map(ToString::to_string);
        let input = || {
            let mut names = quantities.all_of(quantity);
            names
                .find(|name| *name != series.name)
                .map(ToString::to_string)
        };
        let name = output.or_else(input).unwrap_or_else(|| series.name.clone());
        (name, series)
    };
    all.into_iter().map(named).collect()
}

/// Constant wind, where the model has it as a parameter.
fn wind(plan: &Plan, estimate: &Estimate, segment: &str, samples: usize) -> Vec<(String, Channel)> {
    use PhysicalQuantity::{WindX, WindY, WindZ};
    let parameters = &plan.problem.model.document.parameters;
    let of = |row: &ParameterEstimate| {
        let quantity = parameters.get(&row.name)?.quantity?;
        let own = row.segment.as_deref().is_none_or(|own| own == segment);
        let unit = Unit::parse(&row.unit).ok()?;
        let is_wind = own && matches!(quantity, WindX | WindY | WindZ);
        let values = vec![row.estimate; samples];
        is_wind.then(|| {
            (
                row.name.clone(),
                Channel::from_recorded(&row.unit, unit, values),
            )
        })
    };
    estimate.parameters.iter().filter_map(of).collect()
}

/// The samples of a segment that are rows of the recording, as numbers of both: those that were put into gaps are not.
struct Rows(Vec<(usize, usize)>);

impl Rows {
    fn of(recorded: &Maneuver, trajectory: &Trajectory) -> Self {
        let time = recorded.time();
        let row = |(sample, t): (usize, &f64)| {
            let at = time.partition_point(|other| other < t);
            (time.get(at) == Some(t)).then_some((sample, at))
        };
        Self(trajectory.time.iter().enumerate().filter_map(row).collect())
    }

    fn of_samples(&self, values: &[f64]) -> Vec<f64> {
        self.0.iter().map(|&(sample, _)| values[sample]).collect()
    }

    fn of_recording(&self, values: &[f64]) -> Vec<f64> {
        self.0.iter().map(|&(_, row)| values[row]).collect()
    }
}
