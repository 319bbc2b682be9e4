//! Estimates while the data come in: recursive least squares, recursive Fourier-transform regression, extended Kalman filter.
//!
//! A [`Tracker`] takes one sample at a time and says after each what the parameters are, with bounds. It looks at no sample that is
//! still to come, keeps none for longer than its window, and a sample costs no allocation once the second has come.
//!
//! | method | what it does | when it equals a batch |
//! |---|---|---|
//! | `rls` | least squares of the state equations on smoothed and differentiated states, with exponential forgetting | λ = 1, [`crate::estimate::equation_error`] |
//! | `rft` | least squares of their finite Fourier transforms over a band (Morelli, J. Guidance, Control, and Dynamics 23, 2000) | λ = 1, [`crate::estimate::equation_error_frequency`] |
//! | `ekf` | an extended Kalman filter of states and parameters (Jazwinski 1970; Jategaonkar 2015, ch. 7) | never: a filter linearises once, where it stands |
//!
//! Files stand on each other: `options`, `sample`, `estimates` (types) under `setup` (the model and its parameters), under
//! `equations` (regressors), `window`, `sums`, `solver`, `flow`, `begin` (pieces), under `least_squares`, `fourier`, `kalman`, under
//! `tracker`.
//!
//! Invariant: the same samples give the same estimates to the last bit, however they are cut into pieces; a sample that is
//! refused changes nothing.

mod begin;
mod equations;
mod estimates;
mod flow;
mod fourier;
mod kalman;
mod least_squares;
mod options;
mod sample;
mod setup;
mod solver;
mod sums;
mod tracker;
mod window;

pub use estimates::{Estimates, TrackedParameter};
pub use options::{TrackingMethod, TrackingOptions};
pub use sample::{Sample, SampleFault};
pub use setup::Setup;
pub use tracker::Tracker;
