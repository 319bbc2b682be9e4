//! Groups become a recording: every channel with its own samples, at the times of its group.

use indexmap::IndexMap;

use super::super::axis::{TimeAxis, code_of};
use super::super::fault::{CELLS_LISTED, of_file};
use super::super::mapping::Mapping;
use super::super::note;
use super::super::reading::Reading;
use super::super::text::quoted;
use super::super::union::Union;
use super::super::{IngestError, Limits, Origin, code};
use super::archive::{self, Source, even};
use super::group::{Group, Groups, Samples, Time};
use super::plan::Plan;
use crate::flight::{Fault, Finding, FindingCode, Maneuver, Unit};

/// Reads all channels; or those that a mapping names, as it says.
///
/// # Errors
/// There are more than the limits allow; a group's times do not increase; the mapping names what is not there.
pub(in super::super) fn read<S: Samples>(
    mut groups: Groups<S>,
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    if let Some(mapping) = mapping {
        let mut source = Source::of(groups, limits);
        let mut reading = mapping.apply(&mut source, limits)?;
        reading.findings.extend(cut_off(source.groups()));
        return Ok(reading);
    }
    let timed = groups
        .groups
        .iter()
        .filter(|group| group.time != Time::Unknown);
    let columns: usize = timed.map(|group| group.channels.len()).sum();
    limits.columns(columns + 1).map_or(Ok(()), Err)?;
    let plan = Plan::of(&groups.groups, limits);
    check(&groups, &plan, limits)?;
    let mut findings = plan.findings(&groups.left_out);
    let maneuver = maneuver(&mut groups, plan, limits)?;
    findings.extend(cut_off(&groups.groups));
    Ok(Reading {
        maneuver,
        findings,
        origin: Some(Origin::OWN),
    })
}

/// That groups have fewer samples than the file says.
fn cut_off(groups: &[Group]) -> Option<Finding> {
    let told = groups.iter().filter(|group| group.rows < group.said);
    let told: Vec<String> = told
        .map(|group| {
            let name = quoted(&group.name);
            format!("{name} has {} of {} samples", group.rows, group.said)
        })
        .collect();
    let message = format!(
        "the file is cut off: {}",
        note::listed(told.iter().cloned())
    );
    let remedy = "copy the file again, if it was whole where it was recorded";
    (!told.is_empty()).then(|| note::note(FindingCode::CutOff, message, remedy))
}

/// # Errors
/// There is more than the limits allow, or nothing that can be read.
fn check<S>(groups: &Groups<S>, plan: &Plan, limits: &Limits) -> Result<(), IngestError> {
    let rows = |group: usize| groups.groups[group].rows;
    let values = plan.channels.iter().map(|channel| rows(channel.group));
    let longest = values.clone().max().unwrap_or(0);
    let too_much = [
        limits.samples(longest),
        limits.values(values.fold(0, usize::saturating_add)),
    ];
    IngestError::refuse(too_much.into_iter().flatten().collect())?;
    if !plan.channels.is_empty() {
        return Ok(());
    }
    let has_channels = groups.groups.iter().any(|group| !group.channels.is_empty());
    if has_channels
        && groups
            .groups
            .iter()
            .all(|group| group.time == Time::Unknown)
    {
        let message = format!(
            "the file says no times; say the step in a mapping, as {{\"time\": {{\"step\": 0.01, \"unit\": \"s\"}}, \"channels\": {{\"q\": {{\"from\": \"Group.Rate\", \"unit\": \"deg/s\"}}}}}}. It has {}",
            archive::contents(&groups.groups)
        );
        return Err(of_file(code::NO_TIME_COLUMN, message).into());
    }
    let left_out: Vec<String> = plan
        .findings(&groups.left_out)
        .into_iter()
        .map(|finding| finding.message)
        .collect();
    let message = format!(
        "the file has no channel that can be read besides time. {}",
        left_out.join("; ")
    );
    Err(of_file(code::NO_CHANNELS, message.trim()).into())
}

fn maneuver<S: Samples>(
    groups: &mut Groups<S>,
    plan: Plan,
    limits: &Limits,
) -> Result<Maneuver, IngestError> {
    let mut used: Vec<usize> = plan.channels.iter().map(|channel| channel.group).collect();
    used.dedup();
    let mut axes = Vec::with_capacity(used.len());
    for &at in &used {
        let axis = times(&groups.groups[at], &mut groups.samples)?;
        groups.groups[at].rows = axis.len();
        axes.push(axis);
    }
    let union = match axes.len() {
        1 => None,
        _ => {
            let union = Union::of(&axes, limits)?;
            let values = plan.channels.len().saturating_mul(union.time.len());
            limits.values(values).map_or(Ok(()), Err)?;
            Some(union)
        }
    };
    let mut channels = IndexMap::with_capacity(plan.channels.len());
    for channel in plan.channels {
        let mut values = groups.samples.values(channel.at)?;
        values.resize(groups.groups[channel.group].rows, f64::NAN);
        if let Some(union) = &union {
            let axis = used.binary_search(&channel.group).unwrap_or(0);
            values = union.spread(axis, &values);
        }
        channels.insert(channel.name, channel.unit.channel(values));
    }
    let time = match union {
        Some(union) => union.time,
        None => axes.pop().unwrap_or_default(),
    };
    Maneuver::new(time, channels)
        .map_err(|error| of_file(code_of(&error), error.to_string()).into())
}

/// The times of a group.
///
/// # Errors
/// They are damaged, or do not increase: the first of them.
fn times(group: &Group, samples: &mut impl Samples) -> Result<Vec<f64>, IngestError> {
    let recorded = match group.time {
        Time::Even { start, step } => even(group.rows, start, step),
        Time::Recorded(at) => samples.values(at)?,
        Time::Unknown => Vec::new(),
    };
    let seconds = Unit {
        scale: 1.0,
        offset: 0.0,
        dimension: crate::flight::Dimension::SECOND,
    };
    let mut axis = TimeAxis::new(seconds, group.rows);
    let mut faults = Vec::new();
    for time in recorded {
        if let Err(error) = axis.push(time) {
            let message = format!("group {}: {error}", quoted(&group.name));
            faults.push(Fault::new("", code_of(&error), message));
            if faults.len() == CELLS_LISTED {
                break;
            }
        }
    }
    IngestError::refuse(faults)?;
    Ok(axis.into_seconds())
}
