//! Values that no aircraft flies: what a slipped unit looks like. No residual shows it in an input, since control
//! derivatives take up any scale.

use std::f64::consts::TAU;

use crate::flight::{Finding, Severity, is_control, is_flow_angle};
use crate::model::{Model, Quantity};
use crate::simulate::Segment;

/// rad: 69 deg. Neither control surfaces nor vanes get there.
const MOST_DEFLECTION: f64 = 1.2;

/// rad: 0.1 deg from end to end. Where no control moves more, nothing is excited: some degrees divided by 57 are less.
const LEAST_DEFLECTION: f64 = 2e-3;

/// rad/s: more than three turns a second, faster than anything flies that carries these sensors.
const MOST_RATE: f64 = 20.0;

pub(super) fn findings(model: &Model, segments: &[Segment]) -> Vec<Finding> {
    let inputs = (model.inputs.iter().enumerate())
        .map(|(i, input)| (input, range(segments.iter().map(|s| &s.inputs[i]))));
    let outputs = (model.outputs.iter().enumerate())
        .map(|(i, output)| (output, range(segments.iter().map(|s| &s.measured[i]))));
    let inputs: Vec<(&Quantity, Range)> = inputs.collect();
    let idle = (inputs.iter())
        .filter(|(input, _)| input.si == "rad" && is_control(&input.name))
        .all(|(_, (least, most))| most - least < LEAST_DEFLECTION);
    (inputs.into_iter().chain(outputs))
        .filter_map(|(quantity, range)| finding(quantity, range, idle))
        .collect()
}

/// Least and most, SI.
type Range = (f64, f64);

fn range<'s>(values: impl Iterator<Item = &'s Vec<f64>>) -> Range {
    let finite = values.flatten().filter(|value| value.is_finite());
    finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), &v| {
        (least.min(v), most.max(v))
    })
}

fn finding(quantity: &Quantity, range: Range, idle: bool) -> Option<Finding> {
    let (seen, slip) = odd(quantity, range, idle)?;
    let name = &quantity.name;
    let (looks, formula) = match slip {
        Slip::DegreesAsRadians => ("degrees declared as radians", "pi/180"),
        Slip::RadiansAsDegrees => ("radians declared as degrees", "180/pi"),
    };
    Some(Finding {
        code: "implausible".to_string(),
        severity: Severity::Warning,
        channel: Some(name.clone()),
        rows: Vec::new(),
        count: 0,
        message: format!("{name} {seen}: it looks like {looks}"),
        remedy: format!(
            "correct the unit in the recording's header, or say how the channel is made: \"channels\": {{\"{name}\": \"{name}*{formula}\"}}"
        ),
    })
}

enum Slip {
    DegreesAsRadians,
    RadiansAsDegrees,
}

/// What is odd about the range of a quantity, and what it looks like; `idle`: no control of the model moves much.
fn odd(quantity: &Quantity, (least, most): Range, idle: bool) -> Option<(String, Slip)> {
    let name = &quantity.name;
    let (reach, moved) = (most.max(-least), most - least);
    let deflects = is_control(name) || is_flow_angle(name);
    let reaches = |unit: &str| format!("reaches {:.0} {unit}", reach.to_degrees());
    match quantity.si.as_str() {
        "rad" if deflects && reach > MOST_DEFLECTION => {
            let seen = format!(
                "{}, further than control surfaces and vanes go",
                reaches("deg")
            );
            Some((seen, Slip::DegreesAsRadians))
        }
        "rad" if is_control(name) && idle && moved > 0.0 => {
            let seen = format!("moves by {:.4} deg in all", moved.to_degrees());
            Some((seen, Slip::RadiansAsDegrees))
        }
        // a heading may have turned once beyond its circle
        "rad" if reach > 2.0 * TAU => Some((reaches("deg"), Slip::DegreesAsRadians)),
        "rad/s" if reach > MOST_RATE => Some((reaches("deg/s"), Slip::DegreesAsRadians)),
        _ => None,
    }
}
