//! A segment: one continuous stretch of a recording, ready to be simulated.

/// Inputs and measured outputs of one model over one continuous time history, SI.
#[derive(Clone, PartialEq, Debug)]
pub struct Segment {
    /// What tables call it: the maneuver's label, with a number where gaps cut the maneuver.
    pub label: String,
    /// Recorded time of each sample, s.
    pub time: Vec<f64>,
    /// From each sample to the next.
    pub steps: Steps,
    /// By input, then by sample.
    pub inputs: Vec<Vec<f64>>,
    /// By output, then by sample.
    pub measured: Vec<Vec<f64>>,
}

/// The lengths of the integration steps, s.
#[derive(Clone, PartialEq, Debug)]
pub enum Steps {
    /// The same length everywhere.
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

    /// Whether it has no samples.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Seconds of simulated time from the first sample to each.
    pub fn elapsed(&self) -> Vec<f64> {
        let steps = (1..self.len()).map(|k| self.steps.length(k - 1));
        let sums = steps.scan(0.0, |sum, step| {
            *sum += step;
            Some(*sum)
        });
        std::iter::once(0.0).chain(sums).take(self.len()).collect()
    }

    /// The samples of a range, as a segment of its own.
    pub fn part(&self, range: std::ops::Range<usize>) -> Self {
        let slice = |series: &Vec<f64>| series[range.clone()].to_vec();
        Self {
            label: self.label.clone(),
            time: slice(&self.time),
            steps: match &self.steps {
                Steps::Even(step) => Steps::Even(*step),
                Steps::Uneven(steps) => {
                    Steps::Uneven(steps[range.start..(range.end - 1).max(range.start)].to_vec())
                }
            },
            inputs: self.inputs.iter().map(slice).collect(),
            measured: self.measured.iter().map(slice).collect(),
        }
    }
}
