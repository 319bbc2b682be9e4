//! The options by which `fit` and `submit` describe a job: files, a model, and how they meet.

use std::path::Path;
use std::sync::Arc;

use indexmap::{IndexMap, IndexSet};

use super::Failure;
use super::changes::Changes;
use super::document::{document, in_file};
use super::file_rows::FileRows;
use super::intervals::interval_options;
use super::mapping::MappingOption;
use super::pairs::{once, pair};
use super::recording::read_recording;
use super::start_method::start_method;
use crate::estimate::{
    Derivatives, Estimator, FrequencyOptions, IntervalOptions, Method, Noise, NoiseStructure,
    Options, Role, StartMethod,
};
use crate::flight::Maneuver;
use crate::job::{
    self, ConstantValue, Gaps, JobKind, JobSpec, ManeuverUse, ModelSource, Plan, Strict,
};
use crate::model::ModelDocument;
use crate::simulate::{InputInterpolation, Integrator};

#[derive(clap::Args, Debug)]
pub(super) struct Request {
    /// Recordings: tables of text (.csv, .txt, .dat, ...), JSON (.json), Excel workbooks (.xlsx), Parquet
    /// (.parquet), logs of PX4 (.ulg) and ArduPilot (.bin), TDMS (.tdms), MDF 4 (.mf4), frames
    /// of pandas in HDF5 (.h5); with --mapping MAT files (.mat),
    /// other HDF5 files or ASCII matrices (.asc); any of them packed (.gz, .zip). Rows count from 1; FILE:2s-32.5s are seconds. Several are fitted together.
    #[arg(required = true, value_name = "FILE[:FIRST-LAST]")]
    pub files: Vec<FileRows>,
    /// A recording that the model is not fitted to but predicts, to see whether it holds.
    #[arg(long, value_name = "FILE[:FIRST-LAST]")]
    pub validate: Vec<FileRows>,
    /// A recording that is predicted at the very end: a diagnosis makes no decision with it.
    #[arg(long = "final", value_name = "FILE[:FIRST-LAST]")]
    pub last: Vec<FileRows>,
    #[command(flatten)]
    pub mapping: MappingOption,
    /// A catalog model (short-period, lateral-directional-2, ...) or a model document (.toml, .json).
    #[arg(long, short)]
    pub model: String,
    /// How a model input or output is made from recorded channels: "da=(da_right - da_left)/2".
    #[arg(long = "channel", short, value_name = "NAME=FORMULA")]
    channels: Vec<String>,
    #[command(flatten)]
    changes: Changes,
    /// Another value of one of the model's constants: "m=17600", or "m=recording.mass" where the server was told what was flown.
    #[arg(long = "constant", value_name = "NAME=VALUE")]
    constants: Vec<String>,
    /// What to do where recordings have gaps: auto (through where a gap is short against the motion, else split), through
    /// (integrate on), split (parts of their own), or join (close them up).
    #[arg(long, value_name = "HOW", default_value = Gaps::default().name(), value_parser = gaps)]
    gaps: Gaps,
    /// Run recordings with gaps as one continuous time history: the same as --gaps join.
    #[arg(long, conflicts_with = "gaps")]
    join: bool,
    /// Inputs are held between samples, as the commands of a computer are, and not on straight lines.
    #[arg(long)]
    hold: bool,
    /// How the model is stepped through time: euler, rk2 or rk4.
    #[arg(long, value_name = "METHOD", default_value = "rk4", value_parser = integrator)]
    integrator: Integrator,
    /// Refuse the job where something is odd: every warning, or those of codes with commas between.
    #[arg(long, value_name = "CODES", num_args = 0..=1, require_equals = true, default_missing_value = "")]
    strict: Option<String>,
    /// Gauss-Newton steps in place of Levenberg-Marquardt.
    #[arg(long)]
    gauss_newton: bool,
    /// Where output error starts from: automatic, document, equation_error, nelder_mead[:SIMULATIONS], multi_start[:STARTS]
    /// or multiple_shooting[:SECONDS].
    #[arg(long, value_name = "METHOD", default_value = "automatic", value_parser = start_method)]
    start_method: StartMethod,
    /// Noises of outputs are correlated: estimate all of R, and not its diagonal alone.
    #[arg(long)]
    full_noise: bool,
    /// For flight in turbulence: estimate process noise too, with a Kalman filter.
    #[arg(long)]
    filter_error: bool,
    /// The estimator by name: output_error, filter_error, equation_error, output_error_frequency or equation_error_frequency.
    /// The last two need --band.
    #[arg(long, value_name = "NAME", value_parser = estimator, conflicts_with = "filter_error")]
    estimator: Option<Estimator>,
    /// The band of frequencies of an estimator of the frequency domain, Hz: 0.1-1.5. Alone it asks for output_error_frequency.
    #[arg(long, value_name = "FROM-TO", value_parser = band, conflicts_with = "filter_error")]
    band: Option<[f64; 2]>,
    /// 95 % confidence intervals by refits, side by side with the error bounds: all methods, or some with their settings:
    /// bootstrap[:COUNT], block:SAMPLES, profile[:NAME+NAME...], monte_carlo[:COUNT], seed:NUMBER, with commas between.
    #[arg(long, value_name = "METHODS", num_args = 0..=1, require_equals = true, default_missing_value = "", value_parser = interval_options)]
    intervals: Option<IntervalOptions>,
    /// Stop when a step is shorter than this many standard errors.
    #[arg(long, default_value_t = Options::default().tolerance)]
    pub tolerance: f64,
    /// forward_sensitivities, forward_difference, central_difference, complex_step or adjoint.
    #[arg(long, value_name = "TECHNIQUE", default_value = Options::default().derivatives.name())]
    derivatives: String,
    #[arg(long, default_value_t = Options::default().max_iterations)]
    max_iterations: usize,
}

