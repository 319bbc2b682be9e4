//! `trimtab response`: frequency responses of a recording, here and now.

use std::path::PathBuf;

use super::Failure;
use super::mapping::MappingOption;
use super::recording::read_recording;
use super::table::bordered;
use crate::estimate::five_digits;
use crate::response::{
    FrequencyResponse, FrequencyResponses, ResponseOptions, TransferFunctionOrder,
    frequency_responses,
};

/// Prints what outputs of a recording do to its inputs, frequency by frequency: no model is needed.
#[derive(clap::Args, Debug)]
pub(super) struct Response {
    /// A recording; what `fit` reads.
    file: PathBuf,
    #[command(flatten)]
    mapping: MappingOption,
    /// Channels that drive the motion, with commas between; each response is conditioned on the others.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', required = true)]
    inputs: Vec<String>,
    /// Channels that answer, with commas between.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', required = true)]
    outputs: Vec<String>,
    /// The band of frequencies, Hz: 0.1-2.
    #[arg(long, value_name = "FROM-TO", value_parser = super::request::band)]
    band: [f64; 2],
    /// How many frequencies.
    #[arg(long, default_value_t = 100)]
    points: usize,
    /// Lengths of windows, s, with commas between [default: five, from a fifth of the recording down].
    #[arg(long, value_name = "SECONDS", value_delimiter = ',')]
    windows: Vec<f64>,
    /// Fit a transfer function: orders of numerator and denominator, 1/2, and +delay for a delay: 1/2+delay.
    #[arg(long, value_name = "ORDERS", value_parser = order)]
    transfer_function: Option<TransferFunctionOrder>,
    /// Print the responses as JSON instead.
    #[arg(long)]
    json: bool,
}

fn order(text: &str) -> Result<TransferFunctionOrder, String> {
    let wrong = || "orders of numerator and denominator, as 1/2 or 1/2+delay".to_string();
    let (orders, delay) = match text.strip_suffix("+delay") {
        Some(orders) => (orders, true),
        None => (text, false),
    };
    let (numerator, denominator) = orders.split_once('/').ok_or_else(wrong)?;
    let number = |text: &str| text.trim().parse().map_err(|_| wrong());
    Ok(TransferFunctionOrder {
        numerator: number(numerator)?,
        denominator: number(denominator)?,
        delay,
    })
}

impl Response {
    pub(super) fn run(&self) -> Result<(), Failure> {
        let maneuver = read_recording(&self.file, self.mapping.read()?.as_ref())?;
        let options = ResponseOptions {
            inputs: self.inputs.clone(),
            outputs: self.outputs.clone(),
            band_hz: self.band,
            points: self.points,
            windows: self.windows.clone(),
            transfer_function: self.transfer_function,
        };
        let found = frequency_responses(&maneuver, &options)
            .map_err(|faults| Failure::faults("there is no response", &faults))?;
        if self.json {
            println!("{}", serde_json::to_string_pretty(&found)?);
            return Ok(());
        }
        for response in &found.responses {
            println!("{}", table(&found, response));
        }
        Ok(())
    }
}

fn table(all: &FrequencyResponses, response: &FrequencyResponse) -> String {
    let header = ["Hz", "|H|", "dB", "deg", "coherence", "random error"];
    let number = |value: Option<f64>| value.map_or_else(String::new, five_digits);
    let rows = all.frequency_hz.iter().enumerate().map(|(k, frequency)| {
        vec![
            format!("{frequency:.4}"),
            number(response.magnitude[k]),
            number(response.magnitude_db[k]),
            number(response.phase_deg[k]),
            number(response.coherence[k]),
            number(response.random_error[k]),
        ]
    });
    let mut text = format!(
        "{} by {}\n{}",
        response.output,
        response.input,
        bordered(header, rows, 0..6)
    );
    if let Some(bandwidth) = &response.bandwidth {
        text += &format!(
            "\nphase passes -180 deg at {} rad/s; bandwidth by phase {}, by gain {} rad/s; phase delay {} s",
            five_digits(bandwidth.crossing),
            bandwidth.phase.map_or("-".to_string(), five_digits),
            bandwidth.gain.map_or("-".to_string(), five_digits),
            bandwidth.phase_delay.map_or("-".to_string(), five_digits)
        );
    }
    if let Some(fit) = &response.transfer_function {
        let list = |values: &[f64]| -> String {
            values
                .iter()
                .map(|v| five_digits(*v))
                .collect::<Vec<_>>()
                .join(", ")
        };
        text += &format!(
            "\ntransfer function, from the constant on: ({}) / ({}), delay {} s; cost {:.2} at {} frequencies",
            list(&fit.numerator),
            list(&fit.denominator),
            five_digits(fit.delay),
            fit.cost,
            fit.points
        );
    }
    text
}
