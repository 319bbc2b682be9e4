//! Samples that are no measurements: spikes, dropouts and stuck values, found before anything else, since least squares
//! follow them.

use super::accepted::Accepted;
use super::case::Case;
use super::effect::{Effect, Treatment};
use super::fitted::Fitted;
use super::report::Evidence;
use super::spikes::spikes;
use super::stack::Layout;
use crate::estimate::Role;

/// More than this share is no matter of single samples.
const MOST: f64 = 0.1;
const LEAST: usize = 2;

/// λ² that a sample must have to be taken out.
const LEAST_EVIDENCE: f64 = 16.0;

/// The case without such samples (they have no value any more), and the effects; `None` where there are none.
pub(super) fn clean(case: &Case, declared: &Fitted) -> Option<(Case, Vec<Accepted>)> {
    let layout = Layout::of(&declared.problem);
    let mut cleaned = case.clone();
    let mut found = Vec::new();
    for (index, output) in declared.problem.model.outputs.iter().enumerate() {
        let mut count = 0;
        let mut evidence = 0.0;
        let mut flights = cleaned
            .flights
            .iter_mut()
            .filter(|f| f.role == Role::Estimation);
        for series in layout.series.iter().filter(|series| series.output == index) {
            let flight = flights.next()?;
            let residual = &declared.residual[series.range.clone()];
            let (measured, _) = flight.channels.get_mut(&output.name)?;
            for spike in spikes(residual, measured) {
                measured[spike.at] = f64::NAN;
                count += 1;
                evidence += spike.deviations * spike.deviations;
            }
        }
        let samples: usize = layout
            .of_output(&declared.residual, index)
            .iter()
            .map(|s| s.len())
            .sum();
        if count < LEAST || count as f64 > MOST * samples as f64 {
            restore(&mut cleaned, case, &output.name);
            continue;
        }
        found.push((
            Effect::treatment(Treatment::SensorOutliers, &output.name),
            count,
            evidence,
        ));
    }
    if found.is_empty() {
        return None;
    }
    // the flights that are predicted have such samples too: what their own neighbourhood tells is left out
    for flight in cleaned
        .flights
        .iter_mut()
        .filter(|flight| flight.role != Role::Estimation)
    {
        for (effect, ..) in &found {
            if let Some((measured, _)) = flight.channels.get_mut(&effect.target) {
                for spike in spikes(&measured.clone(), measured) {
                    measured[spike.at] = f64::NAN;
                }
            }
        }
    }
    let fitted = Fitted::trial(&cleaned, declared.document.clone(), &declared.values()).ok()?;
    let accepted = found.into_iter().map(|(effect, count, evidence)| Accepted {
        group: vec![super::report::Member {
            effect: effect.clone(),
            weight: 1.0,
        }],
        effect,
        added: Vec::new(),
        evidence: Evidence {
            likelihood_ratio: evidence,
            threshold: LEAST_EVIDENCE * count as f64,
            score: None,
            visible_fraction: None,
            smallest_seen: None,
            held_out: None,
            held_out_by_output: Vec::new(),
        },
        fitted: fitted.clone(),
    });
    let accepted = accepted.collect();
    Some((cleaned, accepted))
}

fn restore(cleaned: &mut Case, case: &Case, output: &str) {
    for (to, from) in cleaned.flights.iter_mut().zip(&case.flights) {
        if let (Some(to), Some(from)) = (to.channels.get_mut(output), from.channels.get(output)) {
            to.0.clone_from(&from.0);
        }
    }
}