impl Request {
    /// All recordings: those to fit, then those to predict.
    pub(super) fn file_rows(&self) -> impl Iterator<Item = &FileRows> {
        self.files.iter().chain(&self.validate).chain(&self.last)
    }

    /// The band of frequencies that was asked for, Hz.
    pub(super) fn band(&self) -> Option<[f64; 2]> {
        self.band
    }

    /// Options of an estimation's solver, where a command has no use for them.
    ///
    /// # Errors
    /// One is given.
    pub(super) fn refuse_solver(&self, command: &str) -> Result<(), Failure> {
        let usual = Options::default();
        let given = [
            ("--gauss-newton", self.gauss_newton),
            ("--start-method", self.start_method != usual.start),
            ("--full-noise", self.full_noise),
            ("--filter-error", self.filter_error),
            ("--estimator", self.estimator.is_some()),
            ("--intervals", self.intervals.is_some()),
            ("--tolerance", self.tolerance != usual.tolerance),
            (
                "--derivatives",
                self.derivatives != usual.derivatives.name(),
            ),
            (
                "--max-iterations",
                self.max_iterations != usual.max_iterations,
            ),
        ];
        match given.into_iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => Err(Failure::new(format!(
                "{option} is of an estimation's solver, which {command} has no use for: leave it out"
            ))),
            None => Ok(()),
        }
    }

    /// The file of each recording, once where several rows of it are used.
    pub(super) fn files(&self) -> IndexSet<&Path> {
        self.file_rows().map(|rows| rows.file.as_path()).collect()
    }

    /// The recording of each.
    pub(super) fn recordings(&self) -> Result<Vec<Arc<Maneuver>>, Failure> {
        let mapping = self.mapping.read()?;
        let read = |file: &Path| read_recording(file, mapping.as_ref()).map(Arc::new);
        let files = self.files().into_iter().map(|file| Ok((file, read(file)?)));
        let files: IndexMap<&Path, Arc<Maneuver>> = files.collect::<Result<_, Failure>>()?;
        let of = |rows: &FileRows| files[rows.file.as_path()].clone();
        Ok(self.file_rows().map(of).collect())
    }

    /// The model: a name that the catalog (or the server) knows, or the document in a file.
    pub(super) fn model(&self) -> Result<ModelSource, Failure> {
        Ok(match in_file(Path::new(&self.model))? {
            Some(document) => ModelSource::Document(Box::new(document)),
            None => ModelSource::Reference(self.model.clone()),
        })
    }

    /// The document that `model` stands for here, without a server.
    pub(super) fn document(&self) -> Result<ModelDocument, Failure> {
        document(&self.model, None)
    }

    fn derivatives(&self) -> Result<Derivatives, Failure> {
        let of_this_name = |technique: &Derivatives| technique.name() == self.derivatives;
        let found = Derivatives::all().into_iter().find(of_this_name);
        found.ok_or_else(|| {
            let known = Derivatives::all().map(|technique| technique.name());
            let name = &self.derivatives;
            Failure::new(format!(
                "there is no technique '{name}'; choose one of {}",
                known.join(", ")
            ))
        })
    }

    /// The job, ready to be run here.
    pub(super) fn plan(&self, kind: JobKind) -> Result<Plan, Failure> {
        let maneuvers = self.recordings()?;
        let ids: Vec<String> = maneuvers.iter().map(|maneuver| maneuver.digest()).collect();
        let spec = JobSpec {
            kind,
            ..self.spec(&ids)?
        };
        job::prepare(&spec, &self.document()?, &maneuvers)
            .map_err(|faults| Failure::faults("the job cannot start", &faults))
    }

    /// The job, for recordings that are known by `ids`.
    pub(super) fn spec(&self, ids: &[String]) -> Result<JobSpec, Failure> {
        let (mut channels, mut constants) = (IndexMap::new(), IndexMap::new());
        for text in &self.channels {
            let (name, formula) = pair(text, "--channel")?;
            let before = channels.insert(name.to_string(), formula.to_string());
            once("--channel", name, before.is_some())?;
        }
        for text in &self.constants {
            let (name, value) = pair(text, "--constant")?;
            let value = match (value.parse::<f64>(), value.starts_with("recording.")) {
                (Ok(number), _) => ConstantValue::Number(number),
                (Err(_), true) => ConstantValue::Recording(value.to_string()),
                (Err(_), false) => {
                    let message = format!(
                        "--constant '{text}': '{value}' is not a number, nor recording.mass or the like"
                    );
                    return Err(Failure::new(message));
                }
            };
            let before = constants.insert(name.to_string(), value);
            once("--constant", name, before.is_some())?;
        }
        let fitted = self.files.iter().map(|file| (file, Role::Estimation));
        let predicted = self.validate.iter().map(|file| (file, Role::Validation));
        let last = self.last.iter().map(|file| (file, Role::Final));
        let gaps = if self.join { Gaps::Join } else { self.gaps };
        let usage = |(id, (used, role)): (&String, (&FileRows, Role))| ManeuverUse {
            label: used.label(),
            rows: used.rows,
            seconds: used.seconds,
            gaps,
            ..ManeuverUse::new(id.clone(), role)
        };
        Ok(JobSpec {
            kind: JobKind::Estimate,
            name: String::new(),
            tags: Vec::new(),
            priority: 0,
            model: self.model()?,
            edits: self.changes.edits.clone(),
            maneuvers: ids
                .iter()
                .zip(fitted.chain(predicted).chain(last))
                .map(usage)
                .collect(),
            channels,
            parameters: self.changes.parameters()?,
            candidates: Vec::new(),
            structure: None,
            knowledge: Default::default(),
            constants,
            options: Options {
                method: if self.gauss_newton {
                    Method::GaussNewton
                } else {
                    Method::LevenbergMarquardt
                },
                estimator: match (self.filter_error, self.estimator, self.band) {
                    (true, ..) => Estimator::FilterError,
                    (false, Some(estimator), _) => estimator,
                    (false, None, Some(_)) => Estimator::OutputErrorFrequency,
                    (false, None, None) => Estimator::OutputError,
                },
                start: self.start_method.clone(),
                noise: Noise::Estimated {
                    structure: match self.full_noise {
                        true => NoiseStructure::Full,
                        false => NoiseStructure::Diagonal,
                    },
                },
                confidence_intervals: self.intervals.clone(),
                frequency: self.band.map(FrequencyOptions::of_band),
                tolerance: self.tolerance,
                max_iterations: self.max_iterations,
                derivatives: self.derivatives()?,
                integrator: self.integrator,
                input_interpolation: match self.hold {
                    true => InputInterpolation::Hold,
                    false => InputInterpolation::default(),
                },
                ..Options::default()
            },
            strict: match self.strict.as_deref() {
                None => Strict::default(),
                Some("") => Strict::All(true),
                Some(codes) => Strict::Codes(
                    codes
                        .split(',')
                        .map(|code| code.trim().to_string())
                        .collect(),
                ),
            },
        })
    }
}

