//! What of a recording is looked at: its signals along stretches without gaps, or why they have no responses.

use super::options::ResponseOptions;
use crate::flight::{Fault, Maneuver};

/// The signals of a recording that were asked for.
pub(super) struct Record {
    /// By stretch, then signal, inputs first: SI.
    pub stretches: Vec<Vec<Vec<f64>>>,
    /// Of the samples, s.
    pub step: f64,
    /// Samples of the longest stretch.
    pub longest: usize,
}

impl Record {
    /// # Errors
    /// An option is out of range; a channel is not there, stands still, or is named twice; steps are not even.
    pub(super) fn of(maneuver: &Maneuver, options: &ResponseOptions) -> Result<Self, Vec<Fault>> {
        if let Some((field, message)) = options.fault() {
            return Err(vec![fault(field, "bad_option", message)]);
        }
        let names: Vec<&String> = options.inputs.iter().chain(&options.outputs).collect();
        check_channels(maneuver, &names, options.inputs.len()).map_err(|fault| vec![fault])?;
        let sampling = maneuver.sampling();
        if !sampling.even {
            let message = "the recording is sampled unevenly, and windows need even steps; upload it evenly sampled";
            return Err(vec![fault(
                "inputs",
                "uneven_sampling",
                message.to_string(),
            )]);
        }
        let step = sampling.step;
        if options.band_hz[1] > 0.5 / step {
            let message = format!(
                "samples are {step} s apart, which tells of frequencies up to {:.4} Hz",
                0.5 / step
            );
            return Err(vec![fault("band_hz", "bad_option", message)]);
        }
        let segments = sampling.segments();
        let along = |rows: &std::ops::Range<usize>| -> Vec<Vec<f64>> {
            let samples = |name: &&String| maneuver.channels()[*name].values[rows.clone()].to_vec();
            names.iter().map(samples).collect()
        };
        Ok(Self {
            stretches: segments.iter().map(along).collect(),
            step,
            longest: segments
                .iter()
                .map(ExactSizeIterator::len)
                .max()
                .unwrap_or(0),
        })
    }
}

fn fault(field: &str, code: &'static str, message: String) -> Fault {
    Fault::new(format!("/{field}"), code, message)
}

/// Whether all channels are there, each named once and moving; the first `inputs` are inputs.
fn check_channels(maneuver: &Maneuver, names: &[&String], inputs: usize) -> Result<(), Fault> {
    for (place, name) in names.iter().enumerate() {
        let field = if place < inputs { "inputs" } else { "outputs" };
        let Some(channel) = maneuver.channels().get(*name) else {
            let all: Vec<&str> = maneuver.channels().keys().map(String::as_str).collect();
            let message = format!("there is no channel '{name}'; there are {}", all.join(", "));
            return Err(fault(field, "unknown_channel", message));
        };
        if names[..place].contains(name) {
            let message = format!("'{name}' is named twice");
            return Err(fault(field, "bad_option", message));
        }
        let mut there = channel.values.iter().filter(|value| value.is_finite());
        let first = there.next();
        if there.all(|value| Some(value) == first) {
            let message = format!(
                "'{name}' has one value throughout, or none, so that it has no response; leave it out"
            );
            return Err(fault(field, "no_response", message));
        }
    }
    Ok(())
}
