//! A segment: one continuous stretch of a recording, ready to be simulated.

/// Inputs and measured outputs of one model over one continuous time history, SI.
#[derive(Clone, PartialEq, Debug)]
pub struct Segment {
    pub label: String,
    /// Recorded time of each sample, s.
    pub time: Vec<f64>,
    pub steps: Steps,
    /// By input, then by sample.
    pub inputs: Vec<Vec<f64>>,
    /// By output, then by sample.
    pub measured: Vec<Vec<f64>>,
}

/// The lengths of the integration steps, s.
#[derive(Clone, PartialEq, Debug)]
pub enum Steps {
    Even(f64),
    /// One step for each pair of neighbouring samples.
    Uneven(Vec<f64>),
}

impl Steps {
    /// Length of the step from sample `k` to the next.
    #[inline]
    pub fn length(&self, k: usize) -> f64 {
        match self {
            Self::Even(step) => *step,
            Self::Uneven(steps) => steps[k],
        }
    }
}

impl Segment {
    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }
}
