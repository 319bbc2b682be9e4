//! `trimtab trim`: steady flight of a model, without a server.

use indexmap::IndexMap;

use super::document::document;
use super::pairs::{once, pair};
use super::{Failure, table};
use crate::dynamics::{Trim, TrimKind, TrimOutcome, TrimQuantity, TrimSpec, TrimValue};
use crate::estimate::five_digits as number;
use crate::job::{ModelSource, ModelTrimSpec};

/// Finds states and inputs of a steady flight: rates of states are zero, and other quantities are held where it is said. The estimated
/// model of a fit is "model" in what trimtab fit --json printed.
#[derive(clap::Args, Debug)]
pub(super) struct TrimCommand {
    /// A catalog model or a model document (.toml, .json).
    model: String,
    /// What is held, in the model's unit or with its own: "V=60", "phi=30[deg]".
    #[arg(long, value_name = "NAME=VALUE")]
    hold: Vec<String>,
    /// The rate of a state that is not zero, per second: "psi=3[deg/s]".
    #[arg(long, value_name = "STATE=VALUE")]
    rate: Vec<String>,
    /// A state whose rate may be anything.
    #[arg(long, value_name = "STATE")]
    free_rate: Vec<String>,
    /// Where the search begins, of a state or input: "u=60[m/s]".
    #[arg(long, value_name = "NAME=VALUE")]
    start: Vec<String>,
    /// Limits of a state or input: "de=-25[deg]..15[deg]".
    #[arg(long, value_name = "NAME=LOWEST..HIGHEST")]
    limit: Vec<String>,
    /// The value of a parameter, in its own unit: "Cma=-0.68".
    #[arg(long, short, value_name = "NAME=VALUE")]
    parameter: Vec<String>,
    /// The value of a constant, in its own unit: "m=1250".
    #[arg(long, value_name = "NAME=VALUE")]
    constant: Vec<String>,
    /// Print everything as JSON.
    #[arg(long)]
    json: bool,
}

impl TrimCommand {
    pub(super) fn run(&self) -> Result<(), Failure> {
        let document = document(&self.model, None)?;
        let limits = |text: &str| {
            let (lowest, highest) = text
                .split_once("..")
                .ok_or_else(|| Failure::new(format!("--limit: '{text}' is no LOWEST..HIGHEST")))?;
            Ok([value(lowest), value(highest)])
        };
        let spec = ModelTrimSpec {
            model: ModelSource::Reference(document.name.clone()),
            constants: map("--constant", &self.constant, plain("--constant"))?,
            parameters: map("--parameter", &self.parameter, plain("--parameter"))?,
            conditions: TrimSpec {
                hold: map("--hold", &self.hold, |text| Ok(value(text)))?,
                rates: map("--rate", &self.rate, |text| Ok(value(text)))?,
                free_rates: self.free_rate.clone(),
                start: map("--start", &self.start, |text| Ok(value(text)))?,
                limits: map("--limit", &self.limit, limits)?,
            },
        };
        let trim = (spec.trim(&document))
            .map_err(|faults| Failure::faults("there is no trim of this kind", &faults))?;
        match self.json {
            true => println!("{}", serde_json::to_string_pretty(&trim)?),
            false => println!("{}", shown(&trim)),
        }
        match trim.outcome {
            TrimOutcome::Trimmed => Ok(()),
            TrimOutcome::NotReached => Err(Failure::new(
                "no steady flight meets all conditions: what comes nearest is above",
            )),
        }
    }
}

fn value(text: &str) -> TrimValue {
    let number = text.trim().parse().map(TrimValue::Number);
    number.unwrap_or_else(|_| TrimValue::Text(text.to_string()))
}

fn plain(option: &'static str) -> impl Fn(&str) -> Result<f64, Failure> {
    move |text| {
        let number: Result<f64, _> = text.parse();
        number.map_err(|_| Failure::new(format!("{option}: '{text}' is no number")))
    }
}

fn map<T>(
    option: &str,
    texts: &[String],
    read: impl Fn(&str) -> Result<T, Failure>,
) -> Result<IndexMap<String, T>, Failure> {
    let mut all = IndexMap::new();
    for text in texts {
        let (name, text) = pair(text, option)?;
        let before = all.insert(name.to_string(), read(text)?);
        once(option, name, before.is_some())?;
    }
    Ok(all)
}

/// A table of quantities; angles in degrees beside radians; then what is open and what is not met.
fn shown(trim: &Trim) -> String {
    let row = |quantity: &TrimQuantity| {
        let degrees = match quantity.unit.strip_prefix("rad") {
            Some(rest) => format!("{} deg{rest}", number(quantity.value.to_degrees())),
            None => String::new(),
        };
        let what = match (quantity.kind, quantity.held) {
            (TrimKind::State, true) => "state, held",
            (TrimKind::State, false) => "state",
            (TrimKind::Input, true) => "input, held",
            (TrimKind::Input, false) => "input",
            (TrimKind::Definition, _) => "definition",
            (TrimKind::Output, _) => "output",
        };
        let name = format!("{} [{}]", quantity.name, quantity.unit);
        vec![name, number(quantity.value), degrees, what.to_string()]
    };
    let rows: Vec<_> = trim.quantities.iter().map(row).collect();
    let mut text = table::bordered(["quantity", "value", "", "what"], rows, 1..3);
    for open in &trim.undetermined {
        let names = open.join(" and ");
        text += &format!("\nundetermined: {names}, where the search began; hold it if it matters");
    }
    if trim.outcome == TrimOutcome::NotReached {
        for condition in &trim.conditions {
            let what = if condition.rate { "rate of " } else { "" };
            text += &format!(
                "\n{what}{} [{}]: {} for {}",
                condition.name,
                condition.unit,
                number(condition.reached),
                number(condition.wanted)
            );
        }
    }
    text
}
