//! `modelDescription.xml` of a functional mock-up unit.

use indexmap::IndexMap;
use sha2::{Digest, Sha256};

use super::setting::FmuSetting;
use crate::flight::Unit;
use crate::model::{Model, Quantity};

/// What the document is written from.
pub(super) struct Description<'m> {
    model: &'m Model,
    setting: &'m FmuSetting<'m>,
    /// Tells one model from another, and belongs to the sources.
    pub guid: String,
}

/// What a variable is: the attributes of its element.
struct Variable {
    name: String,
    kind: &'static str,
    start: Option<f64>,
    /// The variable of which it is the derivative, counted from 1.
    derivative: Option<usize>,
    si: String,
    about: String,
}

impl<'m> Description<'m> {
    pub(super) fn new(model: &'m Model, setting: &'m FmuSetting<'m>, source: &str) -> Self {
        let mut hash = Sha256::new();
        hash.update(source);
        let names = [&model.states, &model.inputs, &model.outputs];
        for quantity in names.into_iter().flatten() {
            hash.update(format!("{} {};", quantity.name, quantity.si));
        }
        for value in setting.inputs.iter().chain(setting.parameters) {
            hash.update(value.to_le_bytes());
        }
        let digest = hex::encode(hash.finalize());
        Self {
            model,
            setting,
            guid: format!(
                "{{{}-{}-{}-{}-{}}}",
                &digest[..8],
                &digest[8..12],
                &digest[12..16],
                &digest[16..20],
                &digest[20..32]
            ),
        }
    }

    /// The document.
    pub(super) fn xml(&self) -> String {
        let (document, setting) = (&self.model.document, self.setting);
        let notes = self.model.notes(setting.parameters, setting.of).join("; ");
        let identifier = identifier(&document.name);
        let files = "<SourceFiles><File name=\"model.c\"/><File name=\"fmi2.c\"/></SourceFiles>";
        let variables = self.variables();
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
             <fmiModelDescription fmiVersion=\"2.0\" modelName=\"{}\" guid=\"{}\" description=\"{}\" generationTool=\"Trimtab\" variableNamingConvention=\"structured\" numberOfEventIndicators=\"0\">\n\
             <ModelExchange modelIdentifier=\"{identifier}\" canGetAndSetFMUstate=\"true\" completedIntegratorStepNotNeeded=\"true\">{files}</ModelExchange>\n\
             <CoSimulation modelIdentifier=\"{identifier}\" canHandleVariableCommunicationStepSize=\"true\" canInterpolateInputs=\"true\" canGetAndSetFMUstate=\"true\">{files}</CoSimulation>\n\
             {}\
             <DefaultExperiment startTime=\"0\" stopTime=\"{:?}\" stepSize=\"{:?}\"/>\n\
             <ModelVariables>\n{}</ModelVariables>\n\
             <ModelStructure>\n{}</ModelStructure>\n\
             </fmiModelDescription>\n",
            escaped(&document.name),
            self.guid,
            escaped(&notes),
            units(&variables),
            setting.duration,
            setting.step,
            variables
                .iter()
                .enumerate()
                .map(element)
                .collect::<String>(),
            self.structure(),
        )
    }

    /// In the order of their value references.
    fn variables(&self) -> Vec<Variable> {
        let (model, document) = (self.model, &self.model.document);
        let about = |text: Option<&String>| text.cloned().unwrap_or_default();
        let mut variables = Vec::new();
        for state in &model.states {
            let text = document.states.get(&state.name).map(|s| &s.description);
            let name = format!("state.{}", state.name);
            variables.push(Variable::of(state, name, LOCAL, about(text)));
        }
        for (index, state) in model.states.iter().enumerate() {
            let mut rate = Variable::of(
                state,
                format!("der(state.{})", state.name),
                LOCAL,
                String::new(),
            );
            rate.si = per_second(&state.si);
            rate.derivative = Some(index + 1);
            variables.push(rate);
        }
        for (input, start) in model.inputs.iter().zip(self.setting.inputs) {
            let text = document.inputs.get(&input.name).map(|i| &i.description);
            let mut variable = Variable::of(input, input.name.clone(), INPUT, about(text));
            variable.start = Some(*start);
            variables.push(variable);
        }
        for output in &model.outputs {
            let text = document.outputs.get(&output.name).map(|o| &o.description);
            let name = self.output_name(&output.name);
            variables.push(Variable::of(output, name, OUTPUT, about(text)));
        }
        for (parameter, start) in model.parameters.iter().zip(self.setting.parameters) {
            variables.push(Variable {
                name: parameter.name.clone(),
                kind: PARAMETER,
                start: Some(*start),
                derivative: None,
                si: Unit::si_name(&parameter.document.unit),
                about: parameter.document.description.clone(),
            });
        }
        variables
    }

    /// An output may be called like an input or a parameter.
    fn output_name(&self, name: &str) -> String {
        let document = &self.model.document;
        match document.inputs.contains_key(name) || document.parameters.contains_key(name) {
            true => format!("output.{name}"),
            false => name.to_string(),
        }
    }

    fn structure(&self) -> String {
        let (states, inputs) = (self.model.states.len(), self.model.inputs.len());
        let list = |what: &str, places: &mut dyn Iterator<Item = usize>| -> String {
            let unknowns: String = places
                .map(|place| format!("<Unknown index=\"{}\"/>\n", place + 1))
                .collect();
            match unknowns.is_empty() {
                true => String::new(),
                false => format!("<{what}>\n{unknowns}</{what}>\n"),
            }
        };
        let outputs = || 2 * states + inputs..2 * states + inputs + self.model.outputs.len();
        list("Outputs", &mut outputs())
            + &list("Derivatives", &mut (states..2 * states))
            + &list("InitialUnknowns", &mut (0..2 * states).chain(outputs()))
    }
}

