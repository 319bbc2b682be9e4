//! Transfer functions: gain, zeros, poles and delay, as a report.

use num_complex::Complex64;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::channel::Channel;
use super::linearisation::Linearisation;
use super::polynomial::from_roots;
use super::root::{FoundRoot, nearest};
use crate::estimate::{Measure, root};

/// Largest standard error of a root, relative to its distance from the next one, at which the delta method holds.
const NEAR: f64 = 0.1;

/// From one input to one output, SI: e^(−delay s) gain Π(s − zero)/Π(s − pole), besides lags of the signals. States between
/// which and the input or the output there is no way are left out.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct TransferFunction {
    /// The input.
    #[schema(example = "de")]
    pub input: String,
    /// The output.
    #[schema(example = "q")]
    pub output: String,
    /// The coefficient of the numerator's highest power; the denominator's is one.
    pub gain: Measure,
    /// H(0), where it is finite.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub static_gain: Option<Measure>,
    /// Of a pair the one above the real axis.
    pub zeros: Vec<Root>,
    /// Of a pair the one above the real axis.
    pub poles: Vec<Root>,
    /// Coefficients, highest power first.
    #[schema(example = json!([-5.2, -3.6]))]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub numerator: Vec<f64>,
    /// Coefficients, highest power first, the first is one.
    #[schema(example = json!([1.0, 1.67, 4.0]))]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub denominator: Vec<f64>,
    /// Of input and output together, s.
    pub delay: Measure,
}

/// A pole or zero: real, or a pair.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Root {
    /// 1/s
    pub real: Measure,
    /// rad/s; zero of a real one.
    pub imaginary: Measure,
}

impl std::fmt::Display for Root {
    /// For a table: `-0.83 ± 1.82i`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&root(self.real.value, self.imaginary.value))
    }
}

/// All of a linear system, by input, then output; those that are zero are left out.
pub(super) fn transfer_functions(linear: &Linearisation<'_>) -> Vec<TransferFunction> {
    let outputs = || 0..linear.outputs.len();
    let pairs = (0..linear.inputs.len()).flat_map(|i| outputs().map(move |o| (i, o)));
    pairs
        .filter_map(|(input, output)| Channel::of(linear, input, output))
        .map(|channel| transfer_function(&channel))
        .collect()
}

fn transfer_function(channel: &Channel<'_>) -> TransferFunction {
    let linear = channel.linear;
    let values = |roots: &[FoundRoot]| roots.iter().map(|root| root.value).collect::<Vec<_>>();
    let numerator = from_roots(&values(&channel.zeros));
    TransferFunction {
        input: channel.input.name.clone(),
        output: channel.output.name.clone(),
        gain: Measure {
            value: channel.gain,
            standard_error: linear.estimated.standard_error(&channel.gain_derivatives),
        },
        static_gain: static_gain(channel),
        zeros: roots(channel, &channel.zeros),
        poles: roots(channel, &channel.poles),
        numerator: numerator.iter().map(|c| c * channel.gain).collect(),
        denominator: from_roots(&values(&channel.poles)),
        delay: Measure {
            value: channel.delay(),
            standard_error: linear.standard_error(|by| channel.delay_by(by)),
        },
    }
}

fn static_gain(channel: &Channel<'_>) -> Option<Measure> {
    let (value, slopes) = channel.static_response()?;
    Some(Measure {
        value,
        standard_error: channel.linear.estimated.standard_error(&slopes),
    })
}

/// Fastest first.
fn roots(channel: &Channel<'_>, found: &[FoundRoot]) -> Vec<Root> {
    let mut all: Vec<(f64, Root)> = (found.iter().enumerate())
        .filter(|(_, root)| root.value.im >= 0.0)
        .map(|(index, root)| {
            (
                root.value.norm(),
                report(channel, root, nearest(found, index)),
            )
        })
        .collect();
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    all.into_iter().map(|(_, root)| root).collect()
}

fn report(channel: &Channel<'_>, root: &FoundRoot, nearest: f64) -> Root {
    let error = |of: fn(&Complex64) -> f64| {
        if root.derivatives.is_empty() {
            return None;
        }
        let slopes: Vec<f64> = root.derivatives.iter().map(of).collect();
        channel.linear.estimated.standard_error(&slopes)
    };
    let (real, imaginary) = (error(|z| z.re), error(|z| z.im));
    let is_apart = |(a, b): (f64, f64)| a.hypot(b) <= NEAR * nearest;
    let is_told = real.zip(imaginary).is_some_and(is_apart);
    let oscillates = root.value.im > 0.0;
    Root {
        real: Measure {
            value: root.value.re,
            standard_error: real.filter(|_| is_told),
        },
        imaginary: Measure {
            value: root.value.im,
            standard_error: match oscillates {
                true => imaginary.filter(|_| is_told),
                false => Some(0.0).filter(|_| is_told),
            },
        },
    }
}
