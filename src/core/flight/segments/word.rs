//! What segments are called.

use std::collections::HashMap;

use super::super::PhysicalQuantity;
use super::motion::Watched;
use super::proposal::{ProposedSegment, SegmentKind};

/// Inputs that move less than such a share of the farthest go with it, as a yaw damper's rudder does.
const BESIDE: f64 = 0.25;

/// By its kind, and of a maneuver by the inputs that move in it, the farthest first.
pub(super) fn of(kind: SegmentKind, moves: &[(&Watched, f64)]) -> String {
    if kind == SegmentKind::Trim {
        return "trim".to_string();
    }
    let farthest = moves.first().map_or(0.0, |(_, excursion)| *excursion);
    let mut words: Vec<&str> = Vec::new();
    for (input, excursion) in moves {
        let word = surface(input.quantity).unwrap_or(&input.name);
        if *excursion >= BESIDE * farthest && !words.contains(&word) {
            words.push(word);
        }
    }
    let words = words.join("+");
    match kind {
        SegmentKind::Maneuver => words,
        _ => format!("quasi-steady {words}").trim_end().to_string(),
    }
}

fn surface(quantity: Option<PhysicalQuantity>) -> Option<&'static str> {
    Some(match quantity? {
        PhysicalQuantity::Elevator => "elevator",
        PhysicalQuantity::Aileron => "aileron",
        PhysicalQuantity::Rudder => "rudder",
        PhysicalQuantity::Canard => "canard",
        _ => return None,
    })
}

/// Counts those of one name.
pub(super) fn number(segments: &mut [ProposedSegment]) {
    let mut counts: HashMap<String, usize> = HashMap::new();
    for segment in segments {
        let count = counts.entry(segment.name.clone()).or_default();
        *count += 1;
        segment.name = format!("{} {count}", segment.name);
    }
}
