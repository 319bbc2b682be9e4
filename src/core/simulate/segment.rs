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
    /// How many integration steps that takes.
    pub substeps: Substeps,
    /// By input, then by sample.
    pub inputs: Vec<Vec<f64>>,
    /// By output, then by sample.
    pub measured: Vec<Vec<f64>>,
}

/// The time from each sample to the next, s.
#[derive(Clone, PartialEq, Debug)]
pub enum Steps {
    /// The same everywhere.
    Even(f64),
    /// One for each pair of neighbouring samples.
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

impl Steps {
    /// The longest, s.
    pub(crate) fn longest(&self) -> f64 {
        match self {
            Self::Even(step) => *step,
            Self::Uneven(steps) => steps.iter().copied().fold(0.0, f64::max),
        }
    }
}

/// The number of integration steps between two samples.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Substeps {
    /// The same between all neighbours, however far apart they are.
    Each(usize),
    /// As many as it takes for none to be longer than this, s.
    NoLonger(f64),
}

impl Default for Substeps {
    fn default() -> Self {
        Self::Each(1)
    }
}

/// A step may be longer than asked for by this share: lengths in seconds are rounded.
const ROUNDING: f64 = 1e-9;

impl Substeps {
    /// The number between two samples that are `length` seconds apart; at least one.
    pub fn within(self, length: f64) -> usize {
        match self {
            Self::Each(count) => count.max(1),
            Self::NoLonger(longest) => {
                ((length / longest * (1.0 - ROUNDING)).ceil() as usize).max(1)
            }
        }
    }
}

impl Segment {
    /// From the first sample to the last, s.
    pub(crate) fn duration(&self) -> f64 {
        (1..self.len()).map(|k| self.steps.length(k - 1)).sum()
    }

    /// The most integration steps between two samples.
    pub fn most_substeps(&self) -> usize {
        self.substeps.within(self.steps.longest())
    }

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
            substeps: self.substeps,
            inputs: self.inputs.iter().map(slice).collect(),
            measured: self.measured.iter().map(slice).collect(),
        }
    }
}
