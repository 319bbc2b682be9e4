//! `trimtab track`: estimates as they would have been in flight, sample by sample.

use indexmap::IndexMap;

use super::Failure;
use super::notes;
use super::pairs::{once, pair};
use super::request::Request;
use super::table::bordered;
use crate::estimate::{Estimator, FrequencyOptions};
use crate::flight::{Unit, with_error};
use crate::job::{self, JobSpec};
use crate::model::Model;
use crate::recursive::{Estimates, Sample, Setup, Tracker, TrackingMethod, TrackingOptions};
use crate::simulate::Segment;

/// Follows the parameters of a model through a recording, sample by sample, as in flight.
#[derive(clap::Args, Debug)]
pub(super) struct Track {
    #[command(flatten)]
    request: Request,
    /// rls: recursive least squares of the state equations; rft: recursive Fourier-transform regression over --band; ekf: extended
    /// Kalman filter, which needs --noise.
    #[arg(long, value_name = "METHOD", value_parser = method)]
    method: TrackingMethod,
    /// The share of its weight that a sample keeps from one to the next; 1 forgets nothing.
    #[arg(long, value_name = "SHARE", default_value_t = 1.0)]
    forgetting: f64,
    /// rls: half the width of the smoothing window, in samples.
    #[arg(long, value_name = "SAMPLES", default_value_t = TrackingOptions::HALF_WIDTH)]
    half_width: usize,
    /// rft: from one frequency of --band to the next, Hz.
    #[arg(long, value_name = "HZ", default_value_t = TrackingOptions::STEP_HZ)]
    frequency_step: f64,
    /// ekf: standard deviation of the noise of an output, in its unit or in one that follows: alpha=0.05deg.
    #[arg(long, value_name = "NAME=NUMBER[UNIT]", value_delimiter = ',')]
    noise: Vec<String>,
    /// ekf: intensity of the process noise of a state, in its unit per root of a second.
    #[arg(long, value_name = "NAME=NUMBER[UNIT]", value_delimiter = ',')]
    process_noise: Vec<String>,
    /// ekf: how fast a parameter may wander, in its unit per root of a second.
    #[arg(long, value_name = "NAME=NUMBER[UNIT]", value_delimiter = ',')]
    drift: Vec<String>,
    /// ekf: standard deviation of a parameter's start value, or of an initial state.
    #[arg(long, value_name = "NAME=NUMBER[UNIT]", value_delimiter = ',')]
    uncertainty: Vec<String>,
    /// Seconds from one line to the next [default: a tenth of the recording; with --csv each sample].
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    every: Option<f64>,
    /// Print CSV: time, and each parameter with its standard error.
    #[arg(long)]
    csv: bool,
}

fn method(text: &str) -> Result<TrackingMethod, String> {
    let mut all = TrackingMethod::ALL.into_iter();
    all.find(|method| method.name() == text).ok_or_else(|| {
        let names = TrackingMethod::ALL.map(TrackingMethod::name);
        format!("choose one of {}", names.join(", "))
    })
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds > 0.0 && seconds.is_finite() => Ok(seconds),
        _ => Err("seconds are a number above 0".to_string()),
    }
}

impl Track {
    pub(super) fn run(&self) -> Result<(), Failure> {
        if !self.request.validate.is_empty() || !self.request.last.is_empty() {
            let message = "--validate and --final are for estimations: what is followed sample by sample is predicted all the time";
            return Err(Failure::new(message));
        }
        self.request.refuse_solver("track")?;
        let frequency = self.request.band().map(|band| FrequencyOptions {
            step_hz: Some(self.frequency_step),
            ..FrequencyOptions::of_band(band)
        });
        let mut options = TrackingOptions {
            forgetting: self.forgetting,
            half_width: self.half_width,
            frequency,
            ..TrackingOptions::new(self.method)
        };
        refuse(&options.faults())?;
        let setup_and_data = self.plan(frequency)?;
        let segments = &setup_and_data.problem.segments;
        let [segment] = segments.as_slice() else {
            return Err(Failure::new(format!(
                "one recording without gaps is followed, and these are {} parts; choose one, as FILE:2s-32.5s, or --gaps through",
                segments.len()
            )));
        };
        notes::say(&setup_and_data.prepared.findings);
        let setup = Setup::of_problem(&setup_and_data.problem)
            .ok_or_else(|| Failure::new("there is no sample to follow"))?;
        self.sizes(&setup.model, &mut options)?;
        let mut tracker = Tracker::new(&setup, &options)
            .map_err(|faults| Failure::faults("this cannot be followed", &Vec::from(faults)))?;
        let lines = self.follow(&mut tracker, segment)?;
        if self.method == TrackingMethod::Ekf {
            say_far(&setup, &tracker);
        }
        println!(
            "{}",
            if self.csv {
                csv(&tracker, &lines)
            } else {
                table(&tracker, &lines)
            }
        );
        Ok(())
    }

