//! Moving air: a gust, and wind that the model does not have, or has as a constant.

use super::edited::AddedRole;
use super::error::EditError;
use super::sheet::{Sheet, unknown};
use super::text::names;
use crate::flight::{Dimension, PhysicalQuantity, wind as by_name};
use crate::model::document::{Definition, Parameter, Per};

/// One 1 - cos gust on an angle, a state or a definition, in the maneuver that the term names or in each: wherever
/// equations read it, those of outputs too, for a vane feels the gust. Where an aircraft goes, it does not tell.
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
    let only_in: Vec<String> = sheet.edit.term.iter().cloned().collect();
    let each = |parameter: Parameter| Parameter {
        per: Per::Maneuver,
        only_in: only_in.clone(),
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
    let ways = ways(sheet);
    sheet.document.substitute(target, &definition);
    for (state, derivative) in ways {
        sheet.document.states[&state].derivative = derivative;
    }
    let passed = format!("min(max((t - {time})/{length}, 0), 1)");
    let equation = format!("{target} + {name}/2*(1 - cos(2*pi*{passed}))");
    let added = Definition {
        unit,
        equation,
        quantity: Some(PhysicalQuantity::Other),
        description: format!("{target} with the gust"),
    };
    sheet.document.definitions.insert(definition, added);
    Ok(())
}

/// The states that say where an aircraft is, and their equations.
fn ways(sheet: &Sheet) -> Vec<(String, String)> {
    use PhysicalQuantity::{Altitude, PositionX, PositionY, PositionZ};
    let quantities = sheet.quantities();
    let states = [Altitude, PositionX, PositionY, PositionZ]
        .into_iter()
        .flat_map(|quantity| quantities.all_of(quantity))
        .filter_map(|name| Some((name, sheet.document.states.get(name)?)));
    states
        .map(|(name, state)| (name.to_string(), state.derivative.clone()))
        .collect()
}

/// A component of the wind, and where the document has it or would feel it.
struct Component {
    axis: PhysicalQuantity,
    place: Place,
}

enum Place {
    /// A wind of the model's own.
    Wind(String),
    /// The state of a position that the wind carries along, and the sign with which it does.
    Position(String, &'static str),
}

impl Component {
    fn find(sheet: &Sheet, wanted: &str) -> Result<Self, EditError> {
        use PhysicalQuantity::{Altitude, PositionX, PositionY, PositionZ, WindX, WindY, WindZ};
        let document = &sheet.document;
        let quantities = sheet.quantities();
        let known = || {
            let winds = [WindX, WindY, WindZ].into_iter();
            let names: Vec<String> = winds
                .flat_map(|axis| quantities.all_of(axis).map(ToString::to_string))
                .collect();
            names
        };
        let is_wind = |axis: &PhysicalQuantity| [WindX, WindY, WindZ].contains(axis);
        let speed = Dimension::METRE.over(Dimension::SECOND);
        let axis = (quantities.get(wanted).filter(is_wind)).or_else(|| by_name(wanted, speed));
        let Some(axis) = axis else {
            return Err(sheet.no_target("wind", wanted, known().iter()));
        };
        let own = quantities.all_of(axis).find(|name| *name == wanted);
        if let Some(name) = own.or_else(|| quantities.all_of(axis).next()) {
            let place = Place::Wind(name.to_string());
            return Ok(Self { axis, place });
        }
        let positions: &[(PhysicalQuantity, &str)] = match axis {
            WindX => &[(PositionX, "+")],
            WindY => &[(PositionY, "+")],
            _ => &[(PositionZ, "+"), (Altitude, "-")],
        };
        let mut carried = positions.iter().filter_map(|(position, sign)| {
            let mut names = quantities.all_of(*position);
            let state = names.find(|name| document.states.contains_key(*name))?;
            Some(Place::Position(state.to_string(), sign))
        });
        match carried.next() {
            Some(place) => Ok(Self { axis, place }),
            None => Err(sheet.no_target(
                "wind or position that it carries along",
                wanted,
                known().iter(),
            )),
        }
    }

