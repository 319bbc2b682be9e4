//! One sample, and why it cannot be taken.

/// What was recorded at one time, SI.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Sample<'s> {
    /// s, on any axis.
    pub time: f64,
    /// By input of the model.
    pub inputs: &'s [f64],
    /// By output of the model; NaN where nothing was measured.
    pub outputs: &'s [f64],
}

/// Why a sample cannot be taken. It changes nothing: the next one may come.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum SampleFault {
    /// The number of values is not that of the model.
    #[error("{found} {what} where the model has {wanted}; give one value for each")]
    Width {
        /// Inputs or outputs.
        what: &'static str,
        /// How many came.
        found: usize,
        /// How many it takes.
        wanted: usize,
    },
    /// The time is no number.
    #[error("the time is not a number")]
    NoTime,
    /// The time is not after that of the sample before.
    #[error("time does not increase: {time} s after {before} s; send samples in order, each once")]
    NotLater {
        /// s.
        time: f64,
        /// s.
        before: f64,
    },
    /// The step is not that of the samples before, as running transforms need.
    #[error(
        "{step} s from the sample before, where samples are {wanted} s apart: rft needs even steps; send lost samples with null in them, or begin anew"
    )]
    Uneven {
        /// s.
        step: f64,
        /// s.
        wanted: f64,
    },
    /// An input has no value.
    #[error(
        "input {name} has no value: every sample needs one; send the last value again where it was lost"
    )]
    NoInput {
        /// Of the input.
        name: String,
    },
    /// The filter has left the range of numbers.
    #[error(
        "the filter leaves the range of numbers; begin anew with smaller uncertainty or with better start values"
    )]
    Diverged,
}