    /// Model, start values and samples, as an estimation would have them.
    fn plan(&self, frequency: Option<FrequencyOptions>) -> Result<job::Plan, Failure> {
        let maneuvers = self.request.recordings()?;
        let ids: Vec<String> = maneuvers.iter().map(|maneuver| maneuver.digest()).collect();
        let mut spec: JobSpec = self.request.spec(&ids)?;
        (spec.options.estimator, spec.options.frequency) = match self.method {
            TrackingMethod::Rls => (Estimator::EquationError, None),
            TrackingMethod::Rft => (Estimator::EquationErrorFrequency, frequency),
            TrackingMethod::Ekf => (Estimator::OutputError, None),
        };
        job::prepare(&spec, &self.request.document()?, &maneuvers)
            .map_err(|faults| Failure::faults("this cannot be followed", &Vec::from(faults)))
    }

    fn sizes(&self, model: &Model, options: &mut TrackingOptions) -> Result<(), Failure> {
        let states = || {
            model
                .states
                .iter()
                .map(|state| (state.name.as_str(), state.unit))
        };
        let parameters = || model.parameters.iter().map(|p| (p.name.as_str(), p.unit));
        let outputs = model.outputs.iter();
        let outputs: Vec<(&str, Unit)> = outputs
            .map(|output| (output.name.as_str(), output.unit))
            .collect();
        options.noise = sizes("--noise", &self.noise, &outputs)?;
        let known: Vec<(&str, Unit)> = states().collect();
        options.process_noise = sizes("--process-noise", &self.process_noise, &known)?;
        let known: Vec<(&str, Unit)> = parameters().collect();
        options.drift = sizes("--drift", &self.drift, &known)?;
        let known: Vec<(&str, Unit)> = parameters().chain(states()).collect();
        options.uncertainty = sizes("--uncertainty", &self.uncertainty, &known)?;
        refuse(&options.faults())
    }

    /// The estimates that are printed: as often as asked for, and the last.
    fn follow(&self, tracker: &mut Tracker, segment: &Segment) -> Result<Vec<Estimates>, Failure> {
        let (Some(&first), Some(&last)) = (segment.time.first(), segment.time.last()) else {
            return Ok(Vec::new());
        };
        let every = match (self.every, self.csv) {
            (Some(every), _) => every,
            (None, true) => 0.0,
            (None, false) => (last - first) / 10.0,
        };
        let mut lines = Vec::new();
        let mut next = first + every;
        let (mut inputs, mut outputs) = (Vec::new(), Vec::new());
        for (k, &time) in segment.time.iter().enumerate() {
            copy(&segment.inputs, k, &mut inputs);
            copy(&segment.measured, k, &mut outputs);
            let sample = Sample {
                time,
                inputs: &inputs,
                outputs: &outputs,
            };
            let found = tracker
                .push(&sample)
                .map_err(|fault| Failure::new(format!("sample {}, at {time} s: {fault}", k + 1)))?;
            // a tick that rounding has moved behind its sample is of this sample
            if found.time.is_finite() && time >= next - 1e-9 * every && time < last {
                lines.push(found.clone());
                while next <= time && every > 0.0 {
                    next += every;
                }
            }
        }
        lines.push(tracker.finish().clone());
        Ok(lines)
    }
}

/// A share of an estimate that is far from where a filter may start and be trusted.
const FAR: f64 = 0.25;

/// Bounds of a filter that has come from far are too small.
fn say_far(setup: &Setup, tracker: &Tracker) {
    let values = tracker.parameters().iter().zip(&tracker.estimates().values);
    let start = |name: &str| {
        let place = setup.model.parameters.iter().position(|p| p.name == name)?;
        Some(
            setup.model.parameters[place]
                .unit
                .from_si(setup.start[place]),
        )
    };
    let is_far = |name: &str, value: f64| {
        start(name).is_some_and(|start| (value - start).abs() > FAR * value.abs())
    };
    let far = values.filter(|(parameter, value)| is_far(&parameter.name, **value));
    let far: Vec<&str> = far.map(|(parameter, _)| parameter.name.as_str()).collect();
    if !far.is_empty() {
        eprintln!(
            "note: more than a quarter from where the filter started: {}; a filter linearises once, so that its bounds are too small; start nearer, or fit the recording",
            far.join(", ")
        );
    }
}