    fn name(&self) -> &str {
        match (&self.place, self.axis) {
            (Place::Wind(name), _) => name,
            (_, PhysicalQuantity::WindX) => "W_x",
            (_, PhysicalQuantity::WindY) => "W_y",
            _ => "W_z",
        }
    }
}

/// Wind that is constant, or changes with time or height; one component, or several joined by `+`. Where the document
/// has velocities through the air in body axes and the attitude, what the change of the wind adds to their derivatives is
/// added too.
pub(super) fn wind(sheet: &mut Sheet) -> Result<(), EditError> {
    let targets = sheet.target().split('+').map(str::trim);
    let components = targets.map(|target| Component::find(sheet, target));
    let components: Vec<Component> = components.collect::<Result<_, _>>()?;
    for (number, component) in components.iter().enumerate() {
        blow(sheet, component, number == 0)?;
    }
    Ok(())
}

fn blow(sheet: &mut Sheet, component: &Component, is_first: bool) -> Result<(), EditError> {
    let wind = component.name();
    let term = (sheet.edit).needed_term("\"constant\", \"ramp\" or \"shear\"")?;
    let base = format!("{wind}_{term}");
    let name = match is_first {
        true => sheet.name(&base)?,
        false => sheet.free(&base),
    };
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
        accelerate(sheet, component, &rate);
    }
    match &component.place {
        Place::Wind(wind) => {
            if !sheet.is_speed(wind) {
                return Err(sheet.unfit("a wind is a speed"));
            }
            (sheet.document).substitute(wind, &format!("({wind} + {change})"));
        }
        Place::Position(state, sign) => {
            let (derivative, _) = sheet.law(state)?;
            *derivative = format!("{derivative} {sign} {change}");
        }
    }
    let words = match component.place {
        Place::Wind(_) => format!("{term} of the wind beyond {wind}"),
        Place::Position(..) => format!("{term} of the wind, component {wind}"),
    };
    let parameter = Parameter {
        per: Per::Maneuver,
        ..unknown(unit, 0.0, Some(bounds), words)
    };
    sheet.add(&name, AddedRole::Size, parameter);
    Ok(())
}

/// Height above the start of the maneuver, and its rate.
fn height(sheet: &Sheet) -> Result<(String, String), EditError> {
    use PhysicalQuantity::{Altitude, PositionZ};
    let quantities = sheet.quantities();
    for (quantity, sign) in [(Altitude, ""), (PositionZ, "-")] {
        let mut states = (quantities.all_of(quantity))
            .filter_map(|name| Some((name, sheet.document.states.get(name)?)));
        if let Some((name, state)) = states.next() {
            let above = format!("({sign}({name} - ({})))", state.initial);
            return Ok((above, format!("({sign}({}))", state.derivative)));
        }
    }
    Err(sheet.unfit("a shear needs a state that is an altitude or a position down, in m"))
}

/// u̇, v̇, ẇ less the wind's rate of change in body axes.
fn accelerate(sheet: &mut Sheet, component: &Component, rate: &str) {
    use PhysicalQuantity::{
        HeadingAngle, PitchAngle, RollAngle, VelocityX, VelocityY, VelocityZ, WindX, WindY,
    };
    let quantities = sheet.quantities();
    let states = &sheet.document.states;
    let state = |quantity| {
        let mut names = quantities.all_of(quantity);
        names
            .find(|name| states.contains_key(*name))
            .map(ToString::to_string)
    };
    let body = [VelocityX, VelocityY, VelocityZ].map(state);
    let attitude = [RollAngle, PitchAngle, HeadingAngle].map(state);
    let ([Some(u), Some(v), Some(w)], [Some(phi), Some(theta), Some(psi)]) = (body, attitude)
    else {
        return;
    };
    let reads_wind = |name: &String| {
        names(&states[name].derivative)
            .iter()
            .any(|n| n == component.name())
    };
    if [&u, &v, &w].into_iter().any(reads_wind) {
        return;
    }
    let shares = match component.axis {
        WindX => [
            format!("cos({theta})*cos({psi})"),
            format!("(sin({phi})*sin({theta})*cos({psi}) - cos({phi})*sin({psi}))"),
            format!("(cos({phi})*sin({theta})*cos({psi}) + sin({phi})*sin({psi}))"),
        ],
        WindY => [
            format!("cos({theta})*sin({psi})"),
            format!("(sin({phi})*sin({theta})*sin({psi}) + cos({phi})*cos({psi}))"),
            format!("(cos({phi})*sin({theta})*sin({psi}) - sin({phi})*cos({psi}))"),
        ],
        _ => [
            format!("(-sin({theta}))"),
            format!("sin({phi})*cos({theta})"),
            format!("cos({phi})*cos({theta})"),
        ],
    };
    for (name, share) in [u, v, w].iter().zip(shares) {
        if let Some(state) = sheet.document.states.get_mut(name) {
            state.derivative = format!("{} - {rate}*{share}", state.derivative);
        }
    }
}
