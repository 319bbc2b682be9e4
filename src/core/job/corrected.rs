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

/// One recording for each segment that was fitted, with its label. A quantity has the name that the model's input or output
/// has of it, else its own.
///
/// # Errors
/// As [`trajectories_of`].
pub fn corrected(
    plan: &Plan,
    estimate: &Estimate,
    maneuvers: &[Arc<Maneuver>],
) -> Result<Vec<(String, Maneuver)>, NoTrajectory> {
    let document = &plan.problem.model.document;
    let quantities = Quantities::of(document);
    let trajectories = trajectories_of(plan, estimate)?;
    let of_segment = |(index, trajectory): (usize, &Trajectory)| {
        let mut channels = IndexMap::new();
        for (name, series) in motion(trajectory, &quantities) {
            let unit = Unit::parse(&series.unit).unwrap_or(Unit::NONE);
            let channel = Channel::from_recorded(&series.unit, unit, series.values.clone());
            channels.insert(name, channel);
        }
        channels.extend(wind(
            plan,
            estimate,
            &trajectory.segment,
            trajectory.time.len(),
        ));
        let recorded = plan.from.get(index).and_then(|&place| maneuvers.get(place));
        if let Some(recorded) = recorded {
            carry(recorded, trajectory, &mut channels);
        }
        let maneuver = Maneuver::new(trajectory.time.clone(), channels).ok()?;
        Some((trajectory.segment.clone(), maneuver))
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

/// Recorded channels of other names, at the samples that are rows of the recording.
fn carry(recorded: &Maneuver, trajectory: &Trajectory, channels: &mut IndexMap<String, Channel>) {
    let time = recorded.time();
    let row = |t: &f64| {
        let at = time.partition_point(|other| other < t);
        (time.get(at) == Some(t)).then_some(at)
    };
    let rows: Vec<Option<usize>> = trajectory.time.iter().map(row).collect();
    for (name, channel) in recorded.channels() {
        if channels.contains_key(name) {
            continue;
        }
        let value = |row: &Option<usize>| row.map_or(f64::NAN, |row| channel.values[row]);
        let values = rows.iter().map(value).collect();
        channels.insert(
            name.clone(),
            Channel {
                values,
                ..channel.clone()
            },
        );
    }
}
