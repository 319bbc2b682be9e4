//! What may be asked of a tracker.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::estimate::FrequencyOptions;
use crate::flight::Fault;

/// How estimates follow the data.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum TrackingMethod {
    /// Recursive least squares of the state equations, on smoothed and differentiated states.
    Rls,
    /// Recursive Fourier-transform regression: least squares of the transformed state equations over a band.
    Rft,
    /// Extended Kalman filter: states and parameters together.
    Ekf,
}

impl TrackingMethod {
    /// All of them, in the order of the help.
    pub const ALL: [Self; 3] = [Self::Rls, Self::Rft, Self::Ekf];

    /// As it is written.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rls => "rls",
            Self::Rft => "rft",
            Self::Ekf => "ekf",
        }
    }
}

/// How a tracker goes about it.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct TrackingOptions {
    /// The principle by which estimates follow the data.
    pub method: TrackingMethod,
    /// λ, the share of its weight that a sample keeps from one to the next: 1 forgets nothing, and 0.998 remembers some 500
    /// samples. With `ekf` the covariance grows by 1/λ from sample to sample.
    #[serde(default = "one")]
    #[schema(example = 0.998, exclusive_minimum = 0.0, maximum = 1.0)]
    pub forgetting: f64,
    /// Of `rls`: half the width, in samples, of the local cubics that smooth and differentiate. Estimates are late by as much.
    #[serde(default = "half_width")]
    #[schema(example = 4, minimum = 2, maximum = 64)]
    pub half_width: usize,
    /// Of `rft`: the band, and what is done about ends and drifts. Without `step_hz` frequencies are 0.04 Hz apart.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frequency: Option<FrequencyOptions>,
    /// Of `ekf`, by output: standard deviation of the measurement noise, in the output's unit. Each output needs one.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schema(example = json!({"alpha": 0.0009, "q": 0.0014}))]
    pub noise: IndexMap<String, f64>,
    /// Of `ekf`, by state: intensity of the process noise, in the state's unit per √s. A state that is not named is not disturbed.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub process_noise: IndexMap<String, f64>,
    /// Of `ekf`, by parameter: how fast it may wander, as the intensity of a random walk, in its unit per √s. One that is not named is constant.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub drift: IndexMap<String, f64>,
    /// Of `ekf`, by parameter or state: standard deviation of what it starts from, in its unit. A parameter that is not named has that
    /// of its prior, or else the size of its start value; an initial state that of the parameters it is made of.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub uncertainty: IndexMap<String, f64>,
}

fn one() -> f64 {
    1.0
}

fn half_width() -> usize {
    TrackingOptions::HALF_WIDTH
}

impl TrackingOptions {
    /// Half the width of a window, in samples, where nothing else is asked for.
    pub const HALF_WIDTH: usize = 4;
    /// The smallest and the largest that may be asked for.
    pub const HALF_WIDTHS: [usize; 2] = [2, 64];
    /// From one frequency of a band to the next, Hz, where nothing else is asked for.
    pub const STEP_HZ: f64 = 0.04;
    /// Most frequencies of a band.
    pub const MOST_FREQUENCIES: f64 = 500.0;

    /// A method with all else at its default.
    pub fn new(method: TrackingMethod) -> Self {
        Self {
            method,
            forgetting: 1.0,
            half_width: Self::HALF_WIDTH,
            frequency: None,
            noise: IndexMap::new(),
            process_noise: IndexMap::new(),
            drift: IndexMap::new(),
            uncertainty: IndexMap::new(),
        }
    }

    /// What is out of range, and what is said to a method that does not heed it.
    pub fn faults(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        let mut fault = |pointer: &str, message: String| {
            faults.push(Fault::new(pointer, "invalid_value", message));
        };
        if !(self.forgetting > 0.0 && self.forgetting <= 1.0) {
            let message =
                "forgetting must be above 0 and at most 1; 0.998 remembers some 500 samples";
            fault("/forgetting", message.to_string());
        }
        let [least, most] = Self::HALF_WIDTHS;
        if !(least..=most).contains(&self.half_width) {
            let message = format!("half_width must be {least} to {most} samples");
            fault("/half_width", message);
        }
        self.check_frequency(&mut fault);
        let sizes = [
            ("noise", &self.noise),
            ("process_noise", &self.process_noise),
            ("drift", &self.drift),
            ("uncertainty", &self.uncertainty),
        ];
        for (field, sizes) in sizes {
            if self.method != TrackingMethod::Ekf && !sizes.is_empty() {
                let message = format!(
                    "{} does not heed {field}; leave it out, or use ekf",
                    self.method.name()
                );
                fault(&format!("/{field}"), message);
            }
            let least_is_in = field != "noise";
            for (name, &size) in sizes {
                let fits = size.is_finite() && (size > 0.0 || least_is_in && size == 0.0);
                if !fits {
                    let least = if least_is_in { "0 or more" } else { "above 0" };
                    let message = format!("it is {size}; it must be a number, {least}");
                    fault(
                        &format!("/{field}/{}", crate::flight::escape(name)),
                        message,
                    );
                }
            }
        }
        faults
    }

    fn check_frequency(&self, fault: &mut impl FnMut(&str, String)) {
        match (self.method, &self.frequency) {
            (TrackingMethod::Rft, None) => {
                let message = "rft needs a band of frequencies, as {\"band_hz\": [0.1, 1.5]}";
                fault("/frequency", message.to_string());
            }
            (TrackingMethod::Rft, Some(frequency)) => {
                if let Some((field, message)) = frequency.fault() {
                    fault(&format!("/frequency/{field}"), message);
                    return;
                }
                let [from, to] = frequency.band_hz;
                let step = frequency.step_hz.unwrap_or(Self::STEP_HZ);
                if (to - from) / step > Self::MOST_FREQUENCIES {
                    let most = Self::MOST_FREQUENCIES;
                    let message = format!(
                        "a band of more than {most} frequencies; make it narrower, or step_hz larger"
                    );
                    fault("/frequency", message);
                }
            }
            (_, Some(_)) => {
                let message = format!(
                    "{} has no band of frequencies; leave it out, or use rft",
                    self.method.name()
                );
                fault("/frequency", message);
            }
            (_, None) => {}
        }
    }
}
