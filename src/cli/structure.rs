//! `trimtab structure`: which terms an equation needs, here and now.

use std::ops::ControlFlow;

use indexmap::IndexMap;

use super::progress::ProgressLine;
use super::request::Request;
use super::table::{self, bordered};
use super::{Failure, notes};
use crate::estimate::five_digits;
use crate::flight::Maneuver;
use crate::job::{self, JobKind, JobSpec, ModelSource, StructureProgress};
use crate::model::{Input, ModelDocument, Output, expression};
use crate::structure::{Structure, StructureMethod, StructureOptions};

/// Finds which terms the equation of an output needs: stepwise regression, or orthogonal functions.
#[derive(clap::Args, Debug)]
// without a model, one is made of the channels
#[command(mut_arg("model", |model| model.required(false).default_value("")))]
pub(super) struct StructureCommand {
    #[command(flatten)]
    request: Request,
    /// The output whose equation is looked for: a channel, or an output of the model.
    #[arg(long, value_name = "NAME")]
    output: String,
    /// Channels of whose powers and products terms are made, with commas between.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    variables: Vec<String>,
    /// A term of your own: "alpha*de". Any number of times.
    #[arg(long = "term", value_name = "TERM")]
    terms: Vec<String>,
    /// The highest order of a term that is made of --variables.
    #[arg(long, default_value_t = 2)]
    order: usize,
    /// Multivariate orthogonal functions in place of stepwise regression.
    #[arg(long)]
    orthogonal: bool,
    /// No constant term.
    #[arg(long)]
    no_constant: bool,
    /// Stepwise: a term comes in where its partial F is above this.
    #[arg(long, value_name = "F", default_value_t = 4.0)]
    f_to_enter: f64,
    /// Stepwise: a term goes out where its partial F falls below this [default: as --f-to-enter].
    #[arg(long, value_name = "F")]
    f_to_remove: Option<f64>,
    /// Stepwise: no term comes in that explains less than this share of the variation.
    #[arg(long, value_name = "SHARE", default_value_t = 0.0)]
    least_r_squared: f64,
    /// Most terms, the constant not counted.
    #[arg(long, value_name = "NUMBER")]
    most_terms: Option<usize>,
    /// Print the whole result as JSON instead.
    #[arg(long)]
    json: bool,
}

impl StructureCommand {
    pub(super) fn run(&self) -> Result<(), Failure> {
        self.request.refuse_solver("structure")?;
        let maneuvers = self.request.recordings()?;
        let ids: Vec<String> = maneuvers.iter().map(|maneuver| maneuver.digest()).collect();
        let document = match self.request.model.as_str() {
            "" => self.document(&maneuvers[0]),
            _ => self.request.document()?,
        };
        let spec = JobSpec {
            kind: JobKind::Structure,
            model: ModelSource::Document(Box::new(document.clone())),
            structure: Some(self.options()),
            ..self.request.spec(&ids)?
        };
        let plan = job::prepare(&spec, &document, &maneuvers)
            .map_err(|faults| Failure::faults("the job cannot start", &faults))?;
        let progress = ProgressLine::new(self.request.tolerance);
        let result = job::run_structure(&plan, &mut |told| {
            if let StructureProgress::Estimation(told) = told {
                progress.told(told);
            }
            ControlFlow::Continue(())
        })
        .map_err(|faults| Failure::faults("the job failed", &faults))?;
        progress.finish(&result.estimate.reason);
        if self.json {
            notes::say(&result.estimate.findings);
            println!("{}", serde_json::to_string_pretty(&result)?);
            return Ok(());
        }
        if let Some(structure) = &result.structure {
            println!("{}\n", tables(structure));
        }
        println!("{}", table::result(&result.estimate, None));
        Ok(())
    }

    fn options(&self) -> StructureOptions {
        StructureOptions {
            output: self.output.clone(),
            method: match self.orthogonal {
                true => StructureMethod::Orthogonal,
                false => StructureMethod::Stepwise,
            },
            terms: self.terms.clone(),
            variables: self.variables.clone(),
            order: self.order,
            constant: !self.no_constant,
            f_to_enter: self.f_to_enter,
            f_to_remove: self.f_to_remove.unwrap_or(self.f_to_enter),
            least_r_squared: self.least_r_squared,
            most_terms: self.most_terms,
        }
    }

    /// A model of the channels that are named: those of the terms are its inputs.
    fn document(&self, maneuver: &Maneuver) -> ModelDocument {
        let unit = |name: &str| {
            let channel = maneuver.channels().get(name);
            channel.map_or_else(String::new, |channel| channel.unit.dimension.to_string())
        };
        let mut inputs = IndexMap::new();
        let mut add = |name: &str| {
            let input = Input {
                unit: unit(name),
                ..Input::default()
            };
            inputs.entry(name.to_string()).or_insert(input);
        };
        self.variables.iter().for_each(|name| add(name));
        for tree in self
            .terms
            .iter()
            .filter_map(|term| expression::parse(term).ok())
        {
            tree.names().into_iter().for_each(|(name, _)| add(name));
        }
        let output = Output {
            unit: unit(&self.output),
            equation: "0".to_string(),
            ..Output::default()
        };
        ModelDocument {
            name: "structure".to_string(),
            inputs,
            outputs: IndexMap::from([(self.output.clone(), output)]),
            ..ModelDocument::default()
        }
    }
}

/// The steps, and what was kept.
fn tables(structure: &Structure) -> String {
    let header = [
        "step",
        "",
        "term",
        "partial F",
        "R²",
        "s",
        "PSE",
        "PRESS",
        "",
    ];
    let rows = structure.steps.iter().map(|step| {
        let partial_f = step.partial_f.map_or_else(String::new, five_digits);
        vec![
            step.number.to_string(),
            step.verdict.name().to_string(),
            step.term.clone().unwrap_or_default(),
            partial_f,
            format!("{:.5}", step.r_squared),
            five_digits(step.variance.sqrt()),
            five_digits(step.pse),
            five_digits(step.press),
            if step.number == structure.kept {
                "kept"
            } else {
                ""
            }
            .to_string(),
        ]
    });
    let left_out = match structure.left_out.as_slice() {
        [] => String::new(),
        terms => format!("\nleft out: {}", terms.join(", ")),
    };
    format!(
        "{}\n{} = {}\n{}{left_out}",
        bordered(header, rows, 3..8),
        structure.output,
        structure.equation,
        structure.reason
    )
}
