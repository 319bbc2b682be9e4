//! Values that no aircraft flies: what a slipped unit looks like. No residual shows it in an input, since control
//! derivatives take up any scale.

use std::f64::consts::TAU;

use crate::flight::{Finding, FindingCode, PhysicalQuantity};
use crate::model::{Model, Quantities, Quantity};
use crate::simulate::Segment;

/// rad: 69 deg. Neither control surfaces nor vanes get there.
const MOST_DEFLECTION: f64 = 1.2;

/// rad: 0.1 deg from end to end. Where no control moves more, nothing is excited: some degrees divided by 57 are less.
const LEAST_DEFLECTION: f64 = 2e-3;

/// rad/s: more than three turns a second, faster than anything flies that carries these sensors.
const MOST_RATE: f64 = 20.0;

/// Of the samples, the share that reaches no further: a few that stand for no value, or spikes, tell of no unit.
const REACHED: f64 = 0.98;

pub(super) fn findings(model: &Model, segments: &[Segment]) -> Vec<Finding> {
    let known = Quantities::of(&model.document);
    let inputs = (model.inputs.iter().enumerate()).map(|(i, input)| Recorded {
        quantity: input,
        is: known.get(&input.name),
        range: range(segments.iter().map(|s| &s.inputs[i])),
    });
    let outputs = (model.outputs.iter().enumerate()).map(|(i, output)| Recorded {
        quantity: output,
        is: known.output(&output.name),
        range: range(segments.iter().map(|s| &s.measured[i])),
    });
    let inputs: Vec<Recorded> = inputs.collect();
    let idle = (inputs.iter())
        .filter(|input| input.quantity.si == "rad" && input.is_control())
        .all(|input| input.range.moved < LEAST_DEFLECTION);
    (inputs.into_iter().chain(outputs))
        .filter_map(|recorded| finding(&recorded, idle))
        .collect()
}

/// How far a quantity goes, SI.
#[derive(Clone, Copy)]
struct Range {
    /// From 0, but for the few samples that are furthest.
    reach: f64,
    /// From the least to the most.
    moved: f64,
}

/// An input or output as it was recorded.
struct Recorded<'m> {
    quantity: &'m Quantity,
    is: Option<PhysicalQuantity>,
    range: Range,
}

impl Recorded<'_> {
    fn is_control(&self) -> bool {
        self.is.is_some_and(PhysicalQuantity::is_control)
    }

    fn deflects(&self) -> bool {
        self.is_control() || self.is.is_some_and(PhysicalQuantity::is_flow_angle)
    }
}

fn range<'s>(values: impl Iterator<Item = &'s Vec<f64>>) -> Range {
    let finite: Vec<f64> = (values.flatten().copied())
        .filter(|value| value.is_finite())
        .collect();
    let (least, most) = finite.iter().fold(
        (f64::INFINITY, f64::NEG_INFINITY),
        |(least, most), &value| (f64::min(least, value), f64::max(most, value)),
    );
    let mut sizes: Vec<f64> = finite.iter().map(|value| value.abs()).collect();
    let place = (REACHED * sizes.len() as f64) as usize;
    let reach = match place < sizes.len() {
        true => *sizes.select_nth_unstable_by(place, f64::total_cmp).1,
        false => 0.0,
    };
    Range {
        reach,
        moved: most - least,
    }
}

fn finding(recorded: &Recorded, idle: bool) -> Option<Finding> {
    let (seen, slip) = odd(recorded, idle)?;
    let name = &recorded.quantity.name;
    let (looks, formula) = match slip {
        Slip::DegreesAsRadians => ("degrees declared as radians", "pi/180"),
        Slip::RadiansAsDegrees => ("radians declared as degrees", "180/pi"),
    };
    let message = format!("{name} {seen}: it looks like {looks}");
    let remedy = format!(
        "correct the unit in the recording's header, or say how the channel is made: \"channels\": {{\"{name}\": \"{name}*{formula}\"}}"
    );
    Some(Finding::new(FindingCode::Implausible, message, remedy).of_channel(name))
}

enum Slip {
    DegreesAsRadians,
    RadiansAsDegrees,
}

/// What is odd about the range of a quantity, and what it looks like; `idle`: no control of the model moves much.
fn odd(recorded: &Recorded, idle: bool) -> Option<(String, Slip)> {
    let Range { reach, moved } = recorded.range;
    let reaches = |unit: &str| format!("reaches {:.0} {unit}", reach.to_degrees());
    match recorded.quantity.si.as_str() {
        "rad" if recorded.deflects() && reach > MOST_DEFLECTION => {
            let seen = format!(
                "{}, further than control surfaces and vanes go",
                reaches("deg")
            );
            Some((seen, Slip::DegreesAsRadians))
        }
        "rad" if recorded.is_control() && idle && moved > 0.0 => {
            let seen = format!("moves by {:.4} deg in all", moved.to_degrees());
            Some((seen, Slip::RadiansAsDegrees))
        }
        // a heading may have turned once beyond its circle
        "rad" if reach > 2.0 * TAU => Some((reaches("deg"), Slip::DegreesAsRadians)),
        "rad/s" if reach > MOST_RATE => Some((reaches("deg/s"), Slip::DegreesAsRadians)),
        _ => None,
    }
}