const LOCAL: &str = "causality=\"local\" variability=\"continuous\" initial=\"calculated\"";
const INPUT: &str = "causality=\"input\" variability=\"continuous\"";
const OUTPUT: &str = "causality=\"output\" variability=\"continuous\" initial=\"calculated\"";
const PARAMETER: &str = "causality=\"parameter\" variability=\"tunable\" initial=\"exact\"";

impl Variable {
    fn of(quantity: &Quantity, name: String, kind: &'static str, about: String) -> Self {
        Self {
            name,
            kind,
            start: None,
            derivative: None,
            si: quantity.si.clone(),
            about,
        }
    }
}

fn element((reference, variable): (usize, &Variable)) -> String {
    let about = match variable.about.is_empty() {
        true => String::new(),
        false => format!(" description=\"{}\"", escaped(&variable.about)),
    };
    let unit = match has_unit(&variable.si) {
        true => format!(" unit=\"{}\"", escaped(&variable.si)),
        false => String::new(),
    };
    let start = (variable.start).map_or(String::new(), |start| {
        format!(" start=\"{}\"", number(start))
    });
    let derivative =
        (variable.derivative).map_or(String::new(), |of| format!(" derivative=\"{of}\""));
    format!(
        "<ScalarVariable name=\"{}\" valueReference=\"{reference}\" {}{about}><Real{unit}{start}{derivative}/></ScalarVariable>\n",
        escaped(&variable.name),
        variable.kind,
    )
}

fn has_unit(si: &str) -> bool {
    !matches!(si, "" | "-")
}

fn per_second(si: &str) -> String {
    match has_unit(si) {
        true => format!("({si})/s"),
        false => "1/s".to_string(),
    }
}

/// As `xs:double` has it.
fn number(value: f64) -> String {
    match value {
        f64::INFINITY => "INF".to_string(),
        f64::NEG_INFINITY => "-INF".to_string(),
        value if value.is_nan() => "NaN".to_string(),
        value => format!("{value:?}"),
    }
}

/// Each unit once, with the exponents of its base units where they are whole.
/// Without units there is no element: the schema wants one `Unit` or more in it.
fn units(variables: &[Variable]) -> String {
    let mut all = IndexMap::new();
    for variable in variables.iter().filter(|variable| has_unit(&variable.si)) {
        let dimension = Unit::parse(&variable.si).map(|unit| unit.dimension);
        let base = dimension
            .ok()
            .and_then(|dimension| dimension.whole_exponents());
        all.entry(variable.si.clone()).or_insert(base);
    }
    let unit = |(name, base): (&String, &Option<Vec<(&str, i32)>>)| match base {
        None => format!("<Unit name=\"{}\"/>\n", escaped(name)),
        Some(exponents) => {
            let exponents: String = (exponents.iter())
                .map(|(base, exponent)| format!(" {base}=\"{exponent}\""))
                .collect();
            format!(
                "<Unit name=\"{}\"><BaseUnit{exponents}/></Unit>\n",
                escaped(name)
            )
        }
    };
    let units: String = all.iter().map(unit).collect();
    match units.is_empty() {
        true => units,
        false => format!("<UnitDefinitions>\n{units}</UnitDefinitions>\n"),
    }
}

/// The name of a model as an identifier of C.
fn identifier(name: &str) -> String {
    let fit = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    format!("trimtab_{}", name.chars().map(fit).collect::<String>())
}

fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            // what XML cannot have
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}
