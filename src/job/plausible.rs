//! Values that no aircraft flies: what a slipped unit looks like. No residual shows it in an input, since control
//! derivatives take up any scale.

use std::f64::consts::TAU;

use crate::diagnose::{is_control, is_flow_angle};
use crate::flight::{Finding, Severity};
use crate::model::{Model, Quantity};
use crate::simulate::Segment;

/// rad: 69 deg. Neither control surfaces nor vanes get there.
const MOST_DEFLECTION: f64 = 1.2;

/// rad: 0.03 deg. What moves, but less than this, excites nothing; a maneuver of some degrees divided by 57 does.
const LEAST_DEFLECTION: f64 = 5e-4;

/// rad/s
const MOST_RATE: f64 = 20.0;

pub(super) fn findings(model: &Model, segments: &[Segment]) -> Vec<Finding> {
    let of = |quantity: &Quantity, values: &dyn Fn(&Segment) -> Vec<f64>| {
        let all = segments.iter().flat_map(values).filter(|v| v.is_finite());
        let (least, most) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), v| {
            (least.min(v), most.max(v))
        });
        let message = odd(quantity, least, most)?;
        Some(Finding {
            code: "implausible".to_string(),
            severity: Severity::Warning,
            channel: Some(quantity.name.clone()),
            rows: Vec::new(),
            count: 0,
            message,
            remedy: format!(
                "correct the unit in the recording's header, or say how it is made: \"channels\": {{\"{0}\": \"{0}*pi/180\"}}; no fit can show it",
                quantity.name
            ),
        })
    };
    let inputs = (model.inputs.iter().enumerate())
        .filter_map(|(i, input)| of(input, &|segment| segment.inputs[i].clone()));
    let outputs = (model.outputs.iter().enumerate())
        .filter_map(|(i, output)| of(output, &|segment| segment.measured[i].clone()));
    inputs.chain(outputs).collect()
}

/// What is odd about the range of a quantity, SI.
fn odd(quantity: &Quantity, least: f64, most: f64) -> Option<String> {
    let name = &quantity.name;
    let (reach, moved) = (most.max(-least), most - least);
    let deflects = is_control(name) || is_flow_angle(name);
    match quantity.si.as_str() {
        "rad" if deflects && reach > MOST_DEFLECTION => Some(format!(
            "{name} reaches {:.0} deg, further than any control surface or vane: it looks like degrees declared as radians",
            reach.to_degrees()
        )),
        "rad" if is_control(name) && moved > 0.0 && moved < LEAST_DEFLECTION => Some(format!(
            "{name} moves by {:.4} deg in all: it looks like radians declared as degrees",
            moved.to_degrees()
        )),
        "rad" if !deflects && reach > 2.0 * TAU => Some(format!(
            "{name} reaches {:.0} deg: it looks like degrees declared as radians",
            reach.to_degrees()
        )),
        "rad/s" if reach > MOST_RATE => Some(format!(
            "{name} reaches {:.0} deg/s: it looks like degrees declared as radians",
            reach.to_degrees()
        )),
        _ => None,
    }
}
