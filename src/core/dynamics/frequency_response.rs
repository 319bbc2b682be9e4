//! Frequency responses: magnitude and phase with standard errors, as a report.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::channel::{Channel, Response};
use super::linearisation::Linearisation;
use super::no_linear_system::NoLinearSystem;
use crate::estimate::{Estimate, Problem};

/// Decibels of a natural logarithm.
pub(super) const DECIBELS: f64 = 20.0 / std::f64::consts::LN_10;

/// Frequencies of one response, at most.
const MOST_FREQUENCIES: usize = 10_000;
/// Frequencies of all responses together, at most.
const MOST_IN_ALL: usize = 1_000_000;
/// Where nobody says otherwise.
const FREQUENCIES: usize = 100;
/// Beyond the slowest and the fastest pole, where nobody says otherwise.
const BEYOND: f64 = 10.0;
/// Poles outside of this range, rad/s, do not count for the range of frequencies.
const OF_INTEREST: (f64, f64) = (1e-3, 1e3);

/// In what frequencies are counted.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
pub enum FrequencyUnit {
    /// Radians per second.
    #[default]
    #[serde(rename = "rad/s")]
    RadiansPerSecond,
    /// Cycles per second.
    #[serde(rename = "Hz")]
    Hertz,
}

impl FrequencyUnit {
    /// As it is written.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::RadiansPerSecond => "rad/s",
            Self::Hertz => "Hz",
        }
    }

    /// Of one of this unit, rad/s.
    fn scale(self) -> f64 {
        match self {
            Self::RadiansPerSecond => 1.0,
            Self::Hertz => std::f64::consts::TAU,
        }
    }
}

/// What frequency responses are wanted.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct FrequencyQuestion {
    /// The segment at whose start the model is linearised; the first where absent.
    pub segment: Option<String>,
    /// One input; all where absent.
    pub input: Option<String>,
    /// One output; all where absent.
    pub output: Option<String>,
    /// In what `from`, `to` and the answer are.
    pub unit: FrequencyUnit,
    /// The lowest frequency, above 0.
    pub from: Option<f64>,
    /// The highest.
    pub to: Option<f64>,
    /// How many, evenly spaced on a logarithmic scale.
    pub points: Option<usize>,
}

/// How an output responds to an input that swings, at some frequencies. Delays and lags of both signals are in it; play and rate
/// limits are not, as no linear system has them (see the remarks of the linear system).
///
/// A band of 2 standard errors holds the truth in 95 of 100 flights. They are those that the covariance of the parameters
/// carries over, and empty where the response depends on a parameter that has none.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct FrequencyResponse {
    /// The input.
    #[schema(example = "de")]
    pub input: String,
    /// The output.
    #[schema(example = "q")]
    pub output: String,
    /// What a magnitude of 0 dB is one of: the output's SI unit over the input's.
    #[schema(example = "(rad/s)/rad")]
    pub unit: String,
    /// In what frequencies are.
    pub frequency_unit: FrequencyUnit,
    /// Evenly spaced on a logarithmic scale.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub frequency: Vec<f64>,
    /// 20 log10 |H|
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub magnitude_db: Vec<f64>,
    /// One standard error of `magnitude_db`.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub magnitude_db_standard_error: Vec<f64>,
    /// arg H, degrees, continuous over all frequencies.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub phase_deg: Vec<f64>,
    /// One standard error of `phase_deg`.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub phase_deg_standard_error: Vec<f64>,
}

/// The responses of an estimate's linear system, by input, then output; those that are zero are left out.
///
/// # Errors
/// A name that the model does not have, frequencies that cannot be, or a derivative that is not finite.
pub fn frequency_responses(
    problem: &Problem,
    estimate: &Estimate,
    question: &FrequencyQuestion,
) -> Result<Vec<FrequencyResponse>, NoLinearSystem> {
    let linear = Linearisation::at(problem, estimate, question.segment.as_deref())?;
    if linear.inputs.is_empty() {
        return Err(NoLinearSystem::NoInputs);
    }
    let chosen = |signals, what, name: &Option<String>, all: usize| match name {
        Some(name) => Linearisation::find(signals, what, name).map(|place| vec![place]),
        None => Ok((0..all).collect()),
    };
    let inputs = chosen(
        &linear.inputs,
        "input",
        &question.input,
        linear.inputs.len(),
    )?;
    let outputs = chosen(
        &linear.outputs,
        "output",
        &question.output,
        linear.outputs.len(),
    )?;
    let pairs = (inputs.iter()).flat_map(|&i| outputs.iter().map(move |&o| (i, o)));
    let channels: Vec<Channel<'_>> = pairs
        .filter_map(|(input, output)| Channel::of(&linear, input, output))
        .collect();
    let omegas = frequencies(question, &channels)?;
    Ok(channels
        .iter()
        .map(|channel| response(channel, &omegas, question.unit))
        .collect())
}

