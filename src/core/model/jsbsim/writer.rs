//! The file: properties, functions and axes, one after the other.

use indexmap::{IndexMap, IndexSet};

use super::axes::{Axis, BODY, STABILITY, axis};
use super::element::{Element, element};
use super::no_aerodynamics::NoAerodynamics;
use super::property::{Property, is_of_the_flow, property};
use crate::flight::{PhysicalQuantity, Unit};
use crate::model::expression::{self, written_unit};
use crate::model::{Model, Per, Quantities, Source};

pub(super) struct Writer<'m> {
    model: &'m Model,
    quantities: Quantities,
    /// SI.
    parameters: &'m [f64],
    /// Properties of the file's own that are used, with what they begin with.
    properties: IndexMap<String, f64>,
    /// Definitions in the order of what they need.
    functions: IndexMap<String, Element>,
    /// Names of the model that are JSBSim's, and which.
    taken: IndexMap<String, &'static str>,
    used: IndexSet<String>,
    /// Coefficients of an axis that another definition stands for.
    passed_over: Vec<String>,
}

/// What the property of a name is called.
fn own(name: &str) -> String {
    format!("aero/trimtab/{name}")
}

impl<'m> Writer<'m> {
    pub(super) fn new(model: &'m Model, parameters: &'m [f64]) -> Self {
        Self {
            model,
            quantities: Quantities::of(&model.document),
            parameters,
            properties: IndexMap::new(),
            functions: IndexMap::new(),
            taken: IndexMap::new(),
            used: IndexSet::new(),
            passed_over: Vec::new(),
        }
    }

    pub(super) fn file(mut self, of: &str) -> Result<String, NoAerodynamics> {
        let coefficients = self.coefficients()?;
        for (name, _) in &coefficients {
            self.define(name)?;
        }
        let properties: String = (self.properties.iter())
            .map(|(name, value)| format!("  <property value=\"{value:?}\"> {name} </property>\n"))
            .collect();
        let functions: String = (self.functions.iter())
            .map(|(name, element)| {
                let inside = element.xml(2);
                format!(
                    "  <function name=\"{}\">\n{inside}  </function>\n",
                    own(name)
                )
            })
            .collect();
        let axes: String = (coefficients.iter())
            .map(|(name, axis)| written(name, axis))
            .chain(missing(&coefficients))
            .collect();
        let notes: String = (self.notes(of, &coefficients).iter())
            .map(|note| format!("  {}\n", in_comment(note)))
            .collect();
        Ok(format!(
            "<?xml version=\"1.0\"?>\n<!--\n{notes}-->\n<aerodynamics>\n{properties}{functions}{axes}</aerodynamics>\n"
        ))
    }

    /// The definitions that are coefficients with an axis; of several of one axis the last one, which may be made of the others.
    fn coefficients(&mut self) -> Result<Vec<(String, Axis)>, NoAerodynamics> {
        let model = self.model;
        let definitions = model.document.definitions.keys();
        let all: Vec<(&String, PhysicalQuantity)> = definitions
            .filter_map(|name| Some((name, self.quantities.get(name)?)))
            .collect();
        let in_frame = |frame: &str| {
            let is = |quantity| {
                axis(quantity, "").is_some_and(|axis| axis.frame == frame && axis.length.is_none())
            };
            (all.iter().find(|(_, quantity)| is(*quantity))).map(|(name, _)| name.to_string())
        };
        let forces = match (in_frame(STABILITY), in_frame(BODY)) {
            (Some(first), Some(second)) => return Err(NoAerodynamics::MixedAxes { first, second }),
            (Some(_), None) => STABILITY,
            (None, _) => BODY,
        };
        let mut by_axis: IndexMap<&str, (String, Axis)> = IndexMap::new();
        for (name, quantity) in all {
            let Some(axis) = axis(quantity, forces) else {
                continue;
            };
            if let Some((before, _)) = by_axis.insert(axis.name, (name.clone(), axis)) {
                let note = format!(
                    "{}: {name}, and not {before}, which is one as well",
                    axis.name
                );
                self.passed_over.push(note);
            }
        }
        match by_axis.is_empty() {
            true => Err(NoAerodynamics::NoCoefficient),
            false => Ok(by_axis.into_values().collect()),
        }
    }

    /// Writes a definition behind those that it needs.
    fn define(&mut self, name: &str) -> Result<(), NoAerodynamics> {
        if self.functions.contains_key(name) {
            return Ok(());
        }
        let equation = &self.model.document.definitions[name].equation;
        let tree = expression::parse(equation)?;
        let element = element(&tree, &mut |inner| self.name(inner, name))?;
        self.functions.insert(name.to_string(), element);
        Ok(())
    }

    /// What a name is in the equation of a definition.
    fn name(&mut self, name: &str, within: &str) -> Result<Element, NoAerodynamics> {
        let document = &self.model.document;
        if let Some(unit) = written_unit(name) {
            return Ok(Element::Value(unit.map_or(1.0, |unit| unit.scale)));
        }
        if let Some(constant) = document.constants.get(name) {
            let unit = Unit::parse(&constant.unit).unwrap_or(Unit::NONE);
            return Ok(Element::Value(unit.to_si(constant.value)));
        }
        if let Some(place) = document.parameters.get_index_of(name) {
            self.used.insert(name.to_string());
            return Ok(self.property(name, self.parameters[place]));
        }
        match name {
            "pi" => return Ok(Element::Value(std::f64::consts::PI)),
            "t" => {
                let name = within.to_string();
                return Err(NoAerodynamics::Time { name });
            }
            _ => {}
        }
        if let Some(property) = self.of_jsbsim(name) {
            self.taken.insert(name.to_string(), property.name);
            return Ok(in_si(property));
        }
        if document.definitions.contains_key(name) {
            self.define(name)?;
            return Ok(Element::Property(own(name)));
        }
        match document.inputs.contains_key(name) {
            true => Ok(self.property(name, 0.0)),
            false => Err(NoAerodynamics::NoProperty {
                name: name.to_string(),
            }),
        }
    }