fn gaps(name: &str) -> Result<Gaps, String> {
    let names = || Gaps::ALL.map(Gaps::name).join(", ");
    let found = Gaps::ALL.into_iter().find(|gaps| gaps.name() == name);
    found.ok_or_else(|| format!("choose one of {}", names()))
}

fn estimator(text: &str) -> Result<Estimator, String> {
    let all = Estimator::ALL;
    let found = all.iter().copied().find(|known| known.name() == text);
    found.ok_or_else(|| {
        let names: Vec<&str> = all.iter().map(|known| known.name()).collect();
        format!("one of {}", names.join(", "))
    })
}

pub(super) fn band(text: &str) -> Result<[f64; 2], String> {
    let wrong = || "two frequencies in Hz, as 0.1-1.5".to_string();
    let (from, to) = text.split_once('-').ok_or_else(wrong)?;
    let number = |text: &str| text.trim().parse::<f64>().map_err(|_| wrong());
    Ok([number(from)?, number(to)?])
}

fn integrator(name: &str) -> Result<Integrator, String> {
    match name {
        "euler" => Ok(Integrator::Euler),
        "rk2" => Ok(Integrator::Rk2),
        "rk4" => Ok(Integrator::Rk4),
        _ => Err("choose one of euler, rk2, rk4".to_string()),
    }
}