fn response(channel: &Channel<'_>, omegas: &[f64], unit: FrequencyUnit) -> FrequencyResponse {
    let mut response = FrequencyResponse {
        input: channel.input.name.clone(),
        output: channel.output.name.clone(),
        unit: format!("({})/{}", channel.output.unit, channel.input.unit),
        frequency_unit: unit,
        frequency: Vec::new(),
        magnitude_db: Vec::new(),
        magnitude_db_standard_error: Vec::new(),
        phase_deg: Vec::new(),
        phase_deg_standard_error: Vec::new(),
    };
    let mut is_told = true;
    for &omega in omegas {
        // on a zero or a pole of the axis there is no magnitude
        let Some(at) = channel.response(omega) else {
            continue;
        };
        response.frequency.push(omega / unit.scale());
        response.magnitude_db.push(DECIBELS * at.value.re);
        response.phase_deg.push(at.value.im.to_degrees());
        let [magnitude, phase] = errors(channel, &at);
        is_told &= magnitude.is_some() && phase.is_some();
        (response.magnitude_db_standard_error).push(DECIBELS * magnitude.unwrap_or_default());
        (response.phase_deg_standard_error).push(phase.unwrap_or_default().to_degrees());
    }
    if !is_told {
        response.magnitude_db_standard_error.clear();
        response.phase_deg_standard_error.clear();
    }
    response
}

/// Standard errors of ln |H| and arg H.
fn errors(channel: &Channel<'_>, at: &Response) -> [Option<f64>; 2] {
    let real: Vec<f64> = at.derivatives.iter().map(|z| z.re).collect();
    let imaginary: Vec<f64> = at.derivatives.iter().map(|z| z.im).collect();
    [real, imaginary].map(|slopes| channel.linear.estimated.standard_error(&slopes))
}

/// rad/s
fn frequencies(
    question: &FrequencyQuestion,
    channels: &[Channel<'_>],
) -> Result<Vec<f64>, NoLinearSystem> {
    let scale = question.unit.scale();
    let (slowest, fastest) = range_of_poles(channels);
    let from = question.from.map_or(slowest / BEYOND, |from| from * scale);
    let to = question.to.map_or(fastest * BEYOND, |to| to * scale);
    let points = question.points.unwrap_or(FREQUENCIES);
    let refuse = |why: String| Err(NoLinearSystem::Frequencies(why));
    // written so that NaN is refused
    if !(from > 0.0 && to.is_finite()) {
        return refuse("from, to: frequencies are above 0 and finite".to_string());
    }
    if from > to {
        let (from, to) = (from / scale, to / scale);
        return refuse(format!("from, to: {from} is above {to}; give both"));
    }
    if !(1..=MOST_FREQUENCIES).contains(&points) {
        return refuse(format!(
            "points: {points} is not between 1 and {MOST_FREQUENCIES}"
        ));
    }
    let responses = channels.len();
    if responses * points > MOST_IN_ALL {
        return refuse(format!(
            "points: {points} of each of {responses} responses are more than {MOST_IN_ALL}; ask for at most {}, or for one input or output",
            MOST_IN_ALL / responses
        ));
    }
    Ok(logarithmic(from, to, points))
}

/// Evenly spaced on a logarithmic scale, both ends among them.
pub(super) fn logarithmic(from: f64, to: f64, points: usize) -> Vec<f64> {
    let last = points.saturating_sub(1).max(1) as f64;
    let at = |k: usize| match k {
        0 => from,
        k if k + 1 == points => to,
        k => from * (to / from).powf(k as f64 / last),
    };
    (0..points).map(at).collect()
}

/// The slowest and the fastest pole, rad/s.
fn range_of_poles(channels: &[Channel<'_>]) -> (f64, f64) {
    let poles = channels.iter().flat_map(|channel| &channel.poles);
    let sizes = poles.map(|pole| pole.value.norm());
    let sizes = sizes.filter(|size| (OF_INTEREST.0..OF_INTEREST.1).contains(size));
    let (slowest, fastest) = sizes.fold((f64::INFINITY, 0.0_f64), |(low, high), size| {
        (low.min(size), high.max(size))
    });
    if slowest <= fastest {
        (slowest, fastest)
    } else {
        (1.0, 1.0)
    }
}
