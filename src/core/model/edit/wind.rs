//! Moving air: a gust, and wind that is not the constant the model has.

use super::edited::AddedRole;
use super::error::EditError;
use super::sheet::{Sheet, dimension, unknown};
use super::text::{laws, names, replace_name};
use crate::flight::Dimension;
use crate::model::document::{Definition, Parameter, Per};

/// One 1 - cos gust on an angle, a state or a definition, wherever the equations of states and definitions read it.
pub(super) fn gust(sheet: &mut Sheet) -> Result<(), EditError> {
    let target = sheet.target();
    let document = &sheet.document;
    let unit = (document.states.get(target).map(|state| &state.unit)).or_else(|| {
        let definition = document.definitions.get(target);
        definition.map(|definition| &definition.unit)
    });
    let Some(unit) = unit.cloned() else {
        let known = document.states.keys().chain(document.definitions.keys());
        return Err(sheet.no_target("state or definition", target, known));
    };
    let each = |parameter: Parameter| Parameter {
        per: Per::Maneuver,
        ..parameter
    };
    let name = sheet.name(&format!("{target}_gust"))?;
    let words = format!("amplitude of the gust in {target}");
    sheet.add(
        &name,
        AddedRole::Size,
        each(unknown(&unit, 0.0, None, words)),
    );
    let time = sheet.free(&format!("{target}_gust_time"));
    let words = "start of the gust, after the start of the maneuver".to_string();
    let parameter = Parameter {
        lower: Some(-10.0),
        ..unknown("s", 1.0, None, words)
    };
    sheet.add(&time, AddedRole::Onset, each(parameter));
    let length = sheet.free(&format!("{target}_gust_length"));
    let words = "how long the gust takes to pass".to_string();
    sheet.add(
        &length,
        AddedRole::Duration,
        each(unknown("s", 1.0, Some((0.1, 5.0)), words)),
    );
    let definition = sheet.free(&format!("{target}_air"));
    for equation in laws(&mut sheet.document) {
        *equation = replace_name(equation, target, &definition);
    }
    let passed = format!("min(max((t - {time})/{length}, 0), 1)");
    let equation = format!("{target} + {name}/2*(1 - cos(2*pi*{passed}))");
    let added = Definition {
        unit,
        equation,
        description: format!("{target} with the gust"),
    };
    sheet.document.definitions.insert(definition, added);
    Ok(())
}

/// Which way a wind blows, of a name such as `W_x`, `Wx`, `wind_x`.
fn axis(name: &str) -> Option<char> {
    let plain = name.to_lowercase().replace('_', "");
    ["wx", "wy", "wz", "windx", "windy", "windz"]
        .contains(&plain.as_str())
        .then(|| plain.chars().last())
        .flatten()
}

/// Wind that changes with time or height. Where the document has u, v, w and the attitude, what the change of the wind adds to
/// their derivatives is added too: they are velocities through the air.
pub(super) fn wind(sheet: &mut Sheet) -> Result<(), EditError> {
    let document = &sheet.document;
    let of_wind = || {
        let constants = document.constants.keys().chain(document.parameters.keys());
        let varying = document.definitions.keys().chain(document.inputs.keys());
        constants.chain(varying).filter(|name| axis(name).is_some())
    };
    let wanted = sheet.target();
    let same = |name: &&String| axis(wanted).is_some() && axis(name) == axis(wanted);
    let found = of_wind()
        .find(|name| *name == wanted)
        .or_else(|| of_wind().find(same));
    let Some(target) = found.cloned() else {
        return Err(sheet.no_target("wind", wanted, of_wind()));
    };
    let speed = Dimension::METRE.over(Dimension::SECOND);
    if sheet.measures(&target) != Some(speed) {
        return Err(sheet.unfit("a wind is a speed"));
    }
    let term = (sheet.edit).needed_term("\"constant\", \"ramp\" or \"shear\"")?;
    let name = sheet.name(&format!("{target}_{term}"))?;
    let (change, rate, unit, bounds) = match term {
        "constant" => (name.clone(), None, "m/s", (-60.0, 60.0)),
        "ramp" => (
            format!("{name}*t"),
            Some(name.clone()),
            "m/s^2",
            (-5.0, 5.0),
        ),
        "shear" => {
            let (above, climb) = height(sheet)?;
            let change = format!("{name}*{above}");
            (change, Some(format!("{name}*{climb}")), "1/s", (-1.0, 1.0))
        }
        _ => {
            let message = "a wind is \"constant\", \"ramp\" or \"shear\"";
            return Err(sheet.edit.bad_term(message));
        }
    };
    if let Some(rate) = rate {
        accelerate(sheet, &target, &rate);
    }
    (sheet.document).substitute(&target, &format!("({target} + {change})"));
    let words = format!("{term} of the wind beyond {target}");
    let parameter = Parameter {
        per: Per::Maneuver,
        ..unknown(unit, 0.0, Some(bounds), words)
    };
    sheet.add(&name, AddedRole::Size, parameter);
    Ok(())
}

/// Height above the start of the maneuver, and its rate.
fn height(sheet: &Sheet) -> Result<(String, String), EditError> {
    let states = &sheet.document.states;
    for (name, sign) in [("h", ""), ("height", ""), ("altitude", ""), ("z", "-")] {
        if let Some(state) = states.get(name)
            && dimension(&state.unit) == Dimension::METRE
        {
            let above = format!("({sign}({name} - ({})))", state.initial);
            return Ok((above, format!("({sign}({}))", state.derivative)));
        }
    }
    Err(sheet.unfit("a shear needs a state 'h' (height) or 'z' (down), in m"))
}

/// u̇, v̇, ẇ less the wind's rate of change in body axes.
fn accelerate(sheet: &mut Sheet, wind: &str, rate: &str) {
    let states = &sheet.document.states;
    let body = ["u", "v", "w"];
    let is_there = body
        .iter()
        .chain(&["phi", "theta", "psi"])
        .all(|name| states.contains_key(*name));
    let reads_wind = |name: &&str| names(&states[*name].derivative).iter().any(|n| n == wind);
    if !is_there || body.iter().any(reads_wind) {
        return;
    }
    let shares = match axis(wind) {
        Some('x') => [
            "cos(theta)*cos(psi)",
            "(sin(phi)*sin(theta)*cos(psi) - cos(phi)*sin(psi))",
            "(cos(phi)*sin(theta)*cos(psi) + sin(phi)*sin(psi))",
        ],
        Some('y') => [
            "cos(theta)*sin(psi)",
            "(sin(phi)*sin(theta)*sin(psi) + cos(phi)*cos(psi))",
            "(cos(phi)*sin(theta)*sin(psi) - sin(phi)*cos(psi))",
        ],
        _ => [
            "(-sin(theta))",
            "sin(phi)*cos(theta)",
            "cos(phi)*cos(theta)",
        ],
    };
    for (name, share) in body.iter().zip(shares) {
        if let Some(state) = sheet.document.states.get_mut(*name) {
            state.derivative = format!("{} - {rate}*{share}", state.derivative);
        }
    }
}
