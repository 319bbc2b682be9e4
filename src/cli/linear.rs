//! `trimtab linear`: the linear system of an estimate, its frequency responses and flying qualities, without a server.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::progress::ProgressLine;
use super::request::Request;
use super::{Failure, figures, linear_tables, notes};
use crate::dashboard::bode_svg;
use crate::dynamics::{
    AirplaneClass, FlightPhaseCategory, FlyingQualities, FlyingQualityQuestion, FrequencyQuestion,
    FrequencyResponse, FrequencyUnit, LinearSystem, flying_qualities, frequency_responses,
    linear_system, linear_system_as_mat,
};
use crate::http::responses_as_csv;
use crate::job::{self, JobKind, SimulatorFormat};
use crate::model::SourceLanguage;

/// Fits a model and prints its linear system (A, B, C, D with standard errors, modes, transfer functions) and flying
/// qualities at the estimate.
#[derive(clap::Args, Debug)]
pub(super) struct Linear {
    #[command(flatten)]
    request: Request,
    /// Print everything as JSON instead.
    #[arg(long)]
    json: bool,
    /// The label of the segment at whose start the model is linearised; the first without it.
    #[arg(long, value_name = "LABEL")]
    segment: Option<String>,
    /// One input for frequency responses.
    #[arg(long, value_name = "NAME")]
    input: Option<String>,
    /// One output for frequency responses.
    #[arg(long, value_name = "NAME")]
    output: Option<String>,
    /// Frequencies in Hz, not in rad/s: --from, --to, and what is written.
    #[arg(long)]
    hz: bool,
    /// The lowest frequency.
    #[arg(long, value_name = "FREQUENCY")]
    from: Option<f64>,
    /// The highest frequency.
    #[arg(long, value_name = "FREQUENCY")]
    to: Option<f64>,
    /// How many frequencies.
    #[arg(long)]
    points: Option<usize>,
    /// Write frequency responses with standard errors to this CSV file.
    #[arg(long, value_name = "FILE")]
    responses: Option<PathBuf>,
    /// Draw frequency responses with bands of 2 standard errors into this directory, as SVG.
    #[arg(long, value_name = "DIRECTORY")]
    figures: Option<PathBuf>,
    /// Write A, B, C, D with standard errors, lags and delays to this MAT file.
    #[arg(long, value_name = "FILE")]
    mat: Option<PathBuf>,
    /// Write the estimated model as source code to this file: C (.c), Python (.py) or MATLAB (.m).
    #[arg(long, value_name = "FILE", value_parser = source_file)]
    source_code: Option<(PathBuf, SourceLanguage)>,
    /// Write the estimated model for a simulator to this file: a functional mock-up unit (.fmu), or the aerodynamics of a JSBSim
    /// aircraft (.xml).
    #[arg(long, value_name = "FILE", value_parser = simulator_file)]
    simulator_model: Option<(PathBuf, SimulatorFormat)>,
    /// Category of the flight phase, A, B or C; levels want it and --class.
    #[arg(long, value_parser = word::<FlightPhaseCategory>, requires = "class")]
    category: Option<FlightPhaseCategory>,
    /// Class of the airplane: I, II, II-C, III or IV.
    #[arg(long, value_parser = word::<AirplaneClass>, requires = "category")]
    class: Option<AirplaneClass>,
    /// True airspeed, m/s, of a model that does not have it.
    #[arg(long, value_parser = airspeed)]
    airspeed: Option<f64>,
}

/// What `--json` prints.
#[derive(Serialize)]
struct Everything<'a> {
    linear_system: &'a LinearSystem,
    frequency_responses: &'a [FrequencyResponse],
    flying_qualities: &'a FlyingQualities,
}