fn refuse(faults: &[crate::flight::Fault]) -> Result<(), Failure> {
    match faults {
        [] => Ok(()),
        faults => Err(Failure::faults("this cannot be followed", faults)),
    }
}

fn copy(series: &[Vec<f64>], k: usize, to: &mut Vec<f64>) {
    to.clear();
    to.extend(series.iter().map(|values| values[k]));
}

/// Numbers by name, each in the unit of the quantity that is called so, or in the one that follows it.
fn sizes(
    option: &str,
    texts: &[String],
    known: &[(&str, Unit)],
) -> Result<IndexMap<String, f64>, Failure> {
    let mut sizes = IndexMap::new();
    for text in texts {
        let (name, value) = pair(text, option)?;
        let Some((_, own)) = known.iter().find(|(known, _)| *known == name) else {
            let names: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
            let message = format!(
                "{option} '{text}': the model has no {name} here; it has {}",
                names.join(", ")
            );
            return Err(Failure::new(message));
        };
        let size =
            size(value, *own).map_err(|why| Failure::new(format!("{option} '{text}': {why}")))?;
        once(option, name, sizes.insert(name.to_string(), size).is_some())?;
    }
    Ok(sizes)
}

/// `0.05`, or `0.05deg`, in the unit `own`.
fn size(text: &str, own: Unit) -> Result<f64, String> {
    // the longest beginning that is a number: 0.05 of 0.05deg, 1e-3 of 1e-3 rad
    let ends = (1..=text.len())
        .rev()
        .filter(|&end| text.is_char_boundary(end));
    let mut numbers =
        ends.filter_map(|end| Some((text[..end].trim().parse::<f64>().ok()?, text[end..].trim())));
    let (number, unit) = numbers
        .next()
        .ok_or("it should be a number, with a unit behind it if wanted")?;
    if unit.is_empty() {
        return Ok(number);
    }
    let given = Unit::parse(unit).map_err(|error| error.to_string())?;
    match given.dimension == own.dimension {
        true => Ok(number * given.scale / own.scale),
        false => Err(format!(
            "{} where the model has {}",
            given.dimension, own.dimension
        )),
    }
}

fn table(tracker: &Tracker, lines: &[Estimates]) -> String {
    let titles = tracker.parameters().iter().map(|p| match p.unit.as_str() {
        "" => p.name.clone(),
        unit => format!("{}, {unit}", p.name),
    });
    let titles: Vec<String> = std::iter::once("t, s".to_string()).chain(titles).collect();
    let rows = lines.iter().map(|line| {
        let both = line.values.iter().zip(&line.standard_errors);
        let numbers = both.map(|(value, error)| match value.is_finite() {
            true => with_error(*value, *error),
            false => "-".to_string(),
        });
        let time = if line.time.is_finite() {
            format!("{:.2}", line.time)
        } else {
            "-".to_string()
        };
        std::iter::once(time).chain(numbers).collect()
    });
    bordered(titles.iter().map(String::as_str), rows, 0..titles.len())
}

fn csv(tracker: &Tracker, lines: &[Estimates]) -> String {
    let titles = tracker.parameters().iter().map(|p| {
        let unit = if p.unit.is_empty() { "-" } else { &p.unit };
        format!("{name}[{unit}],{name}_error[{unit}]", name = p.name)
    });
    let mut text: Vec<String> = vec![
        std::iter::once("t[s]".to_string())
            .chain(titles)
            .collect::<Vec<_>>()
            .join(","),
    ];
    let cell = |value: f64| {
        if value.is_finite() {
            value.to_string()
        } else {
            String::new()
        }
    };
    for line in lines.iter().filter(|line| line.time.is_finite()) {
        let both = line.values.iter().zip(&line.standard_errors);
        let cells = both.flat_map(|(value, error)| [cell(*value), cell(*error)]);
        let cells: Vec<String> = std::iter::once(line.time.to_string())
            .chain(cells)
            .collect();
        text.push(cells.join(","));
    }
    text.join("\n")
}