    fn property(&mut self, name: &str, value: f64) -> Element {
        self.properties.insert(own(name), value);
        Element::Property(own(name))
    }

    /// States and inputs by what they are; a definition only where the document declares it, others are written out.
    fn of_jsbsim(&self, name: &str) -> Option<Property> {
        let document = &self.model.document;
        let quantity = self.quantities.get(name)?;
        if let Some(definition) = document.definitions.get(name) {
            let is_declared = definition.quantity == Some(quantity);
            return property(quantity, "").filter(|_| is_declared && is_of_the_flow(quantity));
        }
        let all = self.model.inputs.iter().chain(&self.model.states);
        let si = all.into_iter().find(|of| of.name == name)?.si.as_str();
        property(quantity, si)
    }

    /// The head of the file.
    fn notes(&self, of: &str, coefficients: &[(String, Axis)]) -> Vec<String> {
        let mut notes = vec![
            of.to_string(),
            "Written by Trimtab. Functions aero/trimtab/... are in SI; parameters begin where they were estimated.".to_string(),
            "Moments are about the centre of gravity of the flights: put AERORP of the aircraft's metrics there.".to_string(),
        ];
        for (name, constant) in &self.model.document.constants {
            notes.push(format!(
                "{name} = {:?} {}: as in the model, also where the aircraft's metrics differ",
                constant.value, constant.unit
            ));
        }
        let list = |(name, axis): &(String, Axis)| {
            let times = axis
                .length
                .map_or(String::new(), |length| format!(" * {length}"));
            format!(
                "{} ({}) = aero/qbar-psf * metrics/Sw-sqft{times} * {name}",
                axis.name, axis.frame
            )
        };
        notes.extend(coefficients.iter().map(list));
        notes.extend(self.passed_over.iter().cloned());
        notes.extend(self.taken.iter().map(|(name, property)| {
            let from = (self.quantities.taken()).find(|(known, _)| known == name);
            let guessed = from.is_some_and(|(_, taken)| taken.from == Source::Guessed);
            let how = if guessed { ", by its name" } else { "" };
            format!("{name} is {property}{how}")
        }));
        let set = (self.model.inputs.iter())
            .filter(|input| self.properties.contains_key(&own(&input.name)));
        notes.extend(set.map(|input| {
            format!(
                "{} [{}] has to be set by the aircraft's flight control",
                own(&input.name),
                input.si
            )
        }));
        notes.extend(self.left_out_parameters());
        notes.extend(self.model.left_out(self.parameters));
        notes
    }

    /// Parameters of the aircraft that are not in the coefficients, and are not zero.
    fn left_out_parameters(&self) -> impl Iterator<Item = String> {
        let drives = |place: usize| {
            let mut entries = self.model.dynamics_jacobian.by_parameter.iter();
            entries.any(|(_, parameter)| *parameter == place)
        };
        let all = self.model.parameters.iter().zip(self.parameters);
        all.enumerate()
            .filter(move |(place, (info, value))| {
                let is_of_aircraft = info.document.per == Per::Job && drives(*place);
                **value != 0.0 && is_of_aircraft && !self.used.contains(&info.name)
            })
            .map(|(_, (info, value))| format!("NOT in it: {} = {value:?}, in SI", info.name))
    }
}

fn in_si(property: Property) -> Element {
    let name = Element::Property(property.name.to_string());
    let si = match property.factor {
        1.0 => name,
        factor => Element::Of("product", vec![name, Element::Value(factor)]),
    };
    match property.least {
        None => si,
        Some(least) => Element::Of("max", vec![si, Element::Value(least)]),
    }
}

/// An axis with its force or moment, in JSBSim's units.
fn written(name: &str, axis: &Axis) -> String {
    let factors = ["aero/qbar-psf", "metrics/Sw-sqft"]
        .into_iter()
        .chain(axis.length)
        .map(|factor| Element::Property(factor.to_string()))
        .chain([Element::Property(own(name))]);
    let product = Element::Of("product", factors.collect()).xml(3);
    let kind = if axis.length.is_some() {
        "moment"
    } else {
        "force"
    };
    format!(
        "  <axis name=\"{}\" frame=\"{}\">\n    <function name=\"aero/{kind}/trimtab-{name}\">\n{product}    </function>\n  </axis>\n",
        axis.name, axis.frame
    )
}

/// JSBSim wants an axis of forces and one of moments.
fn missing(coefficients: &[(String, Axis)]) -> Vec<String> {
    let none = |name: &str, is_moment: bool| {
        let is_there = |(_, axis): &(String, Axis)| axis.length.is_some() == is_moment;
        (!coefficients.iter().any(is_there)).then(|| {
            let zero = Element::Value(0.0).xml(3);
            format!("  <axis name=\"{name}\" frame=\"BODY\">\n    <function name=\"aero/trimtab-no-{name}\">\n{zero}    </function>\n  </axis>\n")
        })
    };
    [none("X", false), none("PITCH", true)]
        .into_iter()
        .flatten()
        .collect()
}

/// A comment of XML has neither two hyphens in a row nor control characters.
fn in_comment(note: &str) -> String {
    let is_no_text = |c: char| c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}');
    let note = note.replace(is_no_text, " ");
    // the first pass leaves the last two of three hyphens together
    note.replace("--", "- -").replace("--", "- -")
}
