//! Cost, steps, output error, error bounds.
mod options;
mod report;
pub use options::{Method, Noise, NoiseStructure, Options};
pub use report::{
    Bound, CollinearSet, Estimate, Iteration, Outcome, OutputFit, OutputSeries, ParameterEstimate,
    Series, TimeHistory,
};