impl Linear {
    pub(super) fn run(&self) -> Result<(), Failure> {
        let plan = self.request.plan(JobKind::Estimate)?;
        let progress = ProgressLine::new(self.request.tolerance);
        let result = job::run(&plan, &mut |told| {
            progress.told(told);
            ControlFlow::Continue(())
        })
        .map_err(|faults| Failure::faults("the job failed", &faults))?;
        progress.finish(&result.estimate.reason);
        notes::say(&result.estimate.findings);
        let (problem, estimate) = (&plan.problem, &result.estimate);
        let none = |why: crate::dynamics::NoLinearSystem| Failure::new(why.to_string());
        let system = linear_system(problem, estimate, self.segment.as_deref()).map_err(none)?;
        let responses = match system.inputs.is_empty() {
            true => Vec::new(),
            false => frequency_responses(problem, estimate, &self.question()).map_err(none)?,
        };
        let question = FlyingQualityQuestion {
            segment: self.segment.clone(),
            category: self.category,
            class: self.class,
            airspeed: self.airspeed,
            band: [None; 2],
        };
        let qualities = flying_qualities(problem, estimate, &question).map_err(none)?;
        if self.json {
            let everything = Everything {
                linear_system: &system,
                frequency_responses: &responses,
                flying_qualities: &qualities,
            };
            println!("{}", serde_json::to_string_pretty(&everything)?);
        } else {
            println!("{}", linear_tables::system(&system));
            println!("\n{}", linear_tables::qualities(&qualities));
        }
        if let Some((file, language)) = &self.source_code {
            let segment = self.segment.as_deref();
            let text = job::source_code(&plan, estimate, segment, *language)
                .map_err(|why| Failure::new(why.to_string()))?;
            written("--source-code", file, text.as_bytes())?;
        }
        if let Some((file, format)) = &self.simulator_model {
            let segment = self.segment.as_deref();
            let content = job::simulator_model(&plan, estimate, segment, *format)
                .map_err(|why| Failure::new(why.to_string()))?;
            written("--simulator-model", file, &content)?;
        }
        if let Some(file) = &self.mat {
            written("--mat", file, &linear_system_as_mat(&system))?;
        }
        self.write(&responses)
    }

    fn question(&self) -> FrequencyQuestion {
        FrequencyQuestion {
            segment: self.segment.clone(),
            input: self.input.clone(),
            output: self.output.clone(),
            unit: match self.hz {
                true => FrequencyUnit::Hertz,
                false => FrequencyUnit::RadiansPerSecond,
            },
            from: self.from,
            to: self.to,
            points: self.points,
        }
    }

    fn write(&self, responses: &[FrequencyResponse]) -> Result<(), Failure> {
        if let Some(file) = &self.responses {
            written("--responses", file, responses_as_csv(responses).as_bytes())?;
        }
        if let Some(directory) = &self.figures {
            let drawn = responses.iter().map(|response| {
                let name = format!("{}-over-{}.svg", response.output, response.input);
                (name, bode_svg(response))
            });
            figures::write(directory, drawn)?;
        }
        Ok(())
    }
}

fn written(option: &str, file: &Path, content: &[u8]) -> Result<(), Failure> {
    std::fs::write(file, content).map_err(|why| {
        let file = file.display();
        Failure::new(format!(
            "{option} {file}: {why}; name a file that can be written"
        ))
    })
}

/// A file whose ending says in which language.
fn source_file(text: &str) -> Result<(PathBuf, SourceLanguage), String> {
    let file = PathBuf::from(text);
    match file.extension().and_then(|extension| extension.to_str()) {
        Some("c") => Ok((file, SourceLanguage::C)),
        Some("py") => Ok((file, SourceLanguage::Python)),
        Some("m") => Ok((file, SourceLanguage::Matlab)),
        _ => Err("its name ends in .c, .py or .m".to_string()),
    }
}

/// A file whose ending says for which simulator.
fn simulator_file(text: &str) -> Result<(PathBuf, SimulatorFormat), String> {
    let file = PathBuf::from(text);
    match file.extension().and_then(|extension| extension.to_str()) {
        Some("fmu") => Ok((file, SimulatorFormat::Fmu)),
        Some("xml") => Ok((file, SimulatorFormat::Jsbsim)),
        _ => Err("its name ends in .fmu or .xml (JSBSim)".to_string()),
    }
}

/// A word of the API.
fn word<T: DeserializeOwned>(text: &str) -> Result<T, String> {
    serde_json::from_value(serde_json::Value::String(text.to_string()))
        .map_err(|error| error.to_string())
}

fn airspeed(text: &str) -> Result<f64, String> {
    let speed: f64 = text.parse().map_err(|_| "a number in m/s".to_string())?;
    match speed > 0.0 && speed.is_finite() {
        true => Ok(speed),
        false => Err("it is above 0, in m/s".to_string()),
    }
}
